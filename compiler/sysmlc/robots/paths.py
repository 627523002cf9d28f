"""The ways that robots are sent: one shortest way from each cell to each target."""

from functools import lru_cache

from sysmlc.robots.study import Grid


@lru_cache(1 << 14)
def hop(grid: Grid, cell: int, goal: int) -> tuple[str, int] | None:
    """The command that leads on to the target, and where it leads; None in it or without a way."""
    ways = grid.nearer(cell, goal)
    there = grid.after(cell, ways[0]) if ways else None
    return None if there is None else (ways[0], there)


@lru_cache(1 << 12)
def chain(grid: Grid, goal: int) -> tuple[tuple[int, int], ...]:
    """Each cell with the next one on the way to the target, the farthest first."""
    known = grid.distances(goal)
    farthest_first = sorted(known, key=lambda cell: -known[cell])
    found = ((cell, hop(grid, cell, goal)) for cell in farthest_first)
    return tuple((cell, step[1]) for cell, step in found if step is not None)


def path(grid: Grid, cell: int, goal: int) -> tuple[int, ...]:
    """All cells of the way, both ends included; empty when there is none."""
    if cell not in grid.distances(goal):
        return ()
    found = [cell]
    while (step := hop(grid, found[-1], goal)) is not None:
        found.append(step[1])
    return tuple(found)
