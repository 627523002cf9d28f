"""If, while and for: control nodes with guards, and regions for each element of a collection."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes, values
from sysmlc.frontends.sysml.connections import steps_of_value
from sysmlc.frontends.sysml.successions import steps
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering


def _control(low: "Lowering", node: Node, owner: Element, subkind: str, name: str = "") -> Element:
    return low.make(node, Kind.CONTROL, name, owner, subkind=subkind)


def _flow(
    low: "Lowering",
    node: Node,
    ends: tuple[Element, Element],
    guard: "Node | str | None" = None,
) -> None:
    made = low.make(node, Kind.CONTROL_FLOW, "", low.graph.owner(ends[0]))
    low.graph.connect(Edge.FLOW_SOURCE, made, ends[0])
    low.graph.connect(Edge.FLOW_TARGET, made, ends[1])
    if isinstance(guard, str):
        low.set(made, guard=guard)
    elif guard is not None:
        low.later(lambda: values.say(low, made, "guard", guard))


def _parts(node: Node) -> tuple[list[Node], list[Node]]:
    """Expressions and actions among the parameters of a node, in order."""
    held = list(nodes.held(node, "ParameterMembership"))
    given = [one for one in held if one.kind in nodes.EXPRESSIONS]
    return given, [one for one in held if one.kind.endswith("ActionUsage")]


def if_(low: "Lowering", node: Node, owner: Element) -> None:
    """A decision with a branch for each action, and a merge behind them."""
    given, bodies = _parts(node)
    decision = _control(low, node, owner, "decision", node.name or "")
    merge = _control(low, node, owner, "merge")
    low.elements[id(node)] = decision
    low.spans[id(node)] = (decision, merge)
    low.last(lambda: low.last(lambda: _start(low, node, owner, decision)))
    guards: list[Node | str | None] = [given[0] if given else "true", "else"]
    for number, guard in enumerate(guards):
        body = bodies[number] if number < len(bodies) else None
        _branch(low, (node, body), owner, (decision, merge), guard)


def _branch(
    low: "Lowering",
    parts: tuple[Node, Node | None],
    owner: Element,
    ends: tuple[Element, Element],
    guard: "Node | str | None",
) -> None:
    node, body = parts
    inside = None if body is None else _body(low, body, owner)
    if inside is None:
        _flow(low, node, ends, guard)
        return
    _flow(low, node, (ends[0], inside[0]), guard)
    _flow(low, node, (inside[1], ends[1]))


def _body(low: "Lowering", body: Node, owner: Element) -> tuple[Element, Element] | None:
    """Entry and exit of the action in a branch; nothing for an empty one.

    The steps of a block stand in the activity itself, so that its conditions and calls are
    those of the activity.
    """
    if body.kind != "ActionUsage" or body.name:
        low.lower(body, owner)
        entry, exit_ = low.point(body, is_target=True), low.point(body, is_target=False)
        return None if entry is None or exit_ is None else (entry, exit_)
    inside = nodes.body_of(body)
    if not inside:
        return None
    before, ends = len(low.graph.owned(owner)), list[Element]()
    steps(low, inside, owner, ends)
    made = low.graph.owned(owner)[before:]
    found = [one for one in made if one.kind in _NODES]
    if not found and not any(one.kind is Kind.CONTROL_FLOW for one in made):
        return None
    ends += (_control(low, body, owner, "merge"), _control(low, body, owner, "merge"))
    low.last(lambda: _tie(low, body, found, (ends[0], ends[1])))
    return ends[0], ends[1]


_NODES = (Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL)


def _tie(
    low: "Lowering", body: Node, found: Iterable[Element], ends: tuple[Element, Element]
) -> None:
    """Lead into the steps that nothing precedes, and out of those that nothing follows."""
    for one in found:
        if not low.graph.sources(one, Edge.FLOW_TARGET):
            _flow(low, body, (ends[0], one))
        if not low.graph.sources(one, Edge.FLOW_SOURCE) and one.subkind != "final":
            _flow(low, body, (one, ends[1]))


def while_(low: "Lowering", node: Node, owner: Element) -> None:
    """A merge, the test, the body and back; the test of ``until`` stands behind the body."""
    given, bodies = _parts(node)
    entry = _control(low, node, owner, "merge", node.name or "")
    exit_ = _control(low, node, owner, "merge")
    low.elements[id(node)] = entry
    low.spans[id(node)] = (entry, exit_)
    low.last(lambda: low.last(lambda: _start(low, node, owner, entry)))
    test, until = _tests(node, given)
    at = entry
    if test is not None:
        decision = _control(low, node, owner, "decision")
        _flow(low, node, (entry, decision))
        _flow(low, node, (decision, exit_), "else")
        at = decision
    inside = _body(low, bodies[0], owner) if bodies else None
    behind = at
    if inside is not None:
        _flow(low, node, (at, inside[0]), test)
        behind = inside[1]
    _repeat(low, node, owner, (behind, entry, exit_), until, None if inside else test)


def _start(low: "Lowering", node: Node, owner: Element, entry: Element) -> None:
    """What nothing precedes starts with the behaviour: the way back of a loop is no start."""
    before = low.graph.sources(entry, Edge.FLOW_TARGET)
    if all(low.is_made(flow, node) for flow in before):
        _flow(low, node, (low.control(owner, "start"), entry))


def _repeat(
    low: "Lowering",
    node: Node,
    owner: Element,
    points: tuple[Element, Element, Element],
    until: Node | None,
    test: Node | None,
) -> None:
    behind, entry, exit_ = points
    if until is None:
        _flow(low, node, (behind, entry), test)
        return
    decision = _control(low, node, owner, "decision")
    _flow(low, node, (behind, decision), test)
    _flow(low, node, (decision, exit_), until)
    _flow(low, node, (decision, entry), "else")


def _tests(node: Node, given: list[Node]) -> tuple[Node | None, Node | None]:
    """The conditions of ``while`` and of ``until``: before and behind the body."""
    held = list(nodes.held(node, "ParameterMembership"))
    body = next((n for n, one in enumerate(held) if one.kind.endswith("ActionUsage")), len(held))
    before = [one for one in given if held.index(one) < body]
    after = [one for one in given if held.index(one) > body]
    return (before[0] if before else None), (after[0] if after else None)


def for_(low: "Lowering", node: Node, owner: Element) -> None:
    """An expansion region that takes the elements of a collection one after the other."""
    held = [one for one in node.members if one.membership.endswith("Membership")]
    bodies = [one for one in held if one.kind.endswith("ActionUsage")]
    attrs = {"subkind": "expansion", "mode": "iterative"}
    made = low.add(node, Kind.STRUCTURED, node.name or "", owner, **attrs)
    _range_over(low, node, made)
    for body in bodies:
        low.elements.setdefault(id(body), made)
        steps(low, nodes.body_of(body) if not body.name else [body], made)


def _range_over(low: "Lowering", node: Node, region: Element) -> None:
    """The collection of a loop as text, and its variable, which has the type of the elements."""
    held = nodes.held(node, "ParameterMembership")
    collection = next((value for one in held if (value := nodes.value_of(one))), None)
    if collection is not None:
        low.later(lambda: values.say(low, region, "collection", collection))
    variable = next((one for one in node.members if one.kind == "ReferenceUsage"), None)
    if variable is None:
        return
    made = low.add(variable, Kind.PROPERTY, variable.name or "", region, subkind="variable")
    *_, feature = [None] if collection is None else (steps_of_value(collection) or [None])
    types = types_of(low, variable) or ([] if feature is None else types_of(low, feature))
    low.later(lambda: low.lead_all(Edge.TYPED_BY, made, types))
