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
