"""Each fact about a model is reported once, by the rule that knows the reason."""

import pytest
from reading_v2 import read

PASSES = ("resolve", "inherit", "classify", "ports", "flows", "behaviours", "activities")
MACHINE = """
package Plant {
    private import ScalarValues::*;
    attribute def Start;
    part def Gate {
        constant attribute fixed : Integer default = 3;
        attribute heat : Real;
        attribute level : Integer default = 0;
        assert constraint { 0 <= level and level <= 9 }
        attribute cooling;
        exhibit state behaviour {
            entry; then closed;
            state closed;
            transition first closed TRIGGER do EFFECT then open;
            state open;
        }
    }
}
"""


def list_messages(text, *passes):
    sink = read(text, passes=(*PASSES, *passes)).sink
    return [f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in sink]


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        (
            "assign heat := heat + 1.5",
            "SM415: 'heat := heat + 1.5' assigns to 'heat', which has no finite type; the contract "
            "shows the assignment as output 'heat_heat_1_5'",
        ),
        (
            "assign fixed := 4",
            "SM415: 'fixed := 4' assigns to 'fixed', which is constant; the contract shows the "
            "assignment as output 'fixed_4'",
        ),
        ("assign level := 12", "SM414: effect 'level := 12': 12 is outside 0..9"),
        (
            'action { language "English" /* open the gate */ }',
            "SM416: effect 'open the gate' is not understood: it is not an assignment, call or "
            "send; the contract shows it as output 'open_the_gate'",
        ),
    ],
)
def test_an_effect_without_formula_has_one_finding_with_the_reason(effect, message):
    text = MACHINE.replace("TRIGGER", "accept Start").replace("EFFECT", effect)
    assert list_messages(text, "contracts") == [message]


def test_an_assignment_with_a_formula_has_no_finding():
    text = MACHINE.replace("TRIGGER", "accept Start").replace("EFFECT", "assign level := 4")
    assert list_messages(text, "contracts") == []


@pytest.mark.parametrize(
    ("trigger", "reason"),
    [
        ("accept after cooling", "time 'cooling' is not a number"),
        ("accept at cooling", "time 'cooling' is absolute"),
    ],
)
def test_a_time_that_cannot_be_counted_has_its_reason(trigger, reason):
    text = MACHINE.replace("TRIGGER", trigger).replace("EFFECT", "assign level := 4")
    assert list_messages(text, "contracts") == [
        f"SM417: {reason}; the contract treats the event as the input 'time_cooling'"
    ]


CROSSING = """
package Plant {
    attribute def Stop;
    attribute def Spill;
    part def Press {
        exhibit state behaviour {
            entry; then working;
            state working parallel {
                state watching {
                    entry; then calm;
                    state calm;
                    transition tripped first calm accept when WHEN then halted;
                }
                state cutting {
                    entry; then turning;
                    state turning;
                    transition turn first turning accept Stop then slow;
                    state slow;
                    transition slowDown first slow accept Spill then turning;
                }
            }
            state halted;
        }
        attribute hot : ScalarValues::Boolean;
    }
}
"""


def test_an_exit_that_competes_with_several_transitions_has_one_finding():
    assert list_messages(CROSSING.replace("WHEN", "hot"), "contracts") == [
        "SM427: 'calm to halted' leaves an orthogonal state while 'turning to slow' or 'slow to "
        "turning' can be taken in another of its regions; the component gets no contract"
    ]
