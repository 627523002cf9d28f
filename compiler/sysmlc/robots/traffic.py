"""Who may set out, and who has to make way: the rules of the compiled environment.

A robot sets out when its whole way is free of other robots and of the ways that others are on.
The first robot with a target leads: while it cannot set out nobody sets out across its way, and
robots that stand in its way are sent aside, with those who stand in their way (docs/robots.md).
"""

from dataclasses import dataclass
from typing import Generic

from sysmlc.robots.run_sets import P, RunSpace, union
from sysmlc.robots.study import Grid, successors_by_distance


@dataclass(slots=True)
class Sent(Generic[P]):
    """What was decided in one step."""

    out: list[list[P]]
    """By robot and place in its list: it sets out to that target."""
    aside: list[list[P]]
    """By robot and cell: it is sent there to make way."""


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
        """``places`` by robot and cell, ``taken`` by cell, ``is_idle`` by robot: it is in its
        target; ``goals``: the cells of its list."""
        self.grid, self.none, self.but = grid, runs.none, runs.but
        self.places, self.is_idle = places, is_idle
        self.goals = goals
        self.taken = taken
        self.reserved = [runs.none] * grid.size

    def ways(self, robot: int, wanted: list[P]) -> list[P]:
        """By cell: it is on the robot's way to its target; ``wanted`` by place in its list."""
        found = [self.none] * self.grid.size
        for goal, wants in zip(self.goals[robot], wanted, strict=True):
            if wants == self.none:
                continue
            one = [wants & here for here in self.places[robot]]
            for cell, after in successors_by_distance(self.grid, goal):
                if one[cell] != self.none:
                    one[after] = one[after] | one[cell]
            found = self._joined(found, one)
        return found

    def reserve(self, cells: list[P]) -> None:
        """Keep cells free for a robot."""
        self.reserved = self._joined(self.reserved, cells)

    def _joined(self, left: list[P], right: list[P]) -> list[P]:
        """Either, one by one; an integer with nothing more would be copied."""
        pairs = zip(left, right, strict=True)
        return [one if more == self.none else one | more for one, more in pairs]

    def send(self, open_: list[list[P]]) -> Sent[P]:
        """Who sets out and who is sent aside; ``open_`` by robot and place in its list."""
        robots = range(len(self.places))
        wants = [union(one, self.none) for one in open_]
        ways = [self.ways(robot, open_[robot]) for robot in robots]
        leads = self._leading(wants)
        leading = [
            union([leads[robot] & ways[robot][cell] for robot in robots], self.none)
            for cell in range(self.grid.size)
        ]
        waits = self.none
        sent: Sent[P] = Sent([[] for _ in robots], [])
        for is_first in (True, False):
            for robot in robots:
                asks = wants[robot] & leads[robot]
                asks = asks if is_first else self.but(wants[robot], leads[robot])
                starts = self._starting(robot, asks, ways[robot], leading, waits, is_first)
                waits = waits | self.but(asks, starts) if is_first else waits
                if starts != self.none:
                    self.reserve([starts & cell for cell in ways[robot]])
                sent.out[robot] = _joined(sent.out[robot], [starts & one for one in open_[robot]])
                self.is_idle[robot] = self.but(self.is_idle[robot], starts)
        held = [waits & cell for cell in leading]
        sent.aside = _Aside(self, held, leads, open_).sent()
        return sent

    def _leading(self, wants: list[P]) -> list[P]:
        found, before = [], self.none
        for one in wants:
            found.append(self.but(one, before))
            before = before | one
        return found

    def _starting(
        self, robot: int, asks: P, way: list[P], leading: list[P], waits: P, is_first: bool
    ) -> P:
        """In which runs a robot that asks may set out."""
        if asks == self.none:
            return asks
        barred = self.none
        for cell, on_way in enumerate(way):
            if on_way == self.none:
                continue
            others = self.but(self.taken[cell], self.places[robot][cell]) | self.reserved[cell]
            if not is_first:
                others = others | (leading[cell] & waits)
            barred = barred | (on_way & others)
        return self.but(asks, barred)


