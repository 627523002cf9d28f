"""Small models in IR text, and the diagrams that the back end ``plantuml`` draws of graphs."""

from pathlib import Path

import backend_runs
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.plantuml import BACKEND
from sysmlc.diagnostics import Diagnostic
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.support.output import Artefact

MODELS = Path(__file__).parent / "models"


def load_model(name: str) -> Graph:
    """Return the graph of one of the small models."""
    return parse_text((MODELS / f"{name}.ir").read_text(encoding="utf-8"))


def emit(
    graph: Graph, templates: Path | None = None, diagrams: str = "derived"
) -> tuple[list[Artefact], list[Diagnostic]]:
    """Return the files that the back end writes, and its diagnostics."""
    options = EmitOptions(templates, diagrams=diagrams)
    artefacts, diagnostics = backend_runs.emit(BACKEND, graph, options)
    return list(artefacts.values()), diagnostics


def draw(graph: Graph) -> dict[str, str]:
    """Return the texts by their path below the folder ``diagrams``."""
    files, _ = emit(graph)
    return {file.path.removeprefix("diagrams/"): file.text for file in files}


def draw_without_style(graph: Graph) -> dict[str, str]:
    """Return the same texts without the style at their beginning."""
    return {path: text.partition("</style>")[2] for path, text in draw(graph).items()}
