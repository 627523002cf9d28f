"""The front end for AutomationML; what reads it is imported when there is a plant to read."""

from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Place, Sink
from sysmlc.frontends.base import FileNames
from sysmlc.frontends.caex import detect
from sysmlc.ir import Graph
from sysmlc.sources import Source


class CaexFrontend:
    """Reads AutomationML: CAEX 2.15 and 3.0, and files that mix them."""

    name = "caex"
    is_folder_unit = False

    def detect(self, source: Source) -> float:
        """How sure it is, from 0 to 1, that the source is AutomationML."""
        return detect.score(source)

    def links(self, source: Source) -> Sequence[str]:
        """The files that its external references name."""
        from sysmlc.frontends.caex.account import links

        return links(source)

    def read_names(self, source: Source) -> FileNames:
        """A file without an instance hierarchy is a library; files refer to others by path."""
        from sysmlc.frontends.caex.account import has_hierarchy

        return FileNames(is_library=not has_hierarchy(source))

    def list_attachments(self, source: Source) -> Sequence[tuple[str, Place]]:
        """The files of other languages that it refers to: they are not read."""
        from sysmlc.frontends.caex.documents import mentioned

        return list(mentioned(source))

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; see docs/automationml.md.

        A damaged file is reported and left out. Raises SourceError for what exceeds the
        limits. The graph does not depend on the order of the files.
        """
        from sysmlc.frontends.caex.reading import read_all

        read_all(sources, graph, sink, coverage)
