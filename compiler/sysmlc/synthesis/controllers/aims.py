"""What a controller aims at: for each goal, which states have to come next, the nearest ones first.

Piterman, Pnueli, Sa'ar 2006, section 4: in each step the system comes to the nearest layer of the
goal that the inputs leave; where none is nearer it waits among states in which an assumption does
not recur. The first choice hardly depends on where the system is, so that little is remembered.
"""

from collections.abc import Callable, Collection, Iterator

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Steps
from sysmlc.synthesis.games.layers import Layer
from sysmlc.synthesis.games.solve import Solution


def aims(
    solution: Solution,
    steps: Steps,
    goal: int,
    leading: Callable[[Node], Node],
    bits: Collection[str],
) -> Iterator[Node]:
    """What may be chosen on the way to a goal: each says it of other places.

    ``steps`` are those of the arena. ``leading`` gives all choices of values of ``bits`` that lead
    to given states for certain; what leads nowhere leaves the environment without a next input,
    which is best of all. A state in which this goal holds and another does not has no aim: the
    other one is in turn.
    """
    manager = solution.arena.manager
    done = waiting = before = manager.false
    nowhere = Layer(manager.false, ())
    for layer in (nowhere, *solution.layers[goal]):
        manager.check("looking for what to do")
        for here, there in _waits(solution, steps, goal, layer, before):
            where = here & ~done
            yield where & leading(there)
            waiting = waiting | here
        possible = leading(layer.states)
        able = manager.exist(manager.support(possible).intersection(bits), possible)
        where = able & ~done & ~waiting
        yield where & possible
        done, before = done | able, layer.states


def _waits(
    solution: Solution, steps: Steps, goal: int, layer: Layer, before: Node
) -> Iterator[tuple[Node, Node]]:
    """From which states of a layer the system may wait, and where."""
    if not layer.waiting:
        return
    arena = solution.arena
    met = arena.goals[goal] if arena.goals else arena.manager.true
    left = layer.states & solution.winning & ~before & ~met
    left = left & ~steps.controllable(before)
    for waiting in layer.waiting:
        here = left & waiting
        if here != arena.manager.false:
            yield here, waiting | before
        left = left & ~waiting
