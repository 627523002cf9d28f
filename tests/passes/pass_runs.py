"""Run passes on a model in IR text and print what they store and report."""

from collections.abc import Iterable
from pathlib import Path

import refinement
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline

STRUCTURAL = ("resolve", "inherit", "classify", "ports", "flows", "behaviours", "interactions")
MODELS = Path(__file__).parent / "models"


def read_models() -> dict[str, str]:
    """Return the texts of ``models/`` by name; the part before the hyphen names the pass."""
    return {path.stem: path.read_text(encoding="utf-8") for path in sorted(MODELS.glob("*.ir"))}


# -- running passes ------------------------------------------------------------------------------


def run_until(text: str, pass_name: str) -> tuple[Graph, Sink]:
    """Run the structural passes up to *pass_name*; return the graph and the diagnostics."""
    graph, sink = parse_text(text), Sink()
    run_structural_passes(graph, sink, pass_name)
    return graph, sink


def run_structural_passes(graph: Graph, sink: Sink, until: str) -> None:
    """Run the structural passes up to and including *until*."""
    names = STRUCTURAL[: STRUCTURAL.index(until) + 1]
    pipeline.build_pipeline(names).run(graph, sink, verify_each=True)


def run_all(text: str) -> tuple[Graph, Sink]:
    """Run all passes; return the graph and the diagnostics."""
    graph, sink = parse_text(text), Sink()
    refinement.run_all(graph, sink, verify_each=True)
    return graph, sink


def derive_contracts(text: str) -> tuple[Graph, list[Contract], Sink]:
    """Run all passes; return the graph, the contracts and the diagnostics."""
    graph, sink = run_all(text)
    return graph, list(graph.derived(Contract)), sink


# -- printing results ----------------------------------------------------------------------------


def print_before(text: str, pass_name: str) -> str:
    """Return the model, as text, after the structural passes that precede the pass."""
    number = STRUCTURAL.index(pass_name)
    return print_text(run_until(text, STRUCTURAL[number - 1])[0] if number else parse_text(text))


def print_after_second_run(graph: Graph, pass_name: str) -> str:
    """Run a pass once more and return the graph as text; the graph must be valid."""
    pipeline.load(pass_name).run(graph, Sink())
    assert verify(graph) == []
    return print_text(graph)


def list_diagnostics(sink: Sink) -> list[str]:
    """Return each diagnostic as a line of code, severity and message."""
    return [
        f"{diagnostic.rule.code} {diagnostic.severity}: {diagnostic.message}" for diagnostic in sink
    ]


def list_codes(sink: Sink) -> list[str]:
    """Return the code of each diagnostic."""
    return [diagnostic.rule.code for diagnostic in sink]


def list_messages(sink: Sink, code: str) -> list[str]:
    """Return the messages of one rule."""
    return [diagnostic.message for diagnostic in sink if diagnostic.rule.code == code]


def print_conjuncts(conjuncts: Iterable[Conjunct]) -> list[str]:
    """Return each conjunct as its class and its formula, ``safety: a -> b'``."""
    return [f"{conjunct.class_}: {print_formula(conjunct.formula)}" for conjunct in conjuncts]
