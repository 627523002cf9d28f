"""Controllers of the specifications of gr1c, slugs and CHASE, and of the large contracts."""

import os
from pathlib import Path

import pytest

from long_runs import quick_first
from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Limits
from sysmlc.synthesis.controller_synthesis import Form, synthesise_controller
from sysmlc.synthesis.controllers.forms import Machine, Table
from sysmlc.synthesis.decision import Options

CORPUS = os.environ.get("SYSMLC_CORPUS")
OPTIONS = Options(limits=Limits(seconds=300))
FOLDER = Path(CORPUS or ".", "gr1")
OTHERS = [
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
"""Contracts with the states of their machines: the thesis had none of the first in six hours."""
pytestmark = [
    pytest.mark.corpus,
    pytest.mark.skipif(not CORPUS, reason="SYSMLC_CORPUS names no folder"),
]


def controllers(name):
    """What is made of the contracts of a file, and what is said."""
    sink = Sink()
    contracts = formats.read((FOLDER / name).read_text(encoding="utf-8"), name, sink)
    made = [
        synthesise_controller(one, lambda origin: Subject(), sink, OPTIONS) for one in contracts
    ]
    return made, [finding.rule.code for finding in sink]


@pytest.mark.parametrize("name", OTHERS)
def test_what_can_be_kept_has_a_controller(name):
    made, told = controllers(name)
    assert made
    assert [one.machine is not None for one in made] == [one.verdict.is_realizable for one in made]
    assert told == ["SM532"] * sum(not one.verdict.is_realizable for one in made)


@pytest.mark.parametrize("name", quick_first(reversed(LARGE)))
def test_large_contracts_have_machines(name):
    (made,), told = controllers(f"{name}.json")
    assert told == []
    assert isinstance(made.machine, Machine)
    assert made.machine.size <= LARGE[name]


@pytest.mark.long
def test_what_consists_of_parts_has_a_table_of_their_strategies():
    name = "chase/Robotic_Arm_Joints.ltl"
    contracts = formats.read((FOLDER / name).read_text(encoding="utf-8"), name, Sink())
    joints = next(one for one in contracts if one.component.endswith(".Joints"))
    made = synthesise_controller(
        joints, lambda origin: Subject(), Sink(), OPTIONS, Form.TABLE
    ).machine
    assert isinstance(made, Table)
    assert (len(made.modes), len(made.nodes) < 2_000) == (1, True)
