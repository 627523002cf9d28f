"""Internal block diagrams show inherited parts and connectors, with ``^`` before their names."""

import re

LINE = """\
package Inherit {
    item def Box;
    port def P { out item x : Box; }
    part def Feeder { port outlet : P; }
    part def FastFeeder :> Feeder;
    part def Press { port inlet : ~P; }
    part def Line {
        part feeder : Feeder;
        part press : Press;
        connection supply connect feeder.outlet to press.inlet;
        flow of Box from feeder.outlet.x to press.inlet.x;
    }
"""


def draw(workspace, members):
    """Return the parts and connections in the diagrams of a model, by the name of the block."""
    workspace.write("line.sysml", f"{LINE}{members}}}\n")
    workspace.sysmlc("line.sysml", "--emit", "plantuml")
    paths = [path for path in workspace.list_files() if path.endswith(".ibd.puml")]
    return {
        path.split(".")[1]: read_diagram(workspace.read(f"out/{path}").replace("<U+005E>", "^"))
        for path in paths
    }


def read_diagram(text):
    parts = re.findall(r'^ *rectangle "\*\*(.*)\*\*"', text, re.MULTILINE)
    lines = re.findall(r"^ *\w+ (?:--|-->) \w+.*", text, re.MULTILINE)
    return parts, [line.strip() for line in lines]


def test_a_specialised_block_shows_what_it_inherits_and_what_it_adds(workspace, all_passes):
    diagrams = draw(
        workspace,
        "part def Double :> Line { part second : Press; connect feeder.outlet to second.inlet; }",
    )
    assert diagrams["Line"] == (
        ["feeder : Feeder", "press : Press"],
        [r"outlet_1 --> inlet_1 : supply\nBox"],
    )
    assert diagrams["Double"] == (
        ["second : Press", "^feeder : Feeder", "^press : Press"],
        ["outlet_1 -- inlet_1", r"outlet_1 --> inlet_2 : ^supply\nBox"],
    )


def test_a_connector_leads_to_the_part_that_redefines_the_inherited_one(workspace, all_passes):
    diagrams = draw(
        workspace,
        "part def Fast :> Line { part :>> feeder : FastFeeder; } part def Same :> Fast;",
    )
    connection = [r"outlet_1 --> inlet_1 : ^supply\nBox"]
    assert diagrams["Fast"] == (["feeder : FastFeeder", "^press : Press"], connection)
    assert diagrams["Same"] == (["^feeder : FastFeeder", "^press : Press"], connection)


def test_a_usage_that_specialises_another_one_has_a_diagram(workspace, all_passes):
    diagrams = draw(
        workspace,
        "part wide : Line { part spare : Press; connect feeder.outlet to spare.inlet; }"
        "part copy :> wide; part plain : Line;",
    )
    assert diagrams["copy"] == (
        ["^spare : Press", "^feeder : Feeder", "^press : Press"],
        ["outlet_1 -- inlet_1 : ^", r"outlet_1 --> inlet_2 : ^supply\nBox"],
    )
    assert set(diagrams) == {"Line", "wide", "copy"}


def test_a_block_without_inherited_connections_has_no_diagram(workspace, all_passes):
    assert set(draw(workspace, "part def Quick :> FastFeeder { part motor; }")) == {"Line"}
