"""Traffic rules of the compiled environment: which robots depart, and which robots make way.

A robot departs if its whole path is free of other robots and of the paths of other robots. The
first robot that wants to depart is the leader. While it cannot depart, no robot departs across its
path, and idle robots on its path are sent aside, together with the robots that block these
(docs/robots.md).
"""

from dataclasses import dataclass
from typing import Generic

from sysmlc.robots.run_sets import P, RunSpace, union
from sysmlc.robots.study import Grid, successors_by_distance


@dataclass(slots=True)
class Decision(Generic[P]):
    """The decisions of one step."""

    departures: list[list[P]]
    """For each robot and index in its list of targets, the runs in which it departs for the target.
    """
    evasions: list[list[P]]
    """For each robot and cell, the runs in which the robot is sent there to make way."""


class Traffic(Generic[P]):
    """Decides in one step which robots depart and which robots make way."""

    def __init__(
        self,
        grid: Grid,
        runs: RunSpace[P],
        places: list[list[P]],
        occupied: list[P],
        is_idle: list[P],
        goals: list[list[int]],
    ) -> None:
        """Store the situation before the decisions, as sets of runs.

        *places* lists them by robot and cell, *occupied* by cell, *is_idle* by robot: the robot is
        in its target. *goals* contains the cells of each robot's targets.
        """
        self.grid, self.none, self.without = grid, runs.none, runs.without
        self.places, self.is_idle = places, is_idle
        self.goals = goals
        self.occupied = occupied
        self.reserved = [runs.none] * grid.size

    def path_cells(self, robot: int, wanted_by_target: list[P]) -> list[P]:
        """Return for each cell the runs in which it is on the robot's path to a target.

        *wanted_by_target* lists for each target of the robot the runs to consider.
        """
        path_cells = [self.none] * self.grid.size
        for goal, run_set in zip(self.goals[robot], wanted_by_target, strict=True):
            if run_set == self.none:
                continue
            positions = [run_set & position for position in self.places[robot]]
            # From the farthest cell to the nearest, so that one pass completes all paths.
            for cell, next_cell in successors_by_distance(self.grid, goal):
                if positions[cell] != self.none:
                    positions[next_cell] = positions[next_cell] | positions[cell]
            path_cells = self._union_pairwise(path_cells, positions)
        return path_cells

    def reserve(self, cells: list[P]) -> None:
        """Reserve cells for a robot."""
        self.reserved = self._union_pairwise(self.reserved, cells)

    def _union_pairwise(self, left: list[P], right: list[P]) -> list[P]:
        """Return the unions of corresponding sets."""
        pairs = zip(left, right, strict=True)
        # The union with an empty set would copy a long integer.
        return [run_set if added == self.none else run_set | added for run_set, added in pairs]

    def send(self, open_targets: list[list[P]]) -> Decision[P]:
        """Return which robots depart and which are sent aside.

        *open_targets* contains, for each robot and target, the runs in which it could depart.
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
        # Leaders first: the other robots must not cross the paths of those that have to wait.
        for is_leader_round in (True, False):
            for robot in robots:
                candidates = (
                    wanting[robot] & leaders[robot]
                    if is_leader_round
                    else self.without(wanting[robot], leaders[robot])
                )
                departing = self._can_depart(
                    robot, candidates, paths[robot], leader_path, waiting, is_leader_round
                )
                if is_leader_round:
                    waiting = waiting | self.without(candidates, departing)
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

    def _find_leaders(self, wanting_by_robot: list[P]) -> list[P]:
        """Return for each robot the runs in which it is the first that wants to depart."""
        leaders, earlier = [], self.none
        for wanting in wanting_by_robot:
            leaders.append(self.without(wanting, earlier))
            earlier = earlier | wanting
        return leaders

    def _can_depart(
        self,
        robot: int,
        candidates: P,
        path: list[P],
        leader_path: list[P],
        waiting: P,
        is_leader_round: bool,
    ) -> P:
        """Return the runs among *candidates* in which a robot may depart on its path."""
        if candidates == self.none:
            return candidates
        blocked = self.none
        for cell, on_way in enumerate(path):
            if on_way == self.none:
                continue
            obstacles = (
                self.without(self.occupied[cell], self.places[robot][cell]) | self.reserved[cell]
            )
            if not is_leader_round:
                obstacles = obstacles | (leader_path[cell] & waiting)
            blocked = blocked | (on_way & obstacles)
        return self.without(candidates, blocked)


def _union_pairwise(left: list[P], right: list[P]) -> list[P]:
    return [run_set | added for run_set, added in zip(left, right, strict=True)] if left else right


class _EvasionPlanner(Generic[P]):
    """Plans evasions: idle robots leave the path of a leader that cannot depart."""

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
        """Return for each robot and cell the runs in which the robot is sent there."""
        none, without = self.traffic.none, self.traffic.without
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
                without(run_set, moved)
                for run_set, moved in zip(must_move, self.moved, strict=True)
            ]
            cells_beside = self._cells_beside(stuck)
            must_move = [
                without(self._standing_in(robot, cells_beside), asked_before[robot])
                for robot in self.robots
            ]
            asked_before = [
                run_set | added for run_set, added in zip(asked_before, must_move, strict=True)
            ]
        return self.evasions

    def _standing_in(self, robot: int, cells: list[P]) -> P:
        """Return the runs in which the robot is in one of *cells*, idle, and not the leader."""
        places = self.traffic.places[robot]
        idle_there = union(
            [position & cell for position, cell in zip(places, cells, strict=True)],
            self.traffic.none,
        )
        return self.traffic.without(idle_there & self.traffic.is_idle[robot], self.leaders[robot])

    def _cells_beside(self, stuck: list[P]) -> list[P]:
        """Return for each cell the runs in which a robot in *stuck* is in a neighbour cell."""
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
        """Move a robot to a free neighbour cell off the leader's path, or else ahead on the path.

        *must_move* contains the runs in which the robot has to make way.
        """
        traffic, none, without = self.traffic, self.traffic.none, self.traffic.without
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
                    without(
                        without(remaining, barred_cells[neighbour]), self.blocked_path[neighbour]
                    ),
                )
            if remaining != none:
                for neighbour in neighbours:
                    moving = without(remaining, barred_cells[neighbour])
                    if moving != none:
                        remaining = self._move_to(
                            robot, neighbour, remaining, moving & self._is_ahead(cell, neighbour)
                        )

    def _move_to(self, robot: int, cell: int, remaining: P, moving: P) -> P:
        """Move the robot to a cell in the runs *moving*, and return the other remaining runs."""
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
