"""``sysmlc contracts check``: contracts of a model, behaviours against requirements."""

import pytest

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Contract
from sysmlc.passes import pipeline
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.contract_checks import BREAKS, check_contracts
from sysmlc.synthesis.decision import Options

CODES = ("SM560", "SM561", "SM562")


def checked(text):
    graph, sink = parse_text(text), Sink()
    pipeline.run(graph, sink, verify_each=True)
    sink = Sink()
    made = graph.derived(Contract)
    results = check_contracts(
        made, made, lambda origin: graph.subject(graph[origin]), sink, Options()
    )
    return {one.verdict.component: one for one in results}, list(sink)


@pytest.mark.parametrize("code", CODES)
def test_rule_reports_its_wrong_model_and_not_its_right_one(code):
    rule = catalogue()[code]
    assert code in [one.rule.code for one in checked(rule.read_page().wrong)[1]]
    assert code not in [one.rule.code for one in checked(rule.read_page().right)[1]]


def test_a_behaviour_keeps_its_requirements_or_a_run_shows_where_not():
    results, _ = checked(BREAKS.read_page().right)
    assert results["Plant::Gate"].is_implemented is True
    results, found = checked(BREAKS.read_page().wrong)
    assert results["Plant::Gate"].is_implemented is False
    assert results["Plant::Gate.requirements"].is_implemented is None
    (broken,) = [one for one in found if one.rule is BREAKS]
    assert broken.message == (
        "the behaviour of 'Plant::Gate' violates 'state=B -> state'=B' ('Stays on' demands it)"
    )
    assert broken.subject.name == "Plant::Stays on::<Constraint>"
    assert broken.notes[0] == "step 1: event=start, state=A"
    assert broken.notes[1] == "step 2: event=stop, state=B"
    assert "state=A" in broken.notes[2]


def test_questions_that_take_too_long_are_told(monkeypatch):
    def give_up(*_):
        raise LimitError("of CPU time", "1 s")

    monkeypatch.setattr("sysmlc.synthesis.contract_checks.lint", give_up)
    results, found = checked(BREAKS.read_page().right)
    assert results["Plant::Gate"].verdict.is_realizable
    assert next(one.message for one in found if one.rule.code == "SM563") == (
        "the checks of 'Plant::Gate' are incomplete: the limit of 1 s of CPU time was reached"
    )
