"""The robots and the compiled environment together, simulated step by step in many runs at once.

A step is a step of the contracts: the environment moves the robots by their commands, assigns
targets and offers free cells, then the controller of each robot answers with a command (MOOD4I
thesis, 4.4.1).
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
"""For each robot the numbers of its targets, in the order in which the robot reaches them."""


@dataclass(slots=True)
class Body(Generic[P]):
    """A robot: run sets by cell, by index in its list of targets, by memory of its controller, by
    command.
    """

    places: list[P]
    assigned: list[P]
    """By index in its list, runs with the target assigned, until another one is."""
    evasions: list[P]
    """Runs in which the robot is sent to a cell to make way."""
    memory: dict[Memory, P]
    commands: dict[str, P]


class State(Struct, Generic[P], frozen=True):
    """Everything that is known between two steps; the future of a run depends on nothing else."""

    bodies: list[Body[P]]
    done: list[P]
    """By target, the runs in which it has been reached."""


class World(Generic[P]):
    """All robots of a floor; ``step`` simulates one step of the contracts."""

    def __init__(
        self,
        study: Study,
        allocation: Allocation,
        answers: Sequence[Answers],
        runs: RunSpace[P],
        state: State[P] | None = None,
        time: int = 0,
    ) -> None:
        """Start with robots that stay in their starts, or continue from a *state*."""
        self.study, self.allocation, self.answers, self.runs = study, allocation, answers, runs
        none, size = runs.none, study.grid.size
        self._without = runs.without
        initial = state or _initial_state(study, allocation, runs)
        self.bodies, self.done = initial.bodies, initial.done[: len(study.targets)]
        self.time = time
        self.neighbours = [tuple(study.grid.neighbours(cell)) for cell in range(size)]
        self.moves_by_cell: dict[tuple[int, int], tuple[str, int] | None] = {}
        self.wrong = none
        """Runs with an error: two robots met, an offered cell was occupied or offered to another
        robot, a robot left its target without a new one, or a controller had no answer."""
        self.exceeds_limit = [none] * len(study.targets)
        """By target, the runs in which a robot has it for longer than C_S allows."""
        self.occupied = self._compute_occupied()
        """By cell, the runs in which a robot is there."""
        self.finished = none
        """Runs in which all targets are reached and all robots rest."""
        if state is None:
            self._answer_all()

    # -- one step ------------------------------------------------------------------------------

    def step(self) -> None:
        """Move the robots, record reached targets, assign targets, and let the controllers
        answer.
        """
        self.time += 1
        idle_runs = [self._runs_at_target(number) for number in range(len(self.bodies))]
        self._move()
        for number, body in enumerate(self.bodies):
            idle = idle_runs[number]
            body.assigned = [
                self._without(runs_under_way, idle) for runs_under_way in body.assigned
            ]
            body.evasions = [
                self._without(runs_under_way, idle) for runs_under_way in body.evasions
            ]
        self._note_reached()
        self._dispatch(idle_runs)
        # A robot may get the target in which it already is.
        self._note_reached()
        self._answer_all()

    def _answer_all(self) -> None:
        self._offered = list(self.occupied)
        resting_runs = [self._runs_at_rest(number) for number in range(len(self.bodies))]
        self.finished = self._intersect((*self.done, *resting_runs))
        for number, resting in enumerate(resting_runs):
            self._update_memory(number, resting)

    def _intersect(self, planes: Sequence[P]) -> P:
        result = self.runs.all
        for run_set in planes:
            if result == self.runs.none:
                break
            result = result & run_set
        return result

    def _move(self) -> None:
        for body in self.bodies:
            body.places = self._positions_after_commands(body)
        self.occupied = self._compute_occupied()

    def _positions_after_commands(self, body: Body[P]) -> list[P]:
        none, grid = self.runs.none, self.study.grid
        moving = union(list(body.commands.values()), none)
        if moving == none:
            return body.places
        positions = [self._without(run_set, moving) for run_set in body.places]
        for cell in grid.cells:
            moving_from = body.places[cell] & moving
            if moving_from == none:
                continue
            for command, neighbour in self.neighbours[cell]:
                moving_this_way = moving_from & body.commands.get(command, none)
                if moving_this_way == none:
                    continue
                self.wrong = self.wrong | (moving_this_way & self.occupied[neighbour])
                positions[neighbour] = positions[neighbour] | moving_this_way
        return positions

    def _compute_occupied(self) -> list[P]:
        """Return the occupied runs by cell; two robots in one cell are an error."""
        none, occupied = self.runs.none, []
        for cell in range(self.study.grid.size):
            already_occupied = none
            for body in self.bodies:
                present = body.places[cell]
                if present != none:
                    self.wrong = self.wrong | (already_occupied & present)
                    already_occupied = already_occupied | present
            occupied.append(already_occupied)
        return occupied

    def _note_reached(self) -> None:
        for number, body in enumerate(self.bodies):
            for index, target in enumerate(self.allocation[number]):
                cell = self.study.targets[target].cell
                arrived = body.assigned[index] & body.places[cell]
                if arrived != self.runs.none:
                    self.done[target] = self.done[target] | arrived

    # -- targets -------------------------------------------------------------------------------

    def _runs_at_rest(self, number: int) -> P:
        """Return the runs in which a robot has no target except its own cell."""
        body, none = self.bodies[number], self.runs.none
        return self._without(self.runs.all, union([*body.assigned, *body.evasions], none))

    def _runs_at_target(self, number: int) -> P:
        """Return the runs in which a robot is in its target."""
        body = self.bodies[number]
        runs = self._runs_at_rest(number)
        for index, target in enumerate(self.allocation[number]):
            arrived = body.assigned[index] & body.places[self.study.targets[target].cell]
            runs = runs if arrived == self.runs.none else runs | arrived
        for cell in self.study.grid.cells:
            arrived = body.evasions[cell] & body.places[cell]
            runs = runs if arrived == self.runs.none else runs | arrived
        return runs

    def _dispatch(self, idle_runs: list[P]) -> None:
        goals = [
            [self.study.targets[target].cell for target in targets] for targets in self.allocation
        ]
        places = [body.places for body in self.bodies]
        traffic = Traffic(self.study.grid, self.runs, places, self.occupied, list(idle_runs), goals)
        for number, body in enumerate(self.bodies):
            traffic.reserve(traffic.path_cells(number, body.assigned))
            traffic.reserve(body.evasions)
        open_targets = [
            self._open_targets(number, idle_runs[number]) for number in range(len(self.bodies))
        ]
        decision = traffic.send(open_targets)
        if self.study.within is not None:
            self._note_slow(decision.departures, self.study.within)
        for number, body in enumerate(self.bodies):
            pairs = zip(body.assigned, decision.departures[number], strict=True)
            body.assigned = [target | departing for target, departing in pairs]
            evasion_pairs = zip(body.evasions, decision.evasions[number], strict=True)
            body.evasions = [target | departing for target, departing in evasion_pairs]

    def _note_slow(self, departures: Sequence[Sequence[P]], within: int) -> None:
        """Record the runs in which robots depart on paths that are too long (the timer of C_S)."""
        for number, targets in enumerate(self.allocation):
            for target, departing in zip(targets, departures[number], strict=True):
                for cell, present in enumerate(self.bodies[number].places):
                    slow_runs, goal = present & departing, self.study.targets[target].cell
                    if slow_runs != self.runs.none and exceeds_travel_limit(
                        self.study.grid, self.answers[number], cell, goal, within
                    ):
                        self.exceeds_limit[target] = self.exceeds_limit[target] | slow_runs

    def _open_targets(self, number: int, idle_runs: P) -> list[P]:
        """Return for each target in its list the runs in which the robot could depart for it
        now.
        """
        open_targets: list[P] = []
        previous_done = idle_runs
        for target in self.allocation[number]:
            departure_runs = self._without(previous_done, self.done[target])
            for earlier in self.study.earlier(target):
                departure_runs = departure_runs & self.done[earlier]
            open_targets.append(departure_runs)
            previous_done = previous_done & self.done[target]
        return open_targets

    # -- answers -------------------------------------------------------------------------------

    def _update_memory(self, number: int, resting_runs: P) -> None:
        """Compute command and memory of a robot's controller in all runs."""
        body = self.bodies[number]
        previous_memory, body.memory, body.commands = body.memory, {}, {}
        for robot_memory, run_set in previous_memory.items():
            if not robot_memory.was_at_target:
                self._answer_target(number, robot_memory, robot_memory.goal, run_set)
            elif run_set != self.runs.none:
                for goal, runs_with_target in self._possible_targets(
                    number, robot_memory.cell, resting_runs
                ):
                    self._answer_target(number, robot_memory, goal, run_set & runs_with_target)

    def _possible_targets(self, number: int, cell: int, resting_runs: P) -> Iterator[tuple[int, P]]:
        """Yield the targets that a robot in a cell can have, with the runs in which it has them."""
        body = self.bodies[number]
        yield cell, resting_runs
        for index, target in enumerate(self.allocation[number]):
            yield self.study.targets[target].cell, body.assigned[index]
        for _, neighbour in self.neighbours[cell]:
            yield neighbour, body.evasions[neighbour]

    def _answer_target(self, number: int, memory: Memory, goal: int, runs: P) -> None:
        none = self.runs.none
        if runs == none:
            return
        move = self._next_move(memory.cell, goal)
        if move is not None:
            self._offer_and_answer(number, memory, goal, move, runs)
            return
        if self.finished != none and number == self.time % len(self.bodies):
            runs = self._offer_in_turn(number, memory, runs)
        self._record_answer(number, memory, goal, "", runs)

    def _offer_in_turn(self, number: int, memory: Memory, runs: P) -> P:
        """Offer a cell to a robot that rests after the mission, and return the runs without a free
        cell.

        Each robot gets its turn infinitely often, as C_E guarantees, and stays, as C_R guarantees.
        """
        for move in self.neighbours[memory.cell]:
            runs_with_free_cell = self._without(runs & self.finished, self.occupied[move[1]])
            if runs_with_free_cell != self.runs.none:
                self._offer_and_answer(number, memory, memory.cell, move, runs_with_free_cell)
                runs = self._without(runs, runs_with_free_cell)
        return runs

    def _offer_and_answer(
        self, number: int, memory: Memory, goal: int, move: tuple[str, int], runs: P
    ) -> None:
        self._offer(move[1], runs)
        self._record_answer(number, memory, goal, move[0], runs)

    def _record_answer(self, number: int, memory: Memory, goal: int, way: str, runs: P) -> None:
        """Record the controller's answer to a target and an offered direction."""
        none, body = self.runs.none, self.bodies[number]
        if runs == none:
            return
        answer = self.answers[number].get(memory, goal, way)
        if answer is None:
            self.wrong = self.wrong | runs
            return
        body.memory[answer.memory] = body.memory.get(answer.memory, none) | runs
        if answer.command in WAYS:
            if goal == memory.cell:
                self.wrong = self.wrong | runs
            body.commands[answer.command] = body.commands.get(answer.command, none) | runs

    def _next_move(self, cell: int, goal: int) -> tuple[str, int] | None:
        key = cell, goal
        if key not in self.moves_by_cell:
            self.moves_by_cell[key] = next_move(self.study.grid, cell, goal)
        return self.moves_by_cell[key]

    def _offer(self, cell: int, runs: P) -> None:
        """Offer a cell, which must be free and not offered to another robot (C_E)."""
        self.wrong = self.wrong | (runs & self._offered[cell])
        self._offered[cell] = self._offered[cell] | runs


def _initial_state(study: Study, allocation: Allocation, runs: RunSpace[P]) -> State[P]:
    """Return the state with all robots in their starts, which are their targets."""
    none, size = runs.none, study.grid.size
    bodies: list[Body[P]] = [
        Body(
            list(runs.starts[robot]),
            [none] * len(allocation[robot]),
            [none] * size,
            {Memory(cell, cell): run_set for cell, run_set in enumerate(runs.starts[robot])},
            {},
        )
        for robot in range(len(study.robots))
    ]
    return State(bodies, [none] * len(study.targets))
