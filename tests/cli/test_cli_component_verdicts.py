"""Verdicts about a component: who writes a feature, and which object performs an action."""

import json
import re

import pytest

CELL = "part def Cell { attribute full : Boolean := false; }"
ROBOT = """part def Robot {
    attribute gripped : Boolean := false;
    action pick { first start then close; action close assign gripped := true; then done; }
}"""
MOVE = (
    "exhibit state M {{ entry; then S; state S; transition first S accept Go {} then T; state T; }}"
)
FLAGS = "attribute x : Boolean := false; attribute y : Boolean := false;"


@pytest.fixture
def decide(workspace, all_passes):
    """Return a function from a block and formulas to the verdicts about the formulas."""

    def check(block, *formulas, others="", kind="part def", generals=""):
        requirements = (
            f"requirement def R{number} {{ subject b : B; "
            f'require constraint {{ language "ltl" /* {formula} */ }} }}'
            for number, formula in enumerate(formulas)
        )
        head = ("package P {", "private import ScalarValues::*;", "item def Go;", others)
        lines = (*head, f"{kind} B {generals} {{ {block} }}", *requirements, "}")
        workspace.write("model.sysml", "\n".join(lines))
        result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
        entries = json.loads(result.stdout)["requirements"]
        assert len(entries) == len(formulas)
        return [entry["verdict"] for entry in entries]

    return check


# -- features ------------------------------------------------------------------------------------


FREE_FLAGS = "attribute x : Boolean; attribute y : Boolean; "


def test_the_first_entry_decides_a_feature_without_initial_value(decide):
    states = "state S {{ {} }} accept Go then T; state T {{ entry assign y := true; }}"
    machine = (
        "attribute x : Boolean; attribute y : Boolean; exhibit state s {{ entry; then S; {} }}"
    )
    block = machine.format(states.format("entry assign y := false;"))
    assert decide(block, "G (y <-> state=T)", "G !y", "!x") == ["holds", "broken", "broken"]
    block = machine.format(states.format("entry assign y := x;"))
    assert decide(block, "y <-> x", "G (y -> x)", "!y") == ["holds", "broken", "broken"]
    block = machine.format(states.format("entry assign y := not y;"))
    assert decide(block, "y", "!y") == ["broken", "broken"]


OWN_ENTRY = "exhibit state s {{ entry {} then S; state S {}; accept Go then T; state T; }}"


@pytest.mark.parametrize(
    ("block", "formulas", "verdicts"),
    [
        ("assign x := true;", ["G x", "!x"], ["holds", "broken"]),
        ("assign x := not x;", ["G x", "!x"], ["holds", "broken"]),
        ("action set { assign x := true; assign y := x; }", ["G x", "G y"], ["holds", "holds"]),
        ("init;", ["G x", "G !y"], ["holds", "holds"]),
    ],
    ids=["assignment", "reads-the-default", "chain", "action-of-the-block"],
)
def test_the_entry_of_a_machine_runs_before_its_first_state(decide, block, formulas, verdicts):
    init = "action init { first start; then assign x := true; then done; }"
    assert decide(FLAGS + init + OWN_ENTRY.format(block, ""), *formulas) == verdicts


def test_the_entry_of_a_machine_goes_before_that_of_its_first_state(decide):
    block = FLAGS + OWN_ENTRY.format("assign x := true;", "{ entry assign y := x; }")
    assert decide(block, "G x", "G y") == ["holds", "holds"]


def test_a_state_performs_the_actions_of_the_machine_that_it_uses(decide):
    actions = "entry assign x := true; then I; do work; exit assign y := true;"
    definition = f"state def D {{ {actions} state I; }}"
    work = "action work { action turn; }"
    block = FLAGS + work + definition + OWN_ENTRY.format(";", ": D")
    formulas = ("G x", "G (y <-> state=T)", "running(work)", "G (state=T -> !running(work))")
    assert decide(block, *formulas) == ["holds", "holds", "holds", "holds"]


def test_a_state_may_have_the_name_of_an_operator(decide):
    block = """attribute done : Boolean := false;
        exhibit state s { entry; then X; state X; accept Go do assign done := true then 'true';
            state 'true'; accept Go then U; state U; }"""
    formulas = (
        "G (s.state=X & event=Go -> X done)",
        "G (done -> s.state!=X)",
        "s.state = X U done",
    )
    assert decide(block, *formulas, "F state=true -> F done", "G state!=U") == [
        "holds",
        "holds",
        "broken",
        "holds",
        "broken",
    ]


def test_a_feature_that_nothing_assigns_keeps_its_value(decide):
    block = FLAGS + MOVE.format("if x do assign y := true")
    assert decide(block, "G !x", "G !y", "G (state=S)") == ["holds", "holds", "holds"]


def test_a_feature_without_default_keeps_one_of_its_values(decide):
    block = "attribute x : Boolean; attribute y : Boolean := false;"
    block += MOVE.format("if x do assign y := true")
    assert decide(block, "G x | G !x", "G !x", "G !y") == ["holds", "broken", "broken"]


