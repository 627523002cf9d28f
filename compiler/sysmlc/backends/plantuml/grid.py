"""A grid for boxes that Graphviz would put all in one row: unconnected ones and large fans."""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import ceil, sqrt

from msgspec.structs import replace

from sysmlc.backends.plantuml.views import Box, BoxView, Line

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
