"""Which behaviours and operations may end with an exception."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind

CALLS = ("call-behavior", "call-operation", "opaque", "call", "start-object-behavior", "")
"""Actions whose end may be an exception."""
_BODIES = ("opaque", "function")


class Raising(Struct, frozen=True):
    """Ids of what raises something by its drawing, and of what may do so for all that is known.

    Operations without method and behaviours of other files are not known; a body of text raises
    nothing.
    """

    drawn: frozenset[str]
    possible: frozenset[str]


def find_raising(graph: Graph) -> Raising:
    """Follow raise actions from callee to caller, up to where a handler catches them."""
    actions = [one for one in graph.of_kind(Kind.ACTION) if one.subkind in (*CALLS, "raise")]
    loose = [(one, home) for one in actions if (home := _home(graph, one)) is not None]
    raised = {home.id for one, home in loose if one.subkind == "raise"}
    unknown = {home.id for one, home in loose if _is_unknown(graph, one)}
    unknown |= {
        called.id
        for one in actions
        for called in _called(graph, one)
        if _is_far(called) or _is_abstract(graph, called)
    }
    callers = _callers(graph, loose)
    return Raising(_closed(raised, callers), _closed(raised | unknown, callers))


def _home(graph: Graph, action: Element) -> Element | None:
    """The behaviour that the action is in, unless a handler there catches what it raises."""
    above: Element | None = action
    while above is not None and above.kind is not Kind.ACTIVITY:
        if "handlers" in above.attrs:
            return None
        above = graph.owner(above)
    return above


def _called(graph: Graph, action: Element) -> list[Element]:
    return graph.targets(action, Edge.CALLS)


def _is_unknown(graph: Graph, action: Element) -> bool:
    return action.subkind != "raise" and not _called(graph, action)


def _is_far(called: Element) -> bool:
    return called.attrs.get("external") is True and called.subkind not in _BODIES


def _callers(graph: Graph, loose: Iterable[tuple[Element, Element]]) -> dict[str, list[str]]:
    """What ends with an exception when the key does: callers, and operations of methods."""
    found: dict[str, list[str]] = {}
    for action, home in loose:
        for called in _called(graph, action):
            found.setdefault(called.id, []).append(home.id)
    for operation in graph.of_kind(Kind.OPERATION):
        for method in graph.targets(operation, Edge.METHOD):
            found.setdefault(method.id, []).append(operation.id)
    return found


def _closed(first: Iterable[str], callers: dict[str, list[str]]) -> frozenset[str]:
    return frozenset(_reached(first, callers))


def _reached(first: Iterable[str], callers: dict[str, list[str]]) -> Iterator[str]:
    seen: set[str] = set()
    waiting = sorted(first)
    while waiting:
        id = waiting.pop()
        if id not in seen:
            seen.add(id)
            waiting += callers.get(id, ())
            yield id


def may_raise(graph: Graph, action: Element, among: frozenset[str], unknown: bool) -> bool:
    """Whether what an action calls is among these; ``unknown`` answers for calls of nothing."""
    called = _called(graph, action)
    return any(one.id in among for one in called) if called else unknown


def _is_abstract(graph: Graph, called: Element) -> bool:
    return called.kind is Kind.OPERATION and not graph.targets(called, Edge.METHOD)
