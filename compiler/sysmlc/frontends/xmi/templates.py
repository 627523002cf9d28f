"""Templates: their parameters, and bindings that substitute the parameters (UML 2.5.1 clause 7.3).

A template has at most one signature, so that its parameters belong to the template itself in the
graph.
"""

from functools import partial

from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.attributes import defer_ids
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.elements import make_handler
from sysmlc.frontends.xmi.unit import File, RowHandler, Stage
from sysmlc.frontends.xmi.value_features import lower_value
from sysmlc.ir import Edge, Element

_CONTAINING = ("ownedParameteredElement", "ownedActual")
"""Features whose content the parameter or substitution refers to."""


def _lower_signature(file: File, row: int) -> None:
    document = file.document
    file.mark_mapped(row)
    owner = file.find_owner(row)
    for child in document.children(row, "ownedParameter"):
        # Papyrus omits the type; the same feature of operations contains parameters.
        if not document.types[child]:
            document.retype(child, "TemplateParameter")
    if owner is not None:
        targets = document.targets(row, "extendedSignature")
        defer_ids(file, owner, "extended_signature", targets)


def _complete_parameter(file: File, parameter: Element, row: int) -> None:
    document = file.document
    for feature in _CONTAINING:
        for child in document.children(row, feature):
            id = document.id(child)
            if id and document.types[child] not in metaclasses.VALUE_TYPES:
                reference = WrittenReference(id, child)
                file.add_reference(Edge.REFERENCES, parameter.id, reference, feature)
    for child in document.children(row, "ownedDefault"):
        if document.types[child] not in metaclasses.VALUE_TYPES:
            defer_ids(file, parameter, "default", [document.id(child)])
    file.defer(Stage.BEHAVIOURS, partial(_name_parameter, file, parameter, row))


def _name_parameter(file: File, parameter: Element, row: int) -> None:
    """Give a parameter the name of the element that it exposes; it has no name of its own."""
    document = file.document
    references = document.references(row, "parameteredElement")
    references += [
        WrittenReference(id, child)
        for child in document.children(row, "ownedParameteredElement")
        if (id := document.id(child))
    ]
    for reference in references[:1]:
        target = file.find_target(reference)
        if target is not None and not parameter.name:
            file.unit.graph.rename(parameter, target.name)


def _make_value_handler(key: str) -> RowHandler:
    """Return a handler that stores a value as an attribute of its owner."""

    def lower(file: File, row: int) -> None:
        owner = file.find_owner(row)
        value = lower_value(file, row).value
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
