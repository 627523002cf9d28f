"""Coverage as a table for people, as JSON, and as SARIF."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence

from sysmlc.diagnostics.coverage import (
    Verdict,
    count_covered,
    covered_tenths,
    sum_counts,
    tenths,
    with_meaning,
)
from sysmlc.diagnostics.coverage_report import (
    LOSSES,
    FileReport,
    LostElement,
    type_reports,
    worst_first,
)
from sysmlc.diagnostics.diagnostic import Diagnostic, Place, Subject
from sysmlc.diagnostics.render import sarif as findings_as_sarif
from sysmlc.diagnostics.render.report import Finding, Report
from sysmlc.support.escapes import escape_invisible

_COLUMNS = (*LOSSES, Verdict.MAPPED, Verdict.IGNORED_NOTATION)
_TITLES = {Verdict.IGNORED_NOTATION: "notation"}
_COLORS = {Verdict.UNSUPPORTED: "31", Verdict.APPROXIMATED: "33", Verdict.EXTERNAL: "36"}
_EXAMPLES = 3
_WIDTH = 64


def text(files: Sequence[FileReport], *, color: bool = False, every: bool = False) -> str:
    """Tables of files and types, worst first, then examples of what is lost (or ``every`` one)."""
    total = sum_counts(file.totals for file in files)
    blocks = [_headline(total), *_tables(files, color), *_details(files, color, every)]
    blocks += _iter_unlisted_losses(files)
    return "\n\n".join(blocks) + "\n"


def _headline(total: Mapping[str, int]) -> str:
    number = with_meaning(total)
    share = _percent(covered_tenths(total))
    return f"{share} covered: {count_covered(total):,} of {number:,} elements that mean something"


def _percent(tenths: int) -> str:
    return f"{tenths // 10}.{tenths % 10} %"


# -- tables ------------------------------------------------------------------------------------


def _tables(files: Sequence[FileReport], color: bool) -> Iterator[str]:
    total = sum_counts(file.totals for file in files)
    if len(files) > 1:
        rows = [(_short(escape_invisible(file.file)), file.totals) for file in worst_first(files)]
        yield _table("file", [*rows, ("total", total)], color)
    types = [(escape_invisible(one.name), one.counts) for one in type_reports(files)]
    shares = ["per cent", "", *map(_share, (tenths(total)[v.value] for v in _COLUMNS)), "100.0"]
    yield _table("type", [*types, ("total", total)], color, shares)


def _short(name: str) -> str:
    """The name for a column; entries of archives have names of 150 characters."""
    return name if len(name) <= _WIDTH else f"{name[: _WIDTH - 23]}...{name[-20:]}"


def _share(tenths: int) -> str:
    return f"{tenths // 10}.{tenths % 10}"


def _table(
    title: str,
    rows: Sequence[tuple[str, Mapping[str, int]]],
    color: bool,
    last: Sequence[str] = (),
) -> str:
    head = [title, "covered", *(_TITLES.get(v, v.value) for v in _COLUMNS), "elements"]
    lines = [head, *(_cells(name, counts) for name, counts in rows), *([last] if last else [])]
    widths = [max(len(line[column]) for line in lines) for column in range(len(head))]
    shown = (_line(line, widths, color and line is not head) for line in lines)
    return "\n".join(shown)


def _cells(name: str, counts: Mapping[str, int]) -> list[str]:
    numbers = [f"{counts[v.value]:,}" if counts[v.value] else "-" for v in _COLUMNS]
    share = _percent(covered_tenths(counts)) if with_meaning(counts) else "-"
    return [name, share, *numbers, f"{sum(counts.values()):,}"]


def _line(cells: Sequence[str], widths: Sequence[int], color: bool) -> str:
    padded = [cells[0].ljust(widths[0])]
    padded += [cell.rjust(width) for cell, width in zip(cells[1:], widths[1:], strict=True)]
    if color:
        for column, verdict in enumerate(_COLUMNS, 2):
            if cells[column] != "-" and verdict in _COLORS:
                padded[column] = _paint(padded[column], _COLORS[verdict])
    return "  ".join(padded).rstrip()


def _paint(text: str, code: str) -> str:
    return f"\x1b[{code}m{text}\x1b[0m"


# -- what is lost ------------------------------------------------------------------------------


def _details(files: Sequence[FileReport], color: bool, every: bool) -> Iterator[str]:
    for one in type_reports(files):
        groups: dict[tuple[Verdict, str, str], list[LostElement]] = {}
        for lost in one.losses:
            if lost.loss.verdict in LOSSES:
                rule = lost.loss.rule
                code = f" [{rule.code} {rule.name}]" if rule else ""
                groups.setdefault((lost.loss.verdict, code, _general(lost)), []).append(lost)
        for (verdict, code, reason), members in groups.items():
            word = _paint(verdict.value, _COLORS[verdict]) if color else verdict.value
            type_name, shown_reason = escape_invisible(one.name), escape_invisible(reason)
            head = f"{type_name}: {len(members)} {word}, {shown_reason}{code}"
            yield "\n".join([head, *_examples(members, every)])


def _iter_unlisted_losses(files: Sequence[FileReport]) -> Iterator[str]:
    """Yield the number of losses of each file that front ends counted without a location."""
    for file in files:
        counted = sum(file.totals[verdict.value] for verdict in LOSSES)
        listed = sum(x.loss.elements for x in file.losses if x.loss.verdict in LOSSES)
        if counted > listed:
            name = escape_invisible(file.file)
            yield f"{name}: {counted - listed:,} of these elements without a place"


def _general(lost: LostElement) -> str:
    """The reason without what differs from element to element."""
    is_external = lost.loss.verdict is Verdict.EXTERNAL and lost.loss.rule is not None
    return "stands for an element in no file of the unit" if is_external else lost.loss.reason


def _examples(members: Sequence[LostElement], every: bool) -> Iterator[str]:
    shown = members if every else members[:_EXAMPLES]
    for lost in shown:
        more = f", {lost.loss.elements} with all that it contains" if lost.loss.elements > 1 else ""
        yield f"  {escape_invisible(lost.where)}  {escape_invisible(lost.element)}{more}"
    if len(members) > len(shown):
        yield f"  and {len(members) - len(shown)} more"


# -- for programs ------------------------------------------------------------------------------


def as_json(files: Sequence[FileReport]) -> str:
    """``coverage.json`` with everything that is not mapped, and the shares."""
    total = sum_counts(file.totals for file in files)
    types = type_reports(files)
    content = {
        "format": "sysmlc-coverage/2",
        "files": [_file(file) for file in files],
        "types": [{"type": one.name, **_counts(one.counts)} for one in types],
        "total": _counts(total),
        "shares": {name: share / 10 for name, share in tenths(total).items()},
    }
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def _file(file: FileReport) -> dict[str, object]:
    return {
        "file": file.file,
        **_counts(file.totals),
        "by_type": {name: dict(counts) for name, counts in file.by_type.items()},
        "losses": [_loss(lost) for lost in file.losses],
    }


def _counts(counts: Mapping[str, int]) -> dict[str, object]:
    share = covered_tenths(counts) / 10
    return {"elements": sum(counts.values()), **counts, "covered": share}


def _loss(lost: LostElement) -> dict[str, object]:
    loss = lost.loss
    return {
        "type": loss.type,
        "verdict": loss.verdict.value,
        "elements": loss.elements,
        "element": lost.element,
        "line": lost.line or None,
        "column": lost.column or None,
        "xpath": lost.xpath or None,
        "code": loss.rule.code if loss.rule else None,
        "reason": loss.reason,
    }


def as_sarif(files: Sequence[FileReport]) -> str:
    """One result for each element that is lost; what is only drawn is none."""
    every = (lost for file in files for lost in file.losses)
    return findings_as_sarif.render(Report(tuple(_findings(every))))


def _findings(every: Iterator[LostElement]) -> Iterator[Finding]:
    for lost in every:
        rule = lost.loss.rule
        if rule is not None:
            message = f"{lost.loss.type} {lost.loss.reason}{_format_contained(lost)}"
            subject = Subject(lost.element, place=Place(lost.file, lost.loss.ordinal))
            found = Diagnostic(rule, rule.severity, message, subject)
            yield Finding(found, lost.file, lost.line, lost.column, xpath=lost.xpath)


def _format_contained(lost: LostElement) -> str:
    number = lost.loss.elements - 1
    return f" ({number} more inside)" if number else ""


FORMATS: dict[str, Callable[[Sequence[FileReport]], str]] = {"json": as_json, "sarif": as_sarif}
"""Formats for programs, by name."""
