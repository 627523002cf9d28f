"""Templates: their parameters, and bindings with what takes the parameters' places.

UML 2.5.1 clause 7.3. A template has at most one signature: its parameters belong to the template
itself in the graph.
"""

from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.behaviour import references
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.elements import Reader, reading
from sysmlc.frontends.xmi.value_features import value_in
from sysmlc.ir import Edge, Element

_OWNED = ("ownedParameteredElement", "ownedActual")


def _signature(context: Context, row: int) -> None:
    document = context.document
    context.inherit(row)
    owner = context.owner(row)
    for child in document.children(row, "ownedParameter"):
        # Papyrus omits the type; the same feature of operations holds other elements.
        if not document.types[child]:
            document.retype(child, "TemplateParameter")
    targets = document.targets(row, "extendedSignature")
    if owner is not None:
        context.keep_ids(owner, "extended_signature", targets)


def _parameter(context: Context, element: Element, row: int) -> None:
    for feature in _OWNED:
        for child in context.document.children(row, feature):
            id = context.document.id(child)
            if id and context.document.types[child] not in metaclasses.VALUE_TYPES:
                context.link(Edge.REFERENCES, element.id, id, child, feature)
    for child in context.document.children(row, "ownedDefault"):
        if context.document.types[child] not in metaclasses.VALUE_TYPES:
            context.keep_ids(element, "default", [context.document.id(child)])
    context.deferred.append((_name, element, row))


def _name(context: Context, element: Element, row: int) -> None:
    """A parameter is called as what it stands for: itself it has no name."""
    targets = references(context.document, row, "parameteredElement")
    targets += [
        (id, child, False)
        for child in context.document.children(row, "ownedParameteredElement")
        if (id := context.document.id(child))
    ]
    for target, _, is_href in targets[:1]:
        found = context.unit.find(context.lowered, target, is_href)
        if found is not None and not element.name:
            name = found[0].document.attributes[found[1]].get("name", "")
            context.graph.rename(element, name)


def _owned_default(context: Context, row: int) -> None:
    """What takes the parameter's place when a binding says nothing."""
    _put(context, row, "default")


def _owned_actual(context: Context, row: int) -> None:
    _put(context, row, "value")


def _put(context: Context, row: int, key: str) -> None:
    owner = context.owner(row)
    value = value_in(context, row).value
    if owner is not None:
        owner.attrs[key] = value


FEATURES: dict[str, Reader] = {"ownedDefault": _owned_default, "ownedActual": _owned_actual}

TYPES: dict[str, Reader] = {
    "TemplateSignature": _signature,
    "RedefinableTemplateSignature": _signature,
    **{
        name: reading(name, _parameter)
        for name in (
            "TemplateParameter",
            "ClassifierTemplateParameter",
            "OperationTemplateParameter",
            "ConnectableElementTemplateParameter",
            "TemplateParameterSubstitution",
        )
    },
}
