"""Rows that are no elements of their own: references, edges, bounds, defaults and values."""

from collections.abc import Callable, Collection

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import feature_names as naming
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi import value_features as value_rows
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.dangling import look_inside
from sysmlc.frontends.xmi.making import make
from sysmlc.frontends.xmi.parts import is_part
from sysmlc.frontends.xmi.uml_features import is_misplaced
from sysmlc.ir import Edge, Element, Kind

_Reader = Callable[[Context, int], None]


_ALWAYS_VALUES = frozenset(
    {
        "lowerValue",
        "upperValue",
        "lower",
        "upper",
        "defaultValue",
        "joinSpec",
        "upperBound",
        "specification",
    }
    | {"clause", "handler", "endData", "weight", "nameExpression"}
)
"""Features that hold values whatever their type."""

# -- what a row is -----------------------------------------------------------------------------


def is_value(context: Context, row: int, feature: str) -> bool:
    """Whether the row holds a value, not an element of the same feature (a pin, a constraint)."""
    if feature in _ALWAYS_VALUES:
        return True
    type_name = context.document.types[row]
    if type_name:
        return type_name in metaclasses.VALUE_TYPES
    if feature != "value":
        return feature not in metaclasses.DEFAULT_TYPES
    owner = context.owner(row)
    return owner is not None and (owner.kind is Kind.SLOT or owner.subkind == "value")


def is_text(context: Context, row: int, feature: str) -> bool:
    """Whether the row is only text: an attribute written as a child."""
    document = context.document
    if feature in metaclasses.DEFAULT_TYPES or document.ends[row] != row + 1:
        return False
    return all("}" in name for name in document.attributes[row])


# -- notation ----------------------------------------------------------------------------------


def notation(context: Context, row: int) -> int:
    """Notation and tool settings; bounds inside MagicDraw's extensions are content."""
    document = context.document
    end = context.subtree(row, Verdict.IGNORED_NOTATION)
    if document.features[row] == "eAnnotations":
        _namespaces(context, row)
    elif document.features[row] == "Extension" and end > row + 1:
        _extension_bounds(context, row)
    return end


def _extension_bounds(context: Context, row: int) -> None:
    document = context.document
    if not context.lowered.own[document.parents[row]]:
        return
    for model in document.children(row, "modelExtension"):
        for child in document.children(model):
            if document.features[child] in ("lowerValue", "upperValue"):
                value_rows.FEATURES[document.features[child]](context, child)


def _namespaces(context: Context, row: int) -> None:
    """Papyrus keeps the namespaces of a profile in an Ecore copy of it."""
    gid = context.gids[row]
    for child in range(row + 1, context.document.ends[row]):
        uri = context.document.attributes[child].get("nsURI")
        if uri and gid:
            context.unit.profiles.add(uri, gid)


# -- references --------------------------------------------------------------------------------


def reference(context: Context, row: int, feature: str) -> int:
    """A child with ``xmi:idref`` or ``href`` stands for what it refers to."""
    document = context.document
    end = context.subtree(row, Verdict.MAPPED)
    for child in document.children(row) if end > row + 1 else ():
        context.subtree(child, Verdict.IGNORED_NOTATION)
    parent = document.parents[row]
    owner = context.owner(row)
    href = document.attributes[row].get("href", "")
    if owner is not None and is_part(context, row, feature):
        context.verdicts[row] = Verdict.EXTERNAL
        context.parts.append(row)
    elif owner is None or feature in ("packagedElement", "nestedPackage"):
        context.verdicts[row] = Verdict.EXTERNAL if href else Verdict.MAPPED
    elif not context.lowered.own[parent]:
        edge = v.FOLDED_REFERENCES.get(feature)
        if edge is not None:
            context.link(edge, owner.id, href or document.idref(row), row, feature, bool(href))
        elif not href:
            context.look(parent, feature, document.idref(row))
    else:
        _refer(context, owner, row, feature, href)
    return end


