"""The scenarios of the examples pass, and fail when an input or an expected value is changed."""

import pytest

from examples.compiling import ROOT, compile_example
from sysmlc.diagnostics import Sink
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source

SCENARIOS = sorted((ROOT / "examples").glob("*/scenarios/*.yaml"))


def run_scenario(path, change=("", "")):
    (model,) = (p for p in path.parents[1].iterdir() if p.suffix in (".uml", ".sysml"))
    sink = Sink()
    text = path.read_text(encoding="utf-8")
    assert change[0] in text
    source = Source(path.name, text.replace(*change, 1).encode())
    report = run_scenarios(compile_example(model, "ir").graph, source, sink)
    return report, [diagnostic.message for diagnostic in sink]


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_the_scenarios_of_an_example_pass(path):
    report, messages = run_scenario(path)
    assert messages == []
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
def test_a_changed_input_fails_the_scenario(name, change):
    path = next(path for path in SCENARIOS if path.stem == name)
    report, messages = run_scenario(path, change)
    assert messages == []
    assert not report.passed


def test_the_examples_have_scenarios():
    assert [path.stem for path in SCENARIOS][:2] == ["gate", "stopper"]
