"""Front end for the XML of MTIP, also called HUDS: models that a plug-in exports from Cameo."""

import re
from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.ir import Graph
from sysmlc.sources import Source

_ROOT = re.compile(
    rb"\s*(<\?xml[^>]*>\s*)?(<!--.*?-->\s*|<!DOCTYPE[^>\[]*(\[.*?\])?\s*>\s*)*<packet[\s>]",
    re.DOTALL,
)
"""The start of an export. The reader refuses a DOCTYPE later and reports its location."""


class HudsFrontend:
    """Reads the flat XML of MTIP; several files are several lists of elements."""

    name = "huds"

    def detect(self, source: Source) -> float:
        """Return 1 if the root is ``packet`` and the head has marks of MTIP, else 0."""
        head = source.data[:8192].removeprefix(b"\xef\xbb\xbf")
        is_marked = b"mtipVersion" in head or b"_dtype=" in head
        return 1.0 if is_marked and _ROOT.match(head) else 0.0

    def links(self, source: Source) -> Sequence[str]:
        """Return nothing: an export refers to no other file."""
        return ()

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; a damaged file is reported and skipped.

        Raises SourceError if a file exceeds the limits.
        """
        from sysmlc.frontends.huds.lowering import lower_files

        lower_files(sources, graph, sink, coverage)


FRONTEND = HudsFrontend()
