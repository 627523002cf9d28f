"""Reports what leads nowhere in the unit; of a long list of one element all at once."""

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.ir import Graph
from sysmlc.passes.resolve.references import Use
from sysmlc.passes.resolve.rules import BROKEN_ID, BROKEN_REFERENCE, MANY_BROKEN

_SINGLY = 4
"""References of one element and relation that lead nowhere and are reported one by one."""


def report_lost(graph: Graph, sink: Sink, lost: list[Use]) -> None:
    """Report what leads nowhere; of a long list of one element all at once."""
    lists: dict[tuple[str, str], list[Use]] = {}
    for use in lost:
        lists.setdefault((use.holder.id, use.relation), []).append(use)
    for uses in lists.values():
        for use in uses if len(uses) <= _SINGLY else ():
            _report_broken(graph, sink, use)
        if len(uses) > _SINGLY:
            _report_many(graph, sink, uses)


def _report_many(graph: Graph, sink: Sink, uses: list[Use]) -> None:
    first = uses[0]
    _mark(graph, first)
    subject = _subject(graph, first)
    sink.report(
        MANY_BROKEN,
        subject,
        relation=first.relation,
        element=subject.name,
        target=first.target,
        others=len(uses) - 1,
    )


def _mark(graph: Graph, use: Use) -> None:
    known = use.holder.attrs.get("unresolved")
    names = {str(name) for name in known} if isinstance(known, tuple) else set()
    graph.set(use.holder, unresolved=tuple(sorted(names | {use.relation})))


def _report_broken(graph: Graph, sink: Sink, use: Use) -> None:
    _mark(graph, use)
    subject = _subject(graph, use)
    sink.report(
        BROKEN_REFERENCE if use.edge else BROKEN_ID,
        subject,
        relation=use.relation,
        element=subject.name,
        target=use.target,
    )


def _subject(graph: Graph, use: Use) -> Subject:
    holder = use.holder
    if use.ordinal < 0:
        return graph.subject(holder)
    return Subject(graph.qualified_name(holder), holder.id, Place(holder.source, use.ordinal))
