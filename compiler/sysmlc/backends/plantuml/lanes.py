"""Activity partitions are written on their nodes, with a tint for each partition.

UML 2.5.1, clause 15.6.4 allows ``(Robot)`` above a name instead of a lane; docs/decisions says
why lanes as boxes were given up.
"""

TINTS = 6
"""Number of tints in ``_style.j2``; further partitions take them again."""


def tint(number: int) -> str:
    """Style of the nodes in the partition with this number, from 0."""
    return f"lane{number % TINTS + 1}"
