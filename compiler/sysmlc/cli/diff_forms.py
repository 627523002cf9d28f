"""The forms in which ``sysmlc diff`` shows differences: text, Markdown, JSON."""

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

import click

from sysmlc.diagnostics import Place
from sysmlc.ir.compare import Change, Ref, What
from sysmlc.support.escapes import escape_invisible, escape_markdown

_SIGNS = {What.ADDED: "+", What.REMOVED: "-"}
_COLORS = {"+": "green", "-": "red", "~": "yellow"}
_WIDEST = 160
_BEFORE = 40
_NOWHERE = "(model)"


def text(changes: Sequence[Change], *, color: bool = False) -> str:
    """A block for each owner, then how many there are of each kind."""
    blocks = [
        "\n".join([_paint(owner, color, bold=True), *_lines(group, color=color)])
        for owner, group in _by_owner(changes)
    ]
    return "\n\n".join([*blocks, counts(changes)]) + "\n"


def _by_owner(changes: Iterable[Change]) -> Iterator[tuple[str, list[Change]]]:
    for owner, group in groupby(changes, key=lambda change: change.owner):
        yield owner or _NOWHERE, list(group)


def _lines(changes: Iterable[Change], *, color: bool) -> Iterator[str]:
    for change in changes:
        sign = _SIGNS.get(change.what, "~")
        line = f"{sign} {change.kind} {change.name}: {_phrase(change)}"
        yield f"  {_paint(line, color, fg=_COLORS[sign])}"


def _paint(line: str, color: bool, **style: Any) -> str:  # noqa: ANN401 - options of click.style
    shown = escape_invisible(line)
    return click.style(shown, **style) if color else shown


def _phrase(change: Change) -> str:
    before, after = excerpts(change.before, change.after)
    if change.what in (What.ADDED, What.REMOVED):
        return f"{change.what}{_contents(change, ', with {} below it')}"
    if change.what is What.RENAMED:
        return f"renamed, was {before or '(none)'}"
    if change.what is What.MOVED:
        return f"moved, was in {before or _NOWHERE}"
    told = f"{before or '(none)'} => {after or '(none)'}"
    if change.what is What.REORDERED:
        return f"reordered, {told}"
    lead = "" if change.what is What.CHANGED else f"{change.what}, "
    return f"{lead}{change.aspect}: {told}"


def _contents(change: Change, phrase: str) -> str:
    return phrase.format(change.contents) if change.contents else ""


def excerpts(before: str, after: str) -> tuple[str, str]:
    """Both texts; when they are long only what lies around their first difference."""
    if max(len(before), len(after)) <= _WIDEST:
        return before, after
    same = next((i for i, (a, b) in enumerate(zip(before, after, strict=False)) if a != b), 0)
    start = max(0, same - _BEFORE)
    return _cut(before, start), _cut(after, start)


def _cut(whole: str, start: int) -> str:
    head = "..." if start and whole else ""
    tail = "..." if len(whole) > start + _WIDEST else ""
    return f"{head}{whole[start : start + _WIDEST]}{tail}"


def counts(changes: Sequence[Change]) -> str:
    """``1 added, 2 rewired``; ``no differences`` when there are none."""
    found = Counter(change.what for change in changes)
    return ", ".join(f"{found[what]} {what}" for what in What if found[what]) or "no differences"


# -- Markdown ----------------------------------------------------------------------------------


def markdown(changes: Sequence[Change]) -> str:
    """A summary, and a table for each owner."""
    blocks = [f"**{counts(changes)}**"]
    for owner, group in _by_owner(changes):
        rows = [f"| {' | '.join(_cells(change))} |" for change in group]
        head = ["| | element | change | before | after |", "|---|---|---|---|---|"]
        blocks += [f"#### {_span(owner)}", "\n".join([*head, *rows])]
    return "\n\n".join(blocks) + "\n"


def _cells(change: Change) -> tuple[str, ...]:
    sign = _SIGNS.get(change.what, "~")
    is_telling = change.what in (What.CHANGED, What.RETYPED, What.REWIRED)
    what = f"{change.what}: {escape_markdown(change.aspect)}" if is_telling else str(change.what)
    what += _contents(change, ", with {} below it")
    before, after = excerpts(change.before, change.after)
    name = f"{escape_markdown(change.kind)} {_code(change.name)}"
    return (f"`{sign}`", name, what, _code(before), _code(after))


def _code(content: str) -> str:
    """A code span in a table, where also a bar in it must be escaped (GitHub Flavored Markdown)."""
    return _span(content).replace("|", "\\|")


def _span(content: str) -> str:
    """A code span: its fence is longer than any run of such signs in it (CommonMark 6.1)."""
    if not content:
        return ""
    shown = escape_invisible(content.replace("\n", " "))
    longest = max(map(len, re.findall("`+", shown)), default=0)
    fence, gap = "`" * (longest + 1), " " if longest else ""
    return f"{fence}{gap}{shown}{gap}{fence}"


# -- JSON --------------------------------------------------------------------------------------


def json_text(
    changes: Sequence[Change], old: Mapping[Place, Place], new: Mapping[Place, Place]
) -> str:
    """``sysmlc-diff/1`` (metamodels/sysmlc-diff.schema.json), with lines and columns."""
    found = Counter(change.what for change in changes)
    owners = [
        {"owner": owner, "changes": [_row(change, old, new) for change in group]}
        for owner, group in groupby(changes, key=lambda change: change.owner)
    ]
    whole = {
        "format": "sysmlc-diff/1",
        "summary": {str(what): found[what] for what in What},
        "owners": owners,
    }
    return json.dumps(whole, ensure_ascii=False, indent=1) + "\n"


def _row(
    change: Change, old: Mapping[Place, Place], new: Mapping[Place, Place]
) -> dict[str, object]:
    return {
        "what": str(change.what),
        "element": change.name,
        "kind": change.kind,
        "aspect": change.aspect,
        "before": change.before,
        "after": change.after,
        "contents": change.contents,
        "old": _ref(change.old, old),
        "new": _ref(change.new, new),
    }


def _ref(ref: Ref | None, places: Mapping[Place, Place]) -> dict[str, object] | None:
    if ref is None:
        return None
    at = places.get(Place(ref.file, ref.ordinal))
    return {
        "id": ref.id,
        "qualified_name": ref.qualified_name,
        "file": ref.file,
        "line": at.line if at else 0,
        "column": at.column if at else 0,
    }
