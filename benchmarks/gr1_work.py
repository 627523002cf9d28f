"""What is measured of contracts: each function does one thing and says in a few words what came."""

import json
import time
from collections.abc import Callable
from pathlib import Path

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
"""CPU seconds after which something is given up."""
ROUNDS = 3
LONG = 5.0
"""Seconds from which on one round is enough."""
OPTIONS = Options(limits=Limits(seconds=LIMIT))
_WORDS = {None: "not decided", True: "realizable", False: "unrealizable"}
TIMER = 15


def best(work: Callable[[], str]) -> tuple[float, str]:
    """The least CPU seconds of some rounds, and what came."""
    runs = [_timed(work)]
    while len(runs) < ROUNDS and runs[0][0] < LONG:
        runs.append(_timed(work))
    return min(runs)


def _timed(work: Callable[[], str]) -> tuple[float, str]:
    start = time.process_time()
    said = work()
    return time.process_time() - start, said


def read(name: str, text: str) -> Contract:
    """The one contract of a text."""
    (contract,) = formats.read(text, name, Sink())
    return contract


def decided(name: str, text: str) -> str:
    """Read, encode and solve."""
    verdict = decide(read(name, text), lambda origin: Subject(), Sink(), OPTIONS)
    nodes = f", {verdict.figures.nodes:,} nodes" if verdict.figures else ""
    return f"{_WORDS[verdict.is_realizable]}{nodes}"


def made(name: str, text: str) -> str:
    """Decide, make a controller, check it."""
    return (
        synthesise_controller(read(name, text), lambda origin: Subject(), Sink(), OPTIONS)
        .text()
        .split("; ")[-1]
    )


def cored(name: str, text: str) -> str:
    """Guarantees that cannot be kept together."""
    contract = read(name, text)
    core = find_unrealizable_core(make_game(contract, Manager(limits=OPTIONS.limits)))
    return f"core of {len(core)} of {len(contract.guarantees)}"


def refined(concrete: str, abstract: str) -> str:
    """Whether the first contract refines the second one."""
    pair = (read("one.gr1.json", concrete), read("other.gr1.json", abstract))
    try:
        failures = list(find_refinement_failures(*pair, Manager(limits=OPTIONS.limits)))
    except DomainError as problem:
        return f"not comparable: {problem}"
    return f"no, {len(failures)} conjuncts fail" if failures else "refines"


def bounded(name: str, text: str) -> tuple[float, int | None]:
    """CPU seconds, and the smallest bound of the timers, which are added if there are none."""
    start, data = time.process_time(), json.loads(text)
    if "tm0" not in data["variables"]:
        _count(data)
    contract = read(name, json.dumps(data))
    timers = [one.name for one in contract.variables if one.name.startswith("tm")]
    found = find_deadline(contract, timers, lambda origin: Subject(), Sink(), OPTIONS)
    return time.process_time() - start, found.bound


def _count(data: dict[str, dict[str, object]]) -> None:
    """Add a timer of the steps to the target of one robot."""
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


def text_of(path: Path) -> str:
    """The text of a file."""
    return path.read_text(encoding="utf-8")
