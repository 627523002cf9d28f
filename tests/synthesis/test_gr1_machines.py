"""Machines of the contracts of DIN 8580 and of the robots: made, small, and passed by the check."""

import os
from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Limits
from sysmlc.synthesis.decide import Options
from sysmlc.synthesis.synthesise import synthesised

CORPUS = os.environ.get("SYSMLC_CORPUS")
OPTIONS = Options(limits=Limits(seconds=300))
MOST_STATES = {
    "din8580/compose": 12,
    "din8580/coordinator": 14,
    "din8580/decompose": 9,
    "din8580/pick": 4,
    "din8580/place": 4,
    "din8580/turn": 24,
    "din8580/move": 68,
    "robots/robot_9": 4,
    "robots/robot_16": 4,
    "robots/robot_25": 4,
    "robots/hol_16x1_smart": 4,
}
pytestmark = [
    pytest.mark.corpus,
    pytest.mark.skipif(not CORPUS, reason="SYSMLC_CORPUS names no folder"),
]


@pytest.mark.parametrize("name", MOST_STATES)
def test_a_machine_is_made_and_small(name):
    text, sink = Path(CORPUS, "gr1", f"{name}.json").read_text(encoding="utf-8"), Sink()
    (contract,) = formats.read(text, f"{name}.json", sink)
    made = synthesised(contract, lambda origin: Subject(), sink, OPTIONS)
    assert list(sink) == []
    assert made.machine is not None
    assert made.machine.size <= MOST_STATES[name]
