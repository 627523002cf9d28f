"""Verdicts on the specifications of the corpus: those that other solvers gave."""

import json
import os
from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Limits
from sysmlc.synthesis.decide import Options, decide

CORPUS = os.environ.get("SYSMLC_CORPUS")
FOLDERS = ("din8580", "robots")
COUNTS = {"din8580": 33, "robots": 34}
LIMITS = Limits(seconds=300)
pytestmark = [
    pytest.mark.corpus,
    pytest.mark.skipif(not CORPUS, reason="SYSMLC_CORPUS names no folder"),
]


def files(folder: str) -> list[Path]:
    return sorted(Path(CORPUS, "gr1", folder).glob("*.json")) if CORPUS else []


@pytest.mark.parametrize("path", [p for f in FOLDERS for p in files(f)], ids=lambda p: p.stem)
def test_the_verdict_is_the_recorded_one(path):
    text, sink = path.read_text(encoding="utf-8"), Sink()
    (contract,) = formats.read(text, path.name, sink)
    verdict = decide(contract, lambda origin: Subject(), sink, Options(limits=LIMITS))
    recorded = json.loads(text)["status"]
    assert verdict.is_realizable == (recorded == "realizable")


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_specification_is_there(folder):
    assert len(files(folder)) == COUNTS[folder]
