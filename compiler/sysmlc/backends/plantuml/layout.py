"""A grid for boxes that Graphviz would put all in one row: unconnected ones and large fans."""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import ceil, sqrt

from msgspec.structs import replace

from sysmlc.backends.plantuml.connections import Connection, Path
from sysmlc.backends.plantuml.views import Box, BoxView, Line, PartView

_FEW = 3
_ROW = 5


def box_view(boxes: Sequence[Box], lines: Sequence[Line]) -> BoxView:
    """The view: unconnected boxes in columns, what hangs below one box in rows of five."""
    tied = {end for line in lines for end in (line.source, line.target)}
    free = [box.alias for box in boxes if box.alias not in tied]
    columns = max(_FEW, ceil(sqrt(len(free))))
    pairs = zip(free, free[columns:], strict=False)
    guides = tuple(Line(upper, "-[hidden]-", lower) for upper, lower in pairs)
    return BoxView(tuple(boxes), tuple(_in_rows(lines)), guides)


def _in_rows(lines: Sequence[Line]) -> Iterator[Line]:
    """Longer lines for the sixth box below another and those that follow: they stand lower."""
    below: Counter[str] = Counter()
    placed: set[tuple[str, str]] = set()
    for line in lines:
        row = below[line.source] // _ROW
        if (line.source, line.target) not in placed:
            below[line.source] += 1
        placed.add((line.source, line.target))
        yield replace(line, arrow=_longer(line.arrow, row))


def _longer(arrow: str, rows: int) -> str:
    for body in ("--", ".."):
        if body in arrow:
            return arrow.replace(body, body + body[0] * rows, 1)
    return arrow


def iter_port_guides(part: PartView, drawn: Sequence[Line]) -> Iterator[Line]:
    """Lines for the ports of each part: dot ranks what is inside between them.

    PlantUML puts the ports of a side on one rank, so that the first of each side is enough. A
    part that has a line to that side needs none; one more would only make lines cross.
    """
    joined = {frozenset((line.source, line.target)) for line in drawn}
    yield from _iter_part_guides(part, joined)


def _iter_part_guides(part: PartView, joined: set[frozenset[str]]) -> Iterator[Line]:
    left = [port.alias for port in part.ports if port.form != "portout"]
    right = [port.alias for port in part.ports if port.form == "portout"]
    for inner in part.parts:
        into = next((port.alias for port in inner.ports if port.form != "portout"), inner.alias)
        out = next((port.alias for port in inner.ports if port.form == "portout"), into)
        own = [inner.alias, *(port.alias for port in inner.ports)]
        if left and not _are_joined(left, own, joined):
            yield Line(left[0], "-[hidden]->", into)
        if right and not _are_joined(own, right, joined):
            yield Line(out, "-[hidden]---->", right[0])
        yield from _iter_part_guides(inner, joined)


def _are_joined(some: list[str], others: list[str], joined: set[frozenset[str]]) -> bool:
    return any(frozenset((one, other)) in joined for one in some for other in others)


_Key = tuple[str, ...]


def find_port_sides(connections: Sequence[Connection]) -> dict[_Key, str]:
    """``portin`` (left) or ``portout`` (right) for each end, by the ids that lead to it.

    Parts stand from left to right as items flow; a link that says no way is drawn from its first
    end to its second. The first connection of a port decides. Where parts or ports are nested
    all stay on the left: dot fails for some diagrams with nested clusters and ports on both sides.
    """
    ends = [end for one in connections for end in (one.source, one.target)]
    if any(end.ports or len(end.parts) > 1 for end in ends):
        return {}
    ranks = _compute_ranks(connections)
    found: dict[_Key, str] = {}
    for connection in connections:
        for own, other, is_first in _iter_ends(connection):
            is_right = _is_right(own, other, is_first, ranks)
            found.setdefault(own.ids(), "portout" if is_right else "portin")
    return found


def _iter_ends(connection: Connection) -> Iterator[tuple[Path, Path, bool]]:
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


def _compute_ranks(connections: Sequence[Connection]) -> dict[str, int]:
    """How many parts items pass before they come to each; those that go round stop counting."""
    steps = [step for one in connections for step in _iter_steps(one)]
    ranks = {top: 0 for one in connections for top in one.tops()}
    for _ in ranks:
        for before, after in steps:
            ranks[after] = max(ranks[after], min(ranks[before] + 1, len(ranks) - 1))
    return ranks


def _iter_steps(connection: Connection) -> Iterator[tuple[str, str]]:
    """The parts of a connection in the order of its one way, else in that of its ends."""
    first, second = connection.source.top, connection.target.top
    if first and second and first != second:
        is_back = connection.arrow.startswith("<") and not connection.arrow.endswith(">")
        yield (second, first) if is_back else (first, second)
