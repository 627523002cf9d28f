"""Runs as text that shows changes, and as sequence diagrams for PlantUML."""

import pytest
from contracts_in_lines import parse_contract

from sysmlc.logic.contract import BooleanDomain, Class, Conjunct
from sysmlc.logic.infix import parse_formula
from sysmlc.synthesis.algebra.fair_systems import Trace
from sysmlc.synthesis.witnesses import Party, Witness, describe_run, witness_diagram, witness_files

FEEDER = parse_contract("env power: bool\nsys ready: bool")
PICKER = parse_contract("env ready: bool\nsys arm: 0..3")
RUN = Trace(
    (
        {"power": True, "ready": False, "arm": 0},
        {"power": True, "ready": True, "arm": 1},
        {"power": True, "ready": True, "arm": 1},
    ),
    1,
)
BROKEN = Conjunct(parse_formula("!ready", {"ready": BooleanDomain()}), Class.LIVENESS, "")
WITNESS = Witness("Line::Cell", BROKEN, RUN, (Party("feeder", FEEDER), Party("picker", PICKER)))


def test_a_run_shows_only_changes_and_where_the_loop_begins():
    assert list(describe_run(RUN)) == [
        "step 1: power=true, ready=false, arm=0",
        "step 2: ready=true, arm=1",
        "step 3: nothing changes",
        "then again from step 2",
    ]


def test_constant_values_are_shown_only_if_the_conjunct_refers_to_them():
    assert next(describe_run(RUN, BROKEN)) == "step 1: ready=false, arm=0"
    about = Conjunct(parse_formula("power", {"power": BooleanDomain()}), Class.LIVENESS, "")
    assert next(describe_run(RUN, about)) == "step 1: power=true, ready=false, arm=0"


def test_auxiliary_variables_are_omitted_unless_the_conjunct_names_them():
    steps = ({"ready": False, "was_1": False}, {"ready": False, "was_1": True})
    run = Trace(steps, 0, frozenset({"was_1"}))
    assert list(describe_run(run))[:2] == [
        "step 1: ready=false",
        "step 2: only auxiliary variables change",
    ]
    about = Conjunct(parse_formula("was_1", {"was_1": BooleanDomain()}), Class.LIVENESS, "")
    assert list(describe_run(run, about))[:2] == ["step 1: was_1=false", "step 2: was_1=true"]


def test_a_long_run_is_cut():
    lines = list(describe_run(Trace(tuple({"n": number} for number in range(30)), 0)))
    assert lines[-2:] == ["and 18 more steps", "then again from step 1"]
    assert len(lines) == 14


def test_inputs_are_messages_and_other_values_are_notes():
    assert witness_diagram(WITNESS).splitlines() == [
        "@startuml",
        "title Line::Cell\\nnot kept: G F (!ready)",
        "hide footbox",
        "participant environment as p0",
        'participant "feeder" as p1',
        'participant "picker" as p2',
        "== step 1 ==",
        "p1 -> p2 : ready=false",
        "hnote over p2 : arm=0",
        "group again and again",
        "== step 2 ==",
        "p1 -> p2 : ready=true",
        "hnote over p2 : arm=1",
        "== step 3 ==",
        "end",
        "@enduml",
    ]


def test_the_runs_of_a_component_are_numbered():
    other = Witness("Line::Belt", BROKEN, RUN, WITNESS.parties)
    assert [name for name, _ in witness_files([WITNESS, other, WITNESS])] == [
        "Line.Cell.run1.puml",
        "Line.Cell.run2.puml",
        "Line.Belt.run1.puml",
    ]


@pytest.mark.plantuml
def test_plantuml_draws_runs(plantuml):
    picture = plantuml.render({"run": witness_diagram(WITNESS)})["run"]
    assert all(name in picture for name in (b"environment", b"feeder", b"picker", b"arm=1"))
