"""The front end for SysML v2 and KerML."""

from collections.abc import Sequence
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.base import FileNames
from sysmlc.ir import Graph
from sysmlc.sources import Source


class SysmlFrontend(Struct, frozen=True):
    """Reads texts and interchange files; all files of a unit are one model.

    ``library`` is where the standard library is; empty where it is usually found.
    """

    is_folder_unit: ClassVar[bool] = True
    name: str = "sysml"
    library: str = ""

    def with_library(self, path: str) -> "SysmlFrontend":
        """The same front end, with the standard library from a folder or an archive."""
        return SysmlFrontend(self.name, path)

    def detect(self, source: Source) -> float:
        """Sure for text that begins with a word of SysML, and for its XMI."""
        from sysmlc.frontends.sysml.detect import score

        return score(source)

    def links(self, source: Source) -> Sequence[str]:
        """Files of a model do not name one another: a folder is a unit."""
        return ()

    def read_names(self, source: Source) -> FileNames:
        """Files refer to one another by the names of their root members."""
        from sysmlc.frontends.sysml.root_names import read_names

        return read_names(source)

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Parse, resolve and lower all files of the unit."""
        from sysmlc.frontends.sysml.reading import read
        from sysmlc.support.garbage_collection import pause_garbage_collection

        ordered = sorted(sources, key=lambda one: one.name)
        with pause_garbage_collection():
            read(ordered, graph, sink, coverage, library=self.library)


FRONTEND = SysmlFrontend()
