"""A floor with robots and a mission as values, and shortest paths on the floor."""

from collections.abc import Iterator
from functools import lru_cache

from msgspec import Struct, field

STAY = "stay"
WAYS = {"up": (-1, 0), "down": (1, 0), "left": (0, -1), "right": (0, 1)}
"""Commands that move a robot, with the changes of row and column (thesis, 4.1.2)."""
COMMANDS = (STAY, *WAYS)


class Grid(Struct, frozen=True):
    """The cells of a floor, numbered row by row from 0."""

    columns: int
    rows: int
    blocked: tuple[int, ...] = ()
    """The cells with obstacles, which robots cannot enter."""

    @property
    def size(self) -> int:
        """Number of all cells."""
        return self.columns * self.rows

    @property
    def cells(self) -> tuple[int, ...]:
        """The cells that a robot can enter."""
        return tuple(cell for cell in range(self.size) if cell not in self.blocked)

    def cell_after(self, cell: int, command: str) -> int | None:
        """Return the cell to which a command leads, or None if it is blocked or off the floor."""
        return _neighbour_after(self, cell, command)

    def neighbours(self, cell: int) -> Iterator[tuple[str, int]]:
        """Yield the neighbours that a robot can enter, each with the command that leads there."""
        return iter(_neighbours(self)[cell])

    def distances(self, target: int) -> dict[int, int]:
        """Return the steps to the target from every cell that is connected to it."""
        return _compute_distances(self, target)

    def commands_nearer(self, cell: int, target: int) -> tuple[str, ...]:
        """Return the commands that reduce the distance to the target."""
        distances = self.distances(target)
        distance = distances.get(cell, 0)
        return tuple(
            way
            for way, neighbour in self.neighbours(cell)
            if distances.get(neighbour, distance) < distance
        )


@lru_cache(1 << 14)
def _neighbour_after(grid: Grid, cell: int, command: str) -> int | None:
    row, column = divmod(cell, grid.columns)
    row_change, column_change = WAYS.get(command, (0, 0))
    row, column = row + row_change, column + column_change
    neighbour = row * grid.columns + column
    is_inside = 0 <= row < grid.rows and 0 <= column < grid.columns
    return neighbour if is_inside and neighbour not in grid.blocked else None


@lru_cache(64)
def _neighbours(grid: Grid) -> tuple[tuple[tuple[str, int], ...], ...]:
    """Return for each cell its neighbours (``Grid.neighbours``)."""
    return tuple(
        tuple(
            (way, neighbour)
            for way in WAYS
            if (neighbour := grid.cell_after(cell, way)) is not None
        )
        for cell in range(grid.size)
    )


@lru_cache(1 << 12)
def _compute_distances(grid: Grid, target: int) -> dict[int, int]:
    distances = {target: 0}
    frontier = [target]
    while frontier:
        visited = len(distances)
        for cell in frontier:
            for _, neighbour in grid.neighbours(cell):
                distances.setdefault(neighbour, distances[cell] + 1)
        frontier = list(distances)[visited:]
    return distances


class Robot(Struct, frozen=True):
    """A robot of a floor."""

    name: str
    word: str
    """The prefix of the names of its variables."""
    origin: str = ""
    start: int | None = None
    """The cell in which it starts; None if that may be any cell."""


class Target(Struct, frozen=True):
    """A cell to be reached, and ``deadline``, the step by which it must be reached."""

    name: str
    word: str
    """The value that stands for the target in contracts."""
    cell: int
    origin: str = ""
    deadline: int | None = None


class Order(Struct, frozen=True):
    """The order of two targets, given by their numbers."""

    earlier: int
    later: int
    is_carried: bool = False
    """Whether the robot that reached the earlier target must continue to the later one (it carries
    something)."""
    origin: str = ""


class Study(Struct, frozen=True):
    """A floor, its robots and their mission."""

    component: str
    origin: str
    grid: Grid
    robots: tuple[Robot, ...]
    targets: tuple[Target, ...] = ()
    orders: tuple[Order, ...] = ()
    deadline: int | None = None
    """Steps within which the mission must be accomplished."""
    within: int | None = None
    """Steps within which a robot must reach a target after its assignment."""
    counter_size: int = 0
    """Number of values of the step counters, which wrap around; 0 for no counters."""
    obstacles: tuple[str, ...] = field(default=())
    """Ids of the obstacles, in the order of ``grid.blocked``."""

    def earlier(self, target: int) -> tuple[int, ...]:
        """Return the targets that must be reached before this one."""
        return tuple(sorted({order.earlier for order in self.orders if order.later == target}))

    def limit(self, target: Target) -> int | None:
        """Return the earlier one of the deadlines of the target and of the mission, if any."""
        deadlines = (self.deadline, target.deadline)
        return min((deadline for deadline in deadlines if deadline is not None), default=None)

    @property
    def carried_targets(self) -> dict[int, int]:
        """The carried targets, by the target from which the same robot continues."""
        return {order.earlier: order.later for order in self.orders if order.is_carried}


def possible_starts(study: Study, robot: int) -> tuple[int, ...]:
    """Return the cells in which a robot may start: its start, or all cells that are free."""
    other_starts = {
        placed_robot.start for number, placed_robot in enumerate(study.robots) if number != robot
    }
    start = study.robots[robot].start
    return (
        (start,)
        if start is not None
        else tuple(cell for cell in study.grid.cells if cell not in other_starts)
    )


@lru_cache(1 << 14)
def next_move(grid: Grid, cell: int, goal: int) -> tuple[str, int] | None:
    """Return the first command on the shortest path to *goal*, and the cell that it leads to.

    None if *cell* is the goal or there is no path.
    """
    commands = grid.commands_nearer(cell, goal)
    neighbour = grid.cell_after(cell, commands[0]) if commands else None
    return None if neighbour is None else (commands[0], neighbour)


@lru_cache(1 << 12)
def successors_by_distance(grid: Grid, goal: int) -> tuple[tuple[int, int], ...]:
    """Return pairs of a cell and the next cell on its path to *goal*, the farthest cells first."""
    distances = grid.distances(goal)
    farthest_first = sorted(distances, key=lambda cell: -distances[cell])
    moves = ((cell, next_move(grid, cell, goal)) for cell in farthest_first)
    return tuple((cell, move[1]) for cell, move in moves if move is not None)


def shortest_path(grid: Grid, cell: int, goal: int) -> tuple[int, ...]:
    """Return the cells of the path, both ends included; empty if there is no path."""
    if cell not in grid.distances(goal):
        return ()
    path = [cell]
    while (move := next_move(grid, path[-1], goal)) is not None:
        path.append(move[1])
    return tuple(path)
