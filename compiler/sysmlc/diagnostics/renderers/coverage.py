"""Coverage as a table for people, as JSON, and as SARIF."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from sysmlc.diagnostics.coverage import (
    Verdict,
    compute_covered_permille,
    compute_permille,
    count_covered,
    count_meaningful,
    sum_counts,
)
from sysmlc.diagnostics.coverage_report import (
    LOSSES,
    WORST_FIRST,
    FileReport,
    LostElement,
    TypeReport,
    make_type_reports,
    sort_by_coverage,
)
from sysmlc.diagnostics.diagnostic import Diagnostic, Place, Subject
from sysmlc.diagnostics.renderers.json_documents import render_sarif as render_findings_as_sarif
from sysmlc.diagnostics.renderers.report import Finding, Report
from sysmlc.diagnostics.renderers.text import paint_text
from sysmlc.support.counts import count
from sysmlc.support.escapes import escape_invisible
from sysmlc.support.output import encode_json

_TITLES = {Verdict.IGNORED_NOTATION: "notation"}
_COLORS = {Verdict.UNSUPPORTED: "31", Verdict.APPROXIMATED: "33", Verdict.EXTERNAL: "36"}
_MAX_EXAMPLES = 3
_MAX_NAME = 64
"""Characters of a name in a table; entries of archives have names of 150 characters."""


def render_text(
    files: Sequence[FileReport], *, color: bool = False, with_all_losses: bool = False
) -> str:
    """Return tables of files and types, and a few examples of losses or all losses."""
    total = sum_counts(file.totals for file in files)
    types = make_type_reports(files)
    blocks = [_format_headline(total)]
    if len(files) > 1:
        rows = [_make_row(_shorten(file.file), file.totals) for file in sort_by_coverage(files)]
        blocks.append(_format_table("file", [*rows, _make_row("total", total)], color))
    blocks.append(_format_type_table(types, total, color))
    for type_report in types:
        blocks += _iter_losses(type_report, color, with_all_losses)
    blocks += _iter_unlisted_losses(files)
    return "\n\n".join(blocks) + "\n"


def _format_headline(total: Mapping[str, int]) -> str:
    covered, meaningful = count_covered(total), count_meaningful(total)
    share = _format_percent(compute_covered_permille(total))
    elements = count(meaningful, "element")
    return f"{share} % covered: {covered:,} of {elements} with a meaning"


def _format_percent(permille: int) -> str:
    return f"{permille // 10}.{permille % 10}"


# -- tables ------------------------------------------------------------------------------------


def _format_type_table(types: Sequence[TypeReport], total: Mapping[str, int], color: bool) -> str:
    rows = [_make_row(escape_invisible(report.name), report.counts) for report in types]
    permille = compute_permille(total)
    shares = [_format_percent(permille[verdict.value]) for verdict in WORST_FIRST]
    last_row = ["per cent", "", *shares, "100.0"]
    return _format_table("type", [*rows, _make_row("total", total), last_row], color)


def _shorten(name: str) -> str:
    """Return the name of a file without its middle if it is too long for a column."""
    name = escape_invisible(name)
    return name if len(name) <= _MAX_NAME else f"{name[: _MAX_NAME - 23]}...{name[-20:]}"


def _make_row(name: str, counts: Mapping[str, int]) -> list[str]:
    has_meaning = count_meaningful(counts) > 0
    share = f"{_format_percent(compute_covered_permille(counts))} %" if has_meaning else "-"
    numbers = [f"{counts[v.value]:,}" if counts[v.value] else "-" for v in WORST_FIRST]
    return [name, share, *numbers, f"{sum(counts.values()):,}"]


def _format_table(title: str, rows: Sequence[list[str]], color: bool) -> str:
    head = [title, "covered", *(_TITLES.get(v, v.value) for v in WORST_FIRST), "elements"]
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    lines = [_format_line(head, widths), *(_format_line(row, widths, color) for row in rows)]
    return "\n".join(lines)


def _format_line(cells: Sequence[str], widths: Sequence[int], color: bool = False) -> str:
    padded = [cells[0].ljust(widths[0])]
    padded += [cell.rjust(width) for cell, width in zip(cells[1:], widths[1:], strict=True)]
    if color:
        for column, verdict in enumerate(WORST_FIRST, 2):
            if cells[column] != "-" and verdict in _COLORS:
                padded[column] = paint_text(padded[column], _COLORS[verdict])
    return "  ".join(padded).rstrip()


# -- losses ------------------------------------------------------------------------------------


def _iter_losses(report: TypeReport, color: bool, with_all_losses: bool) -> Iterator[str]:
    """Yield a block of text for each group of losses with the same verdict, rule and reason."""
    groups: dict[tuple[Verdict, str, str], list[LostElement]] = {}
    for lost in report.losses:
        if lost.loss.verdict in LOSSES:
            rule = lost.loss.rule
            code = f" [{rule.code} {rule.name}]" if rule else ""
            key = lost.loss.verdict, code, _generalize_reason(lost)
            groups.setdefault(key, []).append(lost)
    for (verdict, code, reason), members in groups.items():
        word = paint_text(verdict.value, _COLORS[verdict]) if color else verdict.value
        name = escape_invisible(report.name)
        head = f"{name}: {len(members)} {word}, {escape_invisible(reason)}{code}"
        limit = len(members) if with_all_losses else _MAX_EXAMPLES
        yield "\n".join([head, *_iter_examples(members, limit)])


def _generalize_reason(lost: LostElement) -> str:
    """Return the reason of a loss as a heading for several losses.

    The reason of an external stub names the missing element, so that all would differ.
    """
    is_external = lost.loss.verdict is Verdict.EXTERNAL and lost.loss.rule is not None
    return "stands for an element in no file of the unit" if is_external else lost.loss.reason


def _iter_examples(members: Sequence[LostElement], limit: int) -> Iterator[str]:
    for lost in members[:limit]:
        number = lost.loss.elements
        contents = f", {number} with all that it contains" if number > 1 else ""
        yield f"  {escape_invisible(lost.where)}  {escape_invisible(lost.element)}{contents}"
    if len(members) > limit:
        yield f"  and {len(members) - limit} more"


def _iter_unlisted_losses(files: Sequence[FileReport]) -> Iterator[str]:
    """Yield a line for each file with losses that its front end counted without a location."""
    for file in files:
        counted = sum(file.totals[verdict.value] for verdict in LOSSES)
        listed = sum(x.loss.elements for x in file.losses if x.loss.verdict in LOSSES)
        if counted > listed:
            name = escape_invisible(file.file)
            yield f"{name}: {counted - listed:,} of these elements without a place"


# -- documents for programs ----------------------------------------------------------------------


def render_json(files: Sequence[FileReport]) -> str:
    """Return the format ``sysmlc-coverage/2`` (metamodels/sysmlc-coverage.schema.json).

    Unlike ``Coverage.as_json``, it lists all losses, and shares in per cent.
    """
    total = sum_counts(file.totals for file in files)
    content = {
        "format": "sysmlc-coverage/2",
        "files": [_describe_file(file) for file in files],
        "types": [
            {"type": report.name, **_describe_counts(report.counts)}
            for report in make_type_reports(files)
        ],
        "total": _describe_counts(total),
        "shares": {name: share / 10 for name, share in compute_permille(total).items()},
    }
    return encode_json(content)


def _describe_file(file: FileReport) -> dict[str, object]:
    return {
        "file": file.file,
        **_describe_counts(file.totals),
        "by_type": {name: dict(counts) for name, counts in file.by_type.items()},
        "losses": [_describe_loss(lost) for lost in file.losses],
    }


def _describe_counts(counts: Mapping[str, int]) -> dict[str, object]:
    share = compute_covered_permille(counts) / 10
    return {"elements": sum(counts.values()), **counts, "covered": share}


def _describe_loss(lost: LostElement) -> dict[str, object]:
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


def render_sarif(files: Sequence[FileReport]) -> str:
    """Return a SARIF log with one result for each loss that a diagnostic reports."""
    losses = (lost for file in files for lost in file.losses)
    return render_findings_as_sarif(Report(tuple(_iter_findings(losses))))


def _iter_findings(losses: Iterable[LostElement]) -> Iterator[Finding]:
    for lost in losses:
        rule = lost.loss.rule
        if rule is not None:
            inside = lost.loss.elements - 1
            contents = f" ({inside} more inside)" if inside else ""
            message = f"{lost.loss.type} {lost.loss.reason}{contents}"
            subject = Subject(lost.element, place=Place(lost.file, lost.loss.ordinal))
            diagnostic = Diagnostic(rule, rule.severity, message, subject)
            yield Finding(diagnostic, lost.file, lost.line, lost.column, xpath=lost.xpath)


FORMATS: dict[str, Callable[[Sequence[FileReport]], str]] = {
    "json": render_json,
    "sarif": render_sarif,
}
"""Formats for programs, by name."""
