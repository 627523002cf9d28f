"""Simulation of the robots and the compiled environment, step by step, in many runs at once.

In a step of the contracts the environment first moves the robots by their commands, assigns targets
and offers free cells. Then the controller of each robot answers with a command (MOOD4I thesis,
4.4.1). All values are sets of runs (``run_sets``).
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
    """The state of a robot in all runs; each field maps values to the runs with this value."""

    places: list[P]
    """By cell: the robot is in the cell."""
    assigned: list[P]
    """By index in the robot's list of targets: the target is the last one that was assigned."""
    evasions: list[P]
    """By cell: the robot is sent to the cell to make way."""
    memory: dict[Memory, P]
    """By memory of the robot's controller."""
    commands: dict[str, P]
    """By command; only commands that move the robot are listed."""


class State(Struct, Generic[P], frozen=True):
    """The state of all runs between two steps; the future of a run depends on nothing else."""

    bodies: list[Body[P]]
    done: list[P]
    """For each target, the runs in which it has been reached."""


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
        """Begin with the robots in their starts, or continue from *state* at step *time*."""
        self.study, self.allocation, self.answers, self.runs = study, allocation, answers, runs
        none, size = runs.none, study.grid.size
        self._without = runs.without
        initial = state or _initial_state(study, allocation, runs)
        self.bodies, self.done = initial.bodies, initial.done[: len(study.targets)]
        self.time = time
        self.neighbours = [tuple(study.grid.neighbours(cell)) for cell in range(size)]
        self.moves_by_cell: dict[tuple[int, int], tuple[str, int] | None] = {}
        self.wrong = none
        """The runs with an error: two robots met, an offered cell was occupied or offered twice, a
        robot left its target without a new one, or a controller had no answer."""
        self.exceeds_limit = [none] * len(study.targets)
        """For each target, the runs in which a robot has it for longer than C_S allows."""
        self.occupied = self._compute_occupied()
        """For each cell, the runs in which a robot is in it."""
        self.finished = none
        """The runs in which all targets are reached and all robots rest."""
        if state is None:
            self._answer_all()

    # -- one step ------------------------------------------------------------------------------

    def step(self) -> None:
        """Simulate one step: movements, reached targets, assignments, controllers' answers."""
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
        self._record_reached_targets()
        self._dispatch(idle_runs)
        # A robot may get the target in which it already is.
        self._record_reached_targets()
        self._answer_all()

    def _answer_all(self) -> None:
        """Compute the answers of all controllers, and the finished runs."""
        self._offered = list(self.occupied)
        resting_runs = [self._runs_at_rest(number) for number in range(len(self.bodies))]
        self.finished = self._intersect((*self.done, *resting_runs))
        for number, resting in enumerate(resting_runs):
            self._update_memory(number, resting)

    def _intersect(self, run_sets: Sequence[P]) -> P:
        result = self.runs.all
        for run_set in run_sets:
            if result == self.runs.none:
                break
            result = result & run_set
        return result

    def _move(self) -> None:
        for body in self.bodies:
            body.places = self._positions_after_commands(body)
        self.occupied = self._compute_occupied()

    def _positions_after_commands(self, body: Body[P]) -> list[P]:
        """Return ``places`` after the commands; entering an occupied cell is an error."""
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
        """Return for each cell the runs in which a robot is in it; two robots are an error."""
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

    def _record_reached_targets(self) -> None:
        for number, body in enumerate(self.bodies):
            for index, target in enumerate(self.allocation[number]):
                cell = self.study.targets[target].cell
                arrived = body.assigned[index] & body.places[cell]
                if arrived != self.runs.none:
                    self.done[target] = self.done[target] | arrived

    # -- targets -------------------------------------------------------------------------------

    def _runs_at_rest(self, number: int) -> P:
        """Return the runs in which a robot rests: it has neither a target nor an evasion."""
        body, none = self.bodies[number], self.runs.none
        return self._without(self.runs.all, union([*body.assigned, *body.evasions], none))

    def _runs_at_target(self, number: int) -> P:
        """Return the runs in which a robot is in its target, or rests."""
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
        """Assign targets and evasions by the rules of ``traffic``."""
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
            self._record_slow_departures(decision.departures, self.study.within)
        for number, body in enumerate(self.bodies):
            pairs = zip(body.assigned, decision.departures[number], strict=True)
            body.assigned = [target | departing for target, departing in pairs]
            evasion_pairs = zip(body.evasions, decision.evasions[number], strict=True)
            body.evasions = [target | departing for target, departing in evasion_pairs]

    def _record_slow_departures(self, departures: Sequence[Sequence[P]], within: int) -> None:
        """Record the runs in which a robot departs on a journey that takes longer than *within*."""
        for number, targets in enumerate(self.allocation):
            for target, departing in zip(targets, departures[number], strict=True):
                for cell, present in enumerate(self.bodies[number].places):
                    slow_runs, goal = present & departing, self.study.targets[target].cell
                    if slow_runs != self.runs.none and exceeds_travel_limit(
                        self.study.grid, self.answers[number], cell, goal, within
                    ):
                        self.exceeds_limit[target] = self.exceeds_limit[target] | slow_runs

    def _open_targets(self, number: int, idle_runs: P) -> list[P]:
        """Return for each target of a robot the runs in which the robot may depart for it.

        It must be idle, all targets before this one in its list must have been reached, and so must
        all targets that precede this one in the mission.
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
        """Compute the new memory and the commands of a robot's controller in all runs."""
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
        """Yield the possible target cells of a robot in *cell*, each with its runs."""
        body = self.bodies[number]
        yield cell, resting_runs
        for index, target in enumerate(self.allocation[number]):
            yield self.study.targets[target].cell, body.assigned[index]
        for _, neighbour in self.neighbours[cell]:
            yield neighbour, body.evasions[neighbour]

    def _answer_target(self, number: int, memory: Memory, goal: int, runs: P) -> None:
        """Offer a cell on the way to *goal*, if there is one, and record the answer."""
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
        """Offer a free cell to a robot that rests after the mission.

        So each robot is offered a cell infinitely often, as C_E guarantees, and stays, as C_R
        guarantees. Return the runs without a free cell.
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
        """Record the controller's answer to the target *goal* and the offered direction *way*."""
        none, body = self.runs.none, self.bodies[number]
        if runs == none:
            return
        answer = self.answers[number].get(memory, goal, way)
        if answer is None:
            self.wrong = self.wrong | runs
            return
        body.memory[answer.memory] = body.memory.get(answer.memory, none) | runs
        if answer.command in WAYS:
            # A robot in its target has to stay (C_R).
            if goal == memory.cell:
                self.wrong = self.wrong | runs
            body.commands[answer.command] = body.commands.get(answer.command, none) | runs

    def _next_move(self, cell: int, goal: int) -> tuple[str, int] | None:
        key = cell, goal
        if key not in self.moves_by_cell:
            self.moves_by_cell[key] = next_move(self.study.grid, cell, goal)
        return self.moves_by_cell[key]

    def _offer(self, cell: int, runs: P) -> None:
        """Offer a cell; an occupied cell, or one offered before, is an error (C_E)."""
        self.wrong = self.wrong | (runs & self._offered[cell])
        self._offered[cell] = self._offered[cell] | runs


def _initial_state(study: Study, allocation: Allocation, runs: RunSpace[P]) -> State[P]:
    """Return the state in which all robots are in their starts, which count as their targets."""
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
