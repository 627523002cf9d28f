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
            "SM416: effect 'heat := heat + 1.5' is not understood: 'heat' has no finite type; the "
            "contract shows it as output 'heat_heat_1_5'",
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


GATES = """
package Plant {
    private import ScalarValues::*;
    attribute def Open;
    part def Hall {
        attribute free : Boolean;
        part gate {
            OWN
            exhibit state behaviour {
                entry; then closed;
                state closed;
                transition first closed accept Open if free do assign free := false then open;
                state open;
            }
        }
    }
}
"""


@pytest.mark.parametrize("own", ["", "attribute free : Boolean;"])
def test_a_property_of_the_surrounding_part_may_be_read_and_assigned(own):
    assert list_messages(GATES.replace("OWN", own), "contracts") == []


def test_a_property_of_another_part_is_not_one_of_the_surrounding_part():
    text = GATES.replace("OWN", "").replace(
        "attribute free : Boolean;", "part door { attribute free : Boolean; }"
    )
    assert list_messages(text, "contracts") != []


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
        "SM427: 'calm to halted' leaves a parallel state while 'turning to slow' or 'slow to "
        "turning' can be taken in another of its states; the component gets no contract"
    ]


# -- words of SysML v2 -------------------------------------------------------------------------


PORTS = """
package Plant {
    port def Plug;
    port def Pipe { out attribute amount; }
    part def Pump { port plug : Plug; port pipe : Pipe; }
    part pump : Pump { port redefines plug; }
}
"""


def test_a_port_that_redefines_an_undirected_one_is_reported_there_only():
    assert list_messages(PORTS) == ["SM300: ports of 'Plant::Pump' without a direction (1): 'plug'"]
    (diagnostic,) = read(PORTS, passes=PASSES).sink
    assert diagnostic.help == "say what flows through the ports, such as 'in item part : Part;'"


STARTS = """
action def Pack {
    action close;
    action label;
    first close then done;
    STEP
}
"""


@pytest.mark.parametrize(
    ("step", "messages"),
    [
        (
            "first label then done;",
            ["SM451: action 'Pack' starts with several actions at once: action 'close', "
             "action 'label'"],
        ),
        ("first label then close;", []),
    ],
)  # fmt: skip
def test_only_several_actions_without_predecessor_are_reported(step, messages):
    assert list_messages(STARTS.replace("STEP", step)) == messages


DECISION = """
action def Charge {
    attribute charge : ScalarValues::Real;
    first start;
    then decide;
        if charge < 100.5 then fill;
        if charge >= 100.5 then stop;
    action fill;
    action stop;
}
"""


def test_branches_are_not_compared_where_a_guard_is_not_understood():
    text = DECISION.replace("if charge", "if charge * charge")
    codes = [message.partition(":")[0] for message in list_messages(text)]
    assert codes == ["SM458", "SM458"]


def test_branches_that_both_lack_a_guard_are_compared():
    text = DECISION.replace("if charge < 100.5 then fill", "if fast then fill")
    text = text.replace("if charge >= 100.5 then stop", "if slow then stop")
    text = text.replace(
        "charge : ScalarValues::Real",
        "fast : ScalarValues::Boolean; attribute slow : ScalarValues::Boolean",
    )
    codes = [message.partition(":")[0] for message in list_messages(text)]
    assert codes == ["SM456", "SM457"]


FLOW = """
package Plant {
    item def Job;
    port def Orders { in ref job : Job; }
    part def Cell {
        port orders : Orders;
        FLOW
        perform action work {
            action pack { in ref job : Job[1]; }
        }
    }
}
"""


@pytest.mark.parametrize(
    ("flow", "messages"),
    [
        ("flow from orders.job to work.pack.job;", []),
        ("", ["SM464: parameter 'job' of action 'pack' gets no value; it is taken as available"]),
    ],
)
def test_a_flow_of_the_part_fills_a_parameter_of_its_action(flow, messages):
    assert list_messages(FLOW.replace("FLOW", flow)) == messages


def test_a_flow_from_a_port_to_another_part_runs_against_the_direction_of_the_port():
    text = FLOW.replace("FLOW", "").replace("in ref job : Job[1]", "in ref job : Job")
    text = text.replace(
        "part def Cell {", "part cell : Cell; part lab : Cell;\n"
        "    flow from cell.orders.job to lab.orders.job;\n    part def Cell {"
    )  # fmt: skip
    assert "SM310" in {message.partition(":")[0] for message in list_messages(text)}


def test_a_state_without_entry_transition_is_reported_in_the_words_of_the_language():
    text = "part def Lamp { exhibit state light { state dim; } }"
    assert list_messages(text, "contracts") == [
        "SM421: state 'light' has substates, but no entry transition to the first of them"
    ]


@pytest.mark.parametrize(
    ("member", "codes"),
    [
        ("stray", ["SM195"]),
        ("part x : state;", ["SM192"]),
        ("import state::*;", ["SM192", "SM197"]),
        ("transition first a then a; part a;", ["SM195"]),
        ("render a; rendering a;", ["SM195", "SM480"]),
        ("verify a; requirement a;", ["SM195"]),
        ("part x : Missing;", ["SM205"]),
        ("stray + missing", ["SM195", "SM205"]),
    ],
)
def test_a_word_in_a_wrong_place_is_one_finding(member, codes):
    messages = list_messages(f"package P {{ part p {{ {member} }} }}")
    assert sorted(message.partition(":")[0] for message in messages) == codes
