"""``sysmlc contracts check``: contracts of a model, behaviours against requirements."""

import pytest

from sysmlc import compile_model
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.logic.contract import Contract
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.contract_checks import BREAKS, check_contracts
from sysmlc.synthesis.decision import Options

CODES = ("SM560", "SM561", "SM562")


@pytest.fixture
def check_model(tmp_path):
    """Return the function that checks the contracts of a model in SysML v2."""
    return lambda text: check_text(tmp_path / "plant.sysml", text)


def check_text(path, text):
    path.write_text(text, "utf-8")
    graph, sink = compile_model(path).graph, Sink()
    contracts = graph.derived(Contract)
    results = check_contracts(
        contracts, contracts, lambda origin: graph.subject(graph[origin]), sink, Options()
    )
    return {result.verdict.component: result for result in results}, list(sink)


@pytest.mark.parametrize("code", CODES)
def test_rule_reports_its_wrong_model_and_not_its_right_one(code, check_model):
    rule = catalogue()[code]
    assert code in [diagnostic.rule.code for diagnostic in check_model(rule.read_page().wrong)[1]]
    assert code not in [
        diagnostic.rule.code for diagnostic in check_model(rule.read_page().right)[1]
    ]


def test_a_violated_requirement_is_reported_with_a_run(check_model):
    results, _ = check_model(BREAKS.read_page().right)
    assert results["Plant::Gate"].is_implemented is True
    results, diagnostics = check_model(BREAKS.read_page().wrong)
    assert results["Plant::Gate"].is_implemented is False
    assert results["Plant::Gate.requirements"].is_implemented is None
    (violation,) = [diagnostic for diagnostic in diagnostics if diagnostic.rule is BREAKS]
    assert violation.message == (
        "the behaviour of 'Plant::Gate' violates 'state=open -> state'=open' "
        "('StaysOpen' demands it)"
    )
    assert violation.subject.name == "Plant::StaysOpen::<Constraint>"
    assert violation.notes[0] == "step 1: event=Start, state=shut"
    assert violation.notes[1] == "step 2: event=Stop, state=open"
    assert "state=shut" in violation.notes[2]


def test_checks_that_reach_a_limit_are_reported(monkeypatch, check_model):
    def give_up(*_, **__):
        raise LimitError("of CPU time", "1 s")

    monkeypatch.setattr("sysmlc.synthesis.contract_checks.lint", give_up)
    results, diagnostics = check_model(BREAKS.read_page().right)
    assert results["Plant::Gate"].verdict.is_realizable
    assert next(
        diagnostic.message for diagnostic in diagnostics if diagnostic.rule.code == "SM563"
    ) == ("the checks of 'Plant::Gate' are incomplete: the limit of 1 s of CPU time was reached")
