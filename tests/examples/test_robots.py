"""The hall of robots in both notations: its mission is validated, its outputs were read."""

import json

import pytest

from examples.compiling import ROOT, compile_example, findings, outputs
from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.robots.outcome import run_study
from sysmlc.robots.report import study_files, summarise_outcome
from sysmlc.robots.study import Study
from sysmlc.synthesis.decision import Options, decide

MODELS = [ROOT / "examples" / "robots" / name for name in ("hall.sysml", "hall.uml")]


def outcome_of(model):
    (study,) = compile_example(model, "ir").graph.derived(Study)
    sink = Sink()
    outcome = run_study(study, lambda origin: Subject(), sink, Options(), has_relations=False)
    assert outcome.is_good
    assert list(sink) == []
    return outcome


def test_the_mission_is_done_as_the_report_says(golden):
    outcome = outcome_of(MODELS[0])
    assert f"    {summarise_outcome(outcome)}\n" in (MODELS[0].parent / "README.md").read_text(
        "utf-8"
    )
    made = dict(study_files(outcome))
    kept = {path: text for path, text in made.items() if path.endswith((".md", ".seq.puml"))}
    golden.check("examples/robots", kept | {"files.txt": "".join(f"{one}\n" for one in made)})


def test_both_notations_come_to_the_same():
    """But for the ids of elements, which controllers and contracts name."""
    first, second = (dict(study_files(outcome_of(model))) for model in MODELS)
    assert sorted(first) == sorted(second)
    for path, text in first.items():
        if path.endswith(".json"):
            made, other = (without_ids(json.loads(one)) for one in (text, second[path]))
            assert made == other
        else:
            assert second[path] == text


def without_ids(value):
    if isinstance(value, dict):
        return {key: without_ids(one) for key, one in value.items() if key != "origin"}
    return [without_ids(one) for one in value] if isinstance(value, list) else value


@pytest.mark.long
def test_all_its_contracts_can_be_kept():
    contracts = compile_example(MODELS[0], "ir").graph.derived(Contract)
    verdicts = {
        one.component.removeprefix("Warehouse::"): decide(
            one, lambda origin: Subject(), Sink(), Options()
        ).is_realizable
        for one in contracts
    }
    assert sorted(verdicts) == [
        "Hall",
        "Hall.environment",
        "Hall.mission",
        "Hall.r1",
        "Hall.r1.shared",
        "Hall.r2",
        "Hall.r2.shared",
    ]
    assert set(verdicts.values()) == {True}


def test_both_notations_have_the_same_contracts_and_no_findings():
    said = []
    for model in MODELS:
        made = compile_example(model)
        assert findings(made) == ""
        assert "contracts/Warehouse.Hall.md" in outputs(made)
        said.append(
            [
                (one.component, [print_formula(part.formula) for part in side])
                for one in made.graph.derived(Contract)
                for side in (one.assumptions, one.guarantees)
            ]
        )
    assert said[0] == said[1]
