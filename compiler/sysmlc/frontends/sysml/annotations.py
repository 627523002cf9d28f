"""Comments, documentation and metadata: what annotates an element."""

from collections.abc import Callable, Collection, Iterator
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import kept, nodes, values
from sysmlc.frontends.sysml.libraries import OUR_LIBRARY, PROFILE, RECIPES
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_STAND_INS = "Stereotypes"
"""The package of what the back end writes for stereotypes whose profile is not there."""


_OWNED = frozenset({"OwningMembership", "FeatureMembership"})


def texts(
    low: "Lowering", node: Node, made: Element, what: str, read: Collection[Node] = ()
) -> None:
    """Lower what annotates an element that has no members in the graph; other ones are told.

    ``what`` is what the element is, in words; ``read`` are members that are read elsewhere.
    """
    for one in nodes.body_of(node):
        if nodes.is_text(one):
            low.lower(one, made)
        elif one.membership in _OWNED and one not in read and one.kind not in _EVENTS:
            low.approximated(one, f"a member of {what}", "nothing")


_EVENTS = nodes.EXPRESSIONS | {"EventOccurrenceUsage"}


def documentation(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A comment about its owner."""
    made = _comment(low, node, owner)
    if owner is not None:
        low.graph.connect(Edge.REFERENCES, made, owner)


def comment(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A comment about what it names, else about its owner (KerML 1.0, 8.3.2.3.2)."""
    made = _comment(low, node, owner)
    about = nodes.references(node, "Annotation")
    for one in about:
        low.refer(Edge.REFERENCES, made, one)
    if not about and owner is not None:
        low.graph.connect(Edge.REFERENCES, made, owner)


def _comment(low: "Lowering", node: Node, owner: Element | None) -> Element:
    body = str(node.attributes.get("body", "")).strip()
    return low.add(node, Kind.COMMENT, node.name or "", owner, body=body)


def representation(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A text in another language: the body of its owner, which an opaque element becomes."""
    if owner is None:
        low.unsupported(node)
        return
    body, language = (
        str(node.attributes.get("body", "")).strip(),
        str(node.attributes.get("language", "")),
    )
    bodies = owner.attrs.get("bodies", owner.attrs.get("body"))
    known = bodies if isinstance(bodies, tuple) else () if bodies is None else (bodies,)
    spoken = owner.attrs.get("languages", owner.attrs.get("language", ""))
    languages = spoken if isinstance(spoken, tuple) else (spoken,) * len(known)
    if not known:
        low.set(owner, body=body, language=language)
    else:
        low.set(owner, bodies=(*known, body), languages=(*languages, language))
    if owner.kind in (Kind.ACTIVITY, Kind.ACTION) and not owner.subkind:
        low.set(owner, subkind="opaque")


# -- metadata ----------------------------------------------------------------------------------


def metadata(low: "Lowering", node: Node, owner: Element | None) -> None:
    """Metadata of ours is read with its owner; any other is an applied stereotype."""
    name = our_name(node)
    if name:
        if owner is not None and name in _READ:
            _READ[name](low, node, owner)
        return
    about = nodes.references(node, "Annotation")
    definition = nodes.target(node, "FeatureTyping")
    name = _definition_name(node, definition)
    made = low.add(node, Kind.APPLICATION, name, owner, stereotype=name)
    low.set(made, namespace=_namespace(definition))
    if owner is not None and not about:
        low.graph.connect(Edge.SUBJECT, made, owner)
    for one in about:
        low.refer(Edge.SUBJECT, made, one)
    if definition is not None and low.document(definition) is not None:
        low.later(lambda: _instance_of(low, made, definition))
    for key, value in facts_of(node):
        give_tag(low, made, key, value)


def _named(low: "Lowering", node: Node, owner: Element) -> None:
    """The name in the source; none where only the text needs one."""
    low.graph.rename(owner, str(dict(constants_of(node)).get("name", "")))


def _kept(low: "Lowering", node: Node, owner: Element) -> None:
    """Facts that no word of SysML v2 says."""
    kept.read(low, dict(constants_of(node)), owner)


def _element(low: "Lowering", node: Node, owner: Element) -> None:
    """An element for which SysML v2 has nothing."""
    facts = dict(constants_of(node))
    kind = _BY_NAME.get(str(facts.get("kind")))
    if kind is not None:
        made = low.add(node, kind, str(facts.get("name", "")), owner)
        kept.read(low, facts, made)


_BY_NAME = {str(kind): kind for kind in Kind}


def is_of_type(node: Node) -> bool:
    """Whether metadata stands for an element that the type of its feature owns."""
    return our_name(node) == "Element" and bool(dict(constants_of(node)).get("isOfType"))


_READ: dict[str, Callable[["Lowering", Node, Element], None]] = {
    "Named": _named,
    "Kept": _kept,
    "Element": _element,
}
"""Metadata of ours that is read where it stands; other is read with its owner."""


def give_tag(low: "Lowering", made: Element, key: str, value: Node) -> None:
    """Give a tagged value to an applied stereotype, when all elements are there."""
    low.later(lambda: _tag(low, made, key, value))


_RENAMED = {"MaterialUse": "Material"}
"""A usage of metadata cannot have the name of the level, which is a part definition."""


def _definition_name(node: Node, definition: Node | None) -> str:
    if definition is not None:
        return _RENAMED.get(definition.name or "", definition.name or definition.short_name or "")
    found = nodes.reference(node, "FeatureTyping")
    return "" if found is None else nodes.last_name(found)


def _namespace(definition: Node | None) -> str:
    """The profile of a stand-in, as it says; that of the recipe levels for our own library."""
    if definition is None:
        return ""
    top = nodes.top_of(definition)
    if top is not definition and nodes.name_of(top) == RECIPES:
        return PROFILE
    for one in nodes.members(definition, "MetadataUsage"):
        if our_name(one) == "External":
            return str(dict(constants_of(one)).get("href", ""))
    return ""


def is_stand_in(node: Node) -> bool:
    """Whether a definition only stands for the stereotype of a profile that is not there."""
    owner = node.owner
    return owner is not None and owner.name == _STAND_INS and owner.kind == "Package"


def _instance_of(low: "Lowering", made: Element, definition: Node) -> None:
    stereotype = low.element(definition)
    if stereotype is not None:
        low.graph.connect(Edge.INSTANCE_OF, made, stereotype)


def _tag(low: "Lowering", made: Element, key: str, value: Node) -> None:
    name = f"tag.{key}"
    found = values.constant(value)
    if found is not None:
        low.graph.set(made, **{name: _tagged(low, found)})
        return
    known = low.element(nodes.target(value, "Membership"))
    low.graph.set(made, **{name: known.id if known is not None else values.texts(value, low)})


def _tagged(low: "Lowering", value: AttrValue) -> AttrValue:
    """A tagged value as text; the qualified name of an element of the unit is its id."""
    if isinstance(value, tuple):
        return tuple(_tagged(low, one) for one in value)
    if isinstance(value, bool):
        return "true" if value else "false"
    text = str(value)
    return low.id_of(text) or text if "::" in text else text


def facts_of(node: Node) -> Iterator[tuple[str, Node]]:
    """Names and expressions of the values that metadata gives."""
    for one in node.members:
        value = nodes.value_of(one)
        name = nodes.name_of(one)
        if value is not None and name:
            yield name, value


def constants_of(node: Node) -> Iterator[tuple[str, AttrValue]]:
    """Names and values of what metadata gives as literals."""
    for name, value in facts_of(node):
        found = values.constant(value)
        if found is not None:
            yield name, found


def our_name(node: Node) -> str:
    """Name of the definition in our library that metadata is typed by, or the empty string."""
    found = nodes.reference(node, "FeatureTyping")
    if found is None:
        return ""
    target = found.target
    if target is None or target.owner is None or target.owner.name != OUR_LIBRARY:
        return ""
    return target.name or target.short_name or ""


def ours(node: Node) -> dict[str, Node]:
    """Metadata of our library that a node has, by the names of the definitions."""
    found = {}
    for one in node.members:
        if one.kind == "MetadataUsage" and (name := our_name(one)):
            found[name] = one
    return found


def said(node: Node, name: str, key: str) -> AttrValue:
    """A value that metadata of our library gives to a node, or None."""
    one = ours(node).get(name)
    return None if one is None else dict(constants_of(one)).get(key)
