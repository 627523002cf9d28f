"""The hall of robots in both notations: its mission succeeds, its outputs were reviewed."""

import json

import pytest

from examples.compiling import ROOT, compile_example, format_diagnostics, outputs
from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.robots.outcome import run_study
from sysmlc.robots.report import study_files, summarise_outcome
from sysmlc.robots.study import Study
from sysmlc.synthesis.decision import Options, decide

MODELS = [ROOT / "examples" / "robots" / name for name in ("hall.sysml", "hall.uml")]


def study_hall(model):
    (study,) = compile_example(model, "ir").graph.derived(Study)
    sink = Sink()
    outcome = run_study(study, lambda origin: Subject(), sink, Options(), has_relations=False)
    assert outcome.is_good
    assert list(sink) == []
    return outcome


def test_the_mission_succeeds_as_the_readme_states(golden):
    outcome = study_hall(MODELS[0])
    readme = (MODELS[0].parent / "README.md").read_text("utf-8")
    assert f"    {summarise_outcome(outcome)}\n" in readme
    files = dict(study_files(outcome))
    reviewed = {path: text for path, text in files.items() if path.endswith((".md", ".seq.puml"))}
    reviewed["files.txt"] = "".join(f"{path}\n" for path in files)
    golden.check("examples/robots", reviewed)


def test_both_notations_have_the_same_outcome():
    """Only the ids of elements differ, which controllers and contracts contain."""
    first, second = (dict(study_files(study_hall(model))) for model in MODELS)
    assert sorted(first) == sorted(second)
    for path, text in first.items():
        if path.endswith(".json"):
            assert drop_ids(json.loads(text)) == drop_ids(json.loads(second[path]))
        else:
            assert second[path] == text


def drop_ids(value):
    if isinstance(value, dict):
        return {key: drop_ids(item) for key, item in value.items() if key != "origin"}
    return [drop_ids(item) for item in value] if isinstance(value, list) else value


@pytest.mark.long
def test_all_contracts_of_the_hall_are_realizable():
    contracts = compile_example(MODELS[0], "ir").graph.derived(Contract)
    verdicts = {
        contract.component.removeprefix("Warehouse::"): decide(
            contract, lambda origin: Subject(), Sink(), Options()
        ).is_realizable
        for contract in contracts
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


def test_both_notations_have_the_same_contracts_and_no_diagnostics():
    formulas = []
    for model in MODELS:
        compilation = compile_example(model)
        assert format_diagnostics(compilation) == ""
        assert "contracts/Warehouse.Hall.md" in outputs(compilation)
        formulas.append(
            [
                (contract.component, [print_formula(part.formula) for part in side])
                for contract in compilation.graph.derived(Contract)
                for side in (contract.assumptions, contract.guarantees)
            ]
        )
    assert formulas[0] == formulas[1]
