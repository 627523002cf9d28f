"""The scenarios beside the examples pass, and would fail if the diagram did something else."""

import pytest

from examples.compiling import ROOT, compile_example
from sysmlc.diagnostics import Sink
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source

SCENARIOS = sorted((ROOT / "examples").glob("*/scenarios/*.yaml"))


def play(path, change=("", "")):
    (model,) = path.parents[1].glob("*.uml")
    sink = Sink()
    text = path.read_text(encoding="utf-8")
    assert change[0] in text
    source = Source(path.name, text.replace(*change, 1).encode())
    report = run_scenarios(compile_example(model, "ir").graph, source, sink)
    return report, [found.message for found in sink]


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_the_scenarios_of_an_example_pass(path):
    report, complaints = play(path)
    assert complaints == []
    assert report.passed, report.as_text()


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("gate", ("{palletId: palletB, expectedId: palletA}", "{palletId: palletA}")),
        ("gate", ("bay: free}", "bay: occupied}")),
        ("gate", ("receive_ProductionCompleted: true", "receive_ProductionCompleted: false")),
        ("stopper", ("{mode: bypass}", "{mode: automatic}")),
        ("stopper", ("palletPresent: true", "palletPresent: false")),
        ("stopper", ("event: release}", "event: none}")),
    ],
)
def test_another_input_fails_a_scenario(name, change):
    path = next(path for path in SCENARIOS if path.stem == name)
    report, complaints = play(path, change)
    assert complaints == []
    assert not report.passed


def test_there_are_scenarios():
    assert [path.stem for path in SCENARIOS][:2] == ["gate", "stopper"]
