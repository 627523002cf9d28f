"""Work on one element that reports: what came of it for the graph before, with what it told.

As in ``seen``, but findings are allowed, and some questions about more than single elements.
"""

from collections.abc import Callable
from typing import TypeVar, cast

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.ir.asking import Asking, Question
from sysmlc.ir.graph import Graph
from sysmlc.ir.reads import during
from sysmlc.ir.seen import Seen
from sysmlc.values import dataclass

_T = TypeVar("_T")
_PLAIN = (str, int, float)
"""Of what facts have to be that are told again: nobody changes them."""


@dataclass(frozen=True, slots=True)
class _Finding:
    """What was reported about an element."""

    rule: Rule
    id: str
    notes: tuple[str, ...]
    help: str
    facts: dict[str, object]


@dataclass(frozen=True, slots=True)
class _Work:
    """What came of someone's work, what was reported, and the answers that it needed."""

    result: object
    findings: tuple[_Finding, ...]
    answers: tuple[tuple[Question, object], ...]

    def is_of(self, graph: Graph) -> bool:
        """Whether the same questions have the same answers now."""
        return all(question.answer(graph) == answer for question, answer in self.answers)

    def tell(self, graph: Graph, sink: Sink) -> None:
        """Report again, at the places where the elements are now."""
        for one in self.findings:
            subject = graph.subject(graph[one.id])
            sink.report(one.rule, subject, notes=one.notes, help=one.help, **one.facts)


class _Hearing(Sink):
    """Hands on what is reported, and keeps it."""

    def __init__(self, sink: Sink) -> None:
        super().__init__()
        self._sink = sink
        self._told: list[tuple[Subject, _Finding]] = []

    def report(
        self,
        rule: Rule,
        subject: Subject,
        *,
        notes: tuple[str, ...] = (),
        help: str = "",
        **facts: object,
    ) -> None:
        self._told.append((subject, _Finding(rule, subject.id, notes, help, facts)))
        self._sink.report(rule, subject, notes=notes, help=help, **facts)

    def findings(self, graph: Graph) -> tuple[_Finding, ...] | None:
        """What was reported; None unless all is about elements, in values that nobody changes."""
        is_clear = all(
            one.id in graph
            and subject == graph.subject(graph[one.id])
            and all(isinstance(fact, _PLAIN) for fact in one.facts.values())
            for subject, one in self._told
        )
        return tuple(one for _, one in self._told) if is_clear else None


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
    asking, hearing = Asking(graph), _Hearing(sink)
    result = make(asking, hearing)
    findings = hearing.findings(graph)
    if asking.is_partial and graph.reads is not None and findings is not None:
        work = _Work(result, findings, asking.answers())
        seen.keep(graph.reads.reader, given, asking, work)
    return result
