"""Branches of a behaviour: whether those that a fork opens are joined before its end."""

from collections.abc import Iterable, Mapping

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

_STEPS = (Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL)
_CHOICES = ("decision", "merge")
_EXIT = ""
"""What stands behind every step that nothing follows."""
_Ways = Mapping[str, list[str]]


def is_joined(graph: Graph, end: Element) -> bool:
    """Whether nothing goes on elsewhere when a token comes to a final node of an activity.

    Of every fork (or step that several control flows leave) before the end all ways must lead
    through one node that waits for several flows. Where that holds, the end of the flow is the
    end of the activity (UML 2.5.1, 15.3.3.2).
    """
    owner = graph.owner(end)
    steps = [] if owner is None else [one for one in graph.owned(owner) if one.kind in _STEPS]
    if not any(_may_fork(graph, one) for one in steps):
        return True
    ways = {one.id: _next(graph, one) for one in steps}
    forks = [one.id for one in steps if len(ways[one.id]) > 1 and one.subkind not in _CHOICES]
    if not forks:
        return True
    joins = {one.id for one in steps if _waits(graph, one)}
    return _are_closed(ways, end.id, forks, joins)


def _may_fork(graph: Graph, step: Element) -> bool:
    """Whether several flows leave a step, whatever flows they are and wherever they lead."""
    return len(graph.sources(step, Edge.FLOW_SOURCE)) > 1 and step.subkind not in _CHOICES


def _next(graph: Graph, step: Element) -> list[str]:
    flows = (one for one in graph.sources(step, Edge.FLOW_SOURCE) if _is_control(one))
    found = (graph.target(one, Edge.FLOW_TARGET) for one in flows)
    return [one.id for one in found if one and one.kind in _STEPS and one.owner == step.owner]


def _waits(graph: Graph, step: Element) -> bool:
    """Whether a node goes on only when all flows that lead to it have come."""
    if step.subkind in _CHOICES or step.subkind.endswith("final"):
        return False
    return sum(1 for one in graph.sources(step, Edge.FLOW_TARGET) if _is_control(one)) > 1


def _is_control(flow: Element) -> bool:
    return flow.kind is Kind.CONTROL_FLOW


def _are_closed(ways: _Ways, end: str, forks: Iterable[str], joins: set[str]) -> bool:
    back = _turned(ways)
    leading = _reached(back, [end])
    known = _reached(back, [_EXIT])
    endless = _reached(back, [one for one in ways if one not in known])
    behind = _behind(ways, back)
    return all(
        fork not in endless and not joins.isdisjoint(_chain(behind, fork))
        for fork in forks
        if fork in leading
    )


def _turned(ways: _Ways) -> dict[str, list[str]]:
    """The ways backwards; the exit follows what nothing else follows."""
    back: dict[str, list[str]] = {_EXIT: [], **{one: [] for one in ways}}
    for one, following in ways.items():
        for after in following or [_EXIT]:
            back[after].append(one)
    return back


def _reached(ways: _Ways, starts: Iterable[str]) -> set[str]:
    open_ones = list(starts)
    seen = set(open_ones)
    while open_ones:
        found = [one for one in ways[open_ones.pop()] if one not in seen]
        seen.update(found)
        open_ones.extend(found)
    return seen


def _chain(behind: Mapping[str, str], step: str) -> set[str]:
    """What all ways from a step lead through."""
    found: set[str] = set()
    while step != _EXIT:
        step = behind[step]
        found.add(step)
    return found


def _behind(ways: _Ways, back: _Ways) -> dict[str, str]:
    """The nearest step that all ways from a step lead through (Cooper, Harvey, Kennedy 2001)."""
    order = _finished(back)
    rank = {one: number for number, one in enumerate(order)}
    behind = {_EXIT: _EXIT}
    is_changed = True
    while is_changed:
        is_changed = False
        for one in reversed(order[:-1]):
            new = _common(behind, rank, [to for to in ways[one] or [_EXIT] if to in behind])
            is_changed = is_changed or behind.get(one) != new
            behind[one] = new
    return behind


def _finished(back: _Ways) -> list[str]:
    """Steps in the order in which a walk from the exit leaves them, the exit last."""
    order: list[str] = []
    seen, walk = {_EXIT}, [(_EXIT, iter(back[_EXIT]))]
    while walk:
        one, rest = walk[-1]
        found = next((before for before in rest if before not in seen), None)
        if found is None:
            order.append(one)
            walk.pop()
        else:
            seen.add(found)
            walk.append((found, iter(back[found])))
    return order


def _common(behind: Mapping[str, str], rank: Mapping[str, int], found: list[str]) -> str:
    """Where the chains of several steps meet."""
    met, *others = found
    for one in others:
        while met != one:
            if rank[met] < rank[one]:
                met = behind[met]
            else:
                one = behind[one]
    return met


_OF_CALLS = {"in": "argument", "out": "result"}
_OF_OPAQUE = {"in": "input-value", "out": "output-value"}
_BY_ACTION = {
    "call-behavior": _OF_CALLS,
    "call-operation": _OF_CALLS,
    "opaque": _OF_OPAQUE,
    "send": {"in": "argument"},
    "accept": {"out": "result"},
    "value": {"out": "result"},
    "read": {"out": "result"},
}


def pin_subkind(action: Element, pin: Element) -> str:
    """The UML feature that a pin is for by its direction; empty for actions with several."""
    if action.kind is not Kind.ACTION:
        return ""
    return _BY_ACTION.get(action.subkind, {}).get(str(pin.attrs.get("direction", "")), "")
