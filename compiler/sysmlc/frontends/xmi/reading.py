"""Reads the files of a compile unit into the graph, in the order that their references need.

Every element of a file gets a verdict, and diagnostics report the elements that are not read.
"""

from collections import Counter
from collections.abc import Iterator, Sequence

from sysmlc.diagnostics import Coverage, Rule, Severity, Sink, Subject, Verdict, rule
from sysmlc.diagnostics.coverage import Loss
from sysmlc.frontends.base import read_or_report
from sysmlc.frontends.xmi import metaclasses, papyrus, rules, unknown_names
from sysmlc.frontends.xmi.applications import lower_applications
from sysmlc.frontends.xmi.attributes import set_deferred_attributes
from sysmlc.frontends.xmi.behaviour import complete_behaviour
from sysmlc.frontends.xmi.context import Context, report_dangling
from sysmlc.frontends.xmi.document import Document, read_document
from sysmlc.frontends.xmi.enterprise_architect import localise_references, read_extensions
from sysmlc.frontends.xmi.lowering import lower_document, restore_comments
from sysmlc.frontends.xmi.snapshots import libraries
from sysmlc.frontends.xmi.snapshots.entries import is_snapshot
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.frontends.xmi.value_features import set_multiplicities
from sysmlc.ir import Graph
from sysmlc.sources import Source
from sysmlc.support.counts import count
from sysmlc.support.interpreter import pause_garbage_collection