def test_the_environment_changes_a_feature_with_the_direction_in(decide):
    block = "in attribute x : Boolean; attribute y : Boolean := false;"
    block += MOVE.format("if x do assign y := true")
    assert decide(block, "G x | G !x", "G !y") == ["broken", "broken"]


def test_a_computed_feature_is_not_decided(decide):
    block = "attribute x : Boolean := false; attribute z : Boolean = not x;"
    block += MOVE.format("if z do assign x := true")
    assert decide(block, "G !x", "G (x -> z)") == ["not-decided", "not-decided"]


def test_an_assignment_in_another_language_may_change_a_feature(decide):
    block = FLAGS + MOVE.format('do action { language "Java" /* if (ok()) x = true; */ }')
    assert decide(block, "G !x") == ["not-decided"]


# -- features of parts ---------------------------------------------------------------------------


def test_an_effect_assigns_a_feature_of_a_part(decide):
    block = "part c : Cell;" + MOVE.format("do assign c.full := true")
    formulas = ("G !(c.full)", "G (event=Go -> X c.full)", "G (c.full -> state=T)")
    assert decide(block, *formulas, others=CELL) == ["broken", "holds", "holds"]


def test_each_part_has_its_own_feature(decide):
    block = "part c : Cell; part d : Cell;" + MOVE.format("do assign c.full := true")
    assert decide(block, "G !(c.full)", "G !(d.full)", others=CELL) == ["broken", "holds"]


FILL = "perform action fill {{ first start; then action wait; then action set {}; then done; }}"


def test_an_action_assigns_a_feature_of_a_part(decide):
    block = "part c : Cell; part d : Cell;" + FILL.format("assign c.full := not d.full")
    formulas = ("G !(c.full)", "F c.full", "G (finished(set) -> X c.full)", "G !(d.full)")
    verdicts = ["broken", "holds-if-actions-end", "holds", "holds"]
    assert decide(block, *formulas, others=CELL) == verdicts


def test_what_an_action_assigns_may_belong_to_a_part_of_a_part(decide):
    others = CELL + "part def Rack { part c : Cell; }"
    block = "part r : Rack;" + FILL.format("assign r.c.full := true")
    assert decide(block, "G !(r.c.full)", "F r.c.full", others=others) == [
        "broken",
        "holds-if-actions-end",
    ]


def test_an_action_and_a_part_may_assign_different_values_in_one_step(decide, workspace):
    emptied = "exhibit state M { entry; then S; state S; transition first S accept Go "
    emptied += "do assign full := false then S; }"
    others = CELL.replace("}", f"{emptied} }}")
    block = "part c : Cell;" + FILL.format("assign c.full := true")
    formulas = ("G (finished(set) -> X c.full)", "G (finished(set) & c.event=none -> X c.full)")
    assert decide(block, *formulas, others=others) == ["broken", "holds"]
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    assert "SM558" in result.stderr


def test_a_feature_of_a_part_is_an_argument_and_an_output(decide):
    invert = """action invert { in attribute p : Boolean; out attribute r : Boolean := false;
        first start; then action set assign r := not p; then done; }"""
    arguments = "in attribute :>> p := c.full; out attribute :>> r = c.full;"
    call = f"perform action call references invert {{ {arguments} }}"
    block = f"part c : Cell; {invert} perform action work {{ first start; then {call} then done; }}"
    assert decide(block, "F c.full", "G !(c.full)", others=CELL) == ["holds", "broken"]


def test_a_part_without_definition_reads_the_features_of_the_block_around_it(decide):
    look = """attribute seen : Boolean := false;
        action look { in attribute p : Boolean;
            first start; then action set assign seen := p; then done; }
        perform action work { first start; then action wait;
            then perform action call references look { in attribute :>> p := x; } then done; }"""
    block = f"{FLAGS} perform action fill {{ assign x := true; }} part c {{ {look} }}"
    assert decide(block, "G !(c.seen)", "F c.seen") == ["broken", "holds-if-actions-end"]


@pytest.mark.parametrize("part", ["part c : Cell[2];", "ref part c : Cell;"])
def test_an_assignment_to_an_unknown_object_is_not_decided(decide, part):
    block = f"part d : Cell; {part} {FILL.format('assign c.full := true')}"
    assert decide(block, "G !(d.full)", others=CELL) == ["not-decided"]


@pytest.mark.parametrize("part", ["part c : Cell[2];", "ref part c : Cell;"])
def test_an_assignment_to_an_unknown_object_does_not_set_the_inherited_feature(
    decide, workspace, part
):
    block = f"{part} {FILL.format('assign c.full := true')}"
    formulas = ("F full", "G !full")
    assert decide(block, *formulas, others=CELL, generals=":> Cell") == ["not-decided"] * 2
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    assert "SM562" in result.stderr


