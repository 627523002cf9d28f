"""Runs as witnesses: a way to what is looked for, and a loop in which it goes on for ever."""

from collections.abc import Mapping

from msgspec import Struct

from sysmlc.logic.formula import Literal
from sysmlc.synthesis.algebra.fair_systems import Runs
from sysmlc.synthesis.bdd.manager import Node


class Trace(Struct, frozen=True):
    """Values of all variables in each step; after the last one it goes on at ``loop``.

    A run that ends, since somebody has no answer, has ``loop`` behind its last step, in which
    what should have been answered has no value.
    """

    steps: tuple[Mapping[str, Literal], ...]
    loop: int


def shortest(runs: Runs, target: Node) -> list[Node]:
    """States of a shortest way from the start to the target, one state each.

    Raises ValueError when no way leads there.
    """
    fronts = [runs.system.init]
    known = fronts[0]
    while fronts[-1] & target == runs.manager.false:
        front = runs.after(fronts[-1]) & ~known
        if front == runs.manager.false:
            raise ValueError("the target is not reachable")
        fronts.append(front)
        known = known | front
    way = [one(runs, fronts[-1] & target)]
    for front in reversed(fronts[:-1]):
        way.insert(0, one(runs, front & runs.before(way[0])))
    return way


def lasso(runs: Runs, way: list[Node], within: Node) -> Trace:
    """The way, gone on from its last state by a fair run within states that all have one.

    From each goal to the next, then back to where that began; where no way leads back, the same
    is tried one step on. What is done in a state depends on it alone, so that it comes to an end.

    Raises ValueError where a state has no fair run within ``within``.
    """
    path = list(way)
    while True:
        anchor = len(path) - 1
        for goal in runs.goals:
            path += _walk(runs, path[-1], within, within & goal)
        closing = _walk(runs, path[-1], within, path[anchor], may_stay=False)
        if closing:
            return _trace(runs, path + closing[:-1], anchor)
        onward = runs.after(path[-1]) & within
        if onward == runs.manager.false:
            raise ValueError("no fair run goes on from here")
        path.append(one(runs, onward))


def one(runs: Runs, states: Node) -> Node:
    """One of the states, the same one every time."""
    found = runs.manager.pick(states, runs.bits)
    return runs.manager.false if found is None else runs.manager.cube(found)


def _walk(runs: Runs, start: Node, within: Node, target: Node, may_stay: bool = True) -> list[Node]:
    """States after ``start`` on a shortest way to the target; empty when there is none.

    Already there it is empty too, unless a step has to be taken (``may_stay`` false).
    """
    if may_stay and start & target != runs.manager.false:
        return []
    rings = runs.rings(within, target & within)
    at = start
    found: list[Node] = []
    step = runs.after(start)
    place = next((i for i, ring in enumerate(rings) if ring & step != runs.manager.false), None)
    if place is None:
        return []
    for ring in reversed(rings[: place + 1]):
        at = one(runs, ring & runs.after(at))
        found.append(at)
    return found


def _trace(runs: Runs, states: list[Node], loop: int) -> Trace:
    symbols = runs.system.symbols
    found = (runs.manager.pick(state, runs.bits) or {} for state in states)
    return Trace(tuple(symbols.decode(one) for one in found), loop)
