"""What a front end is: it recognises its files and reads them into the graph."""

from collections.abc import Container, Mapping, Sequence
from typing import Protocol, runtime_checkable

from sysmlc.cache import Cache
from sysmlc.diagnostics import Coverage, Place, Sink
from sysmlc.ir import AttrValue, Graph
from sysmlc.ir.reads import Literal, Value
from sysmlc.sources import Source


class Frontend(Protocol):
    """Reads one family of source languages.

    All files of a compile unit come in one call, because an id is kept only when it is unique
    in the unit. Local references may stay in ``graph.pending`` for the pass ``resolve``.
    """

    name: str

    def detect(self, source: Source) -> float:
        """How sure it is, from 0 to 1 and by content, that it can read this source."""

    def links(self, source: Source) -> Sequence[str]:
        """References to other files, as the source writes them, each once and in order.

        The driver adds those files to the compile unit that are there and allowed.
        """

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph and account for every element of them."""


@runtime_checkable
class Caching(Protocol):
    """A front end that can keep what it parsed."""

    def with_cache(self, cache: Cache) -> Frontend:
        """The same front end, with a cache to keep it in."""


@runtime_checkable
class Libraried(Protocol):
    """A front end whose models refer to a library of models."""

    def with_library(self, path: str) -> Frontend:
        """The same front end, with the library from a folder or an archive."""


@runtime_checkable
class Mentioning(Protocol):
    """A front end whose files refer to others that are not read, but should be there."""

    def mentioned(self, source: Source) -> Sequence[tuple[str, Place]]:
        """Paths of such files, as the source writes them, each with its place."""


@runtime_checkable
class Worded(Protocol):
    """A front end of texts (in UTF-8) that mean the same wherever their words stand."""

    def wording(self, source: Source) -> str:
        """Digest of all that the text says; empty where more than its words matters."""

    def words(self, source: Source) -> Sequence[tuple[int, int]]:
        """Where its words start and end, in characters; the last one is the end of the text."""


@runtime_checkable
class Valued(Worded, Protocol):
    """A front end that can say what other literals in a text change (``Graph.reads``)."""

    def shape(self, source: Source) -> str:
        """As ``wording``, but for the values of literals."""

    def values(
        self, old: Source, new: Source, found: Sequence[Literal], asked: Container[int]
    ) -> Mapping[Value, AttrValue] | None:
        """What attributes become where two texts of one shape have other literals.

        ``found`` are the attributes that were literals of the old one, ``asked`` the places of
        literals that mean more. None where a literal is another one that is no such attribute.
        """


@runtime_checkable
class DiagramReader(Protocol):
    """A front end that can also read the diagrams of authors."""

    def companions(self, name: str) -> Sequence[str]:
        """What may lie beside a source of this name and hold the diagrams of its authors.

        Names of files, or ``archive!pattern`` for entries of an archive (``BINARY-*``).
        """

    def drawings(
        self, sources: Sequence[Source], beside: Sequence[Source], graph: Graph, sink: Sink
    ) -> None:
        """Keep the diagrams of authors (``ir.drawing.Drawing``) for the pass ``views``."""
