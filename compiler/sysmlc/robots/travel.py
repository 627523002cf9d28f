"""How long robots travel: from their starts and from targets to targets (thesis, 4.3.4)."""

from collections.abc import Mapping

from msgspec import Struct

from sysmlc.robots.study import Study

START = -1
"""The place of a robot that has reached no target yet; other places are numbers of targets."""
REACTION = 2
"""Steps in which a robot that has a new target does not move yet: the one in which it learns of
it, and stays because it was in its last target, and the one in which its first command is given."""


class Travel(Struct, frozen=True):
    """Steps by (robot, place, target), all numbers; what is not there cannot be reached."""

    steps: Mapping[tuple[int, int, int], int]
    is_simulated: bool = False
    """Whether they were measured in the simulation of synthesised robots."""

    def get(self, robot: int, place: int, target: int) -> int | None:
        """The steps of one way; None when no way leads there."""
        return self.steps.get((robot, place, target))

    @property
    def longest(self) -> int:
        """The steps of the longest way, at least 1."""
        return max(self.steps.values(), default=1)


def starts_of(study: Study, robot: int) -> tuple[int, ...]:
    """The cells that a robot may start in."""
    taken = {one.start for at, one in enumerate(study.robots) if at != robot}
    start = study.robots[robot].start
    return (start,) if start is not None else tuple(c for c in study.grid.cells if c not in taken)


def shortest(study: Study) -> Travel:
    """The steps that a robot needs when nothing is in its way."""
    found: dict[tuple[int, int, int], int] = {}
    for robot in range(len(study.robots)):
        places = {START: starts_of(study, robot)}
        places |= {at: (target.cell,) for at, target in enumerate(study.targets)}
        for place, cells in places.items():
            for goal, target in enumerate(study.targets):
                known = study.grid.distances(target.cell)
                if goal != place and all(cell in known for cell in cells):
                    way = max((known[cell] for cell in cells), default=0)
                    found[robot, place, goal] = way + REACTION if way else 1
    return Travel(found)
