"""What became of every element of a file: coverage, and findings about what is not read."""

from sysmlc.diagnostics import Coverage, Sink, Subject, Verdict
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context


def account(context: Context, sink: Sink, coverage: Coverage) -> None:
    """Count every element of the file once, and report what is not or not wholly read."""
    document = context.document
    counts = coverage.file(document.name)
    table: dict[tuple[str, Verdict], int] = {}
    for row in range(len(document)):
        key = _type(context, row), context.verdicts[row] or Verdict.UNSUPPORTED
        table[key] = table.get(key, 0) + 1
    for (type_name, verdict), number in table.items():
        counts.count(type_name, verdict, number)
    for feature, number in document.drawn.items():
        counts.count(feature, Verdict.IGNORED_NOTATION, number)
    _report_unsupported(context, sink)
    _report_approximated(context, sink)
    if not any(context.lowered.own):
        subject = Subject(document.name, place=context.place(0))
        sink.report(rules.NO_MODEL, subject, file=document.name)


def _type(context: Context, row: int) -> str:
    document = context.document
    type_name = document.type(row)
    if type_name:
        return document.attributes[row][document.type_key]
    feature = document.features[row]
    known = v.DEFAULT_TYPES.get(feature)
    return f"uml:{known}" if known and context.lowered.own[row] else feature


def _report_unsupported(context: Context, sink: Sink) -> None:
    document = context.document
    found: dict[str, list[tuple[int, int]]] = {}
    row = 0
    while row < len(document):
        verdict = context.verdicts[row]
        if verdict is Verdict.UNSUPPORTED and row not in context.reported:
            end = document.ends[row]
            found.setdefault(_type(context, row), []).append((row, end - row))
            row = end
        else:
            row += 1
    for type_name, rows in found.items():
        number = sum(size for _, size in rows)
        subject = Subject(document.name, place=context.place(rows[0][0]))
        count = _count(len(rows))
        sink.report(rules.UNSUPPORTED, subject, count=count, type=type_name, number=number)


def _report_approximated(context: Context, sink: Sink) -> None:
    found: dict[tuple[str, str], list[int]] = {}
    for row, lost in context.lost.items():
        found.setdefault((_type(context, row), lost), []).append(row)
    for (type_name, lost), rows in found.items():
        subject = Subject(context.document.name, place=context.place(rows[0]))
        count = _count(len(rows))
        sink.report(rules.APPROXIMATED, subject, count=count, type=type_name, lost=lost)


def _count(number: int) -> str:
    return "1 element" if number == 1 else f"{number} elements"
