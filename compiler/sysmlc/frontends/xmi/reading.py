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
from sysmlc.frontends.xmi.dangling import report_dangling
from sysmlc.frontends.xmi.document import Document, read_document
from sysmlc.frontends.xmi.enterprise_architect import localise_references, read_extensions
from sysmlc.frontends.xmi.lowering import lower_document, restore_comments
from sysmlc.frontends.xmi.snapshots import libraries
from sysmlc.frontends.xmi.snapshots.entries import is_snapshot
from sysmlc.frontends.xmi.unit import File, Stage, Unit
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
        unit = Unit([document for document in documents if document is not None], graph, sink)
        for file in unit.files:
            lower_document(file)
        libraries.add_libraries(unit, models, snapshots, sink, coverage)
        _connect(unit)
        for file in unit.files:
            report_dangling(file)
            unknown_names.report_unknown_values(file)
            unknown_names.report_unknown_attributes(file)
            unknown_names.report_unknown_tags(file)
            report_coverage(file, coverage)


def _connect(unit: Unit) -> None:
    """Lower the parts of the documents that refer to elements of any document of the unit."""
    for file in unit.files:
        file.run_deferred(Stage.WALKS)
    for file in unit.files:
        # Namespaces of profiles come before the applications of their stereotypes.
        papyrus.record_applied_namespaces(file)
        localise_references(file)
        restore_comments(file)
        set_multiplicities(file)
        file.run_deferred(Stage.ELEMENTS)
    for file in unit.files:
        lower_applications(file)
        file.run_deferred(Stage.APPLICATIONS)
        read_extensions(file)
        for stage in (Stage.TRIGGERS, Stage.BEHAVIOURS, Stage.GUARDS, Stage.BODIES):
            file.run_deferred(stage)
    unit.resolve_references()


# -- coverage ----------------------------------------------------------------------------------

EXTERNAL = rule(
    "SM160",
    "external-element",
    Severity.INFO,
    "{reason}",
    help="give the other file as a further input",
)


def report_coverage(file: File, coverage: Coverage) -> None:
    """Count every element of the file once, and report elements that are not or partly read."""
    document = file.document
    counts = coverage.file(document.name)
    rows = zip(
        document.types,
        document.features,
        map(bool, file.elements),
        file.verdicts,
        strict=True,
    )
    for (written, feature, has_element, verdict), number in Counter(rows).items():
        type_name = _name_type(written, feature, has_element)
        counts.count(type_name, verdict or Verdict.UNSUPPORTED, number)
    for feature, number in document.skipped_elements.items():
        counts.count(feature, Verdict.IGNORED_NOTATION, number)
    if coverage.is_detailed:
        counts.losses.extend(_list_losses(file))
    _report_unsupported(file)
    _report_approximated(file)
    _report_baseless(file)
    if not any(file.elements):
        subject = Subject(document.name, place=file.locate(0))
        file.unit.sink.report(rules.NO_MODEL, subject, file=document.name)


def _name_type(written: str, feature: str, has_element: bool) -> str:
    """Return the type of a row: as written, else the default of its feature, else its tag.

    Only rows with an element of their own have a default type.
    """
    metaclass = written or (metaclasses.DEFAULT_TYPES.get(feature) if has_element else "")
    return f"uml:{metaclass}" if metaclass else feature


def _type_name(file: File, row: int) -> str:
    document = file.document
    return _name_type(document.types[row], document.features[row], bool(file.elements[row]))


# -- diagnostics -----------------------------------------------------------------------------------


def _report_unsupported(file: File) -> None:
    document = file.document
    rows_by_type: dict[str, list[int]] = {}
    end = -1
    for row, verdict in enumerate(file.verdicts):
        if verdict is Verdict.UNSUPPORTED and row >= end:
            end = document.ends[row]
            loss_rule, _ = file.losses.get(row, (rules.UNSUPPORTED, ""))
            if loss_rule is not rules.BASELESS:
                rows_by_type.setdefault(_type_name(file, row), []).append(row)
    for type_name, rows in rows_by_type.items():
        number = sum(document.ends[row] - row for row in rows)
        file.unit.sink.report(
            rules.UNSUPPORTED,
            file.subject(rows[0]),
            count=count(len(rows), "element"),
            type=type_name,
            number=number,
        )


def _report_approximated(file: File) -> None:
    rows_by_loss: dict[tuple[str, str], list[int]] = {}
    for row, (loss_rule, loss) in file.losses.items():
        if loss_rule is rules.APPROXIMATED:
            rows_by_loss.setdefault((_type_name(file, row), loss), []).append(row)
    for (type_name, loss), rows in rows_by_loss.items():
        number = count(len(rows), "element")
        subject = file.subject(rows[0])
        file.unit.sink.report(rules.APPROXIMATED, subject, count=number, type=type_name, lost=loss)


def _report_baseless(file: File) -> None:
    rows_by_stereotype: dict[str, list[int]] = {}
    for row, (loss_rule, _) in file.losses.items():
        if loss_rule is rules.BASELESS:
            rows_by_stereotype.setdefault(file.document.features[row], []).append(row)
    for name, rows in rows_by_stereotype.items():
        subject = Subject(name, file.document.id(rows[0]), file.locate(rows[0]))
        times = "once" if len(rows) == 1 else f"{len(rows)} times"
        file.unit.sink.report(rules.BASELESS, subject, stereotype=name, times=times)


# -- losses ----------------------------------------------------------------------------------------


def _list_losses(file: File) -> Iterator[Loss]:
    """Yield the rows that are not mapped, in document order, for ``sysmlc coverage``.

    The content of a row counts with the row as long as it has the same verdict.
    """
    for row, number in _count_losses(file).items():
        verdict = file.verdicts[row] or Verdict.UNSUPPORTED
        loss_rule, reason = _explain_loss(file, row, verdict)
        # The element has the name, if the row has an element of its own.
        name = "" if file.elements[row] else file.document.attributes[row].get("name", "")
        yield Loss(
            _type_name(file, row),
            verdict,
            file.document.ordinals[row],
            number,
            file.element_ids[row],
            name,
            loss_rule,
            reason,
        )


def _count_losses(file: File) -> dict[int, int]:
    """Return the number of elements that each loss covers, by the first row of the loss."""
    document, verdicts = file.document, file.verdicts
    first_rows: dict[int, int] = {}
    sizes: dict[int, int] = {}
    skipped = _count_skipped(document)
    for row, verdict in enumerate(verdicts):
        if verdict is Verdict.MAPPED:
            continue
        parent = document.parents[row]
        has_reason = row in file.losses
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


def _explain_loss(file: File, row: int, verdict: Verdict) -> tuple[Rule | None, str]:
    if row in file.losses:
        loss_rule, loss = file.losses[row]
        return loss_rule, f"read without {loss}" if loss_rule is rules.APPROXIMATED else loss
    if verdict is Verdict.APPROXIMATED:
        return rules.APPROXIMATED, "read without part of its meaning"
    if verdict is Verdict.EXTERNAL:
        return EXTERNAL, f"stands for {_find_href(file, row)}, which is in no file of the unit"
    if verdict is Verdict.IGNORED_NOTATION:
        return None, "drawing or tool settings"
    return rules.UNSUPPORTED, "not read"


def _find_href(file: File, row: int) -> str:
    """Return the first href in the row or its content, quoted."""
    document = file.document
    hrefs = (document.href(inner) for inner in range(row, document.ends[row]))
    return next((f"'{href}'" for href in hrefs if href), "another element")
