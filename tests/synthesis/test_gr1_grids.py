"""Robots on a grid are decided within a limit of nodes, independent of time and hash seeds.

A bad order of bits makes these games run for hours; the limit of nodes detects it.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Limits
from sysmlc.synthesis.bdd import manager
from sysmlc.synthesis.decision import Options, decide

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
MAX_NODES = {3: 60_000, 4: 130_000}
"""Limits of nodes by the number of robots on five by five cells: a seventh above the need."""
PROGRAM = """
from test_gr1_grids import decide_grid
from gr1_grid import build_contract
figures = decide_grid(build_contract(5, 3), 3).figures
print(figures.rounds, figures.steps, figures.nodes)
"""


def decide_grid(grid, robots):
    """Decide a grid; the verdict is None if it needs too many nodes."""
    (contract,) = formats.read(json.dumps(grid), "grid.gr1.json", Sink())
    limits = Limits(nodes=MAX_NODES[robots])
    return decide(contract, lambda origin: Subject(), Sink(), Options("cudd", limits))


@pytest.fixture
def build_grid(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from gr1_grid import build_contract

    return build_contract


@pytest.mark.parametrize(("robots", "reorder_at"), [(3, manager.REORDER_AT), (4, 1_000)])
def test_a_grid_is_decided_in_the_initial_order_of_bits(
    build_grid, monkeypatch, robots, reorder_at
):
    monkeypatch.setattr(manager, "REORDER_AT", reorder_at)
    assert decide_grid(build_grid(5, robots), robots).is_realizable is True


@pytest.mark.long
def test_the_figures_do_not_depend_on_hash_seeds():
    path = os.pathsep.join([str(BENCHMARKS), str(Path(__file__).parent)])
    outputs = {
        subprocess.run(
            [sys.executable, "-c", PROGRAM],
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": path},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in "123"
    }
    assert len(outputs) == 1
