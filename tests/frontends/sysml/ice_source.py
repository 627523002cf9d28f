"""The ICE laboratory's text read by braces and semicolons only: none of the compiler's code."""

import re
from collections.abc import Iterator
from pathlib import Path

_TEXT = r'"(?:\\.|[^"\\])*"'
_COMMENT = re.compile(rf"{_TEXT}|(?:\bdoc\s*)?/\*.*?\*/|//[^\n]*", re.DOTALL)
_TOKEN = re.compile(r"[{};]")


class Block:
    """A statement up to its ``;`` or ``{``, with the statements between its braces."""

    def __init__(self, head: str, inside: "list[Block]") -> None:
        self.head = " ".join(head.split())
        self.inside = inside

    def walk(self) -> "Iterator[Block]":
        yield self
        for one in self.inside:
            yield from one.walk()

    def find(self, pattern: str) -> "Iterator[tuple[re.Match[str], Block]]":
        for one in self.walk():
            found = re.fullmatch(pattern, one.head)
            if found:
                yield found, one


def uncommented(text: str) -> str:
    """The text with blanks where comments are, so that lines and columns stay."""

    def blank(found: re.Match[str]) -> str:
        return found[0] if found[0][0] == '"' else re.sub(r"[^\n]", " ", found[0])

    return _COMMENT.sub(blank, text)


def read(path: Path) -> Block:
    """A file as one block."""
    # Braces and semicolons in texts between quotes (``ns=2;s=Busy``) separate nothing.
    text = re.sub(_TEXT, lambda m: m[0].replace(";", "\x01"), uncommented(path.read_text()))
    found, _ = _statements(text, 0)
    return Block("", found)


def _statements(text: str, at: int) -> tuple[list[Block], int]:
    found: list[Block] = []
    while mark := _TOKEN.search(text, at):
        head = text[at : mark.start()].replace("\x01", ";")
        at = mark.end()
        if mark[0] == "}":
            return found, at
        inside: list[Block] = []
        if mark[0] == "{":
            inside, at = _statements(text, at)
        found.append(Block(head, inside))
    return found, at


def arguments(block: Block) -> dict[str, str]:
    """``in ref :>> name = value;`` of a step, by name."""
    pattern = r"in (?:ref |constant )*:>> (\w+) = (.+)"
    found = (re.fullmatch(pattern, one.head) for one in block.inside)
    return {m[1]: m[2] for m in found if m}


def literals(enums: Block) -> dict[str, int | str]:
    """``Enumeration::literal`` with its number, or its name when it has none."""
    found: dict[str, int | str] = {}
    for name, block in enums.find(r"enum def (\w+)(?: :> \w+)?"):
        for one in block.inside:
            literal = re.fullmatch(r"(?:enum )?(\w+)(?: = (-?\d+))?", one.head)
            if literal:
                found[f"{name[1]}::{literal[1]}"] = int(literal[2]) if literal[2] else literal[1]
    return found
