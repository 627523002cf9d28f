"""The front end for AutomationML; the modules that read are imported for the first file."""

from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Place, Sink
from sysmlc.frontends.base import FileNames
from sysmlc.frontends.caex import detection
from sysmlc.ir import Graph
from sysmlc.sources import Source


class CaexFrontend:
    """Reads AutomationML: CAEX 2.15 and 3.0, and files that mix them."""

    name = "caex"
    is_folder_unit = False

    def detect(self, source: Source) -> float:
        """Return how certain it is, from 0 to 1, that the source is AutomationML."""
        return detection.score_source(source)

    def links(self, source: Source) -> Sequence[str]:
        """Return the files that external references name, each once and in order."""
        return detection.list_external_references(source)

    def read_names(self, source: Source) -> FileNames:
        """Return that a file without an instance hierarchy is a library.

        Files refer to one another by path only.
        """
        return FileNames(is_library=not detection.has_hierarchy(source))

    def list_attachments(self, source: Source) -> Sequence[tuple[str, Place]]:
        """Return the files of other languages that the source refers to; they are not read."""
        return list(detection.iter_external_documents(source))

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; see ``reading.read`` and docs/automationml.md."""
        from sysmlc.frontends.caex import reading

        reading.read(sources, graph, sink, coverage)
