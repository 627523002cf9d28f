"""The interface of front ends: detect files of a language and read them into the graph."""

from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet
from typing import Protocol, TypeVar, runtime_checkable

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Place, Rule, Sink, Subject
from sysmlc.ir import Graph
from sysmlc.sources import Fault, Source, SourceError

_T = TypeVar("_T")


class Frontend(Protocol):
    """Reads one family of source languages.

    One call reads all files of a compile unit, because ids are retained only if they are unique in
    the unit. Local references may stay in ``graph.pending`` for the pass ``resolve``. A search of
    folders also considers the files with one of the ``suffixes`` of a plug-in, if it has any.
    """

    name: str

    def detect(self, source: Source) -> float:
        """Return how certainly the content is one that the front end can read, from 0 to 1."""

    def links(self, source: Source) -> Sequence[str]:
        """Return the references to other files, as the source writes them, each once, in order.

        The driver adds the files that exist and are allowed to the compile unit.
        """

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph.

        *coverage* counts the elements of each file by their verdict: mapped, unsupported, ...
        """


class FileNames(Struct, frozen=True):
    """Names by which files of a folder form compile units, in addition to ``Frontend.links``.

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
class UnitFrontend(Protocol):
    """A front end whose files are libraries, refer to one another by name, or share a folder."""

    is_folder_unit: bool
    """Whether all files of a folder form one model, without references to one another."""

    def read_names(self, source: Source) -> FileNames:
        """Return the names that decide with which other files the source forms a compile unit.

        A faulty source raises nothing and is not reported: ``read`` reports its faults.
        """


@runtime_checkable
class LibraryFrontend(Protocol):
    """A front end whose models refer to a library of models."""

    def with_library(self, path: str) -> Frontend:
        """Return this front end, but with the library at *path*, a folder or an archive."""

    def list_library_names(self) -> AbstractSet[str]:
        """Return the names by which models refer to the library."""


@runtime_checkable
class AttachmentFrontend(Protocol):
    """A front end whose files refer to documents that are not read, but should exist."""

    def list_attachments(self, source: Source) -> Sequence[tuple[str, Place]]:
        """Return the paths of the documents, as the source writes them, with their locations."""


@runtime_checkable
class DiagramReader(Protocol):
    """A front end that can also read the diagrams that the authors of a model have drawn."""

    def list_companions(self, name: str) -> Sequence[str]:
        """Return the files in the folder of the source *name* that may contain its diagrams.

        They are names of files, or ``archive!pattern`` for entries of an archive (``BINARY-*``).
        """

    def read_drawings(
        self, sources: Sequence[Source], beside: Sequence[Source], graph: Graph, sink: Sink
    ) -> None:
        """Store the diagrams of authors (``ir.pending.Drawing``) for the pass ``views``."""


def read_or_report(
    read: Callable[[Source], _T], source: Source, malformed: Rule, sink: Sink
) -> _T | None:
    """Return ``read(source)``, or report a damaged file by the rule *malformed* and return None.

    Raises SourceError if the file exceeds the limits.
    """
    try:
        return read(source)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(malformed, subject, file=source.name, problem=problem.message)
        return None
