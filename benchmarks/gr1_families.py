"""Families of contracts of growing size: an elevator, an arbiter, counters, a production line.

Each is generated with its variables declared in several orders, because a decision must not depend
on the order of declarations.
"""

import random
from collections.abc import Callable, Iterable
from itertools import combinations

from msgspec import Struct

Declarations = dict[str, dict[str, object]]
"""Owner and type of each variable."""
_SEED = 21


class Family(Struct, frozen=True):
    """A contract of one size, and the CPU seconds in which it shall be decided."""

    name: str
    contract: dict[str, object]
    limit: float


ORDERS: dict[str, Callable[[Declarations], Iterable[str]]] = {
    "declared": list,
    "reversed": lambda variables: reversed(variables),
    "shuffled": lambda variables: random.Random(_SEED).sample(list(variables), len(variables)),
}


def build_families() -> list[Family]:
    """Return the contracts that are measured."""
    return [
        Family("elevator_20", build_elevator(20), 0.6),
        Family("elevator_30", build_elevator(30), 1.2),
        Family("arbiter_16", build_arbiter(16), 0.6),
        Family("counters_5x8", build_counters(5, 7), 0.4),
        Family("line_7", build_line(7), 2.0),
    ]


def reorder_variables(contract: dict[str, object], order: str) -> dict[str, object]:
    """Return the contract with its variables declared in another of the ``ORDERS``."""
    variables = contract["variables"]
    assert isinstance(variables, dict)
    names = ORDERS[order](variables)
    return contract | {"variables": {name: variables[name] for name in names}}


def build_elevator(floors: int) -> dict[str, object]:
    """Return an elevator that answers each call at its floor with the door open.

    A call stays until it is answered. The elevator moves by one floor, with the door closed, and
    only if there is a call. The door opens only for a call.
    """
    calls = range(floors)
    return {
        "name": f"elevator_{floors}",
        "variables": {
            **{f"call{floor}": {"owner": "env", "type": "bool"} for floor in calls},
            "floor": {"owner": "sys", "type": [0, floors - 1]},
            "open": {"owner": "sys", "type": "bool"},
        },
        "assumptions": {
            "init": [],
            "safety": [f"call{n} & !(floor={n} & open) -> call{n}'" for n in calls],
            "liveness": [],
        },
        "guarantees": {
            "init": ["floor=0", "!open"],
            "safety": [
                "floor'=floor | floor'=floor+1 | floor'=floor-1",
                "open | open' -> floor'=floor",
                *(f"open' & floor'={n} -> call{n}'" for n in calls),
                " & ".join(f"!call{n}" for n in calls) + " -> floor'=floor",
            ],
            "liveness": [f"call{n} -> floor={n} & open" for n in calls],
        },
    }


def build_arbiter(clients: int) -> dict[str, object]:
    """Return an arbiter that grants each request, one at a time, and grants nothing unasked."""
    numbers = range(clients)
    return {
        "name": f"arbiter_{clients}",
        "variables": {
            **{f"request{n}": {"owner": "env", "type": "bool"} for n in numbers},
            **{f"grant{n}": {"owner": "sys", "type": "bool"} for n in numbers},
        },
        "assumptions": {
            "init": [f"!request{n}" for n in numbers],
            "safety": [
                *(f"request{n} & !grant{n} -> request{n}'" for n in numbers),
                *(f"!request{n} & grant{n} -> !request{n}'" for n in numbers),
            ],
            "liveness": [f"!(request{n} & grant{n})" for n in numbers],
        },
        "guarantees": {
            "init": [f"!grant{n}" for n in numbers],
            "safety": [
                *(f"!(grant{a} & grant{b})" for a, b in combinations(numbers, 2)),
                *(f"request{n}' & grant{n} -> grant{n}'" for n in numbers),
                *(f"!request{n}' & !grant{n} -> !grant{n}'" for n in numbers),
            ],
            "liveness": [f"request{n} <-> grant{n}" for n in numbers],
        },
    }


def build_counters(counters: int, largest: int) -> dict[str, object]:
    """Return counters of which the environment permits one to step; each reaches both its ends."""
    numbers = range(counters)
    steps = "(c{n}'=c{n}+1 | c{n}'=c{n}-1 | c{n}'=c{n})"
    return {
        "name": f"counters_{counters}",
        "variables": {
            **{f"c{n}": {"owner": "sys", "type": [0, largest]} for n in numbers},
            **{f"permit{n}": {"owner": "env", "type": "bool"} for n in numbers},
        },
        "assumptions": {
            "init": [],
            "safety": [],
            "liveness": [f"permit{n}" for n in numbers],
        },
        "guarantees": {
            "init": [f"c{n}=0" for n in numbers],
            "safety": [
                *(steps.format(n=n) for n in numbers),
                *(f"!permit{n}' -> c{n}'=c{n}" for n in numbers),
            ],
            "liveness": [f"c{n}={end}" for n in numbers for end in (0, largest)],
        },
    }


def build_line(machines: int) -> dict[str, object]:
    """Return a line of machines that pass pieces on; each machine is idle, working or done.

    The environment brings pieces and ends the work of machines. Only the last machine may be
    emptied without a next machine, which must be idle otherwise.
    """
    numbers = range(machines)
    safety = []
    for n in numbers:
        machine, following = f"m{n}", f"m{n + 1}"
        receives = "piece'" if n == 0 else f"(m{n - 1}=done & m{n - 1}'=idle)"
        passes_on = "true" if n == machines - 1 else f"{following}=idle & {following}'=working"
        safety += [
            f"{machine}=idle & {machine}'!=idle -> {machine}'=working & {receives}",
            f"{machine}=working & !end{n}' -> {machine}'=working",
            f"{machine}=working & end{n}' -> {machine}'=done",
            f"{machine}=done & {machine}'!=done -> {machine}'=idle & {passes_on}",
        ]
        if n:
            safety.append(f"m{n - 1}=done & m{n - 1}'=idle -> {machine}'=working")
    states = ["idle", "working", "done"]
    return {
        "name": f"line_{machines}",
        "variables": {
            "piece": {"owner": "env", "type": "bool"},
            **{f"end{n}": {"owner": "env", "type": "bool"} for n in numbers},
            **{f"m{n}": {"owner": "sys", "type": states} for n in numbers},
        },
        "assumptions": {
            "init": [],
            "safety": [],
            "liveness": ["piece", *(f"end{n}" for n in numbers)],
        },
        "guarantees": {
            "init": [f"m{n}=idle" for n in numbers],
            "safety": safety,
            "liveness": [f"m{n}={state}" for n in numbers for state in states],
        },
    }
