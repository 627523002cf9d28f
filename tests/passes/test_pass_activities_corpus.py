"""Real activities: each becomes a token graph, or a rule inside it says why not."""

import random
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.text import print_text
from sysmlc.logic import evaluate
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.derivation import derive_contract
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
REASONS = ("SM450", "SM454", "SM455", "SM459", "SM460", "SM467", "SM469", "SM473", "SM479")
"""Rules that an activity without token graph has; all but SM454 are absent here or mean that
nothing is drawn (SM469).
"""
_SAMPLE = 60
"""So many contracts of a file are played; of Alf.library every seventh."""


@cache
def refined(corpus: Path, name: str) -> tuple[Graph, Sink]:
    path = corpus / "xmi" / name
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source(path.name, path.read_bytes())], graph, Sink(), Coverage())
    for pass_name in ("resolve", "inherit", "classify", "ports", "flows"):
        pipeline.load(pass_name).run(graph, Sink())
    before = print_text(graph)
    pipeline.load("activities").run(graph, sink)
    assert print_text(graph) == before
    return graph, sink


def drawn(graph: Graph) -> list[Element]:
    found = graph.of_kind(Kind.ACTIVITY)
    return [a for a in found if not a.subkind and "external" not in a.attrs]


def reasons(graph: Graph, sink: Sink, activity: Element) -> list[str]:
    """Codes of located findings inside the activity that say why it has no token graph."""
    inside = {element.id for element in graph.subtree(activity)}
    found = (d for d in sink if d.subject.id in inside and d.subject.place)
    return sorted({d.rule.code for d in found} & set(REASONS))


def row(name: str, graph: Graph, sink: Sink) -> str:
    made = {tokens.activity for tokens in graph.derived(TokenGraph)}
    missing = [activity for activity in drawn(graph) if activity.id not in made]
    why = Counter(" ".join(reasons(graph, sink, one)) or "no reason" for one in missing)
    said = ", ".join(f"{count} {codes}" for codes, count in sorted(why.items())) or "none"
    return f"{name}: {len(drawn(graph))} drawn, {len(made)} token graphs; without: {said}\n"


def test_how_many_activities_have_token_graphs(corpus, golden):
    """A lower number is a loss: look for the reason before the file is written anew."""
    text = "".join(row(name, *refined(corpus, name)) for name in FILES)
    golden.check("passes/activities-corpus", {"share.txt": text})
    assert "no reason" not in text


@pytest.mark.parametrize("name", FILES)
def test_real_activities_keep_their_contracts_when_they_are_played(corpus, name):
    graph, _ = refined(corpus, name)
    made = graph.derived(TokenGraph)
    for tokens in made[:: len(made) // _SAMPLE + 1]:
        dice = random.Random(7)
        state, trace = token_game.initial_state(tokens), []
        for _ in range(60):
            inputs = {v.name: dice.choice(values(v.domain)) for v in tokens.inputs}
            trace.append({**inputs, **token_game.values_of(tokens, state)})
            state = token_game.next_state(
                tokens,
                state,
                inputs,
                evaluate.is_true,
                lambda _, open_, dice=dice: dice.choice(open_),
            )
        for conjunct in derive_contract(tokens).guarantees:
            assert evaluate.find_violation(conjunct, trace) is None, conjunct.text


OTHER_REVISION = {"TestClassReclassifier", "TestClassUnmarshaller"}
"""The MagicDraw file has actions and parameters in these two that the Eclipse file lacks."""


def test_two_dialects_of_one_model_give_the_same_contracts(corpus):
    eclipse, magicdraw = (contracts(*refined(corpus, name)) for name in FILES[:2])
    assert len(eclipse) == 38
    differing = {name for name in eclipse if eclipse[name] != magicdraw[name]}
    assert {name.rpartition("::")[2] for name in differing} == OTHER_REVISION


def contracts(graph: Graph, _: Sink) -> dict[str, list[list[str]]]:
    """The conjuncts of each activity; what the file is called is left out of the names."""
    found: dict[str, list[list[str]]] = {}
    for tokens in graph.derived(TokenGraph):
        contract = derive_contract(tokens)
        parts = (*contract.assumptions, *contract.guarantees)
        name = graph.qualified_name(graph[tokens.activity]).split("::", 1)[-1]
        found.setdefault(name, []).append(sorted(print_formula(one.formula) for one in parts))
    return found


def test_contracts_grow_with_the_activity_and_not_with_its_square(corpus):
    """No conjunct of any real activity has more than a few parts a flow."""
    for name in FILES:
        for tokens in refined(corpus, name)[0].derived(TokenGraph):
            sizes = [size(one.formula) for one in derive_contract(tokens).guarantees]
            assert sum(sizes) < 200 + 75 * len(tokens.edges), tokens.label


def size(formula) -> int:
    return 1 + sum(map(size, getattr(formula, "args", ())))
