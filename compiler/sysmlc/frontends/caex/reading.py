"""Reads the files of a compile unit into the graph, in the order that their references need.

The headers of files are lowered here: documents, and aliases of other files.
"""

import posixpath
from collections.abc import Sequence
from urllib.parse import unquote

from sysmlc.diagnostics import Coverage, Severity, Sink, Verdict, rule
from sysmlc.frontends.base import read_or_report
from sysmlc.frontends.caex import libraries, rules, standard
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.coverage import report_coverage
from sysmlc.frontends.caex.document import Document, Node, read_document
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.hierarchies import Components
from sysmlc.frontends.caex.links import LinkLowering
from sysmlc.frontends.caex.metadata import lower_metadata
from sysmlc.frontends.caex.roles import lower_mappings, lower_roles
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import LIBRARIES, Family
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.sources import Source
from sysmlc.support.interpreter import pause_garbage_collection

REPEATED_ALIAS = rule(
    "SM636",
    "repeated-alias",
    Severity.WARNING,
    "the alias '{alias}' is declared for '{path}', but already stands for '{first}'",
    help="give one of them another alias",
)


def read(sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Read the files into the graph.

    A damaged file is reported and skipped. Raises SourceError if a file exceeds the limits. The
    graph does not depend on the order of the files.
    """
    ordered = sorted(sources, key=lambda source: source.name)
    with pause_garbage_collection():
        readings = [
            read_or_report(read_document, source, rules.MALFORMED, sink) for source in ordered
        ]
        documents = [document for document in readings if document is not None]
        standard_libraries = libraries.StandardLibraries()
        context = Context(documents, graph, sink, standard_libraries.provide)
        _lower_unit(context)
        report_coverage(context, coverage, ordered)
        for document in documents:
            document.release_nodes()
        standard_libraries.release_nodes()


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
    context.mirrors.connect()
    lower_roles(context, components)
    lower_mappings(context, components)
    LinkLowering(context, components).lower()
    for document in context.documents:
        lower_metadata(context, document)
    libraries.mark_standard_libraries(context.graph, context.documents)


def _lower_classes(context: Context) -> list[Type]:
    """Lower headers, and the classes of libraries with their attributes and interfaces."""
    types: list[Type] = []
    for document in context.documents:
        _lower_header(context, document)
    _report_missing_plant(context.findings, context.documents)
    _connect_aliases(context.graph, context.documents)
    for document in context.documents:
        types += libraries.lower_libraries(context, document)
    libraries.connect_base_classes(context, types)
    standard.report_classes_without_base(context.findings, types)
    for type in libraries.order_by_base(types):
        libraries.lower_features(context, type)
    return types


# -- headers -----------------------------------------------------------------------------------


def _lower_header(context: Context, document: Document) -> None:
    """Add the document of a file, and an import for each file that it refers to by alias."""
    root = document.root
    element = context.add_element(
        Kind.DOCUMENT,
        root,
        document,
        None,
        id=f"{document.name}#",
        subkind="caex",
        version=document.version,
        description=root.child_text("Description"),
        superior_standard=root.child_text("SuperiorStandardVersion"),
    )
    context.graph.rename(element, root.attributes.get("FileName", "") or document.name)
    if not root.has_child(*LIBRARIES, "InstanceHierarchy"):
        context.findings.report(rules.NO_MODEL, document, root, file=document.name)
    for node in root.iter_children("ExternalReference"):
        _lower_alias(context, document, node)
    for node in root.iter_children("SuperiorStandardVersion", "Description"):
        node.verdict = Verdict.MAPPED


def _report_missing_plant(findings: Findings, documents: list[Document]) -> None:
    """Report the first file of a unit that has libraries but no instance hierarchy."""
    roots = [document.root for document in documents]
    if any(root.has_child("InstanceHierarchy") for root in roots):
        return
    for document in documents:
        if document.root.has_child(*LIBRARIES):
            findings.report(rules.ONLY_LIBRARIES, document, document.root, file=document.name)
            return


# -- aliases ---------------------------------------------------------------------------------------


def _lower_alias(context: Context, document: Document, node: Node) -> None:
    alias, path = node.attributes.get("Alias", ""), node.attributes.get("Path", "")
    _declare_alias(context, document, node, _resolve_file(document.name, path))
    element = context.add_element(
        Kind.IMPORT,
        node,
        document,
        None,
        id=context.make_unique(f"{document.name}#{alias}", node),
        subkind="alias",
        path=path,
    )
    context.graph.rename(element, alias)


def _declare_alias(context: Context, document: Document, node: Node, file: str) -> None:
    """Declare an alias of a file; report a second declaration for another file."""
    alias = node.attributes.get("Alias", "")
    if context.types.declare_alias(document, alias, file) == file:
        return
    references = document.root.iter_children("ExternalReference")
    first = next(other for other in references if other.attributes.get("Alias", "") == alias)
    paths = {"path": node.attributes.get("Path", ""), "first": first.attributes.get("Path", "")}
    context.findings.report(REPEATED_ALIAS, document, node, alias=alias, **paths)


def _connect_aliases(graph: Graph, documents: list[Document]) -> None:
    """Connect each alias to the document of its file, if that is part of the unit."""
    for document in documents:
        for node in document.root.iter_children("ExternalReference"):
            path = node.attributes.get("Path", "")
            target = f"{_resolve_file(document.name, path)}#"
            if target in graph:
                graph.connect(Edge.REFERENCES, node.element_id, target)


def _resolve_file(name: str, path: str) -> str:
    """Return the name in the unit of the file that a path in the file *name* means.

    Paths in a package (``.amlx``) lead to other parts of it; absolute ones start at its root.
    """
    archive, _, entry = name.rpartition("!")
    file = unquote(path.partition("#")[0])
    if archive:
        folder = "" if file.startswith("/") else posixpath.dirname(entry)
        return f"{archive}!{posixpath.normpath(posixpath.join(folder, file.lstrip('/')))}"
    return posixpath.normpath(posixpath.join(posixpath.dirname(name), file))