def test_a_guard_reads_a_feature_of_a_part(decide):
    block = "part c : Cell; attribute y : Boolean := false;"
    block += MOVE.format("if c.full do assign y := true")
    assert decide(block, "G !y", others=CELL) == ["holds"]
    assert decide(block, "G !y", others=CELL.replace("attribute", "in attribute")) == ["broken"]


@pytest.mark.parametrize("parts", ["part c : Cell[2];", "ref part c : Cell;"])
def test_a_guard_about_an_unknown_object_is_not_decided(decide, parts):
    block = parts + "attribute y : Boolean := false;" + MOVE.format("if c.full do assign y := true")
    assert decide(block, "G !y", others=CELL) == ["not-decided"]


# -- what the environment may be expected to do ----------------------------------------------------

ACCEPT = """perform action act {{
    first start; then action wait accept when {}; then action s assign y := true; then done;
}}"""


def test_a_condition_about_features_that_never_change_is_not_expected(decide):
    assert decide(FLAGS + ACCEPT.format("x"), "F y", "G !y") == ["broken", "holds"]


def test_a_condition_about_an_input_is_expected(decide):
    block = FLAGS + "in attribute ok : Boolean;"
    assert decide(block + ACCEPT.format("ok"), "F y") == ["holds-if-actions-end"]
    assert decide(block + ACCEPT.format("ok or x"), "F y") == ["holds-if-actions-end"]
    assert decide(block + ACCEPT.format("ok and x"), "F y", "G !y") == ["broken", "holds"]


# -- behaviours of states --------------------------------------------------------------------------

SET_Y = "action set { first start then s; action s assign y := true; then done; }"


def test_what_an_entry_performs_may_change_the_initial_value(decide):
    block = FLAGS + SET_Y + "exhibit state M { entry; then S; state S { entry set; } }"
    assert decide(block, "!y", "y", "G (x -> X x)") == ["broken", "holds", "holds"]


WAIT_SET = "action set { first start; then action w; then action s assign y := true; then done; }"
LEAVE = (
    "exhibit state M {{ entry; then S; state S {{ {} }} transition first S {} then T; state T; }}"
)


def test_a_state_is_active_while_its_entry_runs_and_no_transition_leaves_it(decide):
    formulas = {
        "running(set)": "holds",
        "G (running(set) -> state=S & X state=S)": "holds",
        "F (state=T)": "holds-if-actions-end",
        "G (state=T -> y)": "holds",
        "G (state=S -> X state=T)": "broken",
    }
    block = FLAGS + WAIT_SET + LEAVE.format("entry set;", "")
    assert decide(block, *formulas) == list(formulas.values())


def test_an_event_that_comes_while_an_entry_runs_is_lost(decide):
    block = FLAGS + WAIT_SET + LEAVE.format("entry set;", "accept Go")
    lost = "G (event=Go & running(set) -> X state=S)"
    taken = "G (event=Go & state=S & !running(set) -> X state=T)"
    assert decide(block, lost, taken, "F (state=T)") == ["holds", "holds", "broken"]


def test_a_do_behaviour_starts_when_the_entry_has_ended(decide):
    work = "action work { first start; then action c; then done; }"
    block = FLAGS + WAIT_SET + work + LEAVE.format("entry set; do work;", "")
    formulas = ("G (finished(set) -> X running(work))", "G !(running(set) & running(work))")
    assert decide(block, *formulas, "G (running(work) -> y)") == ["holds"] * 3


def test_an_entry_that_takes_time_disables_the_transitions_of_the_state_around(decide):
    inner = "entry; then I; state I { entry set; } transition first I then J; state J;"
    block = FLAGS + WAIT_SET + LEAVE.format(inner, "accept Go")
    assert decide(block, "G (running(set) -> X state=S)", "G (state=S)") == ["holds", "broken"]


def test_a_state_is_left_when_its_exit_ends(decide):
    formulas = {
        "G (state=S & event=Go & !running(set) -> X (running(w) & state=S))": "holds",
        "G (running(set) & !finished(set) -> X running(set))": "holds",
        "G (finished(set) -> X state=T)": "holds",
        "G (state=T -> y)": "holds",
        "G (event=Go & state=S -> F state=T)": "holds-if-actions-end",
        "G (event=Go & state=S -> X state=T)": "broken",
        "F running(set)": "broken",
    }
    block = FLAGS + WAIT_SET + LEAVE.format("exit set;", "accept Go")
    assert decide(block, *formulas) == list(formulas.values())


def test_the_effect_of_a_transition_reads_what_the_exit_assigns(decide):
    block = FLAGS + WAIT_SET + LEAVE.format("exit set;", "accept Go do assign x := y")
    formulas = ("G (running(set) -> !x)", "G (state=T -> x)", "G !x")
    assert decide(block, *formulas) == ["holds", "holds", "broken"]


