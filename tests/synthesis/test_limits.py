"""Limits are checked within operations on decision diagrams, not only between them."""

import gc
import signal
import subprocess
import sys
import time
import weakref
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from contracts_in_lines import describe_elevator, parse_contract

from sysmlc.cli.group import sysmlc
from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.synthesis import LimitError, Limits, Manager
from sysmlc.synthesis import decision as deciding
from sysmlc.synthesis.algebra.refinement import find_refinement_failures
from sysmlc.synthesis.bdd import limits as inside
from sysmlc.synthesis.bdd.limits import Progress
from sysmlc.synthesis.bdd.variable_order import VariableOrder
from sysmlc.synthesis.decision import Options, decide
from sysmlc.synthesis.games.game import make_game

RUNAWAY = """{
  "name": "runaway",
  "variables": {
    "a": {"owner": "env", "type": [0, 65535]},
    "b": {"owner": "env", "type": [0, 65535]},
    "c": {"owner": "sys", "type": [0, 65535]}
  },
  "assumptions": {"init": [], "safety": [], "liveness": []},
  "guarantees": {"init": [], "safety": ["a*b = c*c + 1"], "liveness": ["c = a"]}
}"""
"""One conjunct whose diagram exceeds any memory: only checks within an operation can end it."""
FOLLOWER = """{
  "name": "follower",
  "variables": {
    "asked": {"owner": "env", "type": "bool"},
    "done": {"owner": "sys", "type": "bool"}
  },
  "assumptions": {"init": [], "safety": [], "liveness": []},
  "guarantees": {"init": [], "safety": ["done = asked"], "liveness": ["done | !asked"]}
}"""


def runaway() -> Contract:
    (contract,) = formats.read(RUNAWAY, "runaway.gr1.json", Sink())
    return contract


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "runaway.gr1.json"
    path.write_text(RUNAWAY, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("option", "reached"),
    [
        (("--time-limit", "0.3"), "the limit of 0.3 s of CPU time was reached"),
        (("--nodes", "50000"), "the limit of 50,000 nodes was reached"),
        (("--memory-limit", "0.04"), "the limit of 0.04 GiB of memory was reached"),
    ],
)
def test_a_reached_limit_ends_the_run_and_is_reported(
    file: Path, tmp_path: Path, option: tuple[str, str], reached: str
) -> None:
    out = tmp_path / "out"

    result = CliRunner().invoke(sysmlc, ["synth", str(file), *option, "-o", str(out)])

    assert result.exit_code == 2
    assert "SM531" in result.output
    assert reached in result.output
    assert "translating the contract" in result.output
    assert not out.exists()


def test_a_game_shorter_than_the_first_clock_check_obeys_the_limit_of_nodes(
    tmp_path: Path,
) -> None:
    file = tmp_path / "follower.gr1.json"
    file.write_text(FOLLOWER, encoding="utf-8")

    few = CliRunner().invoke(sysmlc, ["synth", str(file), "--realizable", "--nodes", "1"])
    many = CliRunner().invoke(sysmlc, ["synth", str(file), "--realizable", "--nodes", "1000"])

    assert (few.exit_code, "the limit of 1 node was reached" in few.output) == (2, True)
    assert many.exit_code == 0, many.output


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux enforces memory limits")
def test_without_memory_diagrams_fail_and_the_process_goes_on() -> None:
    code = f"""
import resource
from sysmlc.diagnostics import Sink
from sysmlc.logic import formats
from sysmlc.synthesis import LimitError, Manager, make_game

(contract,) = formats.read({RUNAWAY!r}, "runaway.gr1.json", Sink())
resource.setrlimit(resource.RLIMIT_DATA, (48 << 20, 48 << 20))
manager = Manager("cudd")
try:
    with manager.guard():
        make_game(contract, manager)
except LimitError as problem:
    print(problem)
"""
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (process.returncode, process.stdout) == (0, "the limit of 8 GiB of memory was reached\n")


def test_many_variables_are_declared_before_limits_apply() -> None:
    # CUDD asks whether to stop when about 1,000 bits are declared, and counting nodes failed then.
    lines = [f"sys x{number}: bool" for number in range(600)]
    contract = parse_contract("\n".join((*lines, "promise recurs x0")))

    assert decide(contract, lambda _: Subject(), Sink(), Options()).is_realizable


