"""AutomationML read into the graph: the order in which the parts of its files are lowered."""

from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Place, Sink, Subject
from sysmlc.frontends.caex import (
    account,
    features,
    libraries,
    mappings,
    metadata,
    mirrors,
    roles,
    rules,
)
from sysmlc.frontends.caex.columns import read_document
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.links import Links
from sysmlc.frontends.caex.sites import Sites
from sysmlc.frontends.caex.standard import Standard
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Graph
from sysmlc.sources import Fault, Source, SourceError
from sysmlc.support.garbage_collection import pause_garbage_collection


def read_all(sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Read the files into the graph; see ``CaexFrontend.read``."""
    ordered = sorted(sources, key=lambda source: source.name)
    with pause_garbage_collection():
        documents = [d for source in ordered if (d := _read(source, sink)) is not None]
        standard = Standard()
        context = Context(documents, graph, sink, standard.provide)
        _lower(context)
        account.account(context, coverage, ordered)
        context.forget()
        standard.forget()


def _lower(context: Context) -> None:
    types = []
    for document in context.documents:
        libraries.header(context, document)
    libraries.report_missing_plant(context)
    libraries.tie_aliases(context)
    for document in context.documents:
        types += libraries.lower(context, document)
    libraries.specialise(context, types)
    for type in libraries.in_order(types):
        features.lower_own(context, type)
    sites = Sites(context)
    held = [type for type in types if type.family in (Family.SYSTEM_UNIT, Family.ROLE)]
    for type in libraries.in_order_of_parts(context, held):
        sites.lower_class(type)
    for document in context.documents:
        sites.lower_hierarchies(document)
    sites.finish()
    mirrors.finish(context)
    roles.lower(context, sites)
    mappings.lower(context, sites)
    Links(context, sites).lower()
    for document in context.documents:
        metadata.lower(context, document)
    libraries.set_apart(context)


def _read(source: Source, sink: Sink) -> Document | None:
    try:
        return read_document(source)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(rules.MALFORMED, subject, file=source.name, problem=problem.message)
        return None
