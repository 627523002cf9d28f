"""Actions and states of SysML v2 in the graph."""

from reading_v2 import read


def test_steps_in_the_order_of_their_successions():
    reading = read("""
package P {
    action def Pick;
    action def Build {
        first start;
        then action pick : Pick;
        then decide;
            if count < 3 then pick;
            else place;
        action place;
        then done;
        attribute count : ScalarValues::Integer = 0;
    }
}""")
    assert reading.list_flows("P::Build") == [
        "start -> merge",
        "pick -> decision",
        "decision -> merge [count < 3]",
        "decision -> place [else]",
        "place -> done",
        "merge -> pick",
    ]
    assert reading.list_targets("P::Build::pick", "calls") == ["P::Pick"]
    assert reading.find_element("P::Build::pick").subkind == "call-behavior"
    assert reading.find_element("P::Build::place").subkind == "opaque"


FORKED = """
package P {
    action def A {
        first start; then fork f;
            then x;
            then y;
        action x; then j;
        action y; %s
        join j; then done;
    }
}"""


def test_the_end_behind_the_join_of_all_branches_is_the_end_of_the_activity():
    reading = read(FORKED % "then j;")
    assert reading.list_flows("P::A") == [
        "start -> f",
        "f -> x",
        "f -> y",
        "x -> j",
        "y -> j",
        "j -> done",
    ]
    assert reading.find_element("P::A::done").subkind == "final"


def test_the_end_beside_a_branch_that_goes_on_ends_only_its_own_flow():
    assert read(FORKED % "").find_element("P::A::done").subkind == "flow-final"


def test_calls_of_operations_with_pins():
    reading = read("""
package P {
    part def Robot { action move { in attribute to : ScalarValues::Integer; } }
    part def Cell {
        part robot : Robot;
        action work {
            first start;
            then perform action go ::> robot.move { in attribute :>> to = 3; }
            then done;
        }
    }
}""")
    assert reading.list_owned("P::Robot") == ["Operation move"]
    assert reading.list_owned("P::Cell") == ["Property robot", "Activity work"]
    go = reading.find_element("P::Cell::work::go")
    assert (go.subkind, reading.list_targets("P::Cell::work::go", "calls")) == (
        "call-operation",
        ["P::Robot::move"],
    )
    pin = reading.find_element("P::Cell::work::go::to")
    assert (pin.subkind, pin.attrs["value"]) == ("argument", 3)


def test_flows_and_bindings_between_pins_and_parameters():
    reading = read("""
package P {
    action def Build {
        in item raw; out item made;
        action cut { in item raw; out item piece; }
        action glue { in item piece; out item whole; }
        bind cut.raw = raw;
        flow from cut.piece to glue.piece;
        bind made = glue.whole;
    }
}""")
    assert reading.list_flows("P::Build") == ["raw -> raw", "piece -> piece", "whole -> made"]
    kinds = [line.split()[0] for line in reading.list_owned("P::Build")]
    assert kinds.count("ActivityParameter") == 2


def test_assignments_sendings_and_acceptings():
    reading = read("""
package P {
    item def Go;
    part def A {
        port p;
        attribute x : ScalarValues::Integer;
        action run {
            first start;
            then action set assign x := x + 1;
            then action say send new Go() via p;
            then action wait accept Go via p;
            then action sleep accept after 5 [SI::s];
            then done;
        }
    }
}""")
    run = "P::A::run::"
    assert reading.find_element(f"{run}set").attrs["body"] == "x := x + 1"
    assert reading.list_targets(f"{run}say", "calls") == ["P::Go"]
    assert reading.find_element(f"{run}say").attrs["on_port"] == reading.find_element("P::A::p").id
    wait = reading.find_element(f"{run}wait::<Trigger>")
    assert (wait.subkind, wait.attrs["port"]) == ("signal", reading.find_element("P::A::p").id)
    sleep = reading.find_element(f"{run}sleep::<Trigger>").attrs
    assert (sleep["subkind"], sleep["when"], sleep["relative"]) == ("time", "5 s", True)
    assert str(reading.find_element("P::Go").kind) == "Signal"


def test_the_start_and_the_end_of_a_block_are_its_own():
    reading = read("""
package P {
    part def R {
        attribute x : ScalarValues::Boolean;
        perform action w {
            first start;
            then while x { first start; then action a; then done; }
            then action b;
            then done;
        }
    }
}""")
    assert reading.list_flows("P::R::w") == [
        "merge -> decision",
        "decision -> merge [else]",
        "merge -> a",
        "a -> merge",
        "decision -> merge [x]",
        "merge -> merge",
        "start -> merge",
        "merge -> b",
        "b -> done",
    ]


