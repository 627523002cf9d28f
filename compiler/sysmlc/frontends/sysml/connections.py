"""Connectors, bindings and flows between the parts of a classifier; associations."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.definitions import define, visibility
from sysmlc.frontends.sysml.features import property_
from sysmlc.frontends.sysml.kinds import CLASSIFIERS
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import generals, type_of
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering


def steps_of(end: Node) -> list[Node | None]:
    """Features on the way to the end of a connector or a flow, outermost first."""
    found: list[Node | None] = []
    named = nodes.references(end, "ReferenceSubsetting")
    for one in named or nodes.references(end, "Subsetting", "Redefinition"):
        found += _targets(one.targets, len(one.chain))
    for member in end.members:
        inner = nodes.reference(member, "Redefinition", "ReferenceSubsetting")
        if inner is not None:
            found += _targets(inner.targets, len(inner.chain))
        value = nodes.value_of(member)
        if inner is None and value is not None:
            found += steps_of_value(value)
    return found


def steps_of_value(value: Node) -> list[Node | None]:
    """Features that an expression leads through: a name, or a chain of features."""
    if value.kind == "FeatureChainExpression":
        found: list[Node | None] = []
        for one in value.members:
            found += steps_of_value(one)
        inner = nodes.reference(value, "Membership")
        return found + ([] if inner is None else _targets(inner.targets, len(inner.chain)))
    inner = nodes.reference(value, "Membership")
    if value.kind != "FeatureReferenceExpression" or inner is None:
        return [None]
    return _targets(inner.targets, len(inner.chain))


def _targets(found: list[Node] | None, number: int) -> list[Node | None]:
    known: list[Node | None] = list(found or ())
    return known if len(known) == number else [*known, None]


# -- connectors --------------------------------------------------------------------------------


def linking(node: Node) -> list[Node]:
    """The ends of a connection: those behind `connect`, else those of its body that name one."""
    inside = [one for one in nodes.body_of(node) if one.attributes.get("isEnd")]
    named = [one for one in inside if nodes.reference(one, "ReferenceSubsetting", "Subsetting")]
    return nodes.ends_of(node) or (named if len(named) > 1 else [])


def connector(low: "Lowering", node: Node, owner: Element, role: str = "") -> Element:
    """A connection, an interface or a binding between features of a classifier."""
    made = low.add(node, Kind.CONNECTOR, nodes.name_of(node), owner, role=role, **visibility(node))
    ends = linking(node)
    for end in ends:
        _end(low, end, made)
    _typed(low, node, made)
    for one in nodes.body_of(node):
        if one in ends:
            low.lower_all((text for text in one.members if nodes.is_text(text)), made)
        elif nodes.is_text(one):
            low.lower(one, made)
        elif one.kind in _FLOWS:
            low.lower(one, owner)
        else:
            low.approximated(one, "a feature of a connection", "nothing")
    return made


_FLOWS = frozenset({"FlowUsage", "SuccessionFlowUsage"})


def _typed(low: "Lowering", node: Node, made: Element) -> None:
    for type_ in types_of(low, node):
        if low.document(type_) is not None:
            low.later(lambda type_=type_: low.lead(Edge.TYPED_BY, made, type_))  # type: ignore[misc]


def _end(low: "Lowering", end: Node, made: Element) -> None:
    count = values.multiplicity(low, end)
    one = low.add(end, Kind.CONNECTOR_END, end.name or "", made, multiplicity=count)
    low.graph.connect(Edge.END, made, one)
    low.later(lambda: _lead(low, end, one))


def _lead(low: "Lowering", end: Node, one: Element) -> None:
    *path, role = steps_of(end) or [None]
    low.lead(Edge.ROLE, one, role)
    for step in path:
        low.lead(Edge.PATH, one, _feature(low, step))


def _feature(low: "Lowering", step: Node | None) -> Node | None:
    """The part that is meant where an instance says what is in it: parts lead to an end."""
    here = step
    while here is not None:
        known = low.element(here)
        if known is None or known.kind is not Kind.INSTANCE or known.subkind != "part":
            return here
        found = nodes.reference(here, "Redefinition")
        here = None if found is None else found.target
    return step


# -- flows -------------------------------------------------------------------------------------


def item_flow(low: "Lowering", node: Node, owner: Element | None) -> Element:
    """A flow between features of a classifier, along the connector that joins the same ends."""
    made = low.add(node, Kind.ITEM_FLOW, node.name or "", owner, role="item flow")
    low.set(made, **visibility(node))
    for payload in payloads(node):
        for type_ in nodes.references(payload, "FeatureTyping"):
            low.refer(Edge.CONVEYS, made, type_)
    annotations.texts(low, node, made, "a flow", payloads(node))
    low.last(lambda: _flow(low, node, made))
    return made


def payloads(node: Node) -> list[Node]:
    """What a flow or a message carries, and what a trigger accepts."""
    return [one for one in node.members if one.kind in _PAYLOADS and not nodes.is_text(one)]


_PAYLOADS = frozenset({"PayloadFeature", "ReferenceUsage", "Feature"})


def _flow(low: "Lowering", node: Node, made: Element) -> None:
    found = nodes.ends_of(node) or nodes.events_of(node)
    ends = [_ported(low, end) for end in found[:2]]
    for edge, path in zip((Edge.FLOW_SOURCE, Edge.FLOW_TARGET), ends, strict=False):
        if path:
            low.graph.connect(edge, made, path[-1])
    if len(ends) < 2 or not all(ends):
        low.graph.remove(made)
        low.elements.pop(id(node), None)
        low.unsupported(node)
        return
    owner = low.graph.owner(made)
    if owner is None or len(ends) < 2:
        return
    wanted = {tuple(one.id for one in path) for path in ends}
    for other in low.graph.owned(owner):
        if other.kind is Kind.CONNECTOR and wanted == _paths(low, other):
            low.graph.connect(Edge.REALIZING, made, other)
            return
    _say_paths(low, made, owner, ends)


def _say_paths(low: "Lowering", made: Element, owner: Element, ends: list[list[Element]]) -> None:
    """Say through which parts the ends are, where the features at the ends do not say it."""
    for key, (*path, _) in zip(("source_path", "target_path"), ends, strict=True):
        if path and (len(path) > 1 or _has_like(low, owner, path[0])):
            low.set(made, **{key: tuple(one.id for one in path)})


def _has_like(low: "Lowering", owner: Element, part: Element) -> bool:
    """Whether another part has the features of a part, too."""
    type_ = type_of(low.graph, part)
    for above in (owner, *generals(low.graph, owner)):
        for other in low.graph.owned(above):
            like = None if other is part else type_of(low.graph, other)
            if like is not None and type_ in (like, *generals(low.graph, like)):
                return True
            if like is not None and type_ is not None and like in generals(low.graph, type_):
                return True
    return False


def _ported(low: "Lowering", end: Node) -> list[Element]:
    """The features that lead to the end of a flow, up to the last port among them."""
    found = [known for step in steps_of(end) if (known := low.element(step)) is not None]
    for number in range(len(found) - 1, -1, -1):
        if found[number].kind is Kind.PORT:
            return found[: number + 1]
    return found


def _paths(low: "Lowering", connector_: Element) -> set[tuple[str, ...]]:
    graph, found = low.graph, set()
    for end in graph.targets(connector_, Edge.END):
        steps = [*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)]
        found.add(tuple(one.id for one in steps))
    return found


def flow_definition(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A flow between classifiers (UML 2.5.1 clause 20.1)."""
    ends = [one for one in node.members if _is_end(one)]
    if len(ends) < 2 or not all(nodes.reference(one, "FeatureTyping") for one in ends[:2]):
        low.unsupported(node)
        return
    made = low.add(node, Kind.ITEM_FLOW, nodes.name_of(node), owner, role="item flow")
    edges = iter((Edge.FLOW_SOURCE, Edge.FLOW_TARGET))
    for one in node.members:
        if _is_end(one):
            edge = next(edges, None)
            type_ = nodes.reference(one, "FeatureTyping")
            if edge is not None and type_ is not None:
                low.refer(edge, made, type_)
        elif nodes.is_text(one):
            low.lower(one, made)
        elif nodes.name_of(one) == "payload":
            for type_ in nodes.references(one, "FeatureTyping"):
                low.refer(Edge.CONVEYS, made, type_)


