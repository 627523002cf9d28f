"""Headers of files: documents, aliases of other files, and the report of a missing plant."""

import posixpath
from urllib.parse import unquote

from sysmlc.diagnostics import Severity, Verdict, rule
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.vocabulary import LIBRARIES
from sysmlc.ir import Edge, Kind

REPEATED_ALIAS = rule(
    "SM636",
    "repeated-alias",
    Severity.WARNING,
    "the alias '{alias}' is declared for '{path}', but already stands for '{first}'",
    help="give one of them another alias",
)


def lower_header(context: Context, document: Document) -> None:
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
        context.report(rules.NO_MODEL, document, root, file=document.name)
    for node in root.iter_children("ExternalReference"):
        _lower_alias(context, document, node)
    for node in root.iter_children("SuperiorStandardVersion", "Description"):
        node.verdict = Verdict.MAPPED


def report_missing_plant(context: Context) -> None:
    """Report the first file of a unit that has libraries but no instance hierarchy."""
    roots = [document.root for document in context.documents]
    if any(root.has_child("InstanceHierarchy") for root in roots):
        return
    for document in context.documents:
        if document.root.has_child(*LIBRARIES):
            context.report(rules.ONLY_LIBRARIES, document, document.root, file=document.name)
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
    context.report(REPEATED_ALIAS, document, node, alias=alias, **paths)


def connect_aliases(context: Context) -> None:
    """Connect each alias to the document of its file, if that is part of the unit."""
    for document in context.documents:
        for node in document.root.iter_children("ExternalReference"):
            path = node.attributes.get("Path", "")
            target = f"{_resolve_file(document.name, path)}#"
            if target in context.graph:
                context.graph.connect(Edge.REFERENCES, node.element_id, target)


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
