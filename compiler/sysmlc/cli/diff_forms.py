"""Output formats of ``sysmlc diff``: text, Markdown, JSON."""

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
_MAX_LENGTH = 160
_CONTEXT_LENGTH = 40
_NO_OWNER = "(model)"


def format_text(changes: Sequence[Change], *, color: bool = False) -> str:
    """Return a block of changes for each owner, and the number of changes of each kind."""
    blocks = [
        "\n".join([_paint(owner, color, bold=True), *_format_change(group, color=color)])
        for owner, group in _group_by_owner(changes)
    ]
    return "\n\n".join([*blocks, _count_changes(changes)]) + "\n"


def _group_by_owner(changes: Iterable[Change]) -> Iterator[tuple[str, list[Change]]]:
    for owner, group in groupby(changes, key=lambda change: change.owner):
        yield owner or _NO_OWNER, list(group)


def _format_change(changes: Iterable[Change], *, color: bool) -> Iterator[str]:
    for change in changes:
        sign = _SIGNS.get(change.what, "~")
        line = f"{sign} {change.kind} {change.name}: {_phrase(change)}"
        yield f"  {_paint(line, color, fg=_COLORS[sign])}"


def _paint(line: str, color: bool, **style: Any) -> str:  # noqa: ANN401 - options of click.style
    shown = escape_invisible(line)
    return click.style(shown, **style) if color else shown


def _phrase(change: Change) -> str:
    before, after = _excerpt_pair(change.before, change.after)
    if change.what in (What.ADDED, What.REMOVED):
        return f"{change.what}{_list_contents(change, ', with {} below it')}"
    if change.what is What.RENAMED:
        return f"renamed, was {before or '(none)'}"
    if change.what is What.MOVED:
        return f"moved, was in {before or _NO_OWNER}"
    phrase = f"{before or '(none)'} => {after or '(none)'}"
    if change.what is What.REORDERED:
        return f"reordered, {phrase}"
    lead = "" if change.what is What.CHANGED else f"{change.what}, "
    return f"{lead}{change.aspect}: {phrase}"


def _list_contents(change: Change, phrase: str) -> str:
    return phrase.format(change.contents) if change.contents else ""


def _excerpt_pair(before: str, after: str) -> tuple[str, str]:
    """Return both texts; if one is long, return excerpts around their first difference."""
    if max(len(before), len(after)) <= _MAX_LENGTH:
        return before, after
    same = next((i for i, (a, b) in enumerate(zip(before, after, strict=False)) if a != b), 0)
    start = max(0, same - _CONTEXT_LENGTH)
    return _cut(before, start), _cut(after, start)


def _cut(whole: str, start: int) -> str:
    head = "..." if start and whole else ""
    tail = "..." if len(whole) > start + _MAX_LENGTH else ""
    return f"{head}{whole[start : start + _MAX_LENGTH]}{tail}"


def _count_changes(changes: Sequence[Change]) -> str:
    """Return ``1 added, 2 rewired``, or ``no differences``."""
    counts_by_kind = Counter(change.what for change in changes)
    return (
        ", ".join(f"{counts_by_kind[kind]} {kind}" for kind in What if counts_by_kind[kind])
        or "no differences"
    )


# -- Markdown ----------------------------------------------------------------------------------


def format_markdown(changes: Sequence[Change]) -> str:
    """Return a summary and a table of changes for each owner, in Markdown."""
    blocks = [f"**{_count_changes(changes)}**"]
    for owner, group in _group_by_owner(changes):
        rows = [f"| {' | '.join(_format_cells(change))} |" for change in group]
        head = ["| | element | change | before | after |", "|---|---|---|---|---|"]
        blocks += [f"#### {_format_code(owner)}", "\n".join([*head, *rows])]
    return "\n\n".join(blocks) + "\n"


def _format_cells(change: Change) -> tuple[str, ...]:
    sign = _SIGNS.get(change.what, "~")
    is_telling = change.what in (What.CHANGED, What.RETYPED, What.REWIRED)
    content = f"{change.what}: {escape_markdown(change.aspect)}" if is_telling else str(change.what)
    content += _list_contents(change, ", with {} below it")
    before, after = _excerpt_pair(change.before, change.after)
    name = f"{escape_markdown(change.kind)} {_format_code_in_table(change.name)}"
    return (f"`{sign}`", name, content, _format_code_in_table(before), _format_code_in_table(after))


def _format_code_in_table(content: str) -> str:
    """Return a code span for a table, where a bar must be escaped (GitHub Flavored Markdown)."""
    return _format_code(content).replace("|", "\\|")


def _format_code(content: str) -> str:
    """Return a code span whose fence is longer than any run of backticks in it (CommonMark 6.1)."""
    if not content:
        return ""
    shown = escape_invisible(content.replace("\n", " "))
    longest = max(map(len, re.findall("`+", shown)), default=0)
    fence, gap = "`" * (longest + 1), " " if longest else ""
    return f"{fence}{gap}{shown}{gap}{fence}"


# -- JSON --------------------------------------------------------------------------------------


def format_json(
    changes: Sequence[Change], old: Mapping[Place, Place], new: Mapping[Place, Place]
) -> str:
    """Return ``sysmlc-diff/1`` (metamodels/sysmlc-diff.schema.json), with lines and columns."""
    counts = Counter(change.what for change in changes)
    owners = [
        {"owner": owner, "changes": [_row(change, old, new) for change in group]}
        for owner, group in groupby(changes, key=lambda change: change.owner)
    ]
    whole = {
        "format": "sysmlc-diff/1",
        "summary": {str(kind): counts[kind] for kind in What},
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
    place = places.get(Place(ref.file, ref.ordinal))
    return {
        "id": ref.id,
        "qualified_name": ref.qualified_name,
        "file": ref.file,
        "line": place.line if place else 0,
        "column": place.column if place else 0,
    }
