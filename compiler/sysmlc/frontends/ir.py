"""Front end ``ir``: graphs in their own text form, as ``--emit ir`` saves them.

It serves tests, the examples of ``sysmlc explain``, and bug reports without the original model.
"""

import re
from collections.abc import Sequence

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Place, Severity, Sink, Subject, Verdict, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.sources import Source

IR_SYNTAX = rule(
    "SM176",
    "ir-syntax",
    Severity.ERROR,
    "'{path}' is no graph in text form: {reason}",
    help="docs/ir.md shows the form; --emit ir writes it",
)
_FIRST = re.compile(rb"\s*(?://[^\n]*\n\s*)*(\w+) \S")
_KINDS = frozenset(kind.value.encode() for kind in Kind)
_PLACE = re.compile(r"line (\d+)")


class IrFrontend(Struct, frozen=True):
    """Reads what ``ir.print_text`` prints; several files are one graph when ids differ."""

    name: str = "ir"

    def detect(self, source: Source) -> float:
        """Sure when the first word that is no comment is a kind of element."""
        first = _FIRST.match(source.data[:4096])
        return 1.0 if first and first[1] in _KINDS else 0.0

    def links(self, source: Source) -> Sequence[str]:
        """A graph in text form refers to no other file."""
        return ()

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read each file; one that is broken is reported and left out whole."""
        from sysmlc.ir.text import IrSyntaxError, parse_text

        for source in sources:
            try:
                part = parse_text(source.data.decode("utf-8"))
                _merge(part, graph, source, coverage)
            except (IrSyntaxError, UnicodeDecodeError, ValueError) as problem:
                found = _PLACE.match(str(problem))
                place = Place(source.name, line=int(found[1]) if found else 0)
                sink.report(IR_SYNTAX, Subject(place=place), path=source.name, reason=str(problem))


def _merge(part: Graph, graph: Graph, source: Source, coverage: Coverage) -> None:
    taken = [element.id for element in part if element.id in graph]
    if taken:
        raise ValueError(f"id {taken[0]!r} is taken by another file")
    for root in part.roots():
        for element in part.subtree(root):
            graph.add(_placed(element, source))
            coverage.file(source.name).count(element.kind, Verdict.MAPPED)
    for edge, start, end in part.edges():
        if edge is not Edge.OWNS:
            graph.connect(edge, start, end)
    for reference in part.pending:
        graph.pending.append(reference)


def _placed(element: Element, source: Source) -> Element:
    """Elements without a place of their own stand somewhere in this file."""
    if not element.source and "origin" not in element.attrs:
        element.source = source.name
    return element


FRONTEND = IrFrontend()
