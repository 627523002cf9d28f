"""Floors in models: a block that specialises ``Floor`` is read as a study, or reported."""

import pytest

from sysmlc.analyses.robots import Robots
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


def compile_text(tmp_path, text):
    path = tmp_path / "plant.sysml"
    path.write_text(text, encoding="utf-8")
    return compile_model(Request((path,)))


def read_study(tmp_path, text=HALL):
    result = compile_text(tmp_path, text)
    assert [diagnostic.rule.code for diagnostic in result.diagnostics] == []
    (study,) = result.graph.derived(Study)
    return study


def test_a_floor_with_robots_obstacles_and_a_mission_is_a_study(tmp_path):
    study = read_study(tmp_path)
    assert study.component == "Plant::Hall"
    assert (study.grid.columns, study.grid.rows, study.grid.blocked) == (4, 3, (1,))
    robots = [(robot.word, robot.start) for robot in study.robots]
    assert robots == [("r1", 6), ("spare", None), ("spare_2", None)]
    assert [(target.name, target.cell, target.deadline) for target in study.targets] == [
        ("shelf", 3, None),
        ("dock", 8, 12),
    ]
    order = study.orders[0]
    assert order == Order(0, 1, is_carried=True, origin=order.origin)
    assert study.deadline == 30


def test_the_contracts_of_a_floor_are_contracts_of_the_model(tmp_path):
    result = compile_text(tmp_path, HALL)
    assert [contract.component for contract in result.graph.derived(Contract)] == [
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


def test_a_second_run_of_the_pass_changes_nothing(tmp_path):
    graph = compile_text(tmp_path, HALL).graph
    before = graph.derived(Contract)
    Robots().run(graph, Sink())
    assert graph.derived(Contract) == before


FAULTS = {
    "SM564": ("row = 1; :>> column = 2", "row = 1; :>> column = 4", "r1"),
    "SM565": ("row = 1; :>> column = 2", "row = 0; :>> column = 1", "r1"),
    "SM566": (":>> row = 0; :>> column = 1;", ":>> row = 0;", "pillar"),
    "SM567": (
        "connection : Carry connect shelf to dock;",
        "connection : Before connect shelf to dock; connection : Before connect dock to shelf;",
        "shelf",
    ),
}


@pytest.mark.parametrize("code", FAULTS)
def test_a_fault_is_reported_at_its_element(code, tmp_path):
    old, new, name = FAULTS[code]
    result = compile_text(tmp_path, HALL.replace(old, new))
    (diagnostic,) = result.diagnostics
    assert (diagnostic.rule.code, diagnostic.subject.name.rpartition("::")[2]) == (code, name)
    assert result.graph.derived(Study) == ()


@pytest.mark.parametrize(
    ("orders", "circle"),
    [
        (("shelf to dock", "dock to shelf"), "'shelf' before 'dock' before 'shelf'"),
        (
            ("shelf to dock", "dock to gate", "gate to shelf"),
            "'shelf' before 'dock' before 'gate' before 'shelf'",
        ),
    ],
)
def test_all_targets_of_a_circle_of_orders_are_named(orders, circle, tmp_path):
    gate = "part gate : Target { :>> row = 2; :>> column = 3; }"
    text = gate + "".join(f" connection : Before connect {order};" for order in orders)
    old = "connection : Carry connect shelf to dock;"
    (diagnostic,) = compile_text(tmp_path, HALL.replace(old, text)).diagnostics
    assert diagnostic.rule.code == "SM567"
    assert circle in diagnostic.message


def test_a_row_must_be_a_whole_number(tmp_path):
    for value, problem in (("-1", "is negative"), ("1.5", "is not a whole number")):
        result = compile_text(tmp_path, HALL.replace(":>> row = 1", f":>> row = {value}"))
        (diagnostic,) = (
            diagnostic for diagnostic in result.diagnostics if diagnostic.rule.code == "SM566"
        )
        assert problem in diagnostic.message


def test_a_target_behind_obstacles_is_reported(tmp_path):
    wall = " ".join(
        f"part o{row} : Obstacle {{ :>> row = {row}; :>> column = 1; }}" for row in range(1, 3)
    )
    text = HALL.replace("part spare : Robot[2];", wall)
    result = compile_text(tmp_path, text)
    (diagnostic,) = result.diagnostics
    assert (diagnostic.rule.code, diagnostic.subject.name) == ("SM569", "Plant::Hall::work::dock")


def test_a_second_floor_of_the_same_name_is_reported_and_skipped(tmp_path):
    """Otherwise the contracts of both floors would be written to one file."""
    result = compile_text(tmp_path, HALL + HALL)
    duplicates = [
        diagnostic for diagnostic in result.diagnostics if diagnostic.rule.code == "SM577"
    ]
    assert [diagnostic.subject.name for diagnostic in duplicates] == ["Plant::Hall"]
    assert "SM900" not in {diagnostic.rule.code for diagnostic in result.diagnostics}
    assert len(result.graph.derived(Study)) == 1
    renamed = compile_text(tmp_path, HALL + HALL.replace("package Plant", "package Store"))
    assert "SM577" not in {diagnostic.rule.code for diagnostic in renamed.diagnostics}
    assert len(renamed.graph.derived(Study)) == 2


@pytest.mark.parametrize("count", ["200", "99999999999999999999"])
def test_too_many_robots_are_refused(count, tmp_path):
    """With the second number, an earlier version did not terminate."""
    result = compile_text(tmp_path, HALL.replace("spare : Robot[2]", f"spare : Robot[{count}]"))
    (diagnostic,) = result.diagnostics
    assert diagnostic.rule.code == "SM566"
    assert "too many robots, more than 28 on 12 cells" in diagnostic.message
