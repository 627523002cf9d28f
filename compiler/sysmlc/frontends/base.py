"""What a front end is: it recognises its files and reads them into the graph."""

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from typing import Protocol, runtime_checkable

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Place, Sink
from sysmlc.ir import Graph
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


class FileNames(Struct, frozen=True):
    """How a file takes part in the compile units of its folder, beyond ``Frontend.links``.

    A library, such as a profile, only defines what models use. It belongs to each unit that uses
    it and does not connect these units.
    """

    is_library: bool = False
    declared: AbstractSet[str] = frozenset()
    """Names by which other files can refer to this one."""
    local: AbstractSet[str] = frozenset()
    """Names of all its elements; a use of such a name in the same unit means that element."""
    used: AbstractSet[str] = frozenset()
    """Names by which this file may refer to others; local names may be among them."""


@runtime_checkable
class Relating(Protocol):
    """A front end whose files are libraries, refer to one another by name, or share a folder."""

    is_folder_unit: bool
    """Whether the files of a folder are one model although none of them names another file."""

    def read_names(self, source: Source) -> FileNames:
        """Return how the source takes part in compile units; its faults are reported later."""


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