def test_an_exit_stops_the_do_behaviour_and_events_that_come_while_it_runs_are_lost(decide):
    work = "action work { first start; then action c; then action d; then done; }"
    machine = "exhibit state M { entry; then S; state S { do work; exit set; } state T; state A; "
    machine += "transition first S accept Go then T; transition first S accept Stop then A; }"
    formulas = {
        "running(work)": "holds",
        "G !(running(set) & running(work))": "holds",
        "G (running(set) -> G !running(work))": "holds",
        "G (event=Go & state=S & !running(set) -> G !(state=A))": "holds",
        "G !(running(set) & event=Stop)": "broken",
        "G !(state=A)": "broken",
    }
    block = FLAGS + "item def Stop;" + WAIT_SET + work + machine
    assert decide(block, *formulas) == list(formulas.values())


def test_a_state_without_transitions_never_performs_its_exit(decide):
    block = FLAGS + WAIT_SET + "exhibit state M { entry; then S; state S { exit set; } }"
    assert decide(block, "G !running(set)", "F y") == ["holds", "broken"]


INNER = "entry; then I; state I { exit set; } transition first I accept Go then J; state J;"


@pytest.mark.parametrize(
    ("behaviours", "effect"),
    [
        ("", "do set"),
        ("entry set; entry; then I; state I;", ""),
        ("exit set; entry; then I; state I;", "accept Go"),
        (INNER, "accept Go"),
    ],
)
def test_effects_that_take_time_and_entries_beside_substates_are_not_decided(
    decide, behaviours, effect
):
    block = FLAGS + WAIT_SET + LEAVE.format(behaviours, effect)
    assert decide(block, "F (state=T)", "G !x") == ["not-decided", "not-decided"]


def test_an_exit_that_takes_time_before_a_choice_is_not_decided(decide):
    machine = "exhibit state M { entry; then S; state S { exit set; } state T; "
    machine += "#SysMLC::Choice state c; transition first c if x then T; "
    machine += "transition first c if not x then S; transition first S accept Go then c; }"
    assert decide(FLAGS + WAIT_SET + machine, "G !y", "G !x") == ["not-decided", "not-decided"]


DO = "exhibit state M { entry; then S; state S { do set; } transition first S then T; state T; }"


def test_an_action_that_only_assigns_takes_one_step(decide):
    block = FLAGS + "action set { assign y := true; }" + DO
    formulas = ("F y", "G (state=T -> y)", "G (finished(set) -> X y)", "G !y")
    assert decide(block, *formulas) == ["holds", "holds", "holds", "broken"]


def test_an_action_with_another_text_is_ended_by_the_environment(decide):
    block = FLAGS + 'action set { language "Java" /* lamp.on(); */ }' + DO
    assert decide(block, "F (state=T)", "F y") == ["holds-if-actions-end", "broken"]


def test_the_environment_does_not_open_a_guard_about_an_argument(decide):
    """The call waits at the decision for ever if its argument is false."""
    block = (
        FLAGS
        + """action look { in attribute p : Boolean; first start then d; decide d;
        if p then s; action s; then done; }
        perform action work { first start then l;
        perform action l references look { in attribute :>> p := VALUE; }
        then t; action t assign y := true; then done; }"""
    )
    assert decide(block.replace("VALUE", "false"), "F y", "G !y") == ["broken", "holds"]
    formulas = ("F y", "G (running(s) -> F finished(s))")
    expected = ["holds-if-actions-end", "holds-if-actions-end"]
    assert decide(block.replace("VALUE", "true"), *formulas) == expected


def test_an_action_that_only_assigns_can_be_called(decide):
    block = FLAGS + "action set { assign y := true; } perform action work { first start then s; "
    block += "perform action s references set; then t; action t; then done; }"
    assert decide(block, "F y", "G (running(t) -> y)", "G !y") == ["holds", "holds", "broken"]


# -- what a part performs --------------------------------------------------------------------------

SET_X = "action one { first start then s; action s assign x := true; then done; }"
SET_BOTH = f"perform {SET_X} perform {SET_Y.replace('action set', 'action two')}"


def test_everything_that_a_part_performs_starts_with_it_and_once(decide):
    formulas = ("F x", "F y", "running(two)", "G F running(two)")
    assert decide(FLAGS + SET_BOTH, *formulas) == ["holds", "holds", "holds", "broken"]
    offered = FLAGS + SET_BOTH.replace("perform action two", "action two")
    assert decide(offered, "F x", "F y") == ["holds", "broken"]


def test_a_machine_before_a_performed_action_makes_no_difference(decide):
    assert decide(FLAGS + MOVE.format("do assign x := true") + SET_BOTH, "F y") == ["holds"]


def test_a_part_exhibits_a_machine_that_is_defined_elsewhere(decide):
    machine = MOVE.format("do assign on := true").removeprefix("exhibit state M {")
    definition = f"state def M {{ attribute on : Boolean := false; {machine}"
    formulas = ("G (event=Go & state=S -> X state=T)", "G (state=S)")
    block = f"{FLAGS} exhibit state m : M;"
    assert decide(block, *formulas, others=definition) == ["holds", "broken"]


