"""Hints for the layout by Graphviz: grids, invisible lines, and the sides of ports."""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import ceil, sqrt

from msgspec.structs import replace

from sysmlc.backends.plantuml.connections import Connection, Path
from sysmlc.backends.plantuml.views import Box, BoxView, Line, PartView

_FEW = 3
_ROW = 5


def arrange_boxes(boxes: Sequence[Box], lines: Sequence[Line]) -> BoxView:
    """Return the view with unconnected boxes in columns, and with boxes below one box in rows of
    five.
    """
    connected = {end for line in lines for end in (line.source, line.target)}
    unconnected = [box.alias for box in boxes if box.alias not in connected]
    columns = max(_FEW, ceil(sqrt(len(unconnected))))
    pairs = zip(unconnected, unconnected[columns:], strict=False)
    guides = tuple(Line(upper, "-[hidden]-", lower) for upper, lower in pairs)
    return BoxView(tuple(boxes), tuple(_lengthen_lines(lines)), guides)


def _lengthen_lines(lines: Sequence[Line]) -> Iterator[Line]:
    """Yield longer lines for the sixth and later boxes below another, so that they stand lower."""
    counts: Counter[str] = Counter()
    pairs_done: set[tuple[str, str]] = set()
    for line in lines:
        row = counts[line.source] // _ROW
        if (line.source, line.target) not in pairs_done:
            counts[line.source] += 1
        pairs_done.add((line.source, line.target))
        yield replace(line, arrow=_lengthen_arrow(line.arrow, row))


def _lengthen_arrow(arrow: str, rows: int) -> str:
    for body in ("--", ".."):
        if body in arrow:
            return arrow.replace(body, body + body[0] * rows, 1)
    return arrow


def iter_port_guides(part: PartView, lines: Sequence[Line]) -> Iterator[Line]:
    """Yield invisible lines that keep the ports of internal block diagrams on the border of their
    parts.

    PlantUML puts the ports of a side on one rank, so that a line for the first port of each side is
    enough. A part that has a visible line to that side needs none; another one would only make
    lines cross.
    """
    connected = {frozenset((line.source, line.target)) for line in lines}
    yield from _iter_part_guides(part, connected)


def _iter_part_guides(part: PartView, connected: set[frozenset[str]]) -> Iterator[Line]:
    left = [port.alias for port in part.ports if port.form != "portout"]
    right = [port.alias for port in part.ports if port.form == "portout"]
    for inner in part.parts:
        into = next((port.alias for port in inner.ports if port.form != "portout"), inner.alias)
        out = next((port.alias for port in inner.ports if port.form == "portout"), into)
        own_aliases = [inner.alias, *(port.alias for port in inner.ports)]
        if left and not _are_connected(left, own_aliases, connected):
            yield Line(left[0], "-[hidden]->", into)
        if right and not _are_connected(own_aliases, right, connected):
            yield Line(out, "-[hidden]---->", right[0])
        yield from _iter_part_guides(inner, connected)


def _are_connected(
    left_aliases: list[str], right_aliases: list[str], connected: set[frozenset[str]]
) -> bool:
    return any(
        frozenset((left, right)) in connected for left in left_aliases for right in right_aliases
    )


_Key = tuple[str, ...]


def find_port_sides(connections: Sequence[Connection]) -> dict[_Key, str]:
    """Return ``portin`` (left) or ``portout`` (right) for each end, by the ids on its path.

    Parts stand from left to right as items flow; a link without direction is drawn from its first
    end to its second. The first connection of a port decides. Nested parts and ports all stay on
    the left: dot fails for some diagrams with nested clusters and ports on both sides.
    """
    ends = [end for connection in connections for end in (connection.source, connection.target)]
    if any(end.ports or len(end.parts) > 1 for end in ends):
        return {}
    ranks = _compute_ranks(connections)
    forms: dict[_Key, str] = {}
    for connection in connections:
        for near, far, is_first in _iter_ends(connection):
            is_right = _is_right(near, far, is_first, ranks)
            forms.setdefault(near.ids(), "portout" if is_right else "portin")
    return forms


def _iter_ends(connection: Connection) -> Iterator[tuple[Path, Path, bool]]:
    yield connection.source, connection.target, True
    yield connection.target, connection.source, False


def _is_right(near: Path, far: Path, is_first: bool, ranks: dict[str, int]) -> bool:
    if near.top and far.top and ranks[near.top] != ranks[far.top]:
        return ranks[near.top] < ranks[far.top]
    if bool(near.top) == bool(far.top):
        return is_first
    last = max(ranks.values())
    if last == 0:
        return is_first == bool(near.top)
    return 2 * ranks[near.top or far.top] >= last


def _compute_ranks(connections: Sequence[Connection]) -> dict[str, int]:
    """Return the number of parts that items pass before each part; cycles are cut."""
    steps = [step for connection in connections for step in _iter_steps(connection)]
    ranks = {top: 0 for connection in connections for top in connection.find_top_parts()}
    # Bellman and Ford on unit steps: one round for each part, so that a cycle ends, too.
    for _ in ranks:
        for before, after in steps:
            ranks[after] = max(ranks[after], min(ranks[before] + 1, len(ranks) - 1))
    return ranks


def _iter_steps(connection: Connection) -> Iterator[tuple[str, str]]:
    """Yield the parts of a connection in the direction of its flow, else in the order of its
    ends.
    """
    first, second = connection.source.top, connection.target.top
    if first and second and first != second:
        is_back = connection.arrow.startswith("<") and not connection.arrow.endswith(">")
        yield (second, first) if is_back else (first, second)
