"""Robots and compiled environment together, step by step, in many runs at once.

A step is that of the contracts: the environment moves the robots by their commands, gives targets
and shows ways; then each robot's machine answers with a command (MOOD4I thesis, 4.4.1).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Generic

from msgspec import Struct

from sysmlc.robots.answers import Answers, Memory, exceeds_travel_limit
from sysmlc.robots.run_sets import P, RunSpace, union
from sysmlc.robots.study import WAYS, Study, next_move
from sysmlc.robots.traffic import Traffic

Allocation = tuple[tuple[int, ...], ...]
"""For each robot the numbers of its targets, in the order in which it reaches them."""


@dataclass(slots=True)
class Body(Generic[P]):
    """A robot: conditions by cell, by place in its list, by what its machine knows, by command."""

    places: list[P]
    sent: list[P]
    """On the way to a target of its list; the target stays its own until it has another one."""
    aside: list[P]
    """Sent to a cell to make way."""
    memory: dict[Memory, P]
    commands: dict[str, P]


class State(Struct, Generic[P], frozen=True):
    """All that is known between two steps: what will become of a run depends on nothing else."""

    bodies: list[Body[P]]
    done: list[P]
    """By target: it has been reached."""


class World(Generic[P]):
    """All robots; ``step`` is one step of the contracts."""

    def __init__(
        self,
        study: Study,
        allocation: Allocation,
        answers: Sequence[Answers],
        runs: RunSpace[P],
        state: State[P] | None = None,
        time: int = 0,
    ) -> None:
        """The first step, in which robots are in their starts and stay, or a ``state`` later on."""
        self.study, self.allocation, self.answers, self.runs = study, allocation, answers, runs
        none, size = runs.none, study.grid.size
        self._but = runs.but
        known = state or _first(study, allocation, runs)
        self.bodies, self.done = known.bodies, known.done[: len(study.targets)]
        self.time = time
        self.near = [tuple(study.grid.neighbours(cell)) for cell in range(size)]
        self.hops: dict[tuple[int, int], tuple[str, int] | None] = {}
        self.wrong = none
        """In which runs two robots met, one was offered a cell that is taken or offered to another
        one, one left its target without another one, or a machine had no answer."""
        self.slow = [none] * len(study.targets)
        """By target: a robot sets out to it that will have it for longer than C_S allows."""
        self.taken = self._taken()
        """By cell: a robot is there."""
        self.over = none
        """In which runs nothing is left to do: all targets are reached, and all robots rest."""
        if state is None:
            self._answer_all()

    # -- one step ------------------------------------------------------------------------------

    def step(self) -> None:
        """Move, note what was reached, decide who goes where, let the robots answer."""
        self.time += 1
        idle = [self._at_goal(number) for number in range(len(self.bodies))]
        self._move()
        for number, body in enumerate(self.bodies):
            stays = idle[number]
            body.sent = [self._but(one, stays) for one in body.sent]
            body.aside = [self._but(one, stays) for one in body.aside]
        self._note_reached()
        self._dispatch(idle)
        self._note_reached()
        self._answer_all()

    def _answer_all(self) -> None:
        self._offered = list(self.taken)
        resting = [self._resting(number) for number in range(len(self.bodies))]
        self.over = self._all_of((*self.done, *resting))
        for number, rests in enumerate(resting):
            self._answer(number, rests)

    def _all_of(self, planes: Sequence[P]) -> P:
        found = self.runs.all
        for one in planes:
            if found == self.runs.none:
                break
            found = found & one
        return found

    def _move(self) -> None:
        for body in self.bodies:
            body.places = self._moved(body)
        self.taken = self._taken()

    def _moved(self, body: Body[P]) -> list[P]:
        none, grid = self.runs.none, self.study.grid
        goes = union(list(body.commands.values()), none)
        if goes == none:
            return body.places
        found = [self._but(one, goes) for one in body.places]
        for cell in grid.cells:
            here = body.places[cell] & goes
            if here == none:
                continue
            for way, there in self.near[cell]:
                moves = here & body.commands.get(way, none)
                if moves == none:
                    continue
                self.wrong = self.wrong | (moves & self.taken[there])
                found[there] = found[there] | moves
        return found

    def _taken(self) -> list[P]:
        """By cell: a robot is there; where there are two, something is wrong."""
        none, found = self.runs.none, []
        for cell in range(self.study.grid.size):
            seen = none
            for body in self.bodies:
                here = body.places[cell]
                if here != none:
                    self.wrong = self.wrong | (seen & here)
                    seen = seen | here
            found.append(seen)
        return found

    def _note_reached(self) -> None:
        for number, body in enumerate(self.bodies):
            for place, target in enumerate(self.allocation[number]):
                cell = self.study.targets[target].cell
                arrived = body.sent[place] & body.places[cell]
                if arrived != self.runs.none:
                    self.done[target] = self.done[target] | arrived

    # -- targets -------------------------------------------------------------------------------

    def _resting(self, number: int) -> P:
        """In which runs a robot has no target but the cell that it is in."""
        body, none = self.bodies[number], self.runs.none
        return self._but(self.runs.all, union([*body.sent, *body.aside], none))

    def _at_goal(self, number: int) -> P:
        """In which runs a robot is in its target."""
        body = self.bodies[number]
        found = self._resting(number)
        for place, target in enumerate(self.allocation[number]):
            is_there = body.sent[place] & body.places[self.study.targets[target].cell]
            found = found if is_there == self.runs.none else found | is_there
        for cell in self.study.grid.cells:
            is_there = body.aside[cell] & body.places[cell]
            found = found if is_there == self.runs.none else found | is_there
        return found

    def _dispatch(self, idle: list[P]) -> None:
        goals = [[self.study.targets[one].cell for one in own] for own in self.allocation]
        places = [body.places for body in self.bodies]
        traffic = Traffic(self.study.grid, self.runs, places, self.taken, list(idle), goals)
        for number, body in enumerate(self.bodies):
            traffic.reserve(traffic.ways(number, body.sent))
            traffic.reserve(body.aside)
        open_ = [self._open(number, idle[number]) for number in range(len(self.bodies))]
        decided = traffic.send(open_)
        if self.study.within is not None:
            self._note_slow(decided.out, self.study.within)
        for number, body in enumerate(self.bodies):
            pairs = zip(body.sent, decided.out[number], strict=True)
            body.sent = [one | more for one, more in pairs]
            sides = zip(body.aside, decided.aside[number], strict=True)
            body.aside = [one | more for one, more in sides]

    def _note_slow(self, out: Sequence[Sequence[P]], within: int) -> None:
        """In which runs robots set out on ways that are too long (the timer of C_S)."""
        for number, own in enumerate(self.allocation):
            for target, sent in zip(own, out[number], strict=True):
                for cell, here in enumerate(self.bodies[number].places):
                    both, goal = here & sent, self.study.targets[target].cell
                    if both != self.runs.none and exceeds_travel_limit(
                        self.study.grid, self.answers[number], cell, goal, within
                    ):
                        self.slow[target] = self.slow[target] | both

    def _open(self, number: int, idle: P) -> list[P]:
        """By place in its list: the robot could set out to that target now."""
        found: list[P] = []
        before = idle
        for target in self.allocation[number]:
            ready = self._but(before, self.done[target])
            for earlier in self.study.earlier(target):
                ready = ready & self.done[earlier]
            found.append(ready)
            before = before & self.done[target]
        return found

    # -- answers -------------------------------------------------------------------------------

    def _answer(self, number: int, resting: P) -> None:
        """The command of a robot's machine, and what it knows then."""
        body = self.bodies[number]
        memory, body.memory, body.commands = body.memory, {}, {}
        for known, is_so in memory.items():
            if not known.is_home:
                self._row(number, known, known.goal, is_so)
            elif is_so != self.runs.none:
                for goal, has in self._targets(number, known.cell, resting):
                    self._row(number, known, goal, is_so & has)

    def _targets(self, number: int, cell: int, resting: P) -> Iterator[tuple[int, P]]:
        """The targets that a robot in a cell can be given, with the runs in which it is."""
        body = self.bodies[number]
        yield cell, resting
        for place, target in enumerate(self.allocation[number]):
            yield self.study.targets[target].cell, body.sent[place]
        for _, there in self.near[cell]:
            yield there, body.aside[there]

    def _row(self, number: int, known: Memory, goal: int, given: P) -> None:
        none = self.runs.none
        if given == none:
            return
        step = self._hop(known.cell, goal)
        if step is not None:
            self._shown(number, known, goal, step, given)
            return
        if self.over != none and number == self.time % len(self.bodies):
            given = self._in_turn(number, known, given)
        self._told(number, known, goal, "", given)

    def _in_turn(self, number: int, known: Memory, given: P) -> P:
        """Offer a way to a robot that rests when nothing is left to do; where none is free.

        Each robot has its turn again and again, as C_E promises it, and stays as C_R promises.
        """
        for step in self.near[known.cell]:
            free = self._but(given & self.over, self.taken[step[1]])
            if free != self.runs.none:
                self._shown(number, known, known.cell, step, free)
                given = self._but(given, free)
        return given

    def _shown(
        self, number: int, known: Memory, goal: int, step: tuple[str, int], given: P
    ) -> None:
        self._offer(step[1], given)
        self._told(number, known, goal, step[0], given)

    def _told(self, number: int, known: Memory, goal: int, way: str, given: P) -> None:
        """What a robot answers to its target and the way that it is shown."""
        none, body = self.runs.none, self.bodies[number]
        if given == none:
            return
        answer = self.answers[number].get(known, goal, way)
        if answer is None:
            self.wrong = self.wrong | given
            return
        body.memory[answer.memory] = body.memory.get(answer.memory, none) | given
        if answer.command in WAYS:
            if goal == known.cell:
                self.wrong = self.wrong | given
            body.commands[answer.command] = body.commands.get(answer.command, none) | given

    def _hop(self, cell: int, goal: int) -> tuple[str, int] | None:
        key = cell, goal
        if key not in self.hops:
            self.hops[key] = next_move(self.study.grid, cell, goal)
        return self.hops[key]

    def _offer(self, cell: int, given: P) -> None:
        """Offer a cell to a robot: one that is free, and offered to no other (C_E)."""
        self.wrong = self.wrong | (given & self._offered[cell])
        self._offered[cell] = self._offered[cell] | given


def _first(study: Study, allocation: Allocation, runs: RunSpace[P]) -> State[P]:
    """Robots in their starts, which are their targets."""
    none, size = runs.none, study.grid.size
    bodies: list[Body[P]] = [
        Body(
            list(runs.starts[at]),
            [none] * len(allocation[at]),
            [none] * size,
            {Memory(cell, cell): one for cell, one in enumerate(runs.starts[at])},
            {},
        )
        for at in range(len(study.robots))
    ]
    return State(bodies, [none] * len(study.targets))
