"""What became of every element of a file: coverage, and findings about what is not read."""

from collections import Counter

from sysmlc.diagnostics import Coverage, Sink, Subject, Verdict
from sysmlc.frontends.xmi import metaclasses, rules
from sysmlc.frontends.xmi.context import Context


def account(context: Context, sink: Sink, coverage: Coverage) -> None:
    """Count every element of the file once, and report what is not or not wholly read."""
    document = context.document
    counts = coverage.file(document.name)
    is_own = map(bool, context.lowered.own)
    rows = zip(document.types, document.features, is_own, context.verdicts, strict=True)
    for (written, feature, own, verdict), number in Counter(rows).items():
        counts.count(_type(written, feature, own), verdict or Verdict.UNSUPPORTED, number)
    for feature, number in document.drawn.items():
        counts.count(feature, Verdict.IGNORED_NOTATION, number)
    if coverage.is_detailed:
        from sysmlc.frontends.xmi.losses import losses

        counts.losses.extend(losses(context, _types(context)))
    _report_unsupported(context, sink)
    _report_approximated(context, sink)
    _report_baseless(context, sink)
    if not any(context.lowered.own):
        subject = Subject(document.name, place=context.place(0))
        sink.report(rules.NO_MODEL, subject, file=document.name)


def _types(context: Context) -> list[str]:
    """Name of each row's type."""
    is_own = map(bool, context.lowered.own)
    rows = zip(context.document.types, context.document.features, is_own, strict=True)
    return [_type(*row) for row in rows]


def _type(written: str, feature: str, is_own: bool) -> str:
    """Name of a row's type: as written, else the default of its feature, else its tag."""
    known = written or (metaclasses.DEFAULT_TYPES.get(feature) if is_own else "")
    return f"uml:{known}" if known else feature


def _report_unsupported(context: Context, sink: Sink) -> None:
    if Verdict.UNSUPPORTED not in context.verdicts:
        return
    document = context.document
    found: dict[str, list[tuple[int, int]]] = {}
    types = _types(context)
    baseless = frozenset(context.baseless)
    end = -1
    for row, verdict in enumerate(context.verdicts):
        if verdict is Verdict.UNSUPPORTED and row >= end:
            end = document.ends[row]
            if row not in baseless:
                found.setdefault(types[row], []).append((row, end - row))
    for type_name, rows in found.items():
        number = sum(size for _, size in rows)
        subject = _subject(context, rows[0][0])
        count = _count(len(rows))
        sink.report(rules.UNSUPPORTED, subject, count=count, type=type_name, number=number)


def _report_approximated(context: Context, sink: Sink) -> None:
    found: dict[tuple[str, str], list[int]] = {}
    types = _types(context) if context.lost else []
    for row, lost in context.lost.items():
        found.setdefault((types[row], lost), []).append(row)
    for (type_name, lost), rows in found.items():
        subject = _subject(context, rows[0])
        count = _count(len(rows))
        sink.report(rules.APPROXIMATED, subject, count=count, type=type_name, lost=lost)


def _report_baseless(context: Context, sink: Sink) -> None:
    found: dict[str, list[int]] = {}
    for row in context.baseless:
        found.setdefault(context.document.features[row], []).append(row)
    for name, rows in found.items():
        subject = Subject(name, context.document.id(rows[0]), context.place(rows[0]))
        times = "once" if len(rows) == 1 else f"{len(rows)} times"
        sink.report(rules.BASELESS, subject, stereotype=name, times=times)


def _subject(context: Context, row: int) -> Subject:
    """The row as the subject of a finding: the element that it is, or is inside of."""
    return Subject(context.qualified_name(row), context.gids[row], context.place(row))


def _count(number: int) -> str:
    return "1 element" if number == 1 else f"{number} elements"
