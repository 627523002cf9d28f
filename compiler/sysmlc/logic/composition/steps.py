"""Steps of a composite operation, and the actions of a block that perform them.

A step is over when the action that performs it says that it is executed. A binding says which
action that is, or which of its values tells it; without one it is the only action of the block
that is what the step calls.
"""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.composition.structure import End, Usage, drawn_of, joined, usages
from sysmlc.logic.contract import Contract, Owner

EXECUTED = "executed"
"""The output by which an action tells that it is executed."""


def ends_of_steps(graph: Graph, contract: Contract) -> dict[str, str]:
    """The inputs of an operation that say that a step is over, as features of its steps."""
    found = {}
    for one in contract.variables:
        step = graph.get(one.origin)
        if one.owner is Owner.ENVIRONMENT and step is not None and tells(graph, step):
            found[joined(step.name, EXECUTED)] = one.name
    return found


def performed(graph: Graph, block: Element, path: str) -> Iterator[tuple[End, End]]:
    """For each step of the operations of a block the end of the one action that performs it."""
    known = [one for one in usages(graph, block, path) if one.element.kind in _ACTIONS]
    for operation in known:
        for step in graph.owned(drawn_of(graph, operation.type_)):
            if tells(graph, step):
                able = [one for one in known if _is_what(graph, one, step)]
                if len(able) == 1:
                    feature = joined(step.name, EXECUTED)
                    yield End(operation.path, feature), End(able[0].path, EXECUTED)


_ACTIONS = (Kind.OPERATION, Kind.ACTIVITY)


def tells(graph: Graph, step: Element) -> bool:
    """Whether the step calls an action that tells that it is executed."""
    called = graph.target(step, Edge.CALLS) if step.kind is Kind.ACTION else None
    if called is None or called.kind is not Kind.ACTIVITY:
        return False
    return any(one.name == EXECUTED for one in _parameters(graph, called))


def _parameters(graph: Graph, action: Element) -> Iterator[Element]:
    for one in (action, *query.generals(graph, action)):
        yield from query.parameters(graph, one)


def _is_what(graph: Graph, usage: Usage, step: Element) -> bool:
    called = graph.target(step, Edge.CALLS)
    return called in (usage.type_, *query.generals(graph, usage.type_))
