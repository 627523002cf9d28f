"""What a text says, apart from where: its tokens, and what parts them (KerML 8.2.2.1)."""

from hashlib import sha256

from sysmlc.language.text.scan import BAD, TOKEN

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


def digest(text: str) -> str:
    """Equal for texts that differ in blanks, line ends and notes between their tokens only.

    Two tokens stay together, in one line or in two as they were: faults are mended by that. What
    stands before the first is not looked at. Empty for a text that is not made of tokens.
    """
    found = spans(text)
    if found is None or "\0" in text:
        return ""
    hashed, last = sha256(), found[0][0]
    for start, end in found:
        piece = text[start:end]
        hashed.update(f"{_between(text, last, start)}{len(piece)} {piece}".encode())
        last = end
    return hashed.hexdigest()


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
