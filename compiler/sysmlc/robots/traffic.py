"""Traffic rules of the compiled environment: which robots depart, and which ones make way.

A robot departs if its whole path is free of other robots and of the paths of other robots. The
first robot with a target leads: while it cannot depart, nobody departs across its path, and robots
on its path are sent aside, together with the robots that block these (docs/robots.md).
"""

from dataclasses import dataclass
from typing import Generic

from sysmlc.robots.run_sets import P, RunSpace, union
from sysmlc.robots.study import Grid, successors_by_distance


@dataclass(slots=True)
class Decision(Generic[P]):
    """The decisions of one step."""

    departures: list[list[P]]
    """By robot and index in its list: the robot departs for that target."""
    evasions: list[list[P]]
    """By robot and cell: the robot is sent there to make way."""


class Traffic(Generic[P]):
    """Decides for all robots in one step."""

    def __init__(
        self,
        grid: Grid,
        runs: RunSpace[P],
        places: list[list[P]],
        taken: list[P],
        is_idle: list[P],
        goals: list[list[int]],
    ) -> None:
        """Store the situation of the step.

        *places* are run sets by robot and cell, *taken* by cell, *is_idle* by robot (it is in its
        target). *goals* are the cells of each robot's targets.
        """
        self.grid, self.none, self.without = grid, runs.none, runs.without
        self.places, self.is_idle = places, is_idle
        self.goals = goals
        self.occupied = taken
        self.reserved = [runs.none] * grid.size

    def path_cells(self, robot: int, wanted_by_target: list[P]) -> list[P]:
        """Return for each cell the runs in which it is on the robot's path to a wanted target."""
        path_cells = [self.none] * self.grid.size
        for goal, run_set in zip(self.goals[robot], wanted_by_target, strict=True):
            if run_set == self.none:
                continue
            positions = [run_set & position for position in self.places[robot]]
            for cell, next_cell in successors_by_distance(self.grid, goal):
                if positions[cell] != self.none:
                    positions[next_cell] = positions[next_cell] | positions[cell]
            path_cells = self._union_pairwise(path_cells, positions)
        return path_cells

    def reserve(self, cells: list[P]) -> None:
        """Reserve cells for a robot."""
        self.reserved = self._union_pairwise(self.reserved, cells)

    def _union_pairwise(self, left: list[P], right: list[P]) -> list[P]:
        """Return the pairwise unions; adding an empty set would copy an integer."""
        pairs = zip(left, right, strict=True)
        return [run_set if added == self.none else run_set | added for run_set, added in pairs]

    def send(self, open_targets: list[list[P]]) -> Decision[P]:
        """Decide who departs and who is sent aside; *open_targets* by robot and index in its
        list.
        """
        robots = range(len(self.places))
        wanting = [union(target_set, self.none) for target_set in open_targets]
        paths = [self.path_cells(robot, open_targets[robot]) for robot in robots]
        leaders = self._find_leaders(wanting)
        leader_path = [
            union([leaders[robot] & paths[robot][cell] for robot in robots], self.none)
            for cell in range(self.grid.size)
        ]
        waiting = self.none
        decision: Decision[P] = Decision([[] for _ in robots], [])
        for is_first in (True, False):
            for robot in robots:
                asking = wanting[robot] & leaders[robot]
                asking = asking if is_first else self.without(wanting[robot], leaders[robot])
                departing = self._can_depart(
                    robot, asking, paths[robot], leader_path, waiting, is_first
                )
                waiting = waiting | self.without(asking, departing) if is_first else waiting
                if departing != self.none:
                    self.reserve([departing & cell for cell in paths[robot]])
                decision.departures[robot] = _union_pairwise(
                    decision.departures[robot],
                    [departing & target_set for target_set in open_targets[robot]],
                )
                self.is_idle[robot] = self.without(self.is_idle[robot], departing)
        blocked_path = [waiting & cell for cell in leader_path]
        decision.evasions = _EvasionPlanner(self, blocked_path, leaders, open_targets).plan()
        return decision

    def _find_leaders(self, wants: list[P]) -> list[P]:
        leaders, earlier = [], self.none
        for wanting in wants:
            leaders.append(self.without(wanting, earlier))
            earlier = earlier | wanting
        return leaders

    def _can_depart(
        self, robot: int, asking: P, path: list[P], leader_path: list[P], waiting: P, is_first: bool
    ) -> P:
        """Return the runs in which a robot that wants to depart may do so."""
        if asking == self.none:
            return asking
        blocked = self.none
        for cell, on_way in enumerate(path):
            if on_way == self.none:
                continue
            obstacles = (
                self.without(self.occupied[cell], self.places[robot][cell]) | self.reserved[cell]
            )
            if not is_first:
                obstacles = obstacles | (leader_path[cell] & waiting)
            blocked = blocked | (on_way & obstacles)
        return self.without(asking, blocked)


def _union_pairwise(left: list[P], right: list[P]) -> list[P]:
    return [run_set | added for run_set, added in zip(left, right, strict=True)] if left else right


