"""Work on one element that reports: what came of it for the graph before, with what it told.

As in ``seen``, but findings are allowed, and some questions about more than single elements.
"""

from collections.abc import Callable
from typing import TypeVar, cast

from sysmlc.diagnostics import Sink
from sysmlc.diagnostics.relay import Relay, Report
from sysmlc.ir.asking import Asking, Question
from sysmlc.ir.graph import Graph
from sysmlc.ir.reads import during
from sysmlc.ir.seen import Seen
from sysmlc.values import dataclass

_T = TypeVar("_T")
_PLAIN = (str, int, float)
"""Of what facts have to be that are told again: nobody changes them."""


@dataclass(frozen=True, slots=True)
class _Work:
    """What came of someone's work, what was reported, and the answers that it needed."""

    result: object
    findings: tuple[Report, ...]
    answers: tuple[tuple[Question, object], ...]

    def is_of(self, graph: Graph) -> bool:
        """Whether the same questions have the same answers now."""
        return all(question.answer(graph) == answer for question, answer in self.answers)

    def tell(self, graph: Graph, sink: Sink) -> None:
        """Report again, at the places where the elements are now."""
        for one in self.findings:
            one.tell(sink, graph.subject(graph[one.subject.id]))


def _can_be_told_again(graph: Graph, one: Report) -> bool:
    """Whether it is about an element, in values that nobody changes."""
    id = one.subject.id
    is_about_element = id in graph and one.subject == graph.subject(graph[id])
    return is_about_element and all(isinstance(fact, _PLAIN) for fact in one.facts.values())


def retold(
    graph: Graph, sink: Sink, about: str, given: object, make: Callable[[Graph, Sink], _T]
) -> _T:
    """Someone's work on one element (``during``), or what came of it for the graph before.

    What comes of it and what it tells the sink that ``make`` is handed depends on nothing but on
    what ``make`` asks the graph that it is handed, and on what is ``given``. Ordinals are only
    asked for by ``Graph.ordinals``. What was reported for the graph before is reported again.
    """
    seen, reads = graph.seen, graph.reads
    with during(graph, about):
        if seen is None or reads is None or not seen.is_of(graph):
            return make(graph, sink)
        found = seen.known(reads.reader, given)
        work = None if found is None else cast("_Work", found.value)
        if found is None or work is None or not work.is_of(graph):
            return _made(graph, seen, sink, given, make)
        found.ask(reads)
        work.tell(graph, sink)
        return cast("_T", work.result)


def _made(
    graph: Graph, seen: Seen, sink: Sink, given: object, make: Callable[[Graph, Sink], _T]
) -> _T:
    asking, relay = Asking(graph), Relay(sink)
    result = make(asking, relay)
    is_clear = all(_can_be_told_again(graph, one) for one in relay.reports)
    if asking.is_partial and graph.reads is not None and is_clear:
        work = _Work(result, tuple(relay.reports), asking.answers())
        seen.keep(graph.reads.reader, given, asking, work)
    return result
