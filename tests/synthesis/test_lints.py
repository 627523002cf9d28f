"""What is suspicious in a contract: each rule, and the tables of the thesis read word for word."""

import os
from pathlib import Path

import pytest
from contracts_in_lines import contract

from sysmlc.diagnostics import Sink, Subject, catalogue
from sysmlc.logic.formats import read
from sysmlc.synthesis import Manager, make_game, rules, solve
from sysmlc.synthesis.lints import lint

CODES = ("SM533", "SM534", "SM535", "SM536", "SM537", "SM538", "SM539", "SM540", "SM541", "SM542")
RULES = [catalogue()[code] for code in CODES]


def found(made):
    sink = Sink()
    lint(made, lambda origin: Subject(origin), sink, Manager)
    return [(one.rule.code, one.message) for one in sink]


def read_one(text):
    sink = Sink()
    (made,) = read(text, "lamp", sink)
    assert list(sink) == []
    return made


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_rule_reports_its_wrong_contract_and_says_nothing_of_its_right_one(rule):
    assert rule.code in [code for code, _ in found(read_one(rule.read_page().wrong))]
    assert found(read_one(rule.read_page().right)) == []


def test_every_rule_is_there():
    codes = {value.code for name, value in vars(rules).items() if name.isupper() and name[0] != "_"}
    assert {code for code in codes if CODES[0] <= code <= CODES[-1]} == set(CODES)


@pytest.mark.parametrize("code", ["SM537", "SM539", "SM540"])
def test_what_is_wrong_with_a_conjunct_is_told_at_its_place(code):
    text, sink = catalogue()[code].read_page().wrong, Sink()
    lint(read_one(text), lambda origin: Subject(origin), sink, Manager)
    (told,) = [one for one in sink if one.rule.code == code]
    line, column = map(int, told.subject.name.split(":")[1:])
    formula = text.splitlines()[line - 1][column - 1 :].split('"')[0]
    assert f"'{formula}'" in told.message


def test_a_dead_end_is_shown_by_a_state():
    made = contract(
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
    assert ("SM534", message) in found(made)


@pytest.mark.parametrize("assumed", ["power", "power & (n=1 | n=2)"])
def test_what_is_assumed_of_inputs_at_all_times_is_no_dead_end(assumed):
    made = contract(
        f"""
        env power: bool
        env n: 0..3
        sys on: bool
        assume always {assumed}
        promise always on' <-> n'=1
        """
    )
    assert found(made) == []


def test_what_is_assumed_of_inputs_and_outputs_at_all_times_is_a_dead_end():
    made = contract(
        """
        env power: bool
        sys on: bool
        assume always on -> power
        promise always on' <-> !on
        """
    )
    assert [code for code, _ in found(made)] == ["SM534", "SM535"]


def test_a_choice_needs_no_frame_and_a_quantity_does():
    choice = contract("sys n: 0..3\npromise always n=3 -> n'=0")
    assert [code for code, _ in found(choice)] == ["SM536"]
    moved = contract("sys n: 0..3\npromise always n<3 -> n'=n+1\npromise always n=3 -> n'=0")
    assert found(moved) == []
    command = contract("sys say: stop go\npromise always say=go -> say'=stop")
    assert found(command) == []


def test_missing_fairness_names_what_would_help():
    made = contract("env go: bool\nsys on: bool\npromise always on' <-> go'\npromise recurs on")
    assert found(made) == [
        (
            "SM538",
            "'c' could satisfy its contract if its environment did not wait forever, for instance "
            "if 'go' recurred",
        )
    ]


def test_the_assumption_that_is_to_blame_for_force_is_named():
    made = contract(
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
    (text,) = [message for code, message in found(made) if code == "SM535"]
    assert text.endswith("not without 'go' <-> on', 'go'")


GOOD = ("turn", "move", "pick", "place", "compose", "decompose", "coordinator")
LITERAL = ("turn_literal", "turn_literal_live", "pick_literal", "place_literal_nogrip",
           "coordinator_literal", "coordinator_literal_sys")  # fmt: skip
"""The thesis's tables as they are printed."""


def din8580(name):
    corpus = os.environ.get("SYSMLC_CORPUS")
    if not corpus:
        pytest.skip("SYSMLC_CORPUS is not set")
    path = Path(corpus) / "gr1" / "din8580" / f"{name}.json"
    return read_one(path.read_text())


@pytest.mark.corpus
@pytest.mark.parametrize("name", GOOD)
def test_completed_contracts_of_din_8580_are_not_suspicious(name):
    assert found(din8580(name)) == []


@pytest.mark.corpus
@pytest.mark.parametrize("name", LITERAL)
def test_tables_of_the_thesis_read_literally_are_caught(name):
    made = din8580(name)
    is_kept = solve(make_game(made, Manager())).is_realizable
    assert found(made) or not is_kept


@pytest.mark.corpus
def test_why_the_tables_are_caught():
    codes = {name: {code for code, _ in found(din8580(name))} for name in LITERAL}
    assert codes["turn_literal"] == {"SM536"}
    assert codes["turn_literal_live"] == {"SM536", "SM542"}
    assert codes["pick_literal"] == {"SM542"}
    assert codes["coordinator_literal"] == {"SM537"}
    assert codes["coordinator_literal_sys"] == {"SM541"}
