"""The works that ``gr1.py`` measures; most return their result in a few words."""

import json
import time
from collections.abc import Callable

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.synthesis import Limits, Manager
from sysmlc.synthesis.algebra.fair_systems import DomainError
from sysmlc.synthesis.algebra.refinement import find_refinement_failures
from sysmlc.synthesis.controller_synthesis import synthesise_controller
from sysmlc.synthesis.decision import Options, decide, find_deadline
from sysmlc.synthesis.games.game import make_game
from sysmlc.synthesis.unrealizable import find_unrealizable_core

LIMIT = 600.0
"""CPU seconds after which a work is aborted."""
ROUNDS = 3
LONG = 5.0
"""CPU seconds; a work that takes longer is measured once."""
OPTIONS = Options(limits=Limits(seconds=LIMIT))
_VERDICTS = {None: "not decided", True: "realizable", False: "unrealizable"}
TIMER = 15
"""Largest value of a timer."""


def measure_best(work: Callable[[], str]) -> tuple[float, str]:
    """Return the least CPU seconds of several rounds, and the result."""
    runs = [_measure_once(work)]
    while len(runs) < ROUNDS and runs[0][0] < LONG:
        runs.append(_measure_once(work))
    return min(runs)


def _measure_once(work: Callable[[], str]) -> tuple[float, str]:
    start = time.process_time()
    result = work()
    return time.process_time() - start, result


def read_contract(name: str, text: str) -> Contract:
    """Return the only contract of a text."""
    (contract,) = formats.read(text, name, Sink())
    return contract


def decide_contract(name: str, text: str) -> str:
    """Read a contract and decide whether it is realizable."""
    verdict = decide(read_contract(name, text), lambda origin: Subject(), Sink(), OPTIONS)
    nodes = f", {verdict.figures.nodes:,} nodes" if verdict.figures else ""
    return f"{_VERDICTS[verdict.is_realizable]}{nodes}"


def synthesise_contract(name: str, text: str) -> str:
    """Decide a contract, synthesise a controller and verify it."""
    contract = read_contract(name, text)
    synthesis = synthesise_controller(contract, lambda origin: Subject(), Sink(), OPTIONS)
    return synthesis.text().split("; ")[-1]


def find_core(name: str, text: str) -> str:
    """Find guarantees of an unrealizable contract that no system satisfies together."""
    contract = read_contract(name, text)
    core = find_unrealizable_core(make_game(contract, Manager(limits=OPTIONS.limits)))
    return f"core of {len(core)} of {len(contract.guarantees)}"


def check_refinement(concrete: str, abstract: str) -> str:
    """Check whether the first contract refines the second one."""
    pair = (
        read_contract("concrete.gr1.json", concrete),
        read_contract("abstract.gr1.json", abstract),
    )
    try:
        failures = list(find_refinement_failures(*pair, lambda: Manager(limits=OPTIONS.limits)))
    except DomainError as problem:
        return f"not comparable: {problem}"
    return f"no, {len(failures)} conjuncts fail" if failures else "refines"


def measure_deadline(name: str, text: str) -> tuple[float, int | None]:
    """Return the CPU seconds for the smallest bound of the timers, and that bound.

    A contract without timers gets one.
    """
    start, data = time.process_time(), json.loads(text)
    if "tm0" not in data["variables"]:
        _add_timer(data)
    contract = read_contract(name, json.dumps(data))
    timers = [v.name for v in contract.variables if v.name.startswith("tm")]
    deadline = find_deadline(contract, timers, lambda origin: Subject(), Sink(), OPTIONS)
    return time.process_time() - start, deadline.bound


def _add_timer(data: dict[str, dict[str, object]]) -> None:
    """Add a timer that counts the steps since robot 0 was last at its target."""
    data["variables"]["tm0"] = {"owner": "env", "type": [0, TIMER]}
    init, safety = (data["assumptions"][kind] for kind in ("init", "safety"))
    assert isinstance(init, list)
    assert isinstance(safety, list)
    init.append("tm0=0")
    safety += [
        "pos0=tgt0 -> tm0'=0",
        f"pos0!=tgt0 & tm0!={TIMER} -> tm0'=tm0+1",
        f"pos0!=tgt0 & tm0={TIMER} -> tm0'={TIMER}",
    ]
