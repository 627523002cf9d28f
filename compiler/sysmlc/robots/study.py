"""A floor with robots and a mission, as values: what everything else of the study is made of."""

from collections.abc import Iterator
from functools import lru_cache

from msgspec import Struct, field

STAY = "stay"
WAYS = {"up": (-1, 0), "down": (1, 0), "left": (0, -1), "right": (0, 1)}
"""Commands that move a robot, with the change of row and column (thesis, 4.1.2)."""
COMMANDS = (STAY, *WAYS)


class Grid(Struct, frozen=True):
    """Cells in rows and columns, numbered row by row from 0; no robot enters ``blocked`` ones."""

    columns: int
    rows: int
    blocked: tuple[int, ...] = ()

    @property
    def size(self) -> int:
        """Number of all cells."""
        return self.columns * self.rows

    @property
    def cells(self) -> tuple[int, ...]:
        """The cells that a robot can be in."""
        return tuple(cell for cell in range(self.size) if cell not in self.blocked)

    def after(self, cell: int, command: str) -> int | None:
        """Where a command leads to; None into a wall or an obstacle."""
        return _after(self, cell, command)

    def neighbours(self, cell: int) -> Iterator[tuple[str, int]]:
        """Commands that lead somewhere, and where."""
        return iter(_near(self)[cell])

    def distances(self, target: int) -> dict[int, int]:
        """Steps to the target from every cell from which a way leads there."""
        return _distances(self, target)

    def nearer(self, cell: int, target: int) -> tuple[str, ...]:
        """The commands that bring a robot nearer to the target."""
        known = self.distances(target)
        here = known.get(cell, 0)
        return tuple(way for way, there in self.neighbours(cell) if known.get(there, here) < here)


@lru_cache(1 << 14)
def _after(grid: Grid, cell: int, command: str) -> int | None:
    row, column = divmod(cell, grid.columns)
    rows, columns = WAYS.get(command, (0, 0))
    row, column = row + rows, column + columns
    there = row * grid.columns + column
    is_inside = 0 <= row < grid.rows and 0 <= column < grid.columns
    return there if is_inside and there not in grid.blocked else None


@lru_cache(64)
def _near(grid: Grid) -> tuple[tuple[tuple[str, int], ...], ...]:
    """By cell the commands that lead somewhere, and where."""
    return tuple(
        tuple((way, there) for way in WAYS if (there := grid.after(cell, way)) is not None)
        for cell in range(grid.size)
    )


@lru_cache(1 << 12)
def _distances(grid: Grid, target: int) -> dict[int, int]:
    found = {target: 0}
    front = [target]
    while front:
        known = len(found)
        for cell in front:
            for _, there in grid.neighbours(cell):
                found.setdefault(there, found[cell] + 1)
        front = list(found)[known:]
    return found


class Robot(Struct, frozen=True):
    """A robot; ``word`` begins the names of its variables, ``start`` is None for any cell."""

    name: str
    word: str
    origin: str = ""
    start: int | None = None


class Target(Struct, frozen=True):
    """A cell to be reached, and within how many steps of the start of the mission."""

    name: str
    word: str
    cell: int
    origin: str = ""
    deadline: int | None = None


class Order(Struct, frozen=True):
    """Numbers of two targets of which one is reached before the other.

    With ``is_carried`` the same robot goes on from the earlier one to the later one.
    """

    earlier: int
    later: int
    is_carried: bool = False
    origin: str = ""


class Study(Struct, frozen=True):
    """What is known of a floor, its robots and their mission."""

    component: str
    origin: str
    grid: Grid
    robots: tuple[Robot, ...]
    targets: tuple[Target, ...] = ()
    orders: tuple[Order, ...] = ()
    deadline: int | None = None
    """Steps within which the mission is done."""
    within: int | None = None
    """Steps within which a robot reaches a target once it has it."""
    counted: int = 0
    """What step counters count to before they begin again; 0 is for none."""
    obstacles: tuple[str, ...] = field(default=())
    """Ids of the obstacles, in the order of ``grid.blocked``."""

    def earlier(self, target: int) -> tuple[int, ...]:
        """The targets that are reached before this one."""
        return tuple(sorted({one.earlier for one in self.orders if one.later == target}))

    def limit(self, target: Target) -> int | None:
        """The steps within which a target is to be reached: its own, and those of the mission."""
        known = (self.deadline, target.deadline)
        return min((one for one in known if one is not None), default=None)

    @property
    def carried(self) -> dict[int, int]:
        """The target that the robot goes on to, by the one that it has reached."""
        return {one.earlier: one.later for one in self.orders if one.is_carried}


def possible_starts(study: Study, robot: int) -> tuple[int, ...]:
    """The cells that a robot may start in."""
    taken = {one.start for at, one in enumerate(study.robots) if at != robot}
    start = study.robots[robot].start
    return (start,) if start is not None else tuple(c for c in study.grid.cells if c not in taken)


@lru_cache(1 << 14)
def next_move(grid: Grid, cell: int, goal: int) -> tuple[str, int] | None:
    """The command that leads on to the target, and where it leads; None in it or without a way."""
    ways = grid.nearer(cell, goal)
    there = grid.after(cell, ways[0]) if ways else None
    return None if there is None else (ways[0], there)


@lru_cache(1 << 12)
def successors_by_distance(grid: Grid, goal: int) -> tuple[tuple[int, int], ...]:
    """Each cell with the next one on the way to the target, the farthest first."""
    known = grid.distances(goal)
    farthest_first = sorted(known, key=lambda cell: -known[cell])
    found = ((cell, next_move(grid, cell, goal)) for cell in farthest_first)
    return tuple((cell, step[1]) for cell, step in found if step is not None)


def shortest_path(grid: Grid, cell: int, goal: int) -> tuple[int, ...]:
    """All cells of the way, both ends included; empty when there is none."""
    if cell not in grid.distances(goal):
        return ()
    found = [cell]
    while (step := next_move(grid, found[-1], goal)) is not None:
        found.append(step[1])
    return tuple(found)