def test_refinement_obeys_limits() -> None:
    contract = runaway()
    weaker = Contract(contract.component, contract.origin, contract.variables, (), ())

    with pytest.raises(LimitError, match="CPU time"):
        list(
            find_refinement_failures(weaker, contract, lambda: Manager("cudd", Limits(seconds=0.3)))
        )


@pytest.fixture
def press_ctrl_c_soon() -> Iterator[None]:
    """Press Ctrl-C after some CPU time, even if the tests run in the background.

    A shell may ignore Ctrl-C for background processes. The timer repeats, because an interrupt
    during a garbage collection is lost.
    """
    previous_interrupt = signal.signal(signal.SIGINT, signal.default_int_handler)
    previous_alarm = signal.signal(signal.SIGVTALRM, lambda number, frame: signal.raise_signal(2))
    signal.setitimer(signal.ITIMER_VIRTUAL, 0.3, 3.0)
    yield
    signal.setitimer(signal.ITIMER_VIRTUAL, 0)
    signal.signal(signal.SIGVTALRM, previous_alarm)
    signal.signal(signal.SIGINT, previous_interrupt)


@pytest.mark.usefixtures("press_ctrl_c_soon")
def test_ctrl_c_ends_an_operation() -> None:
    handler = signal.getsignal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        make_game(runaway(), Manager("cudd"))

    assert signal.getsignal(signal.SIGINT) is handler


@pytest.mark.usefixtures("press_ctrl_c_soon")
def test_ctrl_c_is_neither_a_verdict_nor_a_failure(file: Path) -> None:
    assert CliRunner().invoke(sysmlc, ["synth", str(file), "--realizable"]).exit_code == 130


def test_diagrams_that_outlive_their_manager_still_work() -> None:
    manager = Manager("cudd", Limits(seconds=0.001))
    manager.declare(["a", "b"])
    conjunction = manager.var("a") & manager.var("b")
    del manager
    gc.collect()

    assert conjunction & ~conjunction == conjunction & ~conjunction
    assert len(conjunction) == 3


def test_no_callback_is_installed_in_an_unknown_library() -> None:
    class Other:
        vars: tuple[str, ...] = ()

        def is_over(self) -> bool:
            return True

    library = SimpleNamespace(__file__="no library.so")

    assert not inside.install_termination_callback(library, Other(), Other())  # type: ignore[arg-type]


def test_an_abandoned_decision_leaves_no_reference_cycle(monkeypatch: pytest.MonkeyPatch) -> None:
    """The collector of a reference cycle may free the manager before its diagrams."""
    managers: list[weakref.ref[Manager]] = []

    def create_manager(
        engine: str, limits: Limits, progress: Progress, start_time: float
    ) -> Manager:
        manager = Manager(engine, limits, progress, start_time)
        managers.append(weakref.ref(manager))
        return manager

    monkeypatch.setattr(deciding, "Manager", create_manager)
    # In tests, the automatic garbage collection is off (conftest.py).
    assert not gc.isenabled()
    # Above the nodes of a first attempt, several managers are abandoned.
    for nodes in (50_000, 400_000):
        options = Options("cudd", Limits(nodes=nodes))
        verdict = decide(runaway(), lambda origin: Subject(), Sink(), options)
        assert verdict.is_realizable is None
    assert [reference() for reference in managers] == [None] * 4


def test_no_time_is_lost_in_reordering_that_cannot_be_stopped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With calls above the floor, an elevator has a million nodes when reordering begins."""
    monkeypatch.setattr(deciding, "_FIRST_ORDERS", (VariableOrder.DECLARED,))
    monkeypatch.setattr(deciding, "_FIRST_CEILING", 0)
    start = time.process_time()
    options = Options("cudd", Limits(seconds=2.0))
    verdict = decide(parse_contract(describe_elevator(20)), lambda o: Subject(), Sink(), options)
    assert verdict.is_realizable is None
    assert time.process_time() - start < 2.0 * 1.2 + 0.2
