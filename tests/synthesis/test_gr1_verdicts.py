"""Verdicts on the specifications of the corpus, compared with those of authors and other solvers.

Where no verdict is recorded (corpus/gr1/README.md) the table has ours, to detect changes.
"""

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.synthesis import Limits
from sysmlc.synthesis.decision import Options, decide

CORPUS = os.environ.get("SYSMLC_CORPUS")
LIMITS = Limits(seconds=300)
SUFFIXES = {".json", ".spc", ".slugsin", ".structuredslugs", ".tlsf", ".ltl", ".spectra"}
COUNTS = {
    "din8580": 33,
    "robots": 34,
    "gr1c": 6,
    "slugs": 11,
    "tlsf_syntcomp": 10,
    "chase": 9,
    "spectra/SYNTECH15": 61,
    "spectra/SYNTECH15/unrealizable": 17,
    "spectra/forklift": 25,
    "spectra/forklift/unrealizable": 4,
}
"""Files that hold contracts, by folder."""
UNREALIZABLE = {
    "unrealizable1.slugsin": "recorded",
    "section_3_2_errorneous_spec.structuredslugs": "ours",
    "lift_wrong_physics_unreal.tlsf": "recorded in its name",
    "test_1.ltl test_1.C2": "ours",
    "test_2.ltl test_1.C2": "ours",
}
"""Unrealizable contracts outside the folders of that name, with the source of the verdict."""
SLOW = ("ColorSort", "amba", "env_9x3", "hol_16x2")
"""Prefixes of the names of slow contracts."""
OUTSIDE = {
    "HumanoidLTL_713_Humanoid_unrealizable.spectra",
    "HumanoidLTL_NotRealizable2_879_Humanoid_unrealizable.spectra",
    "HumanoidLTL_NotRealizable2_884_Humanoid_unrealizable.spectra",
}
"""Their assumptions refer to ``next_head'``, an output: the system could violate them itself."""
pytestmark = pytest.mark.corpus


def list_specifications(folder: str) -> list[Path]:
    """Return the specifications directly in a folder of the corpus."""
    paths = sorted(Path(CORPUS, "gr1", folder).iterdir()) if CORPUS else []
    return [path for path in paths if path.suffix in SUFFIXES]


def is_recorded_realizable(path: Path, text: str, contract: Contract) -> bool:
    """Whether the contract is realizable."""
    if path.suffix == ".json":
        return str(json.loads(text)["status"]) == "realizable"
    names = {path.name, f"{path.name} {contract.component}"}
    return path.parent.name != "unrealizable" and names.isdisjoint(UNREALIZABLE)


def decide_contracts(path: Path) -> Iterator[tuple[str, bool | None, bool, list[str]]]:
    """Yield for each contract its name, verdict, recorded verdict and codes of diagnostics."""
    text = path.read_text(encoding="utf-8")
    for contract in formats.read(text, path.name, Sink()):
        sink = Sink()
        verdict = decide(contract, lambda origin: Subject(), sink, Options(limits=LIMITS))
        codes = [diagnostic.rule.code for diagnostic in sink]
        yield (
            contract.component,
            verdict.is_realizable,
            is_recorded_realizable(path, text, contract),
            codes,
        )


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=pytest.mark.long if path.name.startswith(SLOW) else ())
        for folder in COUNTS
        for path in list_specifications(folder)
    ],
    ids=lambda path: path.name,
)
def test_the_verdict_is_the_recorded_one(path):
    results = list(decide_contracts(path))
    assert results
    if path.name in OUTSIDE:
        assert [(verdict, codes) for _, verdict, _, codes in results] == [(None, ["SM530"])]
    else:
        assert [result for result in results if result[1] is not result[2]] == []


@pytest.mark.parametrize("folder", COUNTS)
def test_every_specification_is_present(folder):
    assert len(list_specifications(folder)) == COUNTS[folder]


def test_the_syntax_error_of_a_published_contract_is_located():
    path, sink = Path(CORPUS or "", "gr1", "chase", "robotic_arm.ltl"), Sink()
    formats.read(path.read_text(encoding="utf-8"), path.name, sink)
    places = [(diagnostic.rule.code, diagnostic.subject.place) for diagnostic in sink]
    assert [(code, place and (place.line, place.column)) for code, place in places] == [
        ("SM583", (15, 20))
    ]
