"""Each real activity becomes a token graph, or a rule reports the reason inside the activity."""

import random
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from sysmlc.analyses import analysis
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.text import print_text
from sysmlc.logic import evaluate
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.derivation import derive_contract, list_variables
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.domains import values
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

FILES = (
    "papyrus/fUML-Tests.uml",
    "magicdraw/fUML-Tests.mdxml",
    "papyrus/Alf.library.uml",
    "papyrus/AssertionLibrary.uml",
    "papyrus/moka-master.uml",
    "papyrus/TankBarrelExample.uml",
    "papyrus/TutoFMU.uml",
    "papyrus/fUML-Exception-Tests.uml",
    "papyrus/Factorial.uml",
    "papyrus/tracker.uml",
    "papyrus/AllDiagrams.uml",
)
REASONS = ("SM450", "SM454", "SM455", "SM459", "SM460", "SM467", "SM469", "SM473", "SM479", "SM486")
"""Rules that explain why an activity has no token graph."""
_SAMPLE = 60
"""At most so many contracts of a file are played; of Alf.library every seventh."""


@cache
def read_activities(corpus: Path, name: str) -> tuple[Graph, Sink]:
    path = corpus / "xmi" / name
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source(path.name, path.read_bytes())], graph, Sink(), Coverage())
    for pass_name in ("resolve", "inherit", "classify", "ports", "flows"):
        pipeline.load(pass_name).run(graph, Sink())
    before = print_text(graph)
    analysis.load("activities").run(graph, sink)
    assert print_text(graph) == before
    return graph, sink


def list_drawn_activities(graph: Graph) -> list[Element]:
    activities = graph.of_kind(Kind.ACTIVITY)
    return [a for a in activities if not a.subkind and "external" not in a.attrs]


def list_reasons(graph: Graph, sink: Sink, activity: Element) -> list[str]:
    """Return the codes of located diagnostics that explain why the activity has no token graph."""
    inside = {element.id for element in graph.subtree(activity)}
    diagnostics = (d for d in sink if d.subject.id in inside and d.subject.place)
    return sorted({d.rule.code for d in diagnostics} & set(REASONS))


def describe_file(name: str, graph: Graph, sink: Sink) -> str:
    """Return a line with the numbers of activities, of token graphs and of each reason."""
    activities = list_drawn_activities(graph)
    with_graph = {tokens.activity for tokens in graph.derived(TokenGraph)}
    without = [activity for activity in activities if activity.id not in with_graph]
    reasons = Counter(" ".join(list_reasons(graph, sink, a)) or "no reason" for a in without)
    counts = ", ".join(f"{n} {codes}" for codes, n in sorted(reasons.items())) or "none"
    numbers = f"{len(activities)} drawn, {len(with_graph)} token graphs"
    return f"{name}: {numbers}; without: {counts}\n"


def test_the_number_of_activities_with_token_graphs_is_unchanged(corpus, golden):
    """A lower number is a loss: look for the reason before you update the golden file."""
    text = "".join(describe_file(name, *read_activities(corpus, name)) for name in FILES)
    golden.check("passes/activities-corpus", {"share.txt": text})
    assert "no reason" not in text


@pytest.mark.parametrize("name", FILES)
def test_runs_of_real_activities_satisfy_their_contracts(corpus, name):
    graph, _ = read_activities(corpus, name)
    token_graphs = graph.derived(TokenGraph)
    for tokens in token_graphs[:: len(token_graphs) // _SAMPLE + 1]:
        dice = random.Random(7)
        variables = list_variables(tokens)
        state, trace = token_game.initial_state(tokens), []
        for _ in range(60):
            inputs = {v.name: dice.choice(values(v.domain)) for v in variables if v.owner == "env"}
            trace.append({**inputs, **token_game.values_of(tokens, state, inputs)})
            state = token_game.next_state(
                tokens,
                state,
                inputs,
                evaluate.is_true,
                lambda _, flows, dice=dice: dice.choice(flows),
            )
        for conjunct in derive_contract(tokens).guarantees:
            assert evaluate.find_violation(conjunct, trace) is None, conjunct.text


DIFFERENT_REVISIONS = {"TestClassReclassifier"}
"""In it, the MagicDraw file has actions and parameters that the Eclipse file lacks."""


def test_two_dialects_of_one_model_give_the_same_contracts(corpus):
    eclipse, magicdraw = (print_contracts(*read_activities(corpus, name)) for name in FILES[:2])
    assert len(eclipse) == 41
    differing = {name for name in eclipse if eclipse[name] != magicdraw[name]}
    assert {name.rpartition("::")[2] for name in differing} == DIFFERENT_REVISIONS


def print_contracts(graph: Graph, _: Sink) -> dict[str, list[list[str]]]:
    """Return the conjuncts of each activity; the names of activities omit the name of the file."""
    conjuncts: dict[str, list[list[str]]] = {}
    for tokens in graph.derived(TokenGraph):
        contract = derive_contract(tokens)
        parts = (*contract.assumptions, *contract.guarantees)
        name = graph.qualified_name(graph[tokens.activity]).split("::", 1)[-1]
        formulas = sorted(print_formula(conjunct.formula) for conjunct in parts)
        conjuncts.setdefault(name, []).append(formulas)
    return conjuncts


def test_the_size_of_a_contract_is_linear_in_the_number_of_flows(corpus):
    for name in FILES:
        for tokens in read_activities(corpus, name)[0].derived(TokenGraph):
            sizes = [count_nodes(c.formula) for c in derive_contract(tokens).guarantees]
            assert sum(sizes) < 200 + 75 * len(tokens.edges), tokens.label


def count_nodes(formula) -> int:
    """Return the number of nodes of the syntax tree."""
    return 1 + sum(map(count_nodes, getattr(formula, "args", ())))
