"""Comments and notes of several lines, moved to another column without changing what they say.

The text of a comment is without the white space at the start of its lines and the asterisk there
(KerML 8.2.3.3.2), so both may be moved; what is behind them stays.
"""

_BLANK = " \t\f\v"
_TAB = 4


def lines(text: str, column: int, indent: str) -> list[str]:
    """The lines of a comment that started in ``column`` and now starts after ``indent``."""
    first, *rest = text.split("\n")
    if not rest:
        return [indent + text]
    opening = first if first.strip("/*" + _BLANK) else first.rstrip(_BLANK)
    *middle, last = rest
    if all(_is_starred(line) for line in middle) and _is_starred(last.removesuffix("*/")):
        moved = [_starred(line, indent) for line in middle]
        closing = _starred(last, indent)
    else:
        is_bare = not last.removesuffix("*/").strip(_BLANK)
        filled = filter(str.strip, middle if is_bare else rest)
        shift = len(indent) - min([column, *map(_before, filled)])
        moved = [_shifted(line, shift) for line in middle]
        closing = f"{indent} */" if is_bare else _shifted(last, shift)
    return [indent + opening, *moved, closing]


def _is_starred(line: str) -> bool:
    bare = line.lstrip(_BLANK)
    return not bare or bare.startswith("*")


def _starred(line: str, indent: str) -> str:
    bare = line.lstrip(_BLANK)
    if not bare:
        return ""
    if bare in ("*", "* "):
        return f"{indent} *"
    return f"{indent} {bare}"


def _shifted(line: str, shift: int) -> str:
    bare = line.lstrip(_BLANK)
    return " " * max(0, _before(line) + shift) + bare if bare else ""


def _before(line: str) -> int:
    """Columns before the first character of a line."""
    return len(line[: len(line) - len(line.lstrip(_BLANK))].expandtabs(_TAB))
