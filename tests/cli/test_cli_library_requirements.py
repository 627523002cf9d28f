"""Requirements of a library are listed only where the model uses them."""

import json
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("all_passes")

PAGE = Path(__file__).parents[2] / "docs" / "elementary-actions.md"


def check(workspace, text, *options):
    workspace.write("cells.sysml", f"package Cells {{ private import DIN8580::*; {text} }}")
    return workspace.sysmlc("contracts", "check", "cells.sysml", *options).stdout


def test_the_documented_loader_has_one_line_for_each_of_its_contracts(workspace):
    _, _, rest = PAGE.read_text(encoding="utf-8").partition("    part def Loader")
    loader = "part def Loader" + rest.partition("\n\nIt answers")[0]
    assert check(workspace, loader).splitlines() == [
        "Cells::Loader: realizable",
        "Cells::Loader.move: realizable",
        "Cells::Loader.pick: realizable",
        "Cells::Loader.place: realizable",
        "Cells::Loader: its 4 behaviours fit together",
    ]
    report = json.loads(check(workspace, loader, "--format", "json"))
    assert {item["component"] for item in report["requirements"]} == {
        "Cells::Loader",
        "Cells::Loader.move",
        "Cells::Loader.pick",
        "Cells::Loader.place",
    }


def test_the_same_lines_are_written_about_the_model_in_sysml_v1(workspace):
    loader = "part def Loader :> Picking { action pick : Pick; bind pick.command = command; }"
    lines = check(workspace, loader).splitlines()
    assert "Cells::Loader.pick: realizable" in lines
    workspace.sysmlc("build", "cells.sysml", "--emit", "uml", "-o", "saved")
    assert workspace.sysmlc("contracts", "check", "saved/uml").stdout.splitlines() == lines
    file = "saved/uml/libraries/DIN8580.uml"
    alone = workspace.sysmlc("contracts", "check", file).stdout
    assert "DIN8580::Clamping: realizable" in alone.splitlines()


ELSEWHERE = "part def Lamp { out attribute on : Boolean; }"
REQUIREMENT = "requirement def On { subject l : Lamp; require constraint { l.on } }"


@pytest.mark.parametrize(
    ("use", "listed"),
    [
        ("", []),
        ("part cell : Turning;", ["TurningContract"]),
        ("part def Cell :> Supplied;", []),
        ("requirement mine : MovingContract;", ["mine"]),
        ("part def Cell { part unit : Turning; }", ["TurningContract"]),
    ],
    ids=["import only", "typed by the subject", "specialised", "usage", "part of the subject"],
)
def test_a_requirement_of_a_library_is_listed_if_the_model_uses_it(workspace, use, listed):
    text = f"private import ScalarValues::*; {ELSEWHERE} {REQUIREMENT} {use}"
    lines = check(workspace, text).splitlines()
    omitted = {line.partition(": not decided: ")[0] for line in lines if "not decided" in line}
    assert {name.rpartition("::")[2] for name in omitted} >= set(listed)
    assert omitted if listed else not omitted


def test_the_reason_names_the_subject_in_the_library(workspace):
    text = f"private import ScalarValues::*; {ELSEWHERE} {REQUIREMENT} part cell : Turning;"
    assert (
        "DIN8580::TurningContract: not decided: no element of the model satisfies it or "
        "specialises its subject 'DIN8580::Turning'"
    ) in check(workspace, text)


LIBRARY = """library package Gates {
    private import ScalarValues::*;
    part def Gate { out attribute open : Boolean; }
    part def Pair { part left : Gate; part right : Gate; }
    requirement def Opens { subject gate : Gate; require constraint { gate.open } }
    requirement def Nobody { require constraint { true } }
}
"""
LAMP = """part def Lamp { out attribute on : Boolean; }
    requirement def On { subject lamp : Lamp; require constraint { lamp.on } }"""


@pytest.mark.parametrize(
    ("use", "gates"),
    [
        ("", []),
        ("private import Gates::Gate;", []),
        ("part def Wide :> Gate { }", ["Gates::Gate"]),
        ("part def Yard { part gate : Gate; }", ["Gates::Gate"]),
        ("part def Yard { part gates : Pair; }", ["Gates::Gate", "Gates::Pair"]),
    ],
    ids=["nothing", "import", "specialised", "typed", "through another type"],
)
def test_contracts_of_a_library_package_are_checked_if_the_model_uses_them(workspace, use, gates):
    imports = "private import ScalarValues::*; private import Gates::*;"
    workspace.write("gates.sysml", f"{LIBRARY} package Plant {{ {imports} {LAMP} {use} }}")
    lines = workspace.sysmlc("contracts", "check", "gates.sysml").stdout.splitlines()
    names = dict.fromkeys(line.partition(": ")[0] for line in lines)
    assert [name for name in names if name.startswith("Gates::")] == gates
    assert "Plant::Lamp" in names


def test_a_library_package_alone_is_the_model_and_a_name_selects_an_unused_contract(workspace):
    workspace.write("gates.sysml", LIBRARY)
    assert workspace.sysmlc("contracts", "check", "gates.sysml").stdout.splitlines() == [
        "Gates::Gate: realizable",
        "Gates::Pair: its 2 parts share no variables",
        "Gates::Nobody: not decided: the requirement has no subject, and no element satisfies it",
    ]
    workspace.write("gates.sysml", f"{LIBRARY} package Plant {{ part def Lamp; }}")
    result = workspace.sysmlc("contracts", "check", "gates.sysml")
    assert [result.exit_code, result.stdout] == [2, ""]
    assert "all contracts are about libraries that the model does not use" in result.stderr
    selected = workspace.sysmlc("contracts", "check", "gates.sysml", "-c", "Gates::Gate").stdout
    assert selected == "Gates::Gate: realizable\n"
