"""What a back end is: a name and ``emit``. It reads the graph and never changes it."""

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.output import Output


@dataclass(frozen=True, slots=True)
class InputFile:
    """One input as the outputs name it: path relative to the unit's root, and its SHA-256."""

    path: str
    sha256: str
    language: str


@dataclass(frozen=True, slots=True)
class EmitOptions:
    """What the user asked of the back ends."""

    templates: Path | None = None
    inputs: tuple[InputFile, ...] = ()


class Backend(Protocol):
    """Writes one kind of output for the whole graph."""

    name: str
    summary: str
    is_default: bool

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add files to ``output``; report what the target cannot express."""
