"""Uses of behaviours bind steps to actions and parameters to features of the plant."""

import pytest
from reading_v2 import read

from sysmlc.ir import Edge

LINE = """
package P {
    private import RecipeLevels::*;
    part def Robot :> Machine { attribute busy : ScalarValues::Boolean; action place : Place; }
    part def Cell { part robot : Robot; action place : Place; }
    action def Place :> MachineService { in ref robot : Robot; }
    action def Assemble :> Task {
        in ref arm : Robot;
        action put : Place { in ref :>> robot = arm; }
    }
    action def Make :> Recipe {
        in ref arm : Robot;
        action build : Assemble { in ref :>> arm = Make::arm; }
    }
    state def Watch { in ref arm : Robot; inout busy : ScalarValues::Boolean; state on; }
    part def Line {
        part cell : Cell;
        part spare : Robot;
        perform action make : Make {
            in ref :>> arm = cell.robot;
            action :>> build { action :>> put references cell.place; }
        }
        exhibit state watch : Watch {
            in ref :>> arm = spare;
            inout :>> busy = %s;
        }
    }
}
"""


def allocations(reading):
    """Yield client, path and supplier of each allocation of the line."""
    graph = reading.graph
    for one in graph.owned(reading.find_element("P::Line")):
        if one.role == "allocate":
            client, supplier = graph.target(one, Edge.CLIENT), graph.target(one, Edge.SUPPLIER)
            ids = one.attrs.get("target_path")
            path = None if ids is None else [graph[id].name for id in ids]
            yield graph.qualified_name(client), path, graph.qualified_name(supplier)


def test_parameters_and_steps_are_allocated_with_the_way_from_the_block():
    assert list(allocations(read(LINE % "spare.busy"))) == [
        ("P::Make::arm", ["cell"], "P::Cell::robot"),
        ("P::Assemble::put", ["cell"], "P::Cell::place"),
        ("P::Watch::arm", None, "P::Line::spare"),
        ("P::Watch::busy", ["spare"], "P::Robot::busy"),
    ]


@pytest.mark.parametrize("value", ["true", "not spare.busy"])
def test_an_argument_that_is_no_feature_is_reported(value):
    reading = read(LINE % value)
    assert len(list(allocations(reading))) == 3
    assert "SM481" in reading.list_codes()


def test_a_value_for_a_performed_step_is_reported():
    text = LINE.replace(
        "in ref robot : Robot;", "in ref robot : Robot; in n : ScalarValues::Integer;"
    )
    with_value = text.replace("references cell.place;", "references cell.place { in :>> n = 5; }")
    assert "SM481" not in read(text % "spare.busy").list_codes()
    assert "SM481" in read(with_value % "spare.busy").list_codes()
