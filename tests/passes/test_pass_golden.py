"""Each pass on small models in IR text, before and after; and each pass is idempotent.

Structural passes change elements. The other passes leave the elements unchanged; the results that
they store beside the graph are printed as text.
"""

import json
from pathlib import Path

import pytest
from pass_runs import (
    STRUCTURAL,
    list_diagnostics,
    print_after_second_run,
    print_before,
    read_models,
    run_all,
    run_until,
)

from sysmlc.analyses import analysis
from sysmlc.backends.recipe.document import describe_model
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.recipe.model import Model

MODELS = read_models()
DERIVED = Path(__file__).parent / "derived"


# -- structural passes ---------------------------------------------------------------------------


@pytest.mark.parametrize("name", MODELS)
def test_model_before_and_after_a_structural_pass(name, golden):
    pass_name = name.partition("-")[0]
    graph, sink = run_until(MODELS[name], pass_name)
    diagnostics = "".join(f"{line}\n" for line in list_diagnostics(sink))
    notes = "".join(f"  {note}\n" for diagnostic in sink for note in diagnostic.notes)
    golden.check(
        f"passes/{name}",
        {
            "before.ir": print_before(MODELS[name], pass_name),
            "after.ir": print_text(graph),
            "found.txt": diagnostics + notes,
        },
    )


@pytest.mark.parametrize("pass_name", STRUCTURAL)
@pytest.mark.parametrize("name", MODELS)
def test_each_structural_pass_is_idempotent_and_leaves_a_valid_graph(name, pass_name):
    graph, _ = run_until(MODELS[name], pass_name)
    assert verify(graph) == []
    once = print_text(graph)
    assert print_after_second_run(graph, pass_name) == once
    assert print_text(parse_text(once)) == once


# -- passes that derive values -------------------------------------------------------------------


def print_token_graphs(graph):
    """Yield lines with the nodes of each token graph, and its edges with their variables."""
    for token_graph in graph.derived(TokenGraph):
        yield f"token graph of {token_graph.component}"
        for node in token_graph.nodes:
            yield f"  {node.kind} {node.id} {node.label}".rstrip()
        for edge in token_graph.edges:
            guard = f" [{edge.guard.text}]" if edge.guard else ""
            mark = " marked" * edge.marked
            yield f"  {edge.variable}: {edge.source} -> {edge.target}{guard}{mark}"


def print_contracts(graph):
    """Yield lines with the variables of each contract, and its conjuncts with their origins."""
    for contract in graph.derived(Contract):
        yield f"contract of {contract.component}"
        for variable in contract.variables:
            yield f"  {variable.owner} {variable.name}"
        sides = (("assume", contract.assumptions), ("guarantee", contract.guarantees))
        for side, conjuncts in sides:
            for conjunct in conjuncts:
                formula = print_formula(conjunct.formula)
                yield f"  {side} {conjunct.class_} {formula}  -- {conjunct.origin}"


def print_recipes(graph):
    """Yield each recipe document, without inputs."""
    for model in graph.derived(Model):
        yield json.dumps(describe_model(model, ()), indent=1, ensure_ascii=False)


PRINTERS = {
    "activities": print_token_graphs,
    "contracts": print_contracts,
    "recipe": print_recipes,
}


def read_model(name):
    return (DERIVED / f"{name}.ir").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", PRINTERS)
def test_values_that_an_analysis_derives(name, golden):
    graph, sink = run_all(read_model(name))
    values = "".join(f"{line}\n" for line in PRINTERS[name](graph))
    diagnostics = "".join(f"{line}\n" for line in list_diagnostics(sink))
    assert values, "the analysis derived nothing"
    golden.check(f"passes/{name}-derived", {"after.txt": values, "found.txt": diagnostics})
    assert verify(graph) == []


@pytest.mark.parametrize("name", PRINTERS)
def test_each_analysis_is_idempotent(name):
    graph, _ = run_all(read_model(name))
    once = print_text(graph), list(PRINTERS[name](graph))
    analysis.load(name).run(graph, Sink())
    assert (print_text(graph), list(PRINTERS[name](graph))) == once
