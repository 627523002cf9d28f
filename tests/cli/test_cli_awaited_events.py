"""Verdicts name what they expect of the environment: events, guards, and actions that end."""

import json
import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("all_passes")

PAGE = Path(__file__).parents[2] / "docs" / "contracts.md"
MODEL = """package Shop {{
    private import ScalarValues::*;
    item def Go; item def Halt; item def 'Start now';
    part def Lamp {{
        in attribute ready : Boolean; attribute on : Boolean := false;
        perform action job {{ {steps} then action light assign on := true; then done; }}
    }}
    requirement def Lights {{ subject lamp : Lamp; {assumed}
        require constraint {{ language "ltl" /* F on */ }} }}
}}"""


def write_lamp(workspace, steps, assumed=""):
    workspace.write("lamp.sysml", MODEL.format(steps=f"first start; {steps}", assumed=assumed))


def check(workspace, *options):
    return workspace.sysmlc("contracts", "check", "lamp.sysml", *options).stdout


@pytest.mark.parametrize(
    ("steps", "condition"),
    [
        ("then action warm;", "its actions end"),
        ("then action wait accept Go;", "Go comes sooner or later"),
        ("then action wait accept 'Start now';", "'Start now' comes sooner or later"),
        ("then action wait accept when ready;", "'ready' holds sooner or later"),
        ("then action wait accept after 5 [SI::s];", "its actions end"),
        (
            "then action warm; then action wait accept Go;",
            "its actions end and Go comes sooner or later",
        ),
        (
            "then action a accept Go; then action b accept Halt; then action c accept Go;",
            "Go comes and Halt comes sooner or later",
        ),
        (
            "then decide d; if ready then reset; action reset assign on := false;",
            "a guard of decision 'd' holds sooner or later",
        ),
    ],
    ids=["action", "event", "name with a blank", "condition", "time", "both", "events", "guard"],
)
def test_the_verdict_names_what_the_environment_has_to_do(workspace, steps, condition):
    write_lamp(workspace, steps)
    assert check(workspace).splitlines()[:2] == [
        f"Shop::Lamp: realizable, satisfies its requirements if {condition}",
        f"  Lights: holds if {condition}: F on",
    ]


def test_only_what_the_proof_needs_is_named(workspace):
    write_lamp(workspace, "then action warm; then action wait accept Go;")
    text = workspace.read("lamp.sysml").replace("/* F on */", "/* F running(wait) */")
    workspace.write("lamp.sysml", text)
    assert "  Lights: holds if its actions end: F running(wait)\n" in check(workspace)


def test_the_json_document_and_the_page_of_the_activity_say_it(workspace):
    write_lamp(workspace, "then action wait accept Go;")
    (requirement,) = json.loads(check(workspace, "--format", "json"))["requirements"]
    assumption = "Whenever accept action 'wait' runs, Go comes sooner or later."
    assert requirement["verdict"] == "holds-if-actions-end"
    assert requirement["needs"] == [assumption]
    assert requirement["reason"] == f"holds if Go comes sooner or later: {assumption}"
    workspace.sysmlc("lamp.sysml", "-o", "out")
    assert f"**Assumed.** {assumption}" in workspace.read("out/contracts/Shop.Lamp.md")


def test_an_event_that_the_author_assumes_is_not_named(workspace):
    assumed = 'assume constraint { language "ltl" /* G F event=Go */ }'
    write_lamp(workspace, "then action wait accept Go;", assumed)
    assert check(workspace).startswith("Shop::Lamp: realizable, satisfies its requirements\n")


def test_the_documented_assumption_about_a_trigger_proves_the_requirement(workspace):
    page = PAGE.read_text(encoding="utf-8")
    text = page.partition("<!-- expected event -->\n```sysml\n")[2].partition("```")[0]
    workspace.write("lamp.sysml", text)
    assert check(workspace).startswith("Shop::Lamp: realizable, satisfies its requirements\n")
    for formula in ("G F event=Go", "G (state=Waiting -> F event=Go)"):
        assert f"`{formula}`" in page
        workspace.write("lamp.sysml", text.replace("F event=Go", formula, 1))
        assert check(workspace).startswith("Shop::Lamp: realizable, satisfies its requirements\n")
    workspace.write("lamp.sysml", re.sub(r"\n *assume .*", "", text))
    assert "  Lights: broken: F on\n" in check(workspace)


@pytest.mark.parametrize(
    ("assumed", "verdict"),
    [
        ("G event!=Go", "broken: F on"),
        ("G (event!=Halt)", "broken: F on"),
        ("F event=Halt", "holds if its actions end, Go comes and Halt comes sooner or later: F on"),
    ],
)
def test_no_proof_needs_an_event_that_the_author_excludes(workspace, assumed, verdict):
    steps = "then action warm; then action a accept Go; then action b accept Halt;"
    write_lamp(workspace, steps, f'assume constraint {{ language "ltl" /* {assumed} */ }}')
    assert check(workspace).splitlines()[1] == f"  Lights: {verdict}"


