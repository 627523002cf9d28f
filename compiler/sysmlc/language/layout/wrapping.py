"""Long lines broken where it reads best."""

from collections.abc import Sequence

from sysmlc.language.layout.spacing import Piece

WIDTH = 100
"""Characters of a line, its indentation included."""


def wrapped(pieces: Sequence[Piece], first: str, rest: str) -> list[str]:
    """The pieces in lines: the first starts with ``first``, what goes on with ``rest``."""
    found: list[str] = []
    indent = first
    start = 0
    while start < len(pieces):
        end = _end(pieces, start, len(indent))
        found.append(indent + flat(pieces[start:end]))
        indent, start = rest, end
    return found


def flat(pieces: Sequence[Piece]) -> str:
    """The pieces in one line."""
    return "".join(p.space + p.text if i else p.text for i, p in enumerate(pieces))


def _end(pieces: Sequence[Piece], start: int, used: int) -> int:
    """Where the line that begins with piece ``start`` ends."""
    best, rank = 0, 0
    for index in range(start, len(pieces)):
        piece = pieces[index]
        space = piece.space if index > start else ""
        if (
            index > start
            and piece.rank is not None
            and _fits(used)
            and (not best or piece.rank <= rank)
        ):
            best, rank = index, piece.rank
        used += len(space) + _width(piece.text)
        if used > WIDTH and best:
            return best
        if used > WIDTH and index > start and piece.rank is not None:
            return index
    return len(pieces)


def _fits(used: int) -> bool:
    return used <= WIDTH


def _width(text: str) -> int:
    return len(text) - text.rfind("\n") - 1
