"""SysML v2 text from a tree of lines."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from sysmlc.language.text.spelling import (
    RESERVED,
    format_comment,
    quote_name,
    quote_string,
    replace_control_characters,
)

__all__ = [
    "INDENT",
    "RESERVED",
    "Line",
    "format_comment",
    "print_lines",
    "quote_name",
    "quote_string",
    "replace_control_characters",
]

INDENT = "    "
_WIDTH = 96


# -- members -------------------------------------------------------------------------------------


@dataclass(slots=True, eq=False)
class Line:
    """A member of the text: its declaration, and the members between its braces.

    A declaration may have several lines; those after the first are indented by one level. *text*
    is a comment, or a result expression, that ends the member. *depth* adds levels of indentation.
    """

    head: str
    body: list["Line"] = field(default_factory=list)
    text: list[str] = field(default_factory=list)
    depth: int = 0
    tail: str = ""
    """The part of the declaration that follows the members (``then`` of a transition)."""
    tail_body: list["Line"] = field(default_factory=list)
    """The members between the braces that follow the tail."""
    is_short: bool = False
    """Whether the member and its body stand in one line if they fit."""

    @property
    def inline(self) -> str | None:
        """The whole member in one line, or None if it needs several."""
        if not self.head and len(self.text) == 1 and not self.text[0].startswith("/*"):
            return self.text[0]
        if self.text or self.tail or "\n" in self.head:
            return None
        if not self.body:
            return f"{self.head};"
        if not self.is_short and not (len(self.body) == 1 and self.body[0].is_short):
            return None
        body = [line.inline for line in self.body]
        if None in body:
            return None
        text = f"{self.head} {{ {' '.join(map(str, body))} }}"
        return text if len(text) <= _WIDTH else None


def print_lines(lines: Iterable[Line]) -> str:
    """Return the members as text, with empty lines around members of several lines.

    An explicit stack replaces recursion: models of any depth are printed.
    """
    output: list[str] = []
    stack: list[tuple[Line | str, int]] = []
    _push(stack, list(lines), 0)
    while stack:
        top, depth = stack.pop()
        if isinstance(top, str):
            output.append(f"{INDENT * depth}{top}" if top else "")
            continue
        inline = top.inline if len(INDENT) * depth + len(top.head) < _WIDTH else None
        if inline is not None and len(inline) + len(INDENT) * depth <= _WIDTH:
            output.append(f"{INDENT * depth}{inline}")
            continue
        end = "" if top.text else (" {" if top.body else ";")
        output += _format_head(top, depth, end)
        if top.body:
            if top.tail_body:
                stack.append(("}", depth))
                _push(stack, top.tail_body, depth + 1)
                stack.append((f"}} {top.tail} {{", depth))
            else:
                stack.append((f"}} {top.tail};" if top.tail else "}", depth))
            _push(stack, top.body, depth + 1)
    output.append("")
    return "\n".join(output)


def _format_head(line: Line, depth: int, end: str) -> list[str]:
    first, *rest = line.head.split("\n") if line.head else [""]
    rows = [f"{INDENT * depth}{first}", *(f"{INDENT * (depth + 1)}{row}" for row in rest)]
    if not line.text:
        rows[-1] += end
        return rows
    if len(line.text) == 1:
        rows[-1] += f" {line.text[0]}" if first else line.text[0]
        return rows
    return [*rows, *(f"{INDENT * depth}{row}" for row in line.text)]


def _push(stack: list[tuple[Line | str, int]], lines: list[Line], depth: int) -> None:
    """Push the lines in reverse order, with an empty line on each side of a large member."""
    for index in range(len(lines) - 1, -1, -1):
        line = lines[index]
        stack.append((line, depth + line.depth))
        if index and (_needs_empty_lines(line) or _needs_empty_lines(lines[index - 1])):
            stack.append(("", 0))


def _needs_empty_lines(line: Line) -> bool:
    """Whether the member takes several lines, more than one short annotation."""
    if not line.body or line.inline is not None:
        return False
    return len(line.body) > 1 or line.body[0].inline is None or not line.body[0].is_short
