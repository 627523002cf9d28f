"""Steps of operations that are operations again: nothing in the block says when they are over."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.composition.members import Block, Member
from sysmlc.logic.composition.steps import tells
from sysmlc.logic.composition.structure import drawn_of
from sysmlc.logic.contract import Owner

_CELL = """\
Package p "Cells"
  Activity i "Fetch" abstract=true
    Control ii subkind="initial"
    Action ia "grip" subkind="opaque"
    ControlFlow if
      -> flow-source ii
      -> flow-target ia
  Activity u "Shift" abstract=true
    Control ui subkind="initial"
    Action ub "first" subkind="call"
      -> calls {called}
    ControlFlow uf
      -> flow-source ui
      -> flow-target ub
  Activity w "Wait" subkind="opaque" body="wait()"
  Class c "Cell" role="block"
    Operation c.u "shift"
      -> method u
    Operation c.i "fetch"
      -> method i
"""
OPEN_STEP = rule(
    "SM508",
    "nested-operation-without-end",
    Severity.INFO,
    "nothing in '{block}' says when step '{step}' of '{operation}' is over; whoever is around "
    "the block decides it",
    why="'{called}' is an operation with steps of its own, and has no output 'executed' that the "
    "step could wait for.",
    help="give '{called}' an output 'executed' that says when its steps are done, or put its steps "
    "into '{operation}'",
    wrong=_CELL.format(called="i"),
    right=_CELL.format(called="w"),
)


class OpenStep(Struct, frozen=True):
    """A step of an operation (path from a block) that is an operation without an end to see."""

    block: Element
    operation: str
    step: Element
    called: Element


def open_steps(block: Block) -> Iterator[OpenStep]:
    """The steps of the operations in a block that are operations without an end to see."""
    for member in block.members:
        for step, called in _open(block, member):
            yield OpenStep(block.element, member.name, step, called)


def report_open_steps(graph: Graph, found: Iterable[OpenStep], sink: Sink) -> None:
    """Tell of each step once: at the block that has its operation, not at those around it."""
    nearest: dict[str, OpenStep] = {}
    for one in found:
        known = nearest.setdefault(one.step.id, one)
        if one.operation.count(".") < known.operation.count("."):
            nearest[one.step.id] = one
    for one in nearest.values():
        sink.report(
            OPEN_STEP,
            graph.subject(one.step),
            block=one.block.name,
            step=one.step.name,
            operation=one.operation,
            called=one.called.name,
        )


def _open(block: Block, member: Member) -> Iterator[tuple[Element, Element]]:
    graph = block.graph
    if not member.path or graph[member.origin].kind not in (Kind.OPERATION, Kind.ACTIVITY):
        return
    for one in member.contract.variables:
        step = graph.get(one.origin)
        if one.owner is not Owner.ENVIRONMENT or step is None or step.kind is not Kind.ACTION:
            continue
        called = graph.target(step, Edge.CALLS)
        if called is None or called.kind is not Kind.ACTIVITY or tells(graph, step):
            continue
        if any(each.kind is Kind.ACTION for each in graph.owned(drawn_of(graph, called))):
            yield step, called
