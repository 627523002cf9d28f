"""On which side of its part a port without one direction is drawn, so that lines run on."""

from collections.abc import Iterator, Sequence

from sysmlc.backends.plantuml.connections import Connection, Path

_Key = tuple[str, ...]


def sides(connections: Sequence[Connection]) -> dict[_Key, str]:
    """``portin`` (left) or ``portout`` (right) for each end, by the ids that lead to it.

    Parts stand from left to right as items flow; a link that says no way is drawn from its first
    end to its second. The first connection of a port decides. Where parts or ports are nested
    all stay on the left: dot fails for some diagrams with nested clusters and ports on both sides.
    """
    ends = [end for one in connections for end in (one.source, one.target)]
    if any(end.ports or len(end.parts) > 1 for end in ends):
        return {}
    ranks = _ranks(connections)
    found: dict[_Key, str] = {}
    for connection in connections:
        for own, other, is_first in _ends(connection):
            is_right = _is_right(own, other, is_first, ranks)
            found.setdefault(own.ids(), "portout" if is_right else "portin")
    return found


def _ends(connection: Connection) -> Iterator[tuple[Path, Path, bool]]:
    yield connection.source, connection.target, True
    yield connection.target, connection.source, False


def _is_right(own: Path, other: Path, is_first: bool, ranks: dict[str, int]) -> bool:
    if own.top and other.top and ranks[own.top] != ranks[other.top]:
        return ranks[own.top] < ranks[other.top]
    if bool(own.top) == bool(other.top):
        return is_first
    last = max(ranks.values())
    if last == 0:
        return is_first == bool(own.top)
    return 2 * ranks[own.top or other.top] >= last


def _ranks(connections: Sequence[Connection]) -> dict[str, int]:
    """How many parts items pass before they come to each; those that go round stop counting."""
    steps = [step for one in connections for step in _step(one)]
    ranks = {top: 0 for one in connections for top in one.tops()}
    for _ in ranks:
        for before, after in steps:
            ranks[after] = max(ranks[after], min(ranks[before] + 1, len(ranks) - 1))
    return ranks


def _step(connection: Connection) -> Iterator[tuple[str, str]]:
    """The parts of a connection in the order of its one way, else in that of its ends."""
    first, second = connection.source.top, connection.target.top
    if first and second and first != second:
        is_back = connection.arrow.startswith("<") and not connection.arrow.endswith(">")
        yield (second, first) if is_back else (first, second)