@pytest.mark.parametrize("performance", ["perform r.pick;", "perform action p references r.pick;"])
def test_an_action_of_a_part_is_performed_by_the_part(decide, performance):
    formulas = ("F r.gripped", "G !(r.gripped)")
    verdicts = decide(f"part r : Robot; {performance}", *formulas, others=ROBOT)
    assert verdicts == ["holds", "broken"]


@pytest.mark.parametrize(
    "performance",
    [
        "perform r.pick;",
        "perform action p references r.pick;",
        "perform action act { first start; then perform r.pick; then done; }",
    ],
)
def test_the_action_of_one_of_two_equal_parts_is_not_decided(decide, performance):
    parts = "part r : Robot; part q : Robot;"
    verdicts = decide(f"{parts} {performance}", "F r.gripped", "G !(q.gripped)", others=ROBOT)
    assert verdicts == ["not-decided", "not-decided"]


# -- outputs of calls ----------------------------------------------------------------------------

CHECK = (
    "action def Check { out attribute ok : Boolean; first start then inspect; action inspect;"
    " then done; }"
)
SORT = """attribute accepted : Boolean := false;
    perform action sort {{
        {} first start then check; action check : Check {{ {} }}
        then d; decide d; if {} then keep; else drop;
        action keep; then done; action drop; then done;
    }}"""


@pytest.mark.parametrize(
    ("attribute", "output", "guard"),
    [
        ("", "out attribute :>> ok = accepted;", "accepted"),
        ("", "out ok = B::accepted;", "accepted"),
        ("attribute ok : Boolean := false;", "out attribute :>> ok;", "ok"),
    ],
)
def test_an_output_that_nothing_assigns_has_an_unknown_value(decide, attribute, output, guard):
    """Without a value, an output sets the attribute of the activity that has its name."""
    block = SORT.format(attribute, output, guard)
    assert decide(block, "G !running(keep)", "G !running(drop)", others=CHECK) == ["broken"] * 2


def test_an_output_without_attribute_changes_no_other_feature(decide):
    block = SORT.format("", "out attribute :>> ok;", "accepted")
    assert decide(block, "G !running(keep)", "G !running(drop)", others=CHECK) == [
        "holds",
        "broken",
    ]


# -- signals between parts -------------------------------------------------------------------------

PIECES = "item def Piece; port def Chute { out item piece : Piece; }"
SOURCE = """part a { port outlet : Chute; exhibit state M { entry; then Ready; state Ready;
    transition first Ready accept Go do send new Piece() via outlet then Sent; state Sent; } }"""
RELAY = """part m { port inlet : ~Chute; port outlet : Chute; exhibit state M { entry; then Empty;
    state Empty;
    transition first Empty accept Piece via inlet do send new Piece() via outlet then Full;
    state Full; transition first Full accept Piece via inlet then Over; state Over; } }"""
SINK = """part {} {{ port inlet : ~Chute; exhibit state M {{ entry; then Empty; state Empty;
    transition first Empty accept Piece via inlet then Full; state Full; }} }}"""
CHAIN = "connect a.outlet to m.inlet; connect m.outlet to c.inlet;"


def test_a_part_does_not_receive_what_it_sends(decide):
    """The relay gets one piece from ``a``, and not its own one."""
    block = SOURCE + RELAY + SINK.format("c") + CHAIN
    formulas = ("G !(m.state=Over)", "G (m.state=Full -> F m.state=Over)", "G !(c.state=Full)")
    assert decide(block, *formulas, others=PIECES) == ["holds", "broken", "broken"]


WAITING = """part w { port inlet : ~Chute; attribute got : Boolean := false; perform action work {
    first start then a; action a accept Piece via inlet; then s; action s assign got := true;
    then done; } }"""


def test_only_what_a_part_sends_ends_the_accept_action_of_another(decide):
    """The environment is assumed to send only what it can send."""
    wired = PIECES + WAITING.replace("part w", "part def W")
    block = SOURCE.replace("accept Go do send", "accept Go if false do send") + WAITING
    block += "connect a.outlet to w.inlet;"
    assert decide(block, "F w.got", "G !w.got", others=PIECES) == ["broken", "holds"]
    block = SOURCE + WAITING + "connect a.outlet to w.inlet;"
    formulas = ("F w.got", "F a.state=Sent -> F w.got")
    assert decide(block, *formulas, others=PIECES) == ["broken", "holds"]
    assert decide("", "F b.got", others=wired, generals=":> W") == ["holds-if-actions-end"]


def test_a_part_that_is_connected_with_itself_receives_what_it_sends(decide):
    block = SOURCE + RELAY + CHAIN.replace("c.inlet", "m.inlet")
    formulas = ("G !(m.state=Over)", "G (m.state=Full -> F m.state=Over)")
    assert decide(block, *formulas, others=PIECES) == ["broken", "holds"]


def test_a_signal_leaves_through_its_port_only(decide):
    source = SOURCE.replace("port outlet", "port second : Chute; port outlet")
    block = source + SINK.format("c") + SINK.format("d")
    block += "connect a.outlet to c.inlet; connect a.second to d.inlet;"
    formulas = ("G (a.state=Sent -> F c.state=Full)", "F a.state=Sent -> F d.state=Full")
    assert decide(block, *formulas, others=PIECES) == ["holds", "broken"]


