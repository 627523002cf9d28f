"""What a back end is: a name and ``emit``. It reads the graph and never changes it."""

import posixpath
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Protocol

from msgspec import Struct

from sysmlc.diagnostics import Place, Sink
from sysmlc.ir import Graph
from sysmlc.support.output import Output


class InputFile(Struct, frozen=True):
    """One input as the outputs name it: path relative to the unit's root, and its SHA-256."""

    path: str
    sha256: str
    language: str


Locate = Callable[[Iterable[Place]], Mapping[Place, Place]]
"""Finds lines and columns: each place that can be found, with its line and column known."""


def _as_they_are(places: Iterable[Place]) -> Mapping[Place, Place]:
    return {place: place for place in places}


DIAGRAMS = ("derived", "author", "both")
"""Which diagrams are wanted: those that are derived from the model, those of its authors."""
DERIVED, AUTHOR, BOTH = DIAGRAMS


class EmitOptions(Struct, frozen=True):
    """What the user asked of the back ends, and what they may ask of the driver."""

    templates: Path | None = None
    inputs: tuple[InputFile, ...] = ()
    locate: Locate = _as_they_are
    diagrams: str = DERIVED


class Backend(Protocol):
    """Writes one kind of output for the whole graph."""

    name: str
    summary: str
    is_default: bool

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add files to ``output``; report what the target cannot express."""


def find_unit_name(graph: Graph, options: EmitOptions) -> str:
    """Return the name of the first input without its suffix, else the name of the first root."""
    if options.inputs:
        # The path of an input in an archive is ``archive!entry``.
        file_name = posixpath.basename(options.inputs[0].path.partition("!")[0])
        return file_name.partition(".")[0] or file_name
    return next((root.name for root in graph.roots() if root.name), "model")
