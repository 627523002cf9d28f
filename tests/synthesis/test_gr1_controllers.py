"""Controllers of the specifications of gr1c, slugs and CHASE, and of the large contracts."""

import os
from pathlib import Path

import pytest

from long_runs import quick_first
from sysmlc.controllers.machine import Machine
from sysmlc.controllers.table import Table
from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Limits
from sysmlc.synthesis.controller_synthesis import Form, synthesise_controller
from sysmlc.synthesis.decision import Options

CORPUS = os.environ.get("SYSMLC_CORPUS")
OPTIONS = Options(limits=Limits(seconds=300))
FOLDER = Path(CORPUS or ".", "gr1")
PUBLISHED = [
    path.relative_to(FOLDER).as_posix()
    for pattern in ("gr1c/*.spc", "slugs/*slugs*", "chase/PickTurn*.ltl")
    for path in sorted(FOLDER.glob(pattern))
]
LARGE = {
    "din8580/assembly_holistic": 11,
    "robots/hol_9x2_thesis": 3,
    "robots/hol_9x2_move": 75,
    "robots/env_9x2_arbitrated": 4,
}
"""Contracts with the most states of their machines. The thesis reports no result for the first
within six hours."""
pytestmark = pytest.mark.corpus


def synthesise_controllers(name):
    """Synthesise the contracts of a file. Return the results and the codes of diagnostics."""
    sink = Sink()
    contracts = formats.read((FOLDER / name).read_text(encoding="utf-8"), name, sink)
    results = [
        synthesise_controller(contract, lambda origin: Subject(), sink, OPTIONS)
        for contract in contracts
    ]
    return results, [diagnostic.rule.code for diagnostic in sink]


@pytest.mark.parametrize("name", PUBLISHED)
def test_realizable_contracts_have_controllers(name):
    results, codes = synthesise_controllers(name)
    assert results
    assert [result.machine is not None for result in results] == [
        result.verdict.is_realizable for result in results
    ]
    assert codes == ["SM532"] * sum(not result.verdict.is_realizable for result in results)


@pytest.mark.parametrize("name", quick_first(reversed(LARGE)))
def test_large_contracts_have_machines(name):
    (result,), codes = synthesise_controllers(f"{name}.json")
    assert codes == []
    assert isinstance(result.machine, Machine)
    assert result.machine.size <= LARGE[name]


@pytest.mark.long
def test_independent_parts_have_a_table_of_combined_strategies():
    name = "chase/Robotic_Arm_Joints.ltl"
    contracts = formats.read((FOLDER / name).read_text(encoding="utf-8"), name, Sink())
    joints = next(contract for contract in contracts if contract.component.endswith(".Joints"))
    table = synthesise_controller(
        joints, lambda origin: Subject(), Sink(), OPTIONS, Form.TABLE
    ).machine
    assert isinstance(table, Table)
    assert (len(table.modes), len(table.nodes) < 2_000) == (1, True)
