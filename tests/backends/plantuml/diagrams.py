"""What the tests of the diagrams share: from IR text to PlantUML texts and findings."""

from pathlib import Path

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.plantuml import BACKEND
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.support.output import Artefact, Output

MODELS = Path(__file__).parent / "models"


def model(name: str) -> Graph:
    """One of the small models in IR text."""
    return parse_text((MODELS / f"{name}.ir").read_text(encoding="utf-8"))


def emitted(graph: Graph, templates: Path | None = None) -> tuple[list[Artefact], Sink]:
    """The files that the back end makes of the graph, and what it reports."""
    output, sink = Output(), Sink()
    BACKEND.emit(graph, output, sink, EmitOptions(templates))
    return output.artefacts(), sink


def texts(graph: Graph) -> dict[str, str]:
    """The files by their path below ``diagrams``."""
    files, _ = emitted(graph)
    return {file.path.removeprefix("diagrams/"): file.text for file in files}
