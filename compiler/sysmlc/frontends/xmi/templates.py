"""Templates: their parameters, and bindings that substitute the parameters (UML 2.5.1 clause 7.3).

A template has at most one signature, so that its parameters belong to the template itself in the
graph.
"""

from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.context import Context, RowHandler
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.elements import make_handler
from sysmlc.frontends.xmi.value_features import lower_value
from sysmlc.ir import Edge, Element

_CONTAINING = ("ownedParameteredElement", "ownedActual")
"""Features whose content the parameter or substitution refers to."""


def _lower_signature(context: Context, row: int) -> None:
    document = context.document
    context.mark_mapped(row)
    owner = context.find_owner(row)
    for child in document.children(row, "ownedParameter"):
        # Papyrus omits the type; the same feature of operations contains parameters.
        if not document.types[child]:
            document.retype(child, "TemplateParameter")
    if owner is not None:
        targets = document.targets(row, "extendedSignature")
        context.defer_ids(owner, "extended_signature", targets)


def _complete_parameter(context: Context, parameter: Element, row: int) -> None:
    document = context.document
    for feature in _CONTAINING:
        for child in document.children(row, feature):
            id = document.id(child)
            if id and document.types[child] not in metaclasses.VALUE_TYPES:
                reference = WrittenReference(id, child)
                context.add_reference(Edge.REFERENCES, parameter.id, reference, feature)
    for child in document.children(row, "ownedDefault"):
        if document.types[child] not in metaclasses.VALUE_TYPES:
            context.defer_ids(parameter, "default", [document.id(child)])
    context.completions.append((_name_parameter, parameter, row))


def _name_parameter(context: Context, parameter: Element, row: int) -> None:
    """Give a parameter the name of the element that it exposes; it has no name of its own."""
    document = context.document
    references = document.references(row, "parameteredElement")
    references += [
        WrittenReference(id, child)
        for child in document.children(row, "ownedParameteredElement")
        if (id := document.id(child))
    ]
    for reference in references[:1]:
        target = context.unit.find_target(context.file, reference.target, reference.is_href)
        if target is not None and not parameter.name:
            context.graph.rename(parameter, target.name)


def _make_value_handler(key: str) -> RowHandler:
    """Return a handler that stores a value as an attribute of its owner."""

    def lower(context: Context, row: int) -> None:
        owner = context.find_owner(row)
        value = lower_value(context, row).value
        if owner is not None:
            owner.attrs[key] = value

    return lower


FEATURES: dict[str, RowHandler] = {
    "ownedDefault": _make_value_handler("default"),
    "ownedActual": _make_value_handler("value"),
}

TYPES: dict[str, RowHandler] = {
    "TemplateSignature": _lower_signature,
    "RedefinableTemplateSignature": _lower_signature,
    **{
        name: make_handler(name, _complete_parameter)
        for name in (
            "TemplateParameter",
            "ClassifierTemplateParameter",
            "OperationTemplateParameter",
            "ConnectableElementTemplateParameter",
            "TemplateParameterSubstitution",
        )
    },
}
