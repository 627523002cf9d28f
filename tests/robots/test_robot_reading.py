"""Floors of models: what specialises the library is a study, what is wrong with it is told."""

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.logic.contract import Contract
from sysmlc.robots.study import Order, Study

HALL = """
package Plant {
    private import Floors::*;
    part def Hall :> Floor {
        constant attribute :>> columns = 4;
        part r1 : Robot { :>> row = 1; :>> column = 2; }
        part spare : Robot[2];
        part pillar : Obstacle { :>> row = 0; :>> column = 1; }
        part work : Mission {
            constant attribute :>> deadline = 30;
            part shelf : Target { :>> row = 0; :>> column = 3; }
            part dock : Target { :>> row = 2; :>> column = 0; :>> deadline = 12; }
            connection : Carry connect shelf to dock;
        }
    }
}
"""


def compiled(tmp_path, text):
    path = tmp_path / "plant.sysml"
    path.write_text(text, encoding="utf-8")
    return compile_model(Request((path,)))


def study_of(tmp_path, text=HALL):
    made = compiled(tmp_path, text)
    assert [one.rule.code for one in made.diagnostics] == []
    (study,) = made.graph.derived(Study)
    return study


def test_a_floor_with_robots_obstacles_and_a_mission_is_a_study(tmp_path):
    study = study_of(tmp_path)
    assert study.component == "Plant::Hall"
    assert (study.grid.columns, study.grid.rows, study.grid.blocked) == (4, 3, (1,))
    robots = [(one.word, one.start) for one in study.robots]
    assert robots == [("r1", 6), ("spare", None), ("spare_2", None)]
    assert [(one.name, one.cell, one.deadline) for one in study.targets] == [
        ("shelf", 3, None),
        ("dock", 8, 12),
    ]
    order = study.orders[0]
    assert order == Order(0, 1, is_carried=True, origin=order.origin)
    assert study.deadline == 30


def test_its_contracts_are_among_those_of_the_model(tmp_path):
    made = compiled(tmp_path, HALL)
    assert [one.component for one in made.graph.derived(Contract)] == [
        "Plant::Hall",
        "Plant::Hall.environment",
        "Plant::Hall.mission",
        "Plant::Hall.r1",
        "Plant::Hall.r1.shared",
        "Plant::Hall.spare",
        "Plant::Hall.spare.shared",
        "Plant::Hall.spare_2",
        "Plant::Hall.spare_2.shared",
    ]


def test_the_pass_run_again_changes_nothing(tmp_path):
    from sysmlc.passes.robots import Robots

    graph = compiled(tmp_path, HALL).graph
    before = graph.derived(Contract)
    Robots().run(graph, Sink())
    assert graph.derived(Contract) == before


WRONG = {
    "SM564": ("row = 1; :>> column = 2", "row = 1; :>> column = 4", "r1"),
    "SM565": ("row = 1; :>> column = 2", "row = 0; :>> column = 1", "r1"),
    "SM566": (":>> row = 0; :>> column = 1;", ":>> row = 0;", "pillar"),
    "SM567": (
        "connection : Carry connect shelf to dock;",
        "connection : Before connect shelf to dock; connection : Before connect dock to shelf;",
        "shelf",
    ),
}


@pytest.mark.parametrize("code", WRONG)
def test_what_is_wrong_is_told_at_its_element(code, tmp_path):
    old, new, name = WRONG[code]
    made = compiled(tmp_path, HALL.replace(old, new))
    (found,) = made.diagnostics
    assert (found.rule.code, found.subject.name.rpartition("::")[2]) == (code, name)
    assert made.graph.derived(Study) == ()


def test_a_negative_row_and_a_text_are_no_numbers(tmp_path):
    for value, problem in (("-1", "is negative"), ("1.5", "is not a whole number")):
        made = compiled(tmp_path, HALL.replace(":>> row = 1", f":>> row = {value}"))
        (found,) = (one for one in made.diagnostics if one.rule.code == "SM566")
        assert problem in found.message


def test_a_target_behind_obstacles_is_out_of_reach(tmp_path):
    wall = " ".join(
        f"part o{at} : Obstacle {{ :>> row = {at}; :>> column = 1; }}" for at in range(1, 3)
    )
    text = HALL.replace("part spare : Robot[2];", wall)
    made = compiled(tmp_path, text)
    (found,) = made.diagnostics
    assert (found.rule.code, found.subject.name) == ("SM569", "Plant::Hall::work::dock")


def test_a_second_floor_of_one_name_is_told_and_not_studied(tmp_path):
    """A mutant of a model wrote the contracts of both into one file."""
    made = compiled(tmp_path, HALL + HALL)
    twice = [one for one in made.diagnostics if one.rule.code == "SM577"]
    assert [one.subject.name for one in twice] == ["Plant::Hall"]
    assert "SM900" not in {one.rule.code for one in made.diagnostics}
    assert len(made.graph.derived(Study)) == 1
    other = compiled(tmp_path, HALL + HALL.replace("package Plant", "package Store"))
    assert "SM577" not in {one.rule.code for one in other.diagnostics}
    assert len(other.graph.derived(Study)) == 2


@pytest.mark.parametrize("count", ["200", "99999999999999999999"])
def test_more_robots_than_contracts_can_list_are_refused(count, tmp_path):
    """A mutant of a model with the second number had no end."""
    made = compiled(tmp_path, HALL.replace("spare : Robot[2]", f"spare : Robot[{count}]"))
    (found,) = made.diagnostics
    assert found.rule.code == "SM566"
    assert "too many robots, more than 28 on 12 cells" in found.message