class _EvasionPlanner(Generic[P]):
    """Sends robots aside that stand on the path of a leader that cannot depart."""

    def __init__(
        self,
        traffic: Traffic[P],
        blocked_path: list[P],
        leaders: list[P],
        open_targets: list[list[P]],
    ) -> None:
        self.traffic, self.blocked_path, self.leaders, self.open_targets = (
            traffic,
            blocked_path,
            leaders,
            open_targets,
        )
        self.robots = range(len(traffic.places))
        none, size = traffic.none, traffic.grid.size
        pairs = zip(traffic.occupied, traffic.reserved, strict=True)
        self.barred_cells = [run_set | other for run_set, other in pairs]
        self.chosen_cells = [none] * size
        self.moved = [none for _ in self.robots]
        self.evasions = [[none] * size for _ in self.robots]

    def plan(self) -> list[list[P]]:
        """Return the evasions by robot and cell."""
        none, but = self.traffic.none, self.traffic.without
        if all(run_set == none for run_set in self.blocked_path):
            return self.evasions
        must_move = [self._standing_in(robot, self.blocked_path) for robot in self.robots]
        asked_before = list(must_move)
        while any(run_set != none for run_set in must_move):
            for robot in self.robots:
                if must_move[robot] != none:
                    self._move(robot, must_move[robot])
            # Cells do not become free within a step, so a stuck robot is not asked again.
            stuck = [
                but(run_set, moved) for run_set, moved in zip(must_move, self.moved, strict=True)
            ]
            cells_beside = self._cells_beside(stuck)
            must_move = [
                but(self._standing_in(robot, cells_beside), asked_before[robot])
                for robot in self.robots
            ]
            asked_before = [
                run_set | added for run_set, added in zip(asked_before, must_move, strict=True)
            ]
        return self.evasions

    def _standing_in(self, robot: int, cells: list[P]) -> P:
        """Return the runs in which an idle robot that does not lead stands in one of the cells."""
        places = self.traffic.places[robot]
        idle_there = union(
            [position & cell for position, cell in zip(places, cells, strict=True)],
            self.traffic.none,
        )
        return self.traffic.without(idle_there & self.traffic.is_idle[robot], self.leaders[robot])

    def _cells_beside(self, stuck: list[P]) -> list[P]:
        """Return for each cell the runs in which it is next to a robot that cannot make way."""
        grid, none = self.traffic.grid, self.traffic.none
        stuck_robots = [robot for robot in self.robots if stuck[robot] != none]
        stuck_positions = [
            union([stuck[robot] & self.traffic.places[robot][cell] for robot in stuck_robots], none)
            for cell in range(grid.size)
        ]
        return [
            union([stuck_positions[neighbour] for _, neighbour in grid.neighbours(cell)], none)
            for cell in range(grid.size)
        ]

    def _move(self, robot: int, must_move: P) -> None:
        """Move a robot to a free cell off the leader's path, else to one ahead on the path."""
        traffic, none, but = self.traffic, self.traffic.none, self.traffic.without
        barred_cells = [
            occupied | reserved | chosen_cells
            for occupied, reserved, chosen_cells in zip(
                traffic.occupied, traffic.reserved, self.chosen_cells, strict=True
            )
        ]
        for cell in traffic.grid.cells:
            remaining = must_move & traffic.places[robot][cell]
            if remaining == none:
                continue
            neighbours = [neighbour for _, neighbour in traffic.grid.neighbours(cell)]
            for neighbour in neighbours:
                remaining = self._move_to(
                    robot,
                    neighbour,
                    remaining,
                    but(but(remaining, barred_cells[neighbour]), self.blocked_path[neighbour]),
                )
            for neighbour in neighbours if remaining != none else ():
                moving = but(remaining, barred_cells[neighbour])
                if moving != none:
                    remaining = self._move_to(
                        robot, neighbour, remaining, moving & self._is_ahead(cell, neighbour)
                    )

    def _move_to(self, robot: int, cell: int, remaining: P, moving: P) -> P:
        """Move the robot to a cell, and return the runs in which it still stands."""
        if moving == self.traffic.none:
            return remaining
        self.evasions[robot][cell] = self.evasions[robot][cell] | moving
        self.chosen_cells[cell] = self.chosen_cells[cell] | moving
        self.moved[robot] = self.moved[robot] | moving
        return self.traffic.without(remaining, moving)

    def _is_ahead(self, cell: int, neighbour: int) -> P:
        """Return the runs in which *neighbour* is nearer to the leader's target than *cell*."""
        traffic, ahead = self.traffic, self.traffic.none
        for robot in self.robots:
            for goal, wanting in zip(traffic.goals[robot], self.open_targets[robot], strict=True):
                distances = traffic.grid.distances(goal)
                if distances.get(neighbour, 0) < distances.get(cell, 0):
                    ahead = ahead | (wanting & self.leaders[robot])
        return ahead
