"""Members as they are written: a tree that is printed without recursion, four spaces a level."""

from collections.abc import Iterable
from dataclasses import dataclass, field

_STEP = "    "


@dataclass(slots=True, eq=False)
class Line:
    """One member: its declaration, and what stands between its braces.

    Lines after the first of a declaration are continued one level deeper. ``text`` is a comment
    body that ends the member; ``depth`` sets a member apart from those before it.
    """

    head: str
    body: list["Line"] = field(default_factory=list)
    text: list[str] = field(default_factory=list)
    depth: int = 0
    tail: str = ""
    """What of the declaration follows the members."""
    is_short: bool = False
    """Whether it is written in one line with its members, if they fit."""

    @property
    def inline(self) -> str | None:
        """The whole member in one line, or None when it is not meant to be, or too long."""
        if not self.head and len(self.text) == 1 and not self.text[0].startswith("/*"):
            return self.text[0]
        if self.text or self.tail or "\n" in self.head:
            return None
        if not self.body:
            return f"{self.head};"
        if not self.is_short and not (len(self.body) == 1 and self.body[0].is_short):
            return None
        inside = [one.inline for one in self.body]
        if None in inside:
            return None
        found = f"{self.head} {{ {' '.join(map(str, inside))} }}"
        return found if len(found) <= _WIDTH else None


_WIDTH = 96


def printed(lines: Iterable[Line]) -> str:
    """The members as text; definitions and packages stand apart from one another."""
    out: list[str] = []
    stack: list[tuple[Line | str, int]] = []
    _push(stack, list(lines), 0)
    while stack:
        top, depth = stack.pop()
        if isinstance(top, str):
            out.append(f"{_STEP * depth}{top}" if top else "")
            continue
        short = top.inline if len(_STEP) * depth + len(top.head) < _WIDTH else None
        if short is not None and len(short) + len(_STEP) * depth <= _WIDTH:
            out.append(f"{_STEP * depth}{short}")
            continue
        end = "" if top.text else (" {" if top.body else ";")
        out += _head(top, depth, end)
        if top.body:
            stack.append((f"}} {top.tail};" if top.tail else "}", depth))
            _push(stack, top.body, depth + 1)
    out.append("")
    return "\n".join(out)


def _head(line: Line, depth: int, end: str) -> list[str]:
    first, *rest = line.head.split("\n") if line.head else [""]
    lines = [f"{_STEP * depth}{first}", *(f"{_STEP * (depth + 1)}{one}" for one in rest)]
    if not line.text:
        lines[-1] += end
        return lines
    if len(line.text) == 1:
        lines[-1] += f" {line.text[0]}" if first else line.text[0]
        return lines
    return [*lines, *(f"{_STEP * depth}{one}" for one in line.text)]


def _push(stack: list[tuple[Line | str, int]], lines: list[Line], depth: int) -> None:
    for number in range(len(lines) - 1, -1, -1):
        line = lines[number]
        stack.append((line, depth + line.depth))
        if number and (_is_large(line) or _is_large(lines[number - 1])):
            stack.append(("", 0))


def _is_large(line: Line) -> bool:
    """Whether an empty line sets the member apart: it takes several lines."""
    if not line.body or line.inline is not None:
        return False
    return len(line.body) > 1 or line.body[0].inline is None or not line.body[0].is_short