def test_a_block_without_steps_leads_from_its_start_to_its_end():
    reading = read("""
package P {
    part def R {
        attribute x : ScalarValues::Boolean;
        perform action w {
            first start;
            then if x { first start; then done; }
            then action b;
        }
    }
}""")
    assert reading.list_flows("P::R::w") == [
        "merge -> merge",
        "decision -> merge [x]",
        "merge -> merge",
        "decision -> merge [else]",
        "start -> decision",
        "merge -> b",
    ]


def test_if_and_while_are_control_nodes_with_guards():
    reading = read("""
package P {
    action def A {
        attribute x : ScalarValues::Integer;
        first start;
        then while x < 3 { assign x := x + 1; }
        then if x == 3 { action good; } else { action bad; }
        then done;
    }
}""")
    assert sorted(reading.list_flows("P::A")) == sorted(
        [
            "start -> merge",
            "merge -> decision",
            "decision -> merge [else]",
            "decision -> merge [x < 3]",
            "merge -> opaque",
            "opaque -> merge",
            "merge -> merge",
            "merge -> decision",
            "decision -> merge [x == 3]",
            "merge -> good",
            "good -> merge",
            "merge -> merge",
            "decision -> merge [else]",
            "merge -> bad",
            "bad -> merge",
            "merge -> merge",
            "merge -> done",
        ]
    )


def test_state_machines_with_entry_transitions_and_effects():
    reading = read("""
package P {
    item def Open; item def Close;
    part def Door {
        attribute locked : ScalarValues::Boolean;
        exhibit state life {
            entry; then closed;
            state closed { entry assign locked := true; }
            transition opening first closed accept Open if not locked
                do assign locked := false then open;
            state open;
            accept Close then closed;
            accept after 10 [SI::s] then done;
        }
    }
}""")
    assert reading.list_targets("P::Door", "classifier-behavior") == ["P::Door::life"]
    region = "P::Door::life::<Region>"
    assert reading.list_flows(region) == [
        "start -> closed",
        "closed -> open [not locked]",
        "open -> closed",
        "open -> done",
    ]
    opening = f"{region}::opening"
    assert reading.list_targets(f"{opening}::<Trigger>", "typed-by") == ["P::Open"]
    effect = reading.list_targets(opening, "effect")
    assert reading.find_element(effect[0]).attrs["body"] == "locked := false"
    entry = reading.list_targets(f"{region}::closed", "entry")
    assert reading.find_element(entry[0]).attrs["body"] == "locked := true"


def test_parallel_states_are_regions():
    reading = read("""
package P {
    state def S {
        entry; then both;
        state both parallel {
            state left { entry; then a; state a; }
            state right;
        }
    }
}""")
    parallel = "P::S::<Region>::both"
    assert reading.list_owned(parallel) == ["Region left", "Region right"]
    assert reading.list_owned(f"{parallel}::left") == ["Pseudostate start", "Transition", "State a"]
    assert reading.list_owned(f"{parallel}::right") == [
        "State right",
        "Pseudostate start",
        "Transition",
    ]


def test_calculations_are_functions_and_constraints_of_definitions_have_no_name():
    reading = read("""
package P {
    private import ScalarValues::*;
    calc def Sum { in a : Real; in b : Real; return r : Real; a + b }
    constraint def Law { in f : Real; in m : Real; f == m * 2.0 }
}""")
    assert (
        reading.find_element("P::Sum").subkind,
        reading.find_element("P::Sum").attrs["body"],
    ) == (
        "function",
        "a + b",
    )
    assert [
        member.attrs["direction"] for member in reading.graph.owned(reading.find_element("P::Sum"))
    ] == [
        "in",
        "in",
        "return",
    ]
    assert reading.find_element("P::Law").role == "constraint block"
    assert reading.find_element("P::Law::<Constraint>").attrs["body"] == "f == m * 2.0"


def test_a_condition_that_nothing_precedes_starts_with_its_behaviour():
    reading = read("""
package P {
    private import ScalarValues::*;
    action def A {
        attribute x : Integer = 0;
        if x > 0 { assign x := 1; } else { assign x := 0; }
    }
}""")
    assert reading.list_flows("P::A")[-1] == "start -> decision"


def test_an_action_that_is_handed_over_is_a_parameter_and_no_step():
    reading = read("""
package P {
    calc def Scenario { in t; return : ScalarValues::Real; }
    analysis def Study { in calc scenario : Scenario; action run; }
}""")
    kinds = {
        member.name: member.kind.name
        for member in reading.graph.owned(reading.find_element("P::Study"))
    }
    assert kinds == {"scenario": "PARAMETER", "run": "ACTION"}


def test_a_succession_to_an_action_of_a_package_is_reported_and_has_no_flow():
    reading = read("""
package P {
    action focus;
    action takePicture { first focus; then shoot; action shoot; then done; }
}""")
    assert reading.list_flows("P::takePicture") == ["shoot -> done"]
    assert "SM480" in reading.list_codes()