def test_two_senders_to_one_port_do_not_receive_from_each_other(decide):
    """The piece of ``a`` does not get from the inlet of ``c`` over the outlet of ``m`` to ``d``."""
    block = SOURCE + RELAY + SINK.format("c") + SINK.format("d")
    block += (
        "connect a.outlet to c.inlet; connect m.outlet to c.inlet; connect m.outlet to d.inlet;"
    )
    formulas = ("F a.state=Sent -> F c.state=Full", "F a.state=Sent -> F d.state=Full")
    assert decide(block, *formulas, others=PIECES) == ["holds", "broken"]


def test_one_signal_through_two_ports_is_not_decided(decide):
    source = SOURCE.replace("port outlet", "port second : Chute; port outlet").replace(
        "state Sent;",
        "state Sent; transition first Sent accept Go do send new Piece() via second then Ready;",
    )
    block = source + SINK.format("c") + "connect a.outlet to c.inlet;"
    assert decide(block, "G !(c.state=Full)", others=PIECES) == ["not-decided"]


BELTS = """part def Belt { port inlet : ~Chute; port outlet : Chute; }
    part def Feeder { port outlet : Chute; exhibit state F { entry; then Ready; state Ready;
    transition first Ready accept Go do send new Piece() via outlet then Ready; } }"""
CELL_OF_BELTS = """part left : Belt; part right : Belt; part belts : Belt[2];
    port inlet : ~Chute; port outlet : Chute;
    exhibit state M {{ entry; then A; state A; {} state B; {} state C; }}"""


@pytest.mark.parametrize("parts", [("left", "right"), ("belts#(1)", "belts#(2)")])
def test_the_same_port_of_two_parts_is_not_one_event(decide, parts):
    """The next piece at ``left`` must not bring the machine from B to C, as if at ``right``."""
    first, second = parts
    steps = f"accept Piece via {first}.inlet then B;", f"accept Piece via {second}.inlet then C;"
    block = CELL_OF_BELTS.format(*steps)
    formula = "G (state=A & event=Piece & X event=Piece -> X X state=C)"
    assert decide(block, formula, others=PIECES + BELTS) == ["not-decided"]


@pytest.mark.parametrize(
    ("steps", "verdict"),
    [
        ("accept Piece via inlet then B;", "broken"),
        ("accept Piece via left.inlet then B;", "not-decided"),
        ("accept Go do send new Piece() via left.outlet then B;", "not-decided"),
        ("accept Piece via belts#(1).inlet then B;", "not-decided"),
        ("accept Go do send new Piece() via belts#(1).outlet then B;", "not-decided"),
    ],
)
def test_a_port_of_a_part_is_not_the_own_port_of_its_name(decide, steps, verdict):
    cell = "part def Cell {{ {} }}".format(CELL_OF_BELTS.format(steps, ""))
    block = "part cell : Cell; part feeder : Feeder; connect feeder.outlet to cell.inlet;"
    assert decide(block, "G !(cell.state=B)", others=PIECES + BELTS + cell) == [verdict]


# -- wording -------------------------------------------------------------------------------------


# -- values of called activities -------------------------------------------------------------------

JOB = "perform action job {{ first start then a; perform action a references sense {{ {} }} {} }}"
SENSE = (
    "action sense { in attribute p : Boolean; out attribute r : Boolean := false; "
    "first start then set; action set assign r := not p; then done; }"
)


def test_an_output_has_the_value_that_the_last_action_assigns_to_it(decide):
    job = JOB.format("in attribute :>> p := false; out attribute :>> r = x;", "then done;")
    verdicts = ["holds", "broken"]
    assert decide(FLAGS + SENSE + job, "G (finished(a) -> X x)", "G !x") == verdicts


def test_an_output_that_nothing_assigns_has_its_default(decide):
    sense = SENSE.replace("assign r := not p", "")
    job = JOB.format("in attribute :>> p := y; out attribute :>> r = x;", "then done;")
    assert decide(FLAGS + sense + job, "G !x") == ["holds"]
    sense = sense.replace(":= false", "")
    assert decide(FLAGS + sense + job, "G !x") == ["broken"]


def test_each_performance_has_its_own_variables(decide):
    """The second performance starts with ``n`` false, as the first one."""
    count = (
        "action sense { attribute n : Boolean := false; first start then c; "
        "action c assign n := not n; then p; action p assign x := n; then done; }"
    )
    job = JOB.format("", "then b; perform action b references sense; then done;")
    formulas = ("G (finished(a) | finished(b) -> X x)", "G !x")
    assert decide(FLAGS + count + job, *formulas) == ["holds", "broken"]