def _joined(left: list[P], right: list[P]) -> list[P]:
    return [one | other for one, other in zip(left, right, strict=True)] if left else right


class _Aside(Generic[P]):
    """Sends robots aside that stand on the way of a leader that cannot set out."""

    def __init__(
        self, traffic: Traffic[P], held: list[P], leads: list[P], open_: list[list[P]]
    ) -> None:
        self.traffic, self.held, self.leads, self.open = traffic, held, leads, open_
        self.robots = range(len(traffic.places))
        none, size = traffic.none, traffic.grid.size
        pairs = zip(traffic.taken, traffic.reserved, strict=True)
        self.barred = [one | other for one, other in pairs]
        self.chosen = [none] * size
        self.gone = [none for _ in self.robots]
        self.found = [[none] * size for _ in self.robots]

    def sent(self) -> list[list[P]]:
        """By robot and cell: it goes there."""
        none, but = self.traffic.none, self.traffic.but
        if all(one == none for one in self.held):
            return self.found
        wanted = [self._standing(robot, self.held) for robot in self.robots]
        asked = list(wanted)
        while any(one != none for one in wanted):
            for robot in self.robots:
                if wanted[robot] != none:
                    self._move(robot, wanted[robot])
            # Cells do not become free within a step: who could not go is not asked again.
            stuck = [but(one, gone) for one, gone in zip(wanted, self.gone, strict=True)]
            beside = self._beside(stuck)
            wanted = [but(self._standing(robot, beside), asked[robot]) for robot in self.robots]
            asked = [one | more for one, more in zip(asked, wanted, strict=True)]
        return self.found

    def _standing(self, robot: int, cells: list[P]) -> P:
        """In which runs an idle robot that does not lead stands in one of the cells."""
        places = self.traffic.places[robot]
        standing = union(
            [one & cell for one, cell in zip(places, cells, strict=True)], self.traffic.none
        )
        return self.traffic.but(standing & self.traffic.is_idle[robot], self.leads[robot])

    def _beside(self, stuck: list[P]) -> list[P]:
        """By cell: it is next to a robot that has to make way and cannot."""
        grid, none = self.traffic.grid, self.traffic.none
        them = [robot for robot in self.robots if stuck[robot] != none]
        here = [
            union([stuck[robot] & self.traffic.places[robot][cell] for robot in them], none)
            for cell in range(grid.size)
        ]
        return [
            union([here[near] for _, near in grid.neighbours(cell)], none)
            for cell in range(grid.size)
        ]

    def _move(self, robot: int, wanted: P) -> None:
        """Send it to the first neighbour that is free: off the leader's way, else ahead on it."""
        traffic, none, but = self.traffic, self.traffic.none, self.traffic.but
        barred = [
            taken | kept | chosen
            for taken, kept, chosen in zip(
                traffic.taken, traffic.reserved, self.chosen, strict=True
            )
        ]
        for cell in traffic.grid.cells:
            left = wanted & traffic.places[robot][cell]
            if left == none:
                continue
            near = [there for _, there in traffic.grid.neighbours(cell)]
            for there in near:
                left = self._step(
                    robot, there, left, but(but(left, barred[there]), self.held[there])
                )
            for there in near if left != none else ():
                goes = but(left, barred[there])
                if goes != none:
                    left = self._step(robot, there, left, goes & self._ahead(cell, there))

    def _step(self, robot: int, there: int, left: P, goes: P) -> P:
        """Send it there; in which runs it still stands."""
        if goes == self.traffic.none:
            return left
        self.found[robot][there] = self.found[robot][there] | goes
        self.chosen[there] = self.chosen[there] | goes
        self.gone[robot] = self.gone[robot] | goes
        return self.traffic.but(left, goes)

    def _ahead(self, cell: int, there: int) -> P:
        """In which runs a cell is nearer to the leader's target than another one."""
        traffic, found = self.traffic, self.traffic.none
        for robot in self.robots:
            for goal, wants in zip(traffic.goals[robot], self.open[robot], strict=True):
                known = traffic.grid.distances(goal)
                if known.get(there, 0) < known.get(cell, 0):
                    found = found | (wants & self.leads[robot])
        return found
