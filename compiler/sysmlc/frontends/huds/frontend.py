"""The front end for models that MTIP exports from Cameo."""

import re
from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.huds.lowering import lower
from sysmlc.frontends.huds.records import read
from sysmlc.ir import Graph
from sysmlc.sources import Source

_ROOT = re.compile(rb"\s*(<\?xml[^>]*>\s*)?(<!--.*?-->\s*)*<packet[\s>]", re.DOTALL)


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
        """Read the files into the graph. Raises SourceError for a damaged one."""
        for source in sorted(sources, key=lambda one: one.name):
            lower(source.name, read(source), graph, sink, coverage)


FRONTEND = HudsFrontend()
