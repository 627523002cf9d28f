"""Front end for SysML v2 and KerML: text, XMI and archives become the graph of docs/ir.md.

The modules that read are imported when needed.
"""

from collections.abc import Sequence
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.base import FileNames
from sysmlc.frontends.sysml.detection import score_source
from sysmlc.ir import Graph
from sysmlc.sources import Source, SourceError
from sysmlc.support.interpreter import pause_garbage_collection


class SysmlFrontend(Struct, frozen=True):
    """Reads texts and interchange files; all files of a unit are one model.

    ``library`` is the path of the standard library; if it is empty, the installed one is used.
    """

    is_folder_unit: ClassVar[bool] = True
    name: str = "sysml"
    library: str = ""

    def with_library(self, path: str) -> "SysmlFrontend":
        """Return the same front end with the standard library of a folder or an archive."""
        return SysmlFrontend(self.name, path)

    def list_library_names(self) -> frozenset[str]:
        """Return the names of the files of the library, which are those of its packages."""
        from sysmlc.language.library import find_library

        try:
            return frozenset(find_library(self.library or None).stems())
        except SourceError:  # ``read`` reports it.
            return frozenset()

    def detect(self, source: Source) -> float:
        """Return how certain it is, from 0 to 1, that the source is SysML v2 or KerML."""
        return score_source(source)

    def links(self, source: Source) -> Sequence[str]:
        """Return nothing: files do not name one another, and a folder is a unit."""
        return ()

    def read_names(self, source: Source) -> FileNames:
        """Return the names of the root members, by which files refer to one another."""
        from sysmlc.frontends.sysml.reading import read_names

        return read_names(source)

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Parse, resolve and lower all files of the unit, in the order of their names."""
        from sysmlc.frontends.sysml.reading import read

        ordered = sorted(sources, key=lambda source: source.name)
        with pause_garbage_collection():
            read(ordered, graph, sink, coverage, library=self.library)


FRONTEND = SysmlFrontend()
