"""Lints of contracts: each rule, and the tables of the thesis read literally."""

import os
from pathlib import Path

import pytest
from contracts_in_lines import parse_contract

from sysmlc.diagnostics import Sink, Subject, catalogue
from sysmlc.logic.formats import read
from sysmlc.synthesis import Manager, make_game, rules, solve
from sysmlc.synthesis.lints import lint

CODES = ("SM533", "SM534", "SM535", "SM536", "SM537", "SM538", "SM539", "SM540", "SM541", "SM542")
RULES = [catalogue()[code] for code in CODES]


def find_lints(contract):
    sink = Sink()
    lint(contract, lambda origin: Subject(origin), sink, Manager)
    return [(diagnostic.rule.code, diagnostic.message) for diagnostic in sink]


def read_contract(text):
    sink = Sink()
    (contract,) = read(text, "lamp", sink)
    assert list(sink) == []
    return contract


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_rule_reports_its_wrong_contract_and_not_its_right_one(rule):
    assert rule.code in [code for code, _ in find_lints(read_contract(rule.read_page().wrong))]
    assert find_lints(read_contract(rule.read_page().right)) == []


def test_every_lint_rule_is_tested():
    codes = {value.code for name, value in vars(rules).items() if name.isupper() and name[0] != "_"}
    assert {code for code in codes if CODES[0] <= code <= CODES[-1]} == set(CODES)


@pytest.mark.parametrize("code", ["SM537", "SM539", "SM540"])
def test_a_diagnostic_about_a_conjunct_is_at_its_location(code):
    text, sink = catalogue()[code].read_page().wrong, Sink()
    lint(read_contract(text), lambda origin: Subject(origin), sink, Manager)
    (diagnostic,) = [diagnostic for diagnostic in sink if diagnostic.rule.code == code]
    line, column = map(int, diagnostic.subject.name.split(":")[1:])
    formula = text.splitlines()[line - 1][column - 1 :].split('"')[0]
    assert f"'{formula}'" in diagnostic.message


def test_a_dead_end_is_shown_by_a_state():
    contract = parse_contract(
        """
        env go: bool
        sys n: 0..2
        assume always n=2 -> go' & !go'
        promise always n<2 -> n'=n+1
        promise always n=2 -> n'=0
        """
    )
    message = (
        "the environment of 'c' can reach a state in which its assumptions allow no next step: n=2"
    )
    assert ("SM534", message) in find_lints(contract)


@pytest.mark.parametrize("assumed", ["power", "power & (n=1 | n=2)"])
def test_an_invariant_assumption_about_inputs_is_no_dead_end(assumed):
    contract = parse_contract(
        f"""
        env power: bool
        env n: 0..3
        sys on: bool
        assume always {assumed}
        promise always on' <-> n'=1
        """
    )
    assert find_lints(contract) == []


def test_an_invariant_assumption_about_inputs_and_outputs_is_a_dead_end():
    contract = parse_contract(
        """
        env power: bool
        sys on: bool
        assume always on -> power
        promise always on' <-> !on
        """
    )
    assert [code for code, _ in find_lints(contract)] == ["SM534", "SM535"]


def test_a_choice_needs_no_frame_and_a_quantity_does():
    choice = parse_contract("sys n: 0..3\npromise always n=3 -> n'=0")
    assert [code for code, _ in find_lints(choice)] == ["SM536"]
    complete = parse_contract(
        "sys n: 0..3\npromise always n<3 -> n'=n+1\npromise always n=3 -> n'=0"
    )
    assert find_lints(complete) == []
    command = parse_contract("sys say: stop go\npromise always say=go -> say'=stop")
    assert find_lints(command) == []
    single_state = parse_contract("sys state: On\npromise always state=On")
    assert find_lints(single_state) == []


def test_missing_fairness_names_a_helpful_assumption():
    contract = parse_contract(
        "env go: bool\nsys on: bool\npromise always on' <-> go'\npromise recurs on"
    )
    assert find_lints(contract) == [
        (
            "SM538",
            "'c' could satisfy its contract if its environment did not wait forever, for instance "
            "if 'go' recurred",
        )
    ]


def test_the_assumptions_that_can_be_forced_are_named():
    contract = parse_contract(
        """
        env go: bool
        env wind: bool
        sys on: bool
        assume always go' <-> on
        assume recurs go
        assume recurs wind
        promise recurs on & wind
        """
    )
    (text,) = [message for code, message in find_lints(contract) if code == "SM535"]
    assert text.endswith("not without 'go' <-> on', 'go'")


GOOD = ("turn", "move", "pick", "place", "compose", "decompose", "coordinator")
LITERAL = ("turn_literal", "turn_literal_live", "pick_literal", "place_literal_nogrip",
           "coordinator_literal", "coordinator_literal_sys")  # fmt: skip
"""The tables of the thesis as printed."""


def din8580(name):
    corpus = os.environ["SYSMLC_CORPUS"]
    path = Path(corpus) / "gr1" / "din8580" / f"{name}.json"
    return read_contract(path.read_text())


@pytest.mark.corpus
@pytest.mark.parametrize("name", GOOD)
def test_completed_contracts_of_din_8580_are_not_suspicious(name):
    assert find_lints(din8580(name)) == []


@pytest.mark.corpus
@pytest.mark.parametrize("name", LITERAL)
def test_literal_tables_of_the_thesis_have_lints_or_are_unrealizable(name):
    contract = din8580(name)
    is_realizable = solve(make_game(contract, Manager())).is_realizable
    assert find_lints(contract) or not is_realizable


@pytest.mark.corpus
def test_the_lints_of_the_literal_tables():
    codes = {name: {code for code, _ in find_lints(din8580(name))} for name in LITERAL}
    assert codes["turn_literal"] == {"SM536"}
    assert codes["turn_literal_live"] == {"SM536", "SM542"}
    assert codes["pick_literal"] == {"SM542"}
    assert codes["coordinator_literal"] == {"SM537"}
    assert codes["coordinator_literal_sys"] == {"SM541"}
