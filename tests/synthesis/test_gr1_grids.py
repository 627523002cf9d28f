"""Robots on a grid are decided within so many nodes, whatever the clock and the hash seed say.

An order of bits that is bad for these games makes them endless, which a limit of nodes shows.
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
MOST = {3: 60_000, 4: 130_000}
"""Nodes for so many robots on five by five cells, a seventh more than are needed."""
SHOWN = """
from test_gr1_grids import decided
from gr1_grid import holistic
found = decided(holistic(5, 3), 3).figures
print(found.rounds, found.steps, found.nodes)
"""


def decided(grid, robots):
    """The verdict on a grid; none when that needs too many nodes."""
    (contract,) = formats.read(json.dumps(grid), "grid.gr1.json", Sink())
    limits = Limits(nodes=MOST[robots])
    return decide(contract, lambda origin: Subject(), Sink(), Options("cudd", limits))


@pytest.fixture
def holistic(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from gr1_grid import holistic

    return holistic


@pytest.mark.parametrize(("robots", "early"), [(3, manager.REORDER_AT), (4, 1_000)])
def test_a_grid_is_decided_in_the_order_that_its_variables_give(
    holistic, monkeypatch, robots, early
):
    monkeypatch.setattr(manager, "REORDER_AT", early)
    assert decided(holistic(5, robots), robots).is_realizable is True


@pytest.mark.long
def test_what_is_computed_does_not_depend_on_hash_seeds():
    path = os.pathsep.join([str(BENCHMARKS), str(Path(__file__).parent)])
    found = {
        subprocess.run(
            [sys.executable, "-c", SHOWN],
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": path},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in "123"
    }
    assert len(found) == 1
