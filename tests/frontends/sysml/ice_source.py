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
        for child in self.inside:
            yield from child.walk()

    def find(self, pattern: str) -> "Iterator[tuple[re.Match[str], Block]]":
        for block in self.walk():
            match = re.fullmatch(pattern, block.head)
            if match:
                yield match, block


def blank_comments(text: str) -> str:
    """The text with blanks where comments are, so that lines and columns stay."""

    def blank(match: re.Match[str]) -> str:
        return match[0] if match[0][0] == '"' else re.sub(r"[^\n]", " ", match[0])

    return _COMMENT.sub(blank, text)


def read(path: Path) -> Block:
    """A file as one block."""
    # Braces and semicolons in texts between quotes (``ns=2;s=Busy``) separate nothing.
    text = re.sub(_TEXT, lambda m: m[0].replace(";", "\x01"), blank_comments(path.read_text()))
    statements, _ = _read_statements(text, 0)
    return Block("", statements)


def _read_statements(text: str, start: int) -> tuple[list[Block], int]:
    statements: list[Block] = []
    while token := _TOKEN.search(text, start):
        head = text[start : token.start()].replace("\x01", ";")
        start = token.end()
        if token[0] == "}":
            return statements, start
        children: list[Block] = []
        if token[0] == "{":
            children, start = _read_statements(text, start)
        statements.append(Block(head, children))
    return statements, start


def read_arguments(block: Block) -> dict[str, str]:
    """``in ref :>> name = value;`` of a step, by name."""
    pattern = r"in (?:ref |constant )*:>> (\w+) = (.+)"
    matches = (re.fullmatch(pattern, child.head) for child in block.inside)
    return {match[1]: match[2] for match in matches if match}


def read_literals(enums: Block) -> dict[str, int | str]:
    """``Enumeration::literal`` with its number, or its name when it has none."""
    numbers: dict[str, int | str] = {}
    for name, block in enums.find(r"enum def (\w+)(?: :> \w+)?"):
        for child in block.inside:
            literal = re.fullmatch(r"(?:enum )?(\w+)(?: = (-?\d+))?", child.head)
            if literal:
                numbers[f"{name[1]}::{literal[1]}"] = int(literal[2]) if literal[2] else literal[1]
    return numbers
