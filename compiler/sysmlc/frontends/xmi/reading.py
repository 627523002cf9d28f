"""From the files of a unit to its elements: what the front end does when there is UML in XMI."""

from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Place, Sink, Subject
from sysmlc.frontends.xmi import applications, behaviour, comments, dangling, lowering, parts, rules
from sysmlc.frontends.xmi import coverage as account
from sysmlc.frontends.xmi import unknown_attributes as unread
from sysmlc.frontends.xmi import unknown_tags as unread_tags
from sysmlc.frontends.xmi import unknown_values as odd_values
from sysmlc.frontends.xmi.columns import read_document
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.enterprise_architect import profiles as enterprise_architect_profiles
from sysmlc.frontends.xmi.finishing import finish
from sysmlc.frontends.xmi.snapshots.entries import is_snapshot
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.ir import Graph
from sysmlc.sources import Fault, Source, SourceError
from sysmlc.support.garbage_collection import pause_garbage_collection


def read(sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Read the files into the graph; references are left for the pass ``resolve``.

    A damaged file is reported and left out. Raises SourceError for what exceeds the
    limits. The graph does not depend on the order of the files.
    """
    ordered = sorted(sources, key=lambda source: source.name)
    models = [source for source in ordered if not is_snapshot(source)]
    beside = [source for source in ordered if is_snapshot(source)]
    with pause_garbage_collection():
        found = [_read(source, sink) for source in models]
        documents = [document for document in found if document is not None]
        unit = Unit(documents, graph)
        contexts = [lowering.lower(unit, lowered, sink) for lowered in unit.files]
        if beside or any(b"<filePart" in model.data for model in models):
            _add_libraries(unit, contexts, models, beside, sink, coverage)
        _finish(unit, contexts, sink, coverage)


def _add_libraries(
    unit: Unit,
    contexts: list[Context],
    models: list[Source],
    beside: list[Source],
    sink: Sink,
    coverage: Coverage,
) -> None:
    """Add what the models take from snapshots of used projects, beside or inside them."""
    from sysmlc.frontends.xmi.snapshots import file_parts as snapshot_parts
    from sysmlc.frontends.xmi.snapshots import libraries as snapshot_use
    from sysmlc.frontends.xmi.snapshots import unknown_attributes as snapshot_unread

    models, inside = snapshot_parts.split(models)
    found = [*beside, *inside]
    if found:
        snapshots = snapshot_use.read(found, sink)
        snapshot_use.add(unit, contexts, models, snapshots)
        odd = snapshot_unread.report(snapshots, found, unit, sink)
        snapshot_use.account(snapshots, beside, unit, coverage, odd)


def _finish(unit: Unit, contexts: list[Context], sink: Sink, coverage: Coverage) -> None:
    for context in contexts:
        parts.join(context)
    for context in contexts:
        applications.note_namespaces(context)
        enterprise_architect_profiles.localise(context)
        comments.restore(context)
        finish(context)
    for context in contexts:
        applications.lower(context)
        if context.extensions:
            # Readers of what only some tools write are imported when it is there.
            from sysmlc.frontends.xmi.enterprise_architect import extension

            extension.finish(context)
        behaviour.finish(context)
    unit.flush()
    for context in contexts:
        dangling.report(context)
        odd_values.report(context)
        unread.report(context)
        unread_tags.report(context)
        account.account(context, sink, coverage)


def _read(source: Source, sink: Sink) -> Document | None:
    try:
        return read_document(source)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(rules.MALFORMED, subject, file=source.name, problem=problem.message)
        return None
