"""Text of SysML v2 that is read, written and read again is the same model."""

import pytest
from reading_v2 import Reading
from test_v2_roundtrip import PASSES, list_differences

from sysmlc.backends.sysml import print_document
from sysmlc.diagnostics import Sink


def write_lines(text):
    """Return the lines that the back end writes for a text, without indentation."""
    written, _ = print_document(Reading(text, passes=PASSES).graph, Sink())
    return [line.strip() for line in written.splitlines() if line.strip()]


MEMBERS = """
package P {
    part def Robot { attribute speed; part arm : Arm; port p : Plug; }
    part def Arm;
    item def Box;
    port def Plug { out item x : Box; }
    part def Cell {
        part robot : Robot {
            attribute extra : ScalarValues::Integer;
            part :>> arm { attribute more : ScalarValues::Boolean; }
        }
        part plain { part inner { attribute deep : ScalarValues::Integer; } }
        port own { in item y : Box; }
        port wide : Plug { attribute width : ScalarValues::Real; }
        attribute pair { attribute a : ScalarValues::Integer; }
        ref part other : Robot { attribute mark : ScalarValues::Integer; }
        variation part choice : Robot { variant part fast : Robot; }
        interface robot.p to wide;
        assert constraint { plain.inner.deep > 2 and pair.a < 3 }
    }
    part def Sub :> Cell { part :>> robot { attribute even : ScalarValues::Integer; } }
}
"""


def test_members_of_usages_stay_in_them():
    lines = write_lines(MEMBERS)
    assert lines.count("part :>> robot {") == lines.count("part robot : Robot {") == 1
    assert not any(line.startswith("part def R") for line in lines[8:])
    assert list_differences(Reading(MEMBERS, passes=PASSES).graph) == []


LOOP = """
package P {
    part def Pallet { attribute n : ScalarValues::Integer; }
    part def Belt { part pallets : Pallet[10]; }
    action def Find {
        in ref item belt : Belt;
        out attribute found : ScalarValues::Integer;
        first start then each;
        action each for p in belt.pallets {
            action look { in attribute n : ScalarValues::Integer = p.n; }
            then take;
            action take assign found := p.n;
        }
        then done;
    }
}
"""


def test_a_loop_over_a_collection_is_read_back():
    assert "action each for p in belt.pallets {" in write_lines(LOOP)
    assert list_differences(Reading(LOOP, passes=PASSES).graph) == []


def test_a_loop_over_a_collection_in_prose_keeps_its_text():
    reading = Reading(LOOP, passes=PASSES)
    (region,) = [element for element in reading.graph if element.subkind == "expansion"]
    reading.graph.set(region, collection="the pallets of the belt")
    written, _ = print_document(reading.graph, Sink())
    assert "for p in" not in written
    assert '"collection=the pallets of the belt"' in written
    assert list_differences(reading.graph) == []


JOINED = """
package P {
    part def Pilot;
    use case def Fly { actor pilot : Pilot; }
    part def Gate;
    part def Road { part Gate : P::Gate[*]; }
    connection def Way { end Gate : P::Gate; end road : Road; }
    action def Sort {
        attribute big : ScalarValues::Boolean;
        first start then choose;
        decide choose;
            if big then store;
            else look;
        action look; then store;
        action store; then done;
    }
}
"""


def test_actors_ends_and_steps_with_several_predecessors_are_read_back():
    lines = write_lines(JOINED)
    assert "actor pilot : Pilot;" in lines
    assert not any(line.startswith("merge") for line in lines)
    assert list_differences(Reading(JOINED, passes=PASSES).graph) == []


SHIPPED = """
package P {
    private import DIN8580::*;
    part def Robot { action pick : Pick; }
}
"""


def test_elements_of_shipped_libraries_are_referred_to_and_not_written():
    lines = write_lines(SHIPPED)
    assert "action pick : DIN8580::Pick {" in lines
    assert [line for line in lines if line.startswith("package")] == ["package P {"]
    assert list_differences(Reading(SHIPPED, passes=PASSES).graph) == []


@pytest.mark.parametrize("text", [MEMBERS, LOOP, JOINED, SHIPPED])
def test_the_written_text_has_no_errors(text):
    written, _ = print_document(Reading(text, passes=PASSES).graph, Sink())
    again = Reading(written, passes=PASSES)
    assert [diagnostic.message for diagnostic in again.sink if diagnostic.is_error] == []
