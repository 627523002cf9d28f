"""Before and after: the passes that derive values, on small models in IR text.

They leave the elements as they are; what they store beside the graph is shown as text.
"""

import json
from pathlib import Path

import pytest

from sysmlc.backends.recipe.document import describe_model
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline
from sysmlc.recipe.model import Model

FOLDER = Path(__file__).parent / "derived"


def tokens(graph):
    """Each token graph: its nodes, and its edges with the variable that says where tokens are."""
    for found in graph.derived(TokenGraph):
        yield f"token graph of {found.component}"
        for node in found.nodes:
            yield f"  {node.kind} {node.id} {node.label}".rstrip()
        for edge in found.edges:
            guard = f" [{edge.guard.text}]" if edge.guard else ""
            mark = " marked" * edge.marked
            yield f"  {edge.variable}: {edge.source} -> {edge.target}{guard}{mark}"


def contracts(graph):
    """Each contract: variables with their owners, and conjuncts with class and origin."""
    for found in graph.derived(Contract):
        yield f"contract of {found.component}"
        for variable in found.variables:
            yield f"  {variable.owner} {variable.name}"
        for side, conjuncts in (("assume", found.assumptions), ("guarantee", found.guarantees)):
            for one in conjuncts:
                yield f"  {side} {one.class_} {print_formula(one.formula)}  -- {one.origin}"


def recipes(graph):
    """The recipe document, without inputs."""
    for found in graph.derived(Model):
        yield json.dumps(describe_model(found, ()), indent=1, ensure_ascii=False)


SHOWN = {"activities": tokens, "contracts": contracts, "recipe": recipes}


@pytest.mark.parametrize("name", SHOWN)
def test_model_before_and_after_the_pass(name, golden):
    graph, sink = parse_text((FOLDER / f"{name}.ir").read_text(encoding="utf-8")), Sink()
    pipeline.run(graph, sink, verify_each=True)
    shown = "".join(f"{line}\n" for line in SHOWN[name](graph))
    found = "".join(
        f"{diagnostic.rule.code} {diagnostic.severity}: {diagnostic.message}\n"
        for diagnostic in sink
    )
    assert shown, "the pass derived nothing"
    golden.check(f"passes/{name}-derived", {"after.txt": shown, "found.txt": found})
    assert verify(graph) == []


@pytest.mark.parametrize("name", SHOWN)
def test_twice_equals_once(name):
    graph = parse_text((FOLDER / f"{name}.ir").read_text(encoding="utf-8"))
    pipeline.run(graph, Sink())
    once = print_text(graph), list(SHOWN[name](graph))
    pipeline.load(name).run(graph, Sink())
    assert (print_text(graph), list(SHOWN[name](graph))) == once
