"""The library DIN8580 deviates from the tables of the thesis exactly as its page says.

``thesis_tables.sysml`` contains the tables as contracts. The page lists what ``sysmlc contracts
refine`` reports when the library replaces a table, and when a table replaces the library.
"""

import json
import re
from pathlib import Path

import pytest
import spot

pytestmark = pytest.mark.usefixtures("all_passes")

TABLES = Path(__file__).with_name("thesis_tables.sysml")
PAGE = Path(__file__).parents[2] / "docs" / "elementary-actions.md"
CELLS = """package Cells {
    private import DIN8580::*;
    part def Cell {
        action turn : Turn;
        action move : Move;
        action pick : Pick;
        action place : Place { out attribute :>> grip := false; }
    }
    part def Coordinator :> Picking, Placing, Turning;
}
"""
COMPONENTS = {
    "Coordinator": "Coordinator",
    "Turn": "Cell.turn",
    "Move": "Cell.move",
    "Pick": "Cell.pick",
    "Place": "Cell.place",
}
"""The component of the library by the name of its table."""


def list_deviations(workspace, abstract, concrete, words):
    """Return the conjuncts because of which *concrete* does not refine *abstract*.

    Each has the word for the rule that reports it.
    """
    result = workspace.sysmlc("contracts", "refine", abstract, concrete, "--format", "json")
    report = json.loads(result.stdout)
    assert not [entry for entry in report["requirements"] if entry["verdict"] == "not decided"]
    return {
        (words[item["code"]], re.search("(?:guarantee|assumes) '(.*?)', which", item["message"])[1])
        for item in report["diagnostics"]
    }


def compare(workspace, table, tables, cells):
    """Return the deviations of the library from a table, in the words of the page."""
    workspace.write("tables.sysml", tables)
    workspace.write("cells.sysml", cells)
    printed, shipped = f"tables.sysml#Thesis::{table}", f"cells.sysml#Cells::{COMPONENTS[table]}"
    return list_deviations(
        workspace, printed, shipped, {"SM527": "guarantees less", "SM528": "assumes more"}
    ) | list_deviations(
        workspace, shipped, printed, {"SM527": "guarantees more", "SM528": "assumes less"}
    )


def read_page():
    """Return the deviations that the page lists, by the name of the table."""
    deviations = {table: set() for table in COMPONENTS}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        cells = re.split(r"(?<!\\)\|", line)
        if len(cells) == 6 and (name := cells[1].split(" (")[0].strip()) in COMPONENTS:
            formulas = re.findall("`(.*?)`", cells[3].replace("\\|", "|"))
            deviations[name] |= {(cells[2].strip(), formula) for formula in formulas}
    return deviations


@pytest.mark.parametrize("table", COMPONENTS)
def test_the_page_lists_every_deviation_from_a_table_and_no_other(workspace, table):
    tables = TABLES.read_text(encoding="utf-8")
    assert compare(workspace, table, tables, CELLS) == read_page()[table]


def select_less(deviations):
    """Return the guarantees of the table that the library does not give."""
    return {formula for deviation, formula in deviations if deviation == "guarantees less"}


@pytest.mark.parametrize(("table", "step"), [("Turn", 3), ("Move", 2)])
def test_tables_with_another_step_are_met_like_those_with_step_1(workspace, table, step):
    tables = TABLES.read_text(encoding="utf-8").replace("Integer = 1;", f"Integer = {step};")
    redefinition = f"{{ constant attribute :>> step = {step}; }}"
    cells = CELLS.replace(f": {table};", f": {table} {redefinition}")
    deviations = compare(workspace, table, tables, cells)
    assert select_less(deviations) == select_less(read_page()[table])
    result = workspace.sysmlc("contracts", "check", "cells.sysml")
    assert f"Cells::Cell.{table.lower()}: realizable" in result.stdout.splitlines()


@pytest.mark.parametrize("table", ["Turn", "Pick", "Place"])
def test_printed_guarantees_that_the_library_lacks_make_it_unrealizable(workspace, table):
    (guarantee,) = select_less(read_page()[table])
    cells = f"""package Cells {{
        private import DIN8580::*;
        action def Printed :> {table};
        requirement def PrintedContract {{
            subject it : Printed;
            require constraint {{ language "ltl" /* {guarantee} */ }}
        }}
        part def Cell {{ action printed : Printed; action shipped : {table}; }}
    }}"""
    workspace.write("cells.sysml", cells)
    assert workspace.sysmlc("contracts", "check", "cells.sysml").stdout.splitlines()[:2] == [
        "Cells::Cell.printed: unrealizable",
        "Cells::Cell.shipped: realizable",
    ]


SMALL = """package Cells {
    private import DIN8580::*;
    part def Cell {
        action move : Move { constant attribute :>> columns = 2; constant attribute :>> rows = 1; }
        action place : Place;
    }
    part def Coordinator :> Picking, Placing, Turning { constant attribute :>> positions = 2; }
}
"""


@pytest.mark.parametrize("component", ["Cell.move", "Cell.place", "Coordinator"])
def test_spot_realizes_the_contracts_with_printed_guarantees(workspace, component):
    workspace.write("cells.sysml", SMALL)
    workspace.sysmlc("cells.sysml", "-o", "out", "--emit", "+spot")
    formula, parts = (
        workspace.read(f"out/contracts/Cells.{component}.spot.{suffix}")
        for suffix in ("ltl", "part")
    )
    outputs = re.search(r"\.outputs (.*)", parts)[1].split()
    assert spot.solve_game(spot.ltl_to_game(formula.strip(), outputs))


def read_loader():
    """Return the machine of the page."""
    _, _, rest = PAGE.read_text(encoding="utf-8").partition("    part def Loader")
    return "part def Loader" + rest.partition("\n\nIt answers")[0]


PRINTED_PICK = """
    action def PrintedPick :> ElementaryAction {
        in attribute :>> command : Command := Command::none;
        out attribute :>> executed : Boolean := false;
        in attribute pos : Boolean;
        in attribute placed : Boolean := false;
        out attribute grip : Boolean := false;
        out attribute picking : Boolean := false;
    }
    requirement def PrintedContract {
        subject it : PrintedPick;
        assume constraint { language "ltl" /* G F (command=pick & pos) */ }
        require constraint { language "ltl" /* G (picking' <-> command=pick & pos) */ }
        require constraint { language "ltl" /* G (executed' <-> picking) */ }
        require constraint { language "ltl" /* G (grip' <-> picking | grip & !placed') */ }
        require constraint { language "ltl" /* G F (executed & grip) */ }
    }
"""


def test_an_action_that_picks_as_printed_does_not_fit_the_coordinator(workspace):
    loader = read_loader().replace("action pick : Pick;", "action pick : PrintedPick;")
    imports = "private import DIN8580::*; private import ScalarValues::*;"
    workspace.write("cells.sysml", f"package Cells {{ {imports} {PRINTED_PICK} {loader} }}")
    result = workspace.sysmlc("contracts", "check", "cells.sysml")
    assert result.stdout.splitlines()[-1] == "Cells::Loader: its 4 behaviours do not fit together"
    assert "Cells::Loader.pick: realizable" in result.stdout.splitlines()
    assert "'executed on command' of 'PickingContract'" in result.stderr