def test_an_argument_is_a_parameter_of_the_activity_around_the_call(decide):
    outer = (
        "action outer { in attribute p : Boolean; out attribute r : Boolean; first start then i; "
        "perform action i references sense { in attribute :>> p = p; out attribute :>> r = r; } "
        "then done; }"
    )
    job = JOB.replace("sense", "outer").format(
        "in attribute :>> p := y; out attribute :>> r = x;", "then done;"
    )
    assert decide(FLAGS + SENSE + outer + job, "G (finished(a) -> X x)", "G !x") == [
        "holds",
        "broken",
    ]


def test_a_feature_that_a_call_and_an_action_assign_has_the_values_of_both(decide):
    output = "in attribute :>> p := false; out attribute :>> r = x;"
    job = JOB.format(output, "then off; action off assign x := false; then done;")
    formulas = ("G (finished(a) -> X x)", "G (finished(off) -> X !x)", "G !x")
    assert decide(FLAGS + SENSE + job, *formulas) == ["holds", "holds", "broken"]


def test_an_activity_that_is_the_component_has_its_attributes_once(decide):
    """The guard reads what the call sets."""
    job = """attribute x : Boolean := false;
        first start then a;
        perform action a references sense { in attribute :>> p := false; out attribute :>> r = x; }
        then d; decide d; if x then keep; else drop;
        action keep; then done; action drop; then done;"""
    formulas = ("G (finished(a) -> X x)", "G !running(keep)", "G !running(drop)")
    verdicts = decide(job, *formulas, others=SENSE, kind="action def")
    assert verdicts == ["holds", "broken", "holds"]


def test_an_output_without_finite_values_leaves_the_rest_decided(decide):
    sense = SENSE.replace("out attribute r : Boolean := false", "out attribute r : Real")
    sense = sense.replace("assign r := not p", "assign x := true")
    job = "attribute level : Real; " + JOB.format("out attribute :>> r = level;", "then done;")
    assert decide(FLAGS + sense + job, "G (finished(a) -> X x)") == ["holds"]


def test_an_assigned_input_is_not_decided(decide):
    sense = SENSE.replace("assign r := not p", "assign p := true; then t; action t assign r := p")
    job = JOB.format("in attribute :>> p := y; out attribute :>> r = x;", "then done;")
    assert decide(FLAGS + sense + job, "G !x") == ["not-decided"]


def test_formulas_have_the_names_of_the_author(workspace, all_passes):
    cell = "part def Cell { part robot : Robot; perform action work { first start then take; "
    cell += "perform action take references robot.pick; then done; } }"
    formulas = ("G (finished(take) -> X it.robot.gripped) & G F running(take)", "G !robot.gripped")
    requirements = (
        f'requirement R{number} {{ subject it : Cell; require constraint {{ language "ltl" '
        f"/* {formula} */ }} }}"
        for number, formula in enumerate(formulas)
    )
    lines = ("package P {", "private import ScalarValues::*;", ROBOT, cell, *requirements, "}")
    workspace.write("model.sysml", "\n".join(lines))
    result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
    document = json.loads(result.stdout)
    assert [entry["formula"] for entry in document["requirements"]] == [
        "G (finished(take) -> it.robot.gripped')",
        "G F running(take)",
        "G !robot.gripped",
    ]
    (broken,) = (
        diagnostic["message"]
        for diagnostic in document["diagnostics"]
        if "robot.gripped" in diagnostic["message"]
    )
    assert "violates 'G !robot.gripped'" in broken


# -- SysML v1 --------------------------------------------------------------------------------------


def add_satisfactions(text):
    """Return the XMI with the block B satisfying each requirement, as SysML v1 states a subject."""
    (block,) = re.findall(r'xmi:id="([^"]+)" name="B"', text)
    requirements = re.findall(r'xmi:type="uml:Class" xmi:id="([^"]+)" name="R\d+"', text)
    for number, requirement in enumerate(requirements):
        satisfaction = (
            f'<packagedElement xmi:type="uml:Abstraction" xmi:id="s{number}" client="{block}" '
            f'supplier="{requirement}"/>'
        )
        stereotype = f'<Requirements:Satisfy xmi:id="t{number}" base_Abstraction="s{number}"/>'
        text = text.replace("</uml:Package>", f"{satisfaction}</uml:Package>")
        text = text.replace("</xmi:XMI>", f"{stereotype}</xmi:XMI>")
    return text


@pytest.mark.parametrize(
    ("block", "others", "formulas"),
    [
        (FLAGS + MOVE.format("if x do assign y := true"), "", ("G !y", "G (state=S)")),
        (
            "part c : Cell;" + MOVE.format("do assign c.full := true"),
            CELL,
            ("G !(c.full)", "G (event=Go -> X c.full)"),
        ),
        (
            "part c : Cell;" + FILL.format("assign c.full := true"),
            CELL,
            ("G !(c.full)", "F c.full", "G (finished(set) -> X c.full)"),
        ),
        (
            FLAGS + WAIT_SET + LEAVE.format("entry set;", ""),
            "",
            ("F (state=T)", "G (state=T -> y)", "G (state=S)"),
        ),
        ("part r : Robot; perform r.pick;", ROBOT, ("F r.gripped", "G !(r.gripped)")),
    ],
)
def test_the_verdicts_are_equal_in_xmi(decide, workspace, block, others, formulas):
    verdicts = decide(block, *formulas, others=others)
    workspace.sysmlc("build", "model.sysml", "--emit", "uml", "-o", "out")
    workspace.write("model.uml", add_satisfactions(workspace.read("out/uml/model.uml")))
    result = workspace.sysmlc("contracts", "check", "--format", "json", "model.uml")
    entries = json.loads(result.stdout)["requirements"]
    assert [entry["verdict"] for entry in entries] == verdicts


