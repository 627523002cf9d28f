"""Analyses on demand, and back ends that read verdicts, diagnostics and the files of the others."""

from dataclasses import dataclass, replace

import pytest
from driver_helpers import OutlineBackend

import sysmlc
from sysmlc.analyses.analysis import analyse, load
from sysmlc.analyses.verdicts import ContractChecks
from sysmlc.diagnostics import Sink
from sysmlc.driver import BackendError, Observer, Request, compile_model, open_texts
from sysmlc.driver.registry import list_needs
from sysmlc.synthesis.controller_synthesis import Synthesis

LAMP = """package Plant {
    part def Lamp {
        in attribute wanted : ScalarValues::Boolean;
        out attribute lit : ScalarValues::Boolean;
        attribute count : ScalarValues::Integer;
    }
    requirement def Shines {
        subject lamp : Lamp;
        require constraint lights { language "ltl" /* G (wanted -> X lit) */ }
    }
}
"""


@dataclass(frozen=True)
class Summary(OutlineBackend):
    """Write one page about verdicts, controllers, diagnostics and the other files."""

    name: str = "summary"
    needs: tuple[str, ...] = ("verdicts", "controllers")
    is_last: bool = True

    def emit(self, graph, output, sink, options):
        (checks,) = graph.derived(ContractChecks)
        lines = [result.verdict.text().partition(" (")[0] for result in checks.contracts]
        lines += [f"{item.severity}: {item.rule.name}" for item in checks.diagnostics]
        lines += [f"controller: {bool(item.machine)}" for item in graph.derived(Synthesis)]
        lines += [f"{item.severity}: {item.message}" for item in options.diagnostics]
        lines += [f"{artefact.backend}: {artefact.path}" for artefact in options.artefacts]
        output.add("summary.txt", "\n".join(lines), (), self.name)


def compile_lamp(text=LAMP, observer=None, backends=(), analyses=()):
    request = Request((), backends=backends)
    opened = open_texts({"lamp.sysml": text}, request)
    return compile_model(request, observer, opened, analyses)


def test_a_back_end_reads_verdicts_diagnostics_and_the_files_of_the_others():
    text = LAMP.replace("Integer", "Integr").replace("X lit", "X wanted")
    compilation = compile_lamp(text, backends=(Summary(), OutlineBackend()))
    (page,) = (item.text for item in compilation.artefacts if item.path == "summary.txt")
    # The error about the type withholds outlines/Lamp.txt.
    assert page.splitlines() == [
        "Plant::Lamp: unrealizable",
        "error: contract-unrealizable",
        "warning: decided-by-the-other",
        "controller: False",
        "error: unknown name 'ScalarValues::Integr'",
        "outline: outlines/Shines.txt",
    ]
    assert [finding.rule.code for finding in compilation.diagnostics] == ["SM205"]


def test_a_back_end_that_is_not_last_gets_neither_diagnostics_nor_files():
    class Early(Summary):
        is_last = False

    compilation = compile_lamp(backends=(OutlineBackend(), Early(is_last=False)))
    (page,) = (item.text for item in compilation.artefacts if item.path == "summary.txt")
    assert "outline" not in page


def test_a_back_end_cannot_need_an_unknown_analysis():
    with pytest.raises(BackendError, match="'verdict'; did you mean 'verdicts'"):
        list_needs([replace(Summary(), needs=("verdict",))])


def test_contracts_are_decided_again_after_a_change_of_the_graph():
    graph = compile_lamp().graph
    verdicts = load("verdicts")
    sink = Sink()

    def decide():
        analyse(graph, verdicts, sink)
        (checks,) = graph.derived(ContractChecks)
        return checks

    first = decide()
    assert decide() is first
    graph.set(graph["Plant::Shines::lights"], body="F (lit & !lit)")
    second = decide()
    assert [result.verdict.is_realizable for result in first.contracts] == [True]
    assert [result.verdict.is_realizable for result in second.contracts] == [False]


def test_programs_decide_a_changed_model_again():
    compilation = sysmlc.compile_texts({"lamp.sysml": LAMP})
    (verdict,) = (result.verdict for result in sysmlc.check_contracts(compilation).contracts)
    assert verdict.is_realizable
    constraint = compilation.graph["Plant::Shines::lights"]
    compilation.graph.set(constraint, body="G (wanted & !lit)")
    (verdict,) = (result.verdict for result in sysmlc.check_contracts(compilation).contracts)
    assert verdict.is_realizable is False


def test_controllers_carry_their_findings():
    text = LAMP.replace("X lit", "X wanted")
    (contract,) = sysmlc.compile_texts({"lamp.sysml": text}).graph.derived(sysmlc.Contract)
    assert [finding.rule.code for finding in sysmlc.synthesise(contract).diagnostics] == ["SM532"]


def test_progress_shows_the_analyses_that_run():
    steps = []

    class RecordingObserver(Observer):
        def step(self, what, number, total):
            steps.append((what, total - number))

    compile_lamp(observer=RecordingObserver(), analyses=["contracts"])
    assert steps[-2:] == [("analysis activities", 2), ("analysis contracts", 1)]
