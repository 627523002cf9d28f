"""Reads the files of a compile unit into the graph, in the order that their references need."""

from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Place, Sink, Subject
from sysmlc.frontends.caex import headers, libraries, rules
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.coverage import report_coverage
from sysmlc.frontends.caex.document import Document, read_document
from sysmlc.frontends.caex.hierarchies import Components
from sysmlc.frontends.caex.links import LinkLowering
from sysmlc.frontends.caex.metadata import lower_metadata
from sysmlc.frontends.caex.mirrors import connect_mirrors
from sysmlc.frontends.caex.roles import lower_mappings, lower_roles
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Graph
from sysmlc.sources import Fault, Source, SourceError
from sysmlc.support.interpreter import pause_garbage_collection


def read(sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Read the files into the graph.

    A damaged file is reported and skipped. Raises SourceError if a file exceeds the limits. The
    graph does not depend on the order of the files.
    """
    ordered = sorted(sources, key=lambda source: source.name)
    with pause_garbage_collection():
        documents = [
            document for source in ordered if (document := _read_document(source, sink)) is not None
        ]
        standard_libraries = libraries.StandardLibraries()
        context = Context(documents, graph, sink, standard_libraries.provide)
        _lower_unit(context)
        report_coverage(context, coverage, ordered)
        context.release_nodes()
        standard_libraries.release_nodes()


def _read_document(source: Source, sink: Sink) -> Document | None:
    try:
        return read_document(source)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(rules.MALFORMED, subject, file=source.name, problem=problem.message)
        return None


def _lower_unit(context: Context) -> None:
    """Lower the files: classes before their instances, ports before links, descriptions last."""
    types = _lower_classes(context)
    components = Components(context)
    with_parts = [type for type in types if type.family in (Family.SYSTEM_UNIT, Family.ROLE)]
    for type in libraries.order_by_parts(context, with_parts):
        components.lower_class(type)
    for document in context.documents:
        components.lower_hierarchies(document)
    components.complete()
    connect_mirrors(context)
    lower_roles(context, components)
    lower_mappings(context, components)
    LinkLowering(context, components).lower()
    for document in context.documents:
        lower_metadata(context, document)
    libraries.mark_standard_libraries(context)


def _lower_classes(context: Context) -> list[Type]:
    """Lower headers, and the classes of libraries with their attributes and interfaces."""
    types: list[Type] = []
    for document in context.documents:
        headers.lower_header(context, document)
    headers.report_missing_plant(context)
    headers.connect_aliases(context)
    for document in context.documents:
        types += libraries.lower_libraries(context, document)
    libraries.connect_base_classes(context, types)
    for type in libraries.order_by_base(types):
        libraries.lower_features(context, type)
    return types