def _refer(context: Context, owner: Element, row: int, feature: str, href: str) -> None:
    target = href or context.document.idref(row)
    edge = v.SPECIAL.get((owner.kind, feature)) or v.REFERENCES.get(feature)
    if edge is not None:
        context.link(edge, owner.id, target, row, feature, bool(href))
        return
    backwards = v.REVERSED.get((owner.kind, feature))
    if backwards is not None:
        context.link(backwards, owner.id, target, row, feature, bool(href), is_reversed=True)
    elif feature in v.CONDITIONS:
        context.conditions([target], feature)
    elif feature in v.REDUNDANT:
        if not href:
            context.look(context.document.parents[row], feature, target)
    elif feature not in ("partWithPort", "guard", "event"):
        _keep(context, owner, row, feature, href)


def _keep(context: Context, owner: Element, row: int, feature: str, href: str) -> None:
    key = v.snake(feature)
    if href:
        context.keep_ids(owner, key, [href], is_href=True)
    elif feature not in ("sendEvent", "receiveEvent"):
        parent = context.document.parents[row]
        context.keep_ids(owner, key, context.document.targets(parent, feature))


_SAID_BY_OWNER = naming.NAMING - v.FOLDED_REFERENCES.keys()
"""Features of what is an edge of its owner: they lead back to it, or to what both are in."""


# -- edges of the owner ------------------------------------------------------------------------


def _edge(context: Context, row: int) -> None:
    context.inherit(row)
    owner = context.owner(row)
    if owner is None:
        return
    values = context.document.attributes[row]
    for feature, edge in v.FOLDED_REFERENCES.items():
        for target in context.document.tokens(values.get(feature, "")):
            context.link(edge, owner.id, target, row, feature)
    for feature in filter(_SAID_BY_OWNER.__contains__, values):
        context.look(row, feature, values[feature])
    # A name where UML has none, of a generalization, is told as such.
    is_named = not is_misplaced(context.document.types[row], "name")
    tell_lost(context, row, _SAID_BY_OWNER | v.FOLDED_REFERENCES.keys(), is_named=is_named)


def tell_lost(context: Context, row: int, kept: Collection[str], *, is_named: bool = False) -> None:
    """What a row says beyond ``kept`` is not in the graph, unless it is the default anyway.

    Visibilities of what is no element are passed over, for tools make them, and names unless
    the row ``is_named`` by people.
    """
    values = context.document.attributes[row]
    lost = [name for name in values if name in _HAS_MEANING and name not in kept]
    lost = [name for name in lost if values[name] != v.default(name)]
    lost += ["name"] if is_named and values.get("name") else []
    if lost:
        context.approximate(row, ", ".join(f"'{name}'" for name in lost))


_HAS_MEANING = naming.FEATURES - {"name", "visibility"}


def _extension(context: Context, row: int) -> None:
    """The ends of an extension say what the property ``base_...`` of the stereotype says."""
    context.subtree(row, Verdict.MAPPED)
    look_inside(context, row)


def _property(context: Context, row: int) -> None:
    document = context.document
    owner = context.owner(row)
    name = document.attributes[row].get("name", "")
    if owner is not None and owner.kind is Kind.STEREOTYPE and name.startswith("base_"):
        _metaclass(context, row, owner)
    elif not make(context, row, Kind.PROPERTY, "", "Property", document.features[row]):
        context.subtree(row, Verdict.UNSUPPORTED)


def _metaclass(context: Context, row: int, owner: Element) -> None:
    document = context.document
    context.subtree(row, Verdict.MAPPED)
    look_inside(context, row)
    for target in document.targets(row, "type"):
        context.link(Edge.EXTENDS, owner.id, target, row, "type")
    for child in document.children(row, "type"):
        href = document.attributes[child].get("href")
        if href:
            context.link(Edge.EXTENDS, owner.id, href, child, "type", is_href=True)


def _image(context: Context, row: int) -> None:
    context.subtree(row, Verdict.IGNORED_NOTATION)


TYPES: dict[str, _Reader] = {
    **dict.fromkeys(metaclasses.EDGE_TYPES, _edge),
    "Extension": _extension,
    "ExtensionEnd": _extension,
    "Property": _property,
    "Image": _image,
}
