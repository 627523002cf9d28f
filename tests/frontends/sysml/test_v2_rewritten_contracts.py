"""Behaviour in SysML v2 that is written as our own text and read again: graph, text and contracts.

State machines with history, regions and submachines, forks and joins, usages of library operations.
"""

import pytest
from reading_v2 import Reading

from examples.compiling import ROOT
from sysmlc.backends.sysml import print_document
from sysmlc.diagnostics import Sink
from sysmlc.ir.compare import compare
from sysmlc.logic.contract import Contract

PASSES = (
    "resolve",
    "inherit",
    "classify",
    "ports",
    "flows",
    "behaviours",
    "activities",
    "contracts",
)
MACHINES = """
package P {
    private import DIN8580::*;
    private import SysMLC::*;
    item def Go; item def Stop; item def Back; item def Reset;
    state def Sub {
        entry; then idle;
        state idle; accept Go then busy;
        state busy; accept Stop then idle;
    }
    part def Gate {
        attribute n : ScalarValues::Integer;
        exhibit state life {
            entry; then off;
            state off; accept Go then on;
            state on {
                entry; then a;
                state a; accept Go then b;
                state b; accept Stop then a;
                #deepHistory state mem;
            }
            transition leave first on accept Stop then off;
            transition back first off accept Back then on.mem;
            state both parallel {
                state left { entry; then l1; state l1; accept Go then l2; state l2; }
                state right { entry; then r1; state r1; accept Stop then r2; state r2; }
            }
            transition toBoth first off accept Reset then both;
            transition fromBoth first both accept Back then off;
            state sub : Sub;
            transition toSub first on accept Reset then sub;
            transition outSub first sub accept Back then off;
        }
    }
    part def Robot { action pick : Pick; action place : Place; }
    part def Line {
        perform action run {
            first start then split;
            fork split; then a; then b;
            action a; then meet;
            action b; then meet;
            join meet; then c;
            action c; then done;
        }
    }
}
"""
# The types of ISQ that two-tanks uses are not in these texts.
EXAMPLES = sorted(path for path in (ROOT / "examples").rglob("*.sysml") if path.stem != "two-tanks")


def list_contracts(reading):
    """Return assumptions and guarantees by component."""
    return {
        contract.component: (
            [conjunct.formula for conjunct in contract.assumptions],
            [conjunct.formula for conjunct in contract.guarantees],
        )
        for contract in reading.graph.derived(Contract)
    }


def check_round_trip(text):
    """Check that graph, text and contracts are read back; return the contracts."""
    original = Reading(text, passes=PASSES)
    written, _ = print_document(original.graph, Sink())
    again = Reading(written, passes=PASSES)
    assert [
        str(difference)
        for difference in compare(original.graph, again.graph, ("id", "declaration"))
    ] == []
    assert print_document(again.graph, Sink())[0] == written
    assert list_contracts(original) == list_contracts(again)
    assert [diagnostic.message for diagnostic in again.sink if diagnostic.is_error] == []
    return list_contracts(original)


def test_machines_forks_and_usages_of_operations_come_back():
    assert len(check_round_trip(MACHINES)) == 4


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_in_sysml_v2_come_back(path):
    check_round_trip(path.read_text())