def read(sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Read the files into the graph; the pass ``resolve`` connects the references.

    A damaged file is reported and skipped. Raises SourceError if a file exceeds the limits. The
    graph does not depend on the order of the files.
    """
    ordered = sorted(sources, key=lambda source: source.name)
    models = [source for source in ordered if not is_snapshot(source)]
    snapshots = [source for source in ordered if is_snapshot(source)]
    with pause_garbage_collection():
        documents = [
            read_or_report(read_document, source, rules.MALFORMED, sink) for source in models
        ]
        unit = Unit([document for document in documents if document is not None], graph)
        contexts = [lower_document(unit, file, sink) for file in unit.files]
        libraries.add_libraries(unit, contexts, models, snapshots, sink, coverage)
        _connect(unit, contexts)
        for context in contexts:
            report_dangling(context)
            unknown_names.report_unknown_values(context)
            unknown_names.report_unknown_attributes(context)
            unknown_names.report_unknown_tags(context)
            report_coverage(context, sink, coverage)


def _connect(unit: Unit, contexts: list[Context]) -> None:
    """Lower the parts of the documents that refer to elements of any document of the unit."""
    for context in contexts:
        papyrus.join_contained_elements(context)
    for context in contexts:
        # Namespaces of profiles come before the applications of their stereotypes.
        papyrus.record_applied_namespaces(context)
        localise_references(context)
        restore_comments(context)
        set_multiplicities(context)
        set_deferred_attributes(context)
    for context in contexts:
        lower_applications(context)
        read_extensions(context)
        complete_behaviour(context)
    unit.resolve_references()


# -- coverage ----------------------------------------------------------------------------------

EXTERNAL = rule(
    "SM160",
    "external-element",
    Severity.INFO,
    "{reason}",
    help="give the other file as a further input",
)


def report_coverage(context: Context, sink: Sink, coverage: Coverage) -> None:
    """Count every element of the file once, and report elements that are not or partly read."""
    document = context.document
    counts = coverage.file(document.name)
    rows = zip(
        document.types,
        document.features,
        map(bool, context.elements),
        context.verdicts,
        strict=True,
    )
    for (written, feature, has_element, verdict), number in Counter(rows).items():
        type_name = _name_type(written, feature, has_element)
        counts.count(type_name, verdict or Verdict.UNSUPPORTED, number)
    for feature, number in document.skipped_elements.items():
        counts.count(feature, Verdict.IGNORED_NOTATION, number)
    if coverage.is_detailed:
        counts.losses.extend(_list_losses(context))
    _report_unsupported(context, sink)
    _report_approximated(context, sink)
    _report_baseless(context, sink)
    if not any(context.elements):
        subject = Subject(document.name, place=context.locate(0))
        sink.report(rules.NO_MODEL, subject, file=document.name)


def _name_type(written: str, feature: str, has_element: bool) -> str:
    """Return the type of a row: as written, else the default of its feature, else its tag.

    Only rows with an element of their own have a default type.
    """
    metaclass = written or (metaclasses.DEFAULT_TYPES.get(feature) if has_element else "")
    return f"uml:{metaclass}" if metaclass else feature


def _type_name(context: Context, row: int) -> str:
    document = context.document
    return _name_type(document.types[row], document.features[row], bool(context.elements[row]))


# -- diagnostics -----------------------------------------------------------------------------------


def _report_unsupported(context: Context, sink: Sink) -> None:
    document = context.document
    rows_by_type: dict[str, list[int]] = {}
    baseless = frozenset(context.baseless_applications)
    end = -1
    for row, verdict in enumerate(context.verdicts):
        if verdict is Verdict.UNSUPPORTED and row >= end:
            end = document.ends[row]
            if row not in baseless:
                rows_by_type.setdefault(_type_name(context, row), []).append(row)
    for type_name, rows in rows_by_type.items():
        number = sum(document.ends[row] - row for row in rows)
        subject, count = _subject(context, rows[0]), _format_count(len(rows))
        sink.report(rules.UNSUPPORTED, subject, count=count, type=type_name, number=number)


def _report_approximated(context: Context, sink: Sink) -> None:
    rows_by_loss: dict[tuple[str, str], list[int]] = {}
    for row, loss in context.losses.items():
        rows_by_loss.setdefault((_type_name(context, row), loss), []).append(row)
    for (type_name, loss), rows in rows_by_loss.items():
        subject, count = _subject(context, rows[0]), _format_count(len(rows))
        sink.report(rules.APPROXIMATED, subject, count=count, type=type_name, lost=loss)


def _report_baseless(context: Context, sink: Sink) -> None:
    rows_by_stereotype: dict[str, list[int]] = {}
    for row in context.baseless_applications:
        rows_by_stereotype.setdefault(context.document.features[row], []).append(row)
    for name, rows in rows_by_stereotype.items():
        subject = Subject(name, context.document.id(rows[0]), context.locate(rows[0]))
        times = "once" if len(rows) == 1 else f"{len(rows)} times"
        sink.report(rules.BASELESS, subject, stereotype=name, times=times)


def _subject(context: Context, row: int) -> Subject:
    """Return the element that the row is, or that contains it, as the subject of a diagnostic."""
    return Subject(context.qualified_name(row), context.element_ids[row], context.locate(row))


def _format_count(number: int) -> str:
    return count(number, "element")


# -- losses ----------------------------------------------------------------------------------------


def _list_losses(context: Context) -> Iterator[Loss]:
    """Yield the rows that are not mapped, in document order, for ``sysmlc coverage``.

    The content of a row counts with the row as long as it has the same verdict.
    """
    baseless = frozenset(context.baseless_applications)
    for row, number in _count_losses(context).items():
        verdict = context.verdicts[row] or Verdict.UNSUPPORTED
        loss_rule, reason = _explain_loss(context, row, verdict, row in baseless)
        # The element has the name, if the row has an element of its own.
        name = "" if context.elements[row] else context.document.attributes[row].get("name", "")
        yield Loss(
            _type_name(context, row),
            verdict,
            context.document.ordinals[row],
            number,
            context.element_ids[row],
            name,
            loss_rule,
            reason,
        )


def _count_losses(context: Context) -> dict[int, int]:
    """Return the number of elements that each loss covers, by the first row of the loss."""
    document, verdicts = context.document, context.verdicts
    first_rows: dict[int, int] = {}
    sizes: dict[int, int] = {}
    skipped = _count_skipped(document)
    for row, verdict in enumerate(verdicts):
        if verdict is Verdict.MAPPED:
            continue
        parent = document.parents[row]
        has_reason = row in context.loss_rules or row in context.losses
        is_inside = parent in first_rows and verdicts[parent] is verdict and not has_reason
        first_rows[row] = first = first_rows[parent] if is_inside else row
        sizes[first] = sizes.get(first, 0) + 1 + skipped.get(row, 0)
    return sizes


def _count_skipped(document: Document) -> dict[int, int]:
    """Return the number of skipped elements inside a row, for rows that have any."""
    if not document.skipped_elements:
        return {}
    total = len(document) + document.skipped_elements.total()
    next_ordinals = (*document.ordinals[1:], total)
    rows = enumerate(zip(document.ordinals, next_ordinals, strict=True))
    return {
        row: next_ordinal - ordinal - 1
        for row, (ordinal, next_ordinal) in rows
        if next_ordinal - ordinal > 1
    }


def _explain_loss(
    context: Context, row: int, verdict: Verdict, is_baseless: bool
) -> tuple[Rule | None, str]:
    if verdict is Verdict.APPROXIMATED and row in context.loss_rules:
        return context.loss_rules[row]
    if verdict is Verdict.APPROXIMATED:
        return rules.APPROXIMATED, f"read without {context.losses.get(row, 'part of its meaning')}"
    if verdict is Verdict.EXTERNAL:
        return EXTERNAL, f"stands for {_find_href(context, row)}, which is in no file of the unit"
    if verdict is Verdict.IGNORED_NOTATION:
        return None, "drawing or tool settings"
    if is_baseless:
        return rules.BASELESS, "applied to a missing element"
    return rules.UNSUPPORTED, "not read"


def _find_href(context: Context, row: int) -> str:
    """Return the first href in the row or its content, quoted."""
    document = context.document
    hrefs = (document.href(inner) for inner in range(row, document.ends[row]))
    return next((f"'{href}'" for href in hrefs if href), "another element")
