"""Reads the files of a compile unit into the graph, in the order that their references need."""

from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Place, Sink, Subject
from sysmlc.frontends.xmi import papyrus, rules, unknown_names
from sysmlc.frontends.xmi.applications import lower_applications
from sysmlc.frontends.xmi.attributes import set_deferred_attributes
from sysmlc.frontends.xmi.behaviour import complete_behaviour
from sysmlc.frontends.xmi.context import Context, report_dangling
from sysmlc.frontends.xmi.coverage import report_coverage
from sysmlc.frontends.xmi.document import Document, read_document
from sysmlc.frontends.xmi.enterprise_architect import localise_references, read_extensions
from sysmlc.frontends.xmi.lowering import lower_document, restore_comments
from sysmlc.frontends.xmi.snapshots import libraries
from sysmlc.frontends.xmi.snapshots.entries import is_snapshot
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.frontends.xmi.value_features import set_multiplicities
from sysmlc.ir import Graph
from sysmlc.sources import Fault, Source, SourceError
from sysmlc.support.garbage_collection import pause_garbage_collection


def read(sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Read the files into the graph; the pass ``resolve`` connects the references.

    A damaged file is reported and skipped. Raises SourceError if a file exceeds the limits. The
    graph does not depend on the order of the files.
    """
    ordered = sorted(sources, key=lambda source: source.name)
    models = [source for source in ordered if not is_snapshot(source)]
    snapshots = [source for source in ordered if is_snapshot(source)]
    with pause_garbage_collection():
        documents = [_read_document(source, sink) for source in models]
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


def _read_document(source: Source, sink: Sink) -> Document | None:
    try:
        return read_document(source)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(rules.MALFORMED, subject, file=source.name, problem=problem.message)
        return None


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
