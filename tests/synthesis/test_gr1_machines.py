"""Verified machines of the contracts of DIN 8580 and of the robots, and their sizes."""

import os
from pathlib import Path

import pytest

from sysmlc.controllers.machine import Machine
from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Limits
from sysmlc.synthesis.controller_synthesis import synthesise_controller
from sysmlc.synthesis.decision import Options

CORPUS = os.environ.get("SYSMLC_CORPUS")
OPTIONS = Options(limits=Limits(seconds=300))
MAX_SIZES = {
    "din8580/compose": (7, 2),
    "din8580/coordinator": (14, 0),
    "din8580/coordinator_must_turn": (15, 0),
    "din8580/decompose": (7, 2),
    "din8580/move": (5, 4),
    "din8580/move_wall_assumed": (5, 4),
    "din8580/pick": (4, 0),
    "din8580/place": (4, 0),
    "din8580/turn": (5, 2),
    "robots/robot_9": (2, 0),
    "robots/robot_16": (2, 0),
    "robots/robot_25": (2, 0),
    "robots/hol_16x1_smart": (2, 0),
    "robots/hol_16x1_move": (17, 0),
}
"""States and registers."""
pytestmark = pytest.mark.corpus


@pytest.mark.parametrize("name", MAX_SIZES)
def test_the_machine_has_few_states(name):
    text, sink = Path(CORPUS, "gr1", f"{name}.json").read_text(encoding="utf-8"), Sink()
    (contract,) = formats.read(text, f"{name}.json", sink)
    result = synthesise_controller(contract, lambda origin: Subject(), sink, OPTIONS)
    assert list(sink) == []
    assert isinstance(result.machine, Machine)
    states, registers = MAX_SIZES[name]
    assert result.machine.size <= states
    assert len(result.machine.registers) == registers
