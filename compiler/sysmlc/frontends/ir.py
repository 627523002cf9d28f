"""Front end ``ir``: graphs in their own text form, as ``--emit ir`` saves them.

It serves tests, the examples of ``sysmlc explain``, and bug reports without the original model.
"""

import re
from collections.abc import Sequence

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Place, Severity, Sink, Subject, Verdict, rule
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.sources import Source

IR_SYNTAX = rule(
    "SM176",
    "ir-syntax",
    Severity.ERROR,
    "'{path}' is not a graph in text form: {reason}",
    help="docs/ir.md describes the form; --emit ir writes it",
)
_FIRST_WORD = re.compile(rb"\s*(?://[^\n]*\n\s*)*(\w+) \S")
_KINDS = frozenset(kind.value.encode() for kind in Kind)
_LINE = re.compile(r"line (\d+)")


class IrFrontend(Struct, frozen=True):
    """Reads the output of ``ir.print_text``; several files form one graph if their ids differ."""

    name: str = "ir"

    def detect(self, source: Source) -> float:
        """Return 1 if the first word after comments is a kind of element, else 0.

        A text of SysML v2 that begins with the misspelt ``Package`` is none.
        """
        if source.name.lower().endswith((".sysml", ".kerml")):
            return 0.0
        match = _FIRST_WORD.match(source.data[:4096])
        return 1.0 if match and match[1] in _KINDS else 0.0

    def links(self, source: Source) -> Sequence[str]:
        """Return nothing: a graph in text form refers to no other file."""
        return ()

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read each file; a file with a syntax error is reported and skipped."""
        from sysmlc.ir.text import IrSyntaxError, parse_text

        for source in sources:
            try:
                part = parse_text(source.data.decode("utf-8"))
                _merge(part, graph, source, coverage)
            except (IrSyntaxError, UnicodeDecodeError, ValueError) as problem:
                match = _LINE.match(str(problem))
                place = Place(source.name, line=int(match[1]) if match else 0)
                sink.report(IR_SYNTAX, Subject(place=place), path=source.name, reason=str(problem))


def _merge(part: Graph, graph: Graph, source: Source, coverage: Coverage) -> None:
    """Add the elements and edges of *part*. Raises ValueError if an id is already in *graph*."""
    clashes = [element.id for element in part if element.id in graph]
    if clashes:
        raise ValueError(f"id {clashes[0]!r} is taken by another file")
    for root in part.roots():
        for element in part.subtree(root):
            if not element.source and "origin" not in element.attrs:
                element.source = source.name
            graph.add(element)
            coverage.file(source.name).count(element.kind, Verdict.MAPPED)
    for edge, start, end in part.edges():
        if edge is not Edge.OWNS:
            graph.connect(edge, start, end)
    graph.pending.extend(part.pending)


FRONTEND = IrFrontend()
