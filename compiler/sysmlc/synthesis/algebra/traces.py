"""Runs as witnesses: a path to a state, and a loop in which the run continues forever."""

from collections.abc import Mapping

from msgspec import Struct

from sysmlc.logic.formula import Literal
from sysmlc.synthesis.algebra.fair_systems import Runs
from sysmlc.synthesis.bdd.manager import Node


class Trace(Struct, frozen=True):
    """Values of all variables in each step; after the last step the run continues at step ``loop``.

    A run that ends because somebody has no answer has ``loop`` behind its last step, in which the
    variables of the missing answer have no value.
    """

    steps: tuple[Mapping[str, Literal], ...]
    loop: int


def shortest_path(runs: Runs, target: Node) -> list[Node]:
    """Return the states of a shortest path from an initial state to *target*.

    Raises ValueError if *target* is not reachable.
    """
    frontiers = [runs.system.init]
    reached = frontiers[0]
    while frontiers[-1] & target == runs.manager.false:
        frontier = runs.successors(frontiers[-1]) & ~reached
        if frontier == runs.manager.false:
            raise ValueError("the target is not reachable")
        frontiers.append(frontier)
        reached = reached | frontier
    path = [pick_state(runs, frontiers[-1] & target)]
    for frontier in reversed(frontiers[:-1]):
        path.insert(0, pick_state(runs, frontier & runs.predecessors(path[0])))
    return path


def build_lasso(runs: Runs, path: list[Node], within: Node) -> Trace:
    """Extend a path by a fair run inside *within*, from whose states fair runs continue.

    The extension visits each goal in turn and then returns to its begin. If there is no way back,
    the same is tried one step later; since the choice in a state depends only on the state, this
    ends.

    Raises ValueError if no fair run continues.
    """
    extended = list(path)
    while True:
        anchor = len(extended) - 1
        for goal in runs.goals:
            extended += _shortest_walk(runs, extended[-1], within, within & goal)
        closing = _shortest_walk(runs, extended[-1], within, extended[anchor], may_stay=False)
        if closing:
            return _decode_trace(runs, extended + closing[:-1], anchor)
        successors = runs.successors(extended[-1]) & within
        if successors == runs.manager.false:
            raise ValueError("no fair run goes on from here")
        extended.append(pick_state(runs, successors))


def pick_state(runs: Runs, states: Node) -> Node:
    """Return one of the states, always the same one."""
    assignment = runs.manager.pick(states, runs.bits)
    return runs.manager.false if assignment is None else runs.manager.cube(assignment)


def _shortest_walk(
    runs: Runs, start: Node, within: Node, target: Node, may_stay: bool = True
) -> list[Node]:
    """Return the states after *start* on a shortest path to *target*, or an empty list if there is
    none.

    It is also empty if *start* is in *target*, unless ``may_stay`` is false.
    """
    if may_stay and start & target != runs.manager.false:
        return []
    layers = runs.rings(within, target & within)
    state = start
    walk: list[Node] = []
    successors = runs.successors(start)
    distance = next(
        (index for index, layer in enumerate(layers) if layer & successors != runs.manager.false),
        None,
    )
    if distance is None:
        return []
    for layer in reversed(layers[: distance + 1]):
        state = pick_state(runs, layer & runs.successors(state))
        walk.append(state)
    return walk


def _decode_trace(runs: Runs, states: list[Node], loop: int) -> Trace:
    symbols = runs.system.symbols
    assignments = (runs.manager.pick(state, runs.bits) or {} for state in states)
    return Trace(tuple(symbols.decode(assignment) for assignment in assignments), loop)
