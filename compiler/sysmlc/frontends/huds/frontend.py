"""The front end for models that MTIP exports from Cameo."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Coverage, Place, Sink, Subject
from sysmlc.ir import Graph
from sysmlc.sources import Fault, Source, SourceError

if TYPE_CHECKING:
    from sysmlc.frontends.huds.records import Record

_ROOT = re.compile(
    rb"\s*(<\?xml[^>]*>\s*)?(<!--.*?-->\s*|<!DOCTYPE[^>\[]*(\[.*?\])?\s*>\s*)*<packet[\s>]",
    re.DOTALL,
)
"""A DOCTYPE is refused later, with its place."""


class HudsFrontend:
    """Reads the flat XML of MTIP; several files are several lists of elements."""

    name = "huds"

    def detect(self, source: Source) -> float:
        """Sure when the root is ``packet`` and MTIP's types of data are near."""
        head = source.data[:8192].removeprefix(b"\xef\xbb\xbf")
        known = b"mtipVersion" in head or b"_dtype=" in head
        return 1.0 if known and _ROOT.match(head) else 0.0

    def links(self, source: Source) -> Sequence[str]:
        """An export refers to no other file."""
        return ()

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; a damaged file is reported and left out.

        Raises SourceError for what exceeds the limits.
        """
        from sysmlc.frontends.huds.lowering import lower

        for source in sorted(sources, key=lambda one: one.name):
            records = _records(source, sink)
            if records is not None:
                lower(source.name, records, graph, sink, coverage)


def _records(source: Source, sink: Sink) -> "list[Record] | None":
    from sysmlc.frontends.huds.records import read
    from sysmlc.frontends.huds.rules import MALFORMED

    try:
        return read(source)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(MALFORMED, subject, file=source.name, problem=problem.message)
        return None


FRONTEND = HudsFrontend()
