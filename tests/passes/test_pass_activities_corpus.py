"""Real activities: each becomes a token graph, or a rule inside it says why not."""

import random
from pathlib import Path

import pytest

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph, Kind
from sysmlc.ir.text import print_text
from sysmlc.logic import evaluate, token_game
from sysmlc.logic.activity_contract import derive
from sysmlc.logic.domains import values
from sysmlc.logic.tokens import TokenGraph
from sysmlc.passes import pipeline
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

FILES = {
    "fUML-Tests.uml": (43, 35),
    "TankBarrelExample.uml": (4, 4),
    "moka-master.uml": (2, 2),
    "tracker.uml": (1, 1),
    "Factorial.uml": (3, 3),
}
"""Drawn activities, and those that become token graphs. The others have data stores, flows
across structured nodes, or flows that hold several tokens, which is what they were made to test.
"""


def refined(corpus: Path, name: str) -> tuple[Graph, Sink]:
    path = corpus / "xmi" / "papyrus" / name
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source(name, path.read_bytes())], graph, Sink(), Coverage())
    for pass_name in ("resolve", "inherit", "classify", "ports", "flows"):
        pipeline.load(pass_name).run(graph, Sink())
    before = print_text(graph)
    pipeline.load("activities").run(graph, sink)
    assert print_text(graph) == before
    return graph, sink


@pytest.mark.parametrize("name", FILES)
def test_every_activity_is_a_token_graph_or_has_a_rule(corpus, name):
    graph, sink = refined(corpus, name)
    drawn = [a for a in graph.of_kind(Kind.ACTIVITY) if not a.subkind and "external" not in a.attrs]
    made = {tokens.activity for tokens in graph.derived(TokenGraph)}
    assert (len(drawn), len(made)) == FILES[name]
    found = {diagnostic.subject.id for diagnostic in sink if diagnostic.subject.place}
    for activity in drawn:
        inside = {element.id for element in graph.subtree(activity)}
        assert activity.id in made or found & inside


@pytest.mark.parametrize("name", FILES)
def test_real_activities_keep_their_contracts_when_they_are_played(corpus, name):
    graph, _ = refined(corpus, name)
    for tokens in graph.derived(TokenGraph):
        dice = random.Random(7)
        state, trace = token_game.start(tokens), []
        for _ in range(80):
            inputs = {v.name: dice.choice(values(v.domain)) for v in tokens.inputs}
            trace.append({**inputs, **token_game.values(tokens, state)})
            state = token_game.step(
                tokens,
                state,
                inputs,
                evaluate.is_true,
                lambda _, open_, dice=dice: dice.choice(open_),
            )
        for conjunct in derive(tokens).guarantees:
            assert evaluate.violation(conjunct, trace) is None, conjunct.text