# -- components without a step relation ------------------------------------------------------------

ASSIGN = "do action a { first start then s; action s assign k := true; then done; }"


def test_formulas_about_a_machine_that_is_not_described_are_not_decided(decide):
    block = "exhibit state M { attribute k : Boolean := false; entry; then S; "
    block += f"state S {{ {ASSIGN} }} transition first S accept Go if k then T; state T; }}"
    formulas = ("G (running(a) -> M.state=S)", "G !(M.state=T)")
    assert decide(block, *formulas) == ["not-decided", "not-decided"]


# -- signals ---------------------------------------------------------------------------------------

PARTS = """part def Sender {{ port left; port right;
    exhibit state m {{
        entry; then A; state A; transition first A do send new Go(){} then T; state T;
    }}
}}
part def Receiver {{ port p;
    exhibit state m {{ entry; then A; state A; transition first A accept {} then T; state T; }}
}}"""


@pytest.mark.parametrize(
    ("via", "signal", "connections", "verdict"),
    [
        ("", "Go", "connect s to r;", "holds"),
        ("", "Other::Go", "connect s to r;", "not-decided"),
        (" via left", "Go", "connect s.left to r.p;", "holds"),
        ("", "Go", "connect s.left to r.p;", "holds"),
        ("", "Go", "connect s.left to r.p; connect s.right to t.p;", "not-decided"),
    ],
)
def test_signals_and_their_ports_are_told_apart(decide, via, signal, connections, verdict):
    others = "package Other { item def Go; }" + PARTS.format(via, signal)
    block = f"part s : Sender; part r : Receiver; part t : Receiver; {connections}"
    assert decide(block, "F r.m.state=T", others=others) == [verdict]


def test_requirements_on_a_state_machine_without_contract_are_not_decided(workspace, all_passes):
    """A region without a first state (SM421) gives no contract; the requirement was left out."""
    model = """package P {
        private import ScalarValues::*;
        item def Go;
        part def Cell {
            attribute x : Boolean := false;
            exhibit state Main {
                state A;
                transition first A accept Go do assign x := true then B;
                state B;
            }
        }
        requirement def R {
            subject cell : Cell;
            require constraint { language "ltl" /* G !x */ }
        }
    }"""
    workspace.write("model.sysml", model)
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    line = "P::R: not decided: state machine 'Main' has no contract (see 'sysmlc check')"
    assert line in result.stdout


ENDLESS = """action bad { first start then f; fork f; then a; then b; action a; then m;
    action b; then m; merge m; then c; action c; then m; }"""
"""Two tokens in one cycle, so that the activity has no token graph (SM454); it never ends."""


def test_an_activity_without_token_graph_is_not_assumed_to_end(decide):
    states = """exhibit state M { entry; then Idle; state Idle;
        transition first Idle accept Go then Busy;
        state Busy { do bad; } transition first Busy then Idle; }"""
    formulas = "G (state=Busy -> F state=Idle)", "F state=Busy", "G (state=Idle -> !running(bad))"
    verdicts = ["not-decided", "broken", "holds"]
    assert decide(ENDLESS + states, *formulas) == verdicts
    called = """perform action job { first start then x; perform action x references bad;
        then y; action y; then done; }"""
    assert decide(ENDLESS + called, "F running(y)") == ["not-decided"]
    performed = ENDLESS.replace("action bad", "perform action bad")
    formulas = "F finished(bad)", "G !finished(bad)"
    assert decide(performed, *formulas) == ["not-decided", "not-decided"]


def test_the_first_formula_about_an_accept_action_may_read_the_event(decide):
    block = "perform action w { first start then a; action a accept Go; then done; }"
    formula = "G (running(a) & event=Go -> finished(a))"
    assert decide(block, formula) == ["holds"]


def test_a_formula_reads_an_event_that_only_an_action_of_a_state_accepts(decide):
    """The state machine alone receives fewer events than the block."""
    block = """action w { first start then a; action a accept Stop; then done; }
        exhibit state M { entry; then S; state S; transition first S accept Go then T;
        state T { do w; } transition first T then S; }"""
    formulas = "G (running(a) & event=Stop -> finished(a))", "G (event=Stop -> X state=S)"
    verdicts = decide(block, *formulas, others="item def Stop;")
    assert verdicts == ["holds", "holds"]