# -- associations ------------------------------------------------------------------------------


def association(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A connection definition; an end that repeats a feature of the other end's type is that."""
    kind, role = CLASSIFIERS[node.kind]
    ends = [one for one in node.members if _is_end(one)]
    low.skipped.update(id(one) for one in ends)
    made = define(low, node, owner, kind, role)
    low.last(lambda: _ends(low, ends, made))


def _is_end(node: Node) -> bool:
    return node.membership == "EndFeatureMembership" or bool(node.attributes.get("isEnd"))


def _ends(low: "Lowering", ends: list[Node], made: Element) -> None:
    for end in ends:
        known = _feature_of_other(low, end, ends)
        if known is None:
            low.skipped.discard(id(end))
            known = property_(low, end, made)
            low.work()
        else:
            low.elements[id(end)] = known
        low.graph.connect(Edge.END, made, known)


def _feature_of_other(low: "Lowering", end: Node, ends: list[Node]) -> Element | None:
    types = [low.element(one) for one in types_of(low, end)]
    for other in ends if len(ends) == 2 else ():
        for type_ in types_of(low, other) if other is not end else ():
            above = low.element(type_)
            for feature in low.graph.owned(above) if above is not None else ():
                is_same = feature.name == nodes.name_of(end) and feature.kind in _FEATURES
                if is_same and type_of(low.graph, feature) in types:
                    return feature
    return None


_FEATURES = (Kind.PROPERTY, Kind.PORT)


def allocation_definition(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An allocation between definitions."""
    attrs: dict[str, AttrValue] = {"role": "allocate", "subkind": "abstraction"}
    made = low.add(node, Kind.DEPENDENCY, nodes.name_of(node), owner, **attrs)
    edges = iter((Edge.CLIENT, Edge.SUPPLIER))
    for one in node.members:
        edge = next(edges, None) if _is_end(one) else None
        if edge is not None:
            for type_ in nodes.references(one, "FeatureTyping"):
                low.refer(edge, made, type_)
        elif not _is_end(one):
            low.lower(one, made)