@pytest.mark.parametrize(("sent", "is_satisfied"), [("", True), ("do send Full() via p", False)])
def test_a_block_decides_the_events_that_only_its_parts_send(workspace, sent, is_satisfied):
    workspace.write(
        "line.sysml",
        f"""package Line {{
    item def Go; item def Full;
    port def Pipe {{ out item full : Full; }}
    part def Sender {{ port p : Pipe;
        exhibit state S {{ entry; then A; state A; state B;
            transition first A accept Go {sent} then B; }} }}
    part def Receiver {{ port q : ~Pipe;
        exhibit state S {{ entry; then A; state A; state B;
            transition first A accept Full via q then B; }} }}
    part def Cell {{ part s : Sender; part r : Receiver; connect s.p to r.q; }}
    requirement def Silent {{ subject cell : Cell;
        require constraint {{ language "ltl" /* G r.event=none */ }} }}
}}""",
    )
    lines = workspace.sysmlc("contracts", "check", "line.sysml").stdout.splitlines()
    verdict = "satisfies" if is_satisfied else "violates"
    assert f"Line::Cell: realizable, {verdict} its requirements" in lines


def test_formulas_outside_gr1_are_decided_for_blocks_of_parts_as_for_others(workspace):
    workspace.write(
        "block.sysml",
        """package Shop {
    private import ScalarValues::*;
    item def Go;
    part def Lamp { attribute on : Boolean := false;
        exhibit state S { entry; then A; state A;
            transition first A accept Go do assign on := true then A; } }
    part def Room { part lamp : Lamp; }
    requirement def Settles { subject room : Room;
        require constraint { language "ltl" /* F G room.lamp.on | F G !room.lamp.on */ } }
}""",
    )
    result = workspace.sysmlc("contracts", "check", "block.sysml")
    assert "Shop::Room: checked one by one, satisfies its requirements" in result.stdout
    assert result.exit_code == 0


@pytest.mark.parametrize(
    "steps", ["then accept when n > 12;", "then decide; if n > 12 then b; action b;"]
)
def test_a_condition_outside_the_declared_range_never_becomes_true(workspace, steps):
    """The number made the condition unreadable: "holds if 'n > 12' holds sooner or later"."""
    write_lamp(workspace, steps)
    declared = "in attribute n : Integer; assert constraint { n >= 0 and n <= 9 } perform"
    workspace.write("lamp.sysml", workspace.read("lamp.sysml").replace("perform", declared))
    assert check(workspace).splitlines()[:2] == [
        "Shop::Lamp: realizable, violates its requirements",
        "  Lights: broken: F on",
    ]
    assert "12 is outside 0..9" in workspace.sysmlc("check", "lamp.sysml").stderr


def test_a_condition_beyond_an_assumed_range_decides_nothing(workspace):
    """No proof relies on a condition that is false in all runs that the check sees."""
    write_lamp(workspace, "then accept when n > k * k + 300;")
    inputs = "in attribute n : Integer; in attribute k : Integer; perform"
    workspace.write("lamp.sysml", workspace.read("lamp.sysml").replace("perform", inputs))
    reason = "it depends on n in 0..15 and k in 0..15 (assumed)"
    assert f"  Lights: not decided: {reason}: F on\n" in check(workspace)


SELF = """package Shop {{
    private import ScalarValues::*;
    item def Go; item def Start;
    port def Pipe {{ out item go : Go; }}
    part def Lamp {{
        attribute on : Boolean := false; port p : Pipe; port q : ~Pipe;
        {behaviour}
    }}
    requirement def Lights {{ subject lamp : Lamp;
        require constraint {{ language "ltl" /* F on */ }} }}
}}"""
SENT_TO_ITSELF = [
    "perform action job {{ first start; then send Go() {to}; then accept Go {via};"
    " then assign on := true; then done; }}",
    "exhibit state Work {{ entry; then A; state A; then B; state B; state C;"
    " transition first A do send Go() {to} then B;"
    " transition first B accept Go {via} do assign on := true then C; }}",
]


@pytest.mark.parametrize("behaviour", SENT_TO_ITSELF, ids=["action", "machine"])
def test_nobody_else_need_send_what_a_component_sends_itself(workspace, behaviour):
    """It was "holds if Go comes sooner or later", or broken by a run in which it never comes."""
    workspace.write("lamp.sysml", SELF.format(behaviour=behaviour.format(to="to self", via="")))
    result = workspace.sysmlc("contracts", "check", "lamp.sysml")
    assert "  Lights: not decided: F on\n" in result.stdout
    assert "'Lamp' may send 'Go' to itself, without a port" in result.stderr


@pytest.mark.parametrize("behaviour", SENT_TO_ITSELF, ids=["action", "machine"])
@pytest.mark.parametrize(("to", "via"), [("via p", "via q"), ("to p", ""), ("to self", "via q")])
def test_what_leaves_or_comes_by_a_port_is_sent_to_others(workspace, behaviour, to, via):
    workspace.write("lamp.sysml", SELF.format(behaviour=behaviour.format(to=to, via=via)))
    result = workspace.sysmlc("contracts", "check", "lamp.sysml")
    assert "  Lights: not decided" not in result.stdout


def test_what_an_action_sends_without_a_connection_is_not_lost(workspace):
    text = SELF.format(behaviour="").replace(
        "requirement",
        """part def Switch { perform action press { first start; then send Go(); then done; } }
    part def Room { part switch : Switch; part lamp : Lamp {
        perform action job { first start; then accept Go; then assign on := true; then done; } } }
    requirement""",
    )
    workspace.write(
        "lamp.sysml",
        text.replace("lamp : Lamp;\n", "room : Room;\n").replace("F on", "F room.lamp.on"),
    )
    result = workspace.sysmlc("contracts", "check", "lamp.sysml")
    assert "  Lights: not decided: F" in result.stdout
    assert "no connection leads 'Go' from 'switch'" in result.stderr
