"""``sysmlc contracts check``: a line for each contract, findings before, exit codes."""

import pytest

from sysmlc.driver import registry
from sysmlc.passes import pipeline
from sysmlc.synthesis import composition_check as together
from sysmlc.synthesis import contract_checks as check
from sysmlc.synthesis import rules


@pytest.fixture
def all_passes(monkeypatch):
    every = [pipeline.load(name) for name in pipeline.NAMES]
    monkeypatch.setattr(registry, "load_passes", lambda options: every)


def test_a_contract_that_is_well_is_one_line(here):
    here.write("lamp.gr1.json", rules.NO_FAIRNESS.read_page().right)
    made = here.sysmlc("contracts", "check", "lamp.gr1.json")
    assert [made.exit_code, made.stdout] == [0, "lamp: realizable\n"]


def test_suspicious_contracts_are_told_and_are_no_error(here):
    here.write("lamp.gr1.json", rules.IDLE.read_page().wrong)
    made = here.sysmlc("contracts", "check", "lamp.gr1.json")
    assert made.exit_code == 0
    assert "warning[SM541 vacuous-win]: 'lamp' satisfies its contract without ever" in made.stderr


def test_an_unrealizable_contract_is_an_error(here):
    here.write("lamp.gr1.json", rules.NO_FAIRNESS.read_page().wrong)
    made = here.sysmlc("contracts", "check", "lamp.gr1.json")
    assert [made.exit_code, made.stdout] == [1, "lamp: unrealizable\n"]
    assert "for instance if 'go' recurred" in made.stderr


def test_a_behaviour_that_breaks_a_requirement(here, all_passes):
    here.write("lamp.ir", check.BREAKS.read_page().wrong)
    made = here.sysmlc("contracts", "check", "lamp.ir")
    assert made.exit_code == 1
    assert "Plant::Gate: realizable, violates its requirements\n" in made.stdout
    assert "error[SM560 behaviour-breaks-requirement]" in made.stderr
    assert "step 2: event=stop, state=B" in made.stderr


def test_only_one_component(here, all_passes):
    here.write("lamp.ir", check.BREAKS.read_page().right)
    made = here.sysmlc("contracts", "check", "lamp.ir", "-c", "Plant::Gate.requirements")
    assert made.stdout == "Plant::Gate.requirements: realizable\n"
    made = here.sysmlc("contracts", "check", "lamp.ir", "-c", "Plant::Gat")
    assert [made.exit_code, made.stdout] == [2, ""]


def test_a_component_alone_is_compared_with_its_requirements_too(here, all_passes):
    here.write("lamp.ir", check.BREAKS.read_page().wrong)
    made = here.sysmlc("contracts", "check", "lamp.ir", "-c", "Plant::Gate")
    assert [made.exit_code, made.stdout] == [
        1,
        "Plant::Gate: realizable, violates its requirements\n",
    ]


def test_parts_of_a_block_are_put_together_and_runs_are_drawn(here, all_passes):
    here.write("cell.sysml", together.OPEN.read_page().wrong)
    made = here.sysmlc("contracts", "check", "cell.sysml", "-c", "Line::Cell", "-o", "out")
    assert made.exit_code == 1
    assert made.stdout == (
        "Line::Cell: realizable\nLine::Cell: its 2 parts together violate its contract\n"
    )
    assert "error[SM595 part-assumption-open]: part 'picker' of 'Line::Cell'" in made.stderr
    assert here.files("out") == ["Line.Cell.run1.puml", "Line.Cell.run2.puml"]


def test_a_model_that_is_wrong_says_why_it_has_no_contracts(here, all_passes):
    here.write(
        "cell.sysml",
        together.OPEN.read_page().wrong.replace("import ScalarValues::*", "import Units"),
    )
    made = here.sysmlc("contracts", "check", "cell.sysml")
    assert made.exit_code == 2
    assert "SM205 unresolved-name" in made.stderr
