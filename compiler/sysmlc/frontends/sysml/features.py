"""Features of definitions: properties, ports, parameters of constraints, literals."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.definitions import marked, told, variant, visibility
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import generals
from sysmlc.language.tree import Node, Relation

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_COMPOSITE = frozenset({"PartUsage", "ItemUsage", "OccurrenceUsage", "ConstraintUsage"})
_CLASS_ROLES = {"PortUsage": "interface block", "AttributeUsage": "value type"}
_OWN_ROLES = frozenset({"block", "interface block", "value type", ""})


def property_(low: "Lowering", node: Node, owner: Element) -> Element:
    """A feature of a classifier; one with members of its own is typed by a class made for it."""
    kind, subkind = marked(node, Kind.PROPERTY)
    made = low.add(node, kind, nodes.name_of(node), owner, subkind=subkind, **_attrs(node, owner))
    describe(low, node, made)
    _aggregate(node, made)
    return made


def _attrs(node: Node, owner: Element) -> dict[str, AttrValue]:
    direction = node.attributes.get("direction")
    found: dict[str, AttrValue] = visibility(node) | told(node) | variant(node)
    if direction is not None and owner.role != "constraint block":
        found["direction"] = direction
        found["role"] = "flow property" if owner.role in _OWN_ROLES else ""
    return found


def _aggregate(node: Node, made: Element) -> None:
    is_own = not node.attributes.get("isReference") and "direction" not in node.attributes
    if not {"shared", "SharedAggregation"}.isdisjoint(annotations.ours(node)):
        made.attrs["aggregation"] = "shared"
    elif node.kind in _COMPOSITE and is_own and not node.attributes.get("isEnd"):
        made.attrs["aggregation"] = "composite"


def describe(low: "Lowering", node: Node, made: Element) -> None:
    """What a declaration says of a feature: flags, multiplicity, types, generals, value, texts."""
    flags, bounds = _flags(node), values.multiplicity(low, node)
    if flags or bounds:
        low.set(made, **flags, multiplicity=bounds)
    if node.attributes.get("isUnique") is False:
        low.graph.set(made, unique=False)
    relate(low, node, made)
    value = nodes.value_of(node)
    if value is not None:
        values.give(low, made, "default", value)
    if node.members:
        _inside(low, node, made)


_FLAGS = {
    "isAbstract": "abstract",
    "isDerived": "derived",
    "isConstant": "readonly",
    "isOrdered": "ordered",
    "isIndividual": "individual",
}


def _flags(node: Node) -> dict[str, AttrValue]:
    """What the facts of a feature are as attributes, in this order."""
    if _FLAGS.keys().isdisjoint(node.attributes):
        return {}
    return {flag: bool(node.attributes.get(fact)) for fact, flag in _FLAGS.items()}


def relate(low: "Lowering", node: Node, made: Element) -> None:
    """Types, and features that are redefined or subsetted; those of the library give types only."""
    for relation in node.relations:
        _relate(low, made, relation)
    own = _own_class(low, node, made) if node.members else None
    if own is not None:
        low.graph.connect(Edge.TYPED_BY, made, own)
        return
    low.later(lambda: give_types(low, node, made))


def _relate(low: "Lowering", made: Element, relation: Relation) -> None:
    if relation.kind == "ConjugatedPortTyping":
        low.set(made, conjugated=True)
    if relation.kind not in _ABOUT_FEATURES:
        return
    found = relation.reference
    target = found.target
    if target is not None and low.document(target) is None:
        return
    if relation.kind == "Redefinition":
        low.refer(Edge.REDEFINES, made, found)
    else:
        low.last(lambda: _subset(low, made, found.target))


_ABOUT_FEATURES = frozenset({"Redefinition", *nodes.SUBSETTINGS})


def _subset(low: "Lowering", made: Element, target: Node | None) -> None:
    """A feature that the owner has or inherits is subsetted; one of another type is referred to."""
    known = low.element(target)
    owner, above = low.graph.owner(made), None if known is None else low.graph.owner(known)
    if known is None or owner is None or above is None:
        low.lead(Edge.SUBSETS, made, target)
        return
    is_inherited = above is owner or above in generals(low.graph, owner)
    low.graph.connect(Edge.SUBSETS if is_inherited else Edge.REFERENCES, made, known)


def give_types(low: "Lowering", node: Node, made: Element) -> None:
    """Edges to the types of a feature, stated or inherited; the elements must be there."""
    stated = nodes.references(node, "FeatureTyping", "ConjugatedPortTyping")
    for one in stated:
        low.lead(Edge.TYPED_BY, made, one.target)
    if not stated:
        for target in types_of(low, node):
            low.lead(Edge.TYPED_BY, made, target)


def _inside(low: "Lowering", node: Node, made: Element) -> None:
    """Texts belong to the feature itself, other members to the class that is made for it."""
    own = low.made_for.get(id(node))
    for one in nodes.body_of(node):
        if _is_of_itself(one, node):
            low.lower(one, made)
        elif own is not None and id(one) not in low.repeated:
            low.lower(one, own)


def _own_class(low: "Lowering", node: Node, made: Element) -> Element | None:
    """A class for what a usage has beyond its type (SysML 1.6 clause 8.3.2.10)."""
    rest = [one for one in nodes.body_of(node) if not _is_of_itself(one, node)]
    if not rest:
        return None
    rest = [one for one in rest if not is_interface_id(low, one, made)]
    if not rest:
        return None
    owner = low.graph.owner(made)
    role = _CLASS_ROLES.get(node.kind, "block")
    kind = Kind.DATA_TYPE if role == "value type" else Kind.CLASS
    own = low.make(node, kind, made.name, owner, role=role, property_specific=True)
    if made.attrs.pop("variation", False):
        low.set(own, variation=True)
    low.made_for[id(node)] = own
    low.later(lambda: low.lead_all(Edge.SPECIALIZES, own, types_of(low, node)))
    # Metadata may say another name of the feature than the text has.
    low.last(lambda: low.graph.rename(own, made.name))
    return own


def _is_of_itself(one: Node, feature: Node) -> bool:
    """Whether a member says something of the feature: a text, or what it realises."""
    is_realization = one.kind == "Dependency" and "Realization" in annotations.ours(one)
    is_own = is_realization and not one.name and nodes.target(one, "client") is feature
    return is_own or (nodes.is_text(one) and not annotations.is_of_type(one))


def is_interface_id(low: "Lowering", node: Node, made: Element) -> bool:
    """Whether a redefined port only says the id that it has in AutomationML."""
    is_id = node.kind == "PortUsage" and "AutomationML" in annotations.ours(node)
    if not is_id or len(nodes.body_of(node)) != 1 or nodes.target(node, "Redefinition") is None:
        return False
    given = annotations.said(node, "AutomationML", "id")
    target = nodes.target(node, "Redefinition")
    low.repeated.add(id(node))
    low.skipped.update(map(id, nodes.body_of(node)))
    low.later(lambda: _interface_id(low, made, target, given))
    return True


def _interface_id(low: "Lowering", made: Element, target: Node | None, given: AttrValue) -> None:
    port = low.element(target)
    known = made.attrs.get("interface_ids")
    if port is not None and made.kind is not Kind.CLASS:
        pairs = known if isinstance(known, tuple) else ()
        low.graph.set(made, interface_ids=(*pairs, (port.id, given)))


# -- ports -------------------------------------------------------------------------------------


def port(low: "Lowering", node: Node, owner: Element) -> Element:
    """A port; one that only holds what flows through it is a flow port of SysML 1.2."""
    direction = node.attributes.get("direction")
    given = _attrs(node, owner) | {"role": "proxy port", "direction": direction}
    said = annotations.said(node, "Kind", "name")
    if said == "port" or "AutomationML" in annotations.ours(node):
        given["role"] = "port"
    elif "FullPort" in annotations.ours(node):
        given["role"] = "full port"
    made = low.add(node, Kind.PORT, nodes.name_of(node), owner, **given)
    flowing = _flowing(node)
    if flowing is not None:
        _flow_port(low, node, flowing, made)
    else:
        describe(low, node, made)
    return made


def _flowing(node: Node) -> Node | None:
    rest = [one for one in nodes.body_of(node) if not nodes.is_text(one)]
    is_only = len(rest) == 1 and rest[0].kind == "ReferenceUsage" and not nodes.name_of(rest[0])
    return rest[0] if is_only and not node.relations else None


def _flow_port(low: "Lowering", node: Node, flowing: Node, made: Element) -> None:
    is_plain = annotations.said(node, "Kind", "name") == "port"
    low.set(
        made,
        role="port" if is_plain else "flow port",
        direction=flowing.attributes.get("direction"),
        multiplicity=values.multiplicity(low, node),
    )
    for one in nodes.references(flowing, "FeatureTyping"):
        low.refer(Edge.TYPED_BY, made, one)
    low.seen.add(id(flowing))
    for held in (node, flowing):
        low.lower_texts(held, made)


def part_port(low: "Lowering", node: Node, owner: Element, role: str) -> Element:
    """A port of SysML v1 that a block types: a part with a keyword of ours."""
    made = low.add(node, Kind.PORT, nodes.name_of(node), owner, role=role, **visibility(node))
    describe(low, node, made)
    return made


PART_PORTS = {"FullPort": "full port", "BlockPort": "port"}


def literal(low: "Lowering", node: Node, owner: Element) -> Element:
    """One value of an enumeration."""
    made = low.add(node, Kind.ENUMERATION_LITERAL, nodes.name_of(node), owner)
    value = nodes.value_of(node)
    if value is not None:
        values.give(low, made, "value", value)
    annotations.texts(low, node, made, "an enumerated value")
    return made


def in_classifier(low: "Lowering", node: Node, owner: Element) -> Element:
    """A feature of a classifier by its metaclass."""
    if owner.kind is Kind.ENUMERATION and node.kind in ("EnumerationUsage", "AttributeUsage"):
        return literal(low, node, owner)
    if node.kind == "PortUsage":
        return port(low, node, owner)
    mark = next((one for one in annotations.ours(node) if one in PART_PORTS), "")
    if mark:
        return part_port(low, node, owner, PART_PORTS[mark])
    return property_(low, node, owner)
