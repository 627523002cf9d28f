"""What the tests of passes share: running them on a text, and showing what they found."""

from pathlib import Path

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline

STRUCTURAL = ("resolve", "inherit", "classify", "ports", "flows", "behaviours", "interactions")
MODELS = Path(__file__).parent / "models"


def models() -> dict[str, str]:
    """Texts of the models of this folder by name; the pass is what stands before the hyphen."""
    return {path.stem: path.read_text(encoding="utf-8") for path in sorted(MODELS.glob("*.ir"))}


def refined(text: str, until: str) -> tuple[Graph, Sink]:
    """The graph behind the structural pass ``until``, and all that was found on the way."""
    graph, sink = parse_text(text), Sink()
    refine(graph, sink, until)
    return graph, sink


def refine(graph: Graph, sink: Sink, until: str) -> None:
    """Run the structural passes up to and with ``until``."""
    names = STRUCTURAL[: STRUCTURAL.index(until) + 1]
    pipeline.build_pipeline(names).run(graph, sink, verify_each=True)


def before(text: str, name: str) -> str:
    """The model as the pass of that name gets it."""
    number = STRUCTURAL.index(name)
    return print_text(refined(text, STRUCTURAL[number - 1])[0] if number else parse_text(text))


def again(graph: Graph, name: str) -> str:
    """The graph after one more run of a pass; it is valid."""
    pipeline.load(name).run(graph, Sink())
    assert verify(graph) == []
    return print_text(graph)


def lines(sink: Sink) -> list[str]:
    """Findings, one a line, as a test expects them: code, severity, message."""
    return [
        f"{diagnostic.rule.code} {diagnostic.severity}: {diagnostic.message}" for diagnostic in sink
    ]


def codes(sink: Sink) -> list[str]:
    """Codes of the findings."""
    return [diagnostic.rule.code for diagnostic in sink]
