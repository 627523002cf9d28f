"""What a text says, apart from where: its tokens, and what parts them (KerML 8.2.2.1)."""

import math
from hashlib import sha256

from sysmlc.language.text.scan import BAD, DIGITS, TOKEN, body_text, unquoted

_TRUTH = frozenset({"true", "false"})

Spans = list[tuple[int, int]]
"""Where each token starts and ends, in characters; the last one is the end of the text."""


def spans(text: str) -> Spans | None:
    """The tokens of a text; None where something in it is no token."""
    found: Spans = []
    for match in TOKEN.finditer(text):
        group = match.lastindex or 0
        if group == BAD:
            return None
        found.append(match.span(group) if group else (match.end(), match.end()))
        if not group:
            break
    return found


def digests(text: str) -> tuple[str, str]:
    """What a text says, and what it says but for the values of literals; empty without tokens.

    The first is equal for texts that differ in blanks, line ends and notes between their tokens
    only. Two tokens stay together, in one line or in two as they were: faults are mended by that.
    What stands before the first is not looked at. The second knows of literals of what kind they
    are: a text, a natural or another number, a truth value, the body of a comment.
    """
    found = list(TOKEN.finditer(text))
    if "\0" in text or BAD in {match.lastindex for match in found}:
        return "", ""
    # A text says the same few hundred things again and again.
    pieces = [match[0] for match in found]
    told = {piece: _told(piece) for piece in set(pieces)}
    each = [told[piece] for piece in pieces]
    return _hashed([said for said, _ in each]), _hashed([shape for _, shape in each])


def digest(text: str) -> str:
    """The first of the ``digests`` of a text."""
    return digests(text)[0]


def _told(piece: str) -> tuple[str, str]:
    """What a token says with what parts it from the one before, and that without its value."""
    found = TOKEN.match(piece)
    token = found[found.lastindex or 0] if found and found.lastindex else ""
    between = _between(piece, 0, len(piece) - len(token))
    whole = f"{between}{len(token)} {token}"
    kind = literal_kind(token)
    return whole, f"{between}{kind}" if kind else whole


def _hashed(said: list[str]) -> str:
    together = "".join(said).lstrip()
    return sha256(together.encode("utf-8", "surrogatepass")).hexdigest()


def literal_kind(piece: str) -> str:
    """What kind of literal a token is; empty for any other token."""
    if piece[:1] == '"':
        return "text"
    if piece[:2] == "/*":
        return "comment"
    if piece[:1].isdigit() or (piece[:1] == "." and piece[1:2].isdigit()):
        return "natural" if piece.isdigit() and len(piece) <= DIGITS else "number"
    return "truth" if piece in _TRUTH else ""


def literal(piece: str) -> str | int | float | bool | None:
    """The value of a literal; None for another token, and for a number that is too large."""
    kind = literal_kind(piece)
    if kind == "text":
        return unquoted(piece)
    if kind == "comment":
        return body_text(piece)
    if kind == "truth":
        return piece == "true"
    if kind == "natural":
        return int(piece)
    found = float(piece) if kind else math.inf
    return None if math.isinf(found) else found


def last(text: str, start: int, end: int) -> int:
    """Where the last token of part of a text starts; -1 without one."""
    found = -1
    for match in TOKEN.finditer(text, start, end):
        group = match.lastindex or 0
        if not group:
            break
        found = match.start(group)
    return found


def said(text: str, start: int, end: int) -> str:
    """Part of a text in one line, without notes."""
    pieces, last = [], -1
    for match in TOKEN.finditer(text, start, end):
        group = match.lastindex or 0
        if not group:
            break
        if last >= 0 and match.start(group) > last:
            pieces.append(" ")
        pieces.append(match[group])
        last = match.end(group)
    return "".join(pieces)


def _between(text: str, start: int, end: int) -> str:
    if start == end:
        return ""
    between = text[start:end]
    return "\n" if "\n" in between or "\r" in between else " "
