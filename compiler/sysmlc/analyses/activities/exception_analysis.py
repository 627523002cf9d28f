"""Interprocedural analysis: which behaviours and operations may end with an exception."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind

CALLS = ("call-behavior", "call-operation", "opaque", "call", "start-object-behavior", "")
"""Actions whose end may be an exception."""
_BODIES = ("opaque", "function")


class Raising(Struct, frozen=True):
    """Ids of the behaviours and operations that may end with an exception.

    ``drawn`` holds those from which some path of calls leads to a raise action. ``possible`` also
    holds those whose behaviour is unknown, and their callers: operations without a method, and
    behaviours of other files. A behaviour with a text body is assumed to raise nothing.
    """

    drawn: frozenset[str]
    possible: frozenset[str]


def find_raising(graph: Graph) -> Raising:
    """Propagate exceptions from callees to callers, but not through calls with a handler."""
    actions = [
        action for action in graph.of_kind(Kind.ACTION) if action.subkind in (*CALLS, "raise")
    ]
    unprotected = [
        (action, home) for action in actions if (home := _find_raiser(graph, action)) is not None
    ]
    raised = {home.id for action, home in unprotected if action.subkind == "raise"}
    unknown = {home.id for action, home in unprotected if _calls_unknown(graph, action)}
    unknown |= {
        called.id
        for action in actions
        for called in _called_by(graph, action)
        if _is_external(called) or _is_abstract(graph, called)
    }
    # Calls inside a protected node raise no exception out of their behaviour.
    callers = _index_callers(graph, unprotected)
    return Raising(
        _close_over_callers(raised, callers), _close_over_callers(raised | unknown, callers)
    )


def _find_raiser(graph: Graph, action: Element) -> Element | None:
    """Return the behaviour of the action, or None if a handler in it catches the exception."""
    element: Element | None = action
    while element is not None and element.kind is not Kind.ACTIVITY:
        if "handlers" in element.attrs:
            return None
        element = graph.owner(element)
    return element


def _called_by(graph: Graph, action: Element) -> list[Element]:
    return graph.targets(action, Edge.CALLS)


def _calls_unknown(graph: Graph, action: Element) -> bool:
    return action.subkind != "raise" and not _called_by(graph, action)


def _is_external(called: Element) -> bool:
    return called.attrs.get("external") is True and called.subkind not in _BODIES


def _index_callers(
    graph: Graph, unprotected: Iterable[tuple[Element, Element]]
) -> dict[str, list[str]]:
    """Map each behaviour to its callers and to the operations that it implements."""
    callers: dict[str, list[str]] = {}
    for action, home in unprotected:
        for called in _called_by(graph, action):
            callers.setdefault(called.id, []).append(home.id)
    for operation in graph.of_kind(Kind.OPERATION):
        for method in graph.targets(operation, Edge.METHOD):
            callers.setdefault(method.id, []).append(operation.id)
    return callers


def _close_over_callers(first: Iterable[str], callers: dict[str, list[str]]) -> frozenset[str]:
    return frozenset(_walk_callers(first, callers))


def _walk_callers(first: Iterable[str], callers: dict[str, list[str]]) -> Iterator[str]:
    seen: set[str] = set()
    worklist = sorted(first)
    while worklist:
        id = worklist.pop()
        if id not in seen:
            seen.add(id)
            worklist += callers.get(id, ())
            yield id


def may_raise(graph: Graph, action: Element, raising: frozenset[str], unknown: bool) -> bool:
    """Whether the action calls a behaviour in *raising*.

    *unknown* is the result for an action whose callee the model does not name.
    """
    called = _called_by(graph, action)
    return any(behaviour.id in raising for behaviour in called) if called else unknown


def _is_abstract(graph: Graph, called: Element) -> bool:
    return called.kind is Kind.OPERATION and not graph.targets(called, Edge.METHOD)
