"""The front end for SysML v2 and KerML."""

from collections.abc import Container, Mapping, Sequence
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.ir import AttrValue, Graph
from sysmlc.ir.reads import Literal, Value
from sysmlc.sources import Source
from sysmlc.values import dataclass

if TYPE_CHECKING:
    from sysmlc.cache import Cache


@dataclass(frozen=True, slots=True)
class SysmlFrontend:
    """Reads texts and interchange files; all files of a unit are one model.

    ``library`` is where the standard library is; empty where it is usually found.
    """

    name: str = "sysml"
    library: str = ""
    cache: "Cache | None" = None

    def with_cache(self, cache: "Cache") -> "SysmlFrontend":
        """The same front end, with a cache for parsed files."""
        return SysmlFrontend(self.name, self.library, cache)

    def with_library(self, path: str) -> "SysmlFrontend":
        """The same front end, with the standard library from a folder or an archive."""
        return SysmlFrontend(self.name, path, self.cache)

    def detect(self, source: Source) -> float:
        """Sure for text that begins with a word of SysML, and for its XMI."""
        from sysmlc.frontends.sysml.detect import score

        return score(source)

    def links(self, source: Source) -> Sequence[str]:
        """Files of a model do not name one another: a folder is a unit."""
        return ()

    def wording(self, source: Source) -> str:
        """Digest of the tokens of a text; empty for what is no text that can be read."""
        from sysmlc.frontends.sysml.wording import digest

        return digest(source, self.cache)

    def words(self, source: Source) -> Sequence[tuple[int, int]]:
        """Where the tokens of a text are."""
        from sysmlc.frontends.sysml.wording import spans

        return spans(source)

    def shape(self, source: Source) -> str:
        """The same without the values of literals."""
        from sysmlc.frontends.sysml.wording import shape

        return shape(source, self.cache)

    def values(
        self, old: Source, new: Source, found: Sequence[Literal], asked: Container[int]
    ) -> Mapping[Value, AttrValue] | None:
        """What attributes become where two texts of one shape have other literals."""
        from sysmlc.frontends.sysml.wording import values

        return values(old, new, found, asked)

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Parse, resolve and lower all files of the unit."""
        from sysmlc.collecting import uncollected
        from sysmlc.frontends.sysml.reading import read

        ordered = sorted(sources, key=lambda one: one.name)
        with uncollected():
            read(ordered, graph, sink, coverage, library=self.library, cache=self.cache)


FRONTEND = SysmlFrontend()
