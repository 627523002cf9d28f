"""Activity partitions: boxes around their nodes where the flow allows it, else names on nodes.

Graphviz lays out each box on its own, so a flow that leaves a box and comes back turns against
the reading direction. Then partitions are written on the nodes, as UML 2.5.1, clause 15.6.4
allows: ``(Robot)`` above the name, with one tint for each partition.
"""

from collections.abc import Iterable, Mapping

TINTS = 6
"""Number of tints in ``_style.j2``; further partitions take them again."""


def can_be_boxes(lane_of: Mapping[str, str], flows: Iterable[tuple[str, str]]) -> bool:
    """Whether no flow returns to a lane that it left.

    ``lane_of`` maps nodes in lanes to their lane, ``flows`` are pairs of nodes.
    """
    following: dict[str, list[str]] = {}
    for source, target in flows:
        one, other = lane_of.get(source, source), lane_of.get(target, target)
        if one != other:
            following.setdefault(one, []).append(other)
    return not any(_returns(lane, following) for lane in dict.fromkeys(lane_of.values()))


def _returns(start: str, following: Mapping[str, list[str]]) -> bool:
    seen: dict[str, None] = {}
    queue = list(following.get(start, ()))
    for place in queue:
        if place == start:
            return True
        if place not in seen:
            seen[place] = None
            queue.extend(following.get(place, ()))
    return False


def tint(number: int) -> str:
    """Style of the nodes in the partition with this number, from 0."""
    return f"lane{number % TINTS + 1}"
