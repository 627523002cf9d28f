"""Reading of the files of a unit: documents, resolved with the libraries that they refer to."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from sysmlc.diagnostics import Coverage, Sink, Subject, Verdict
from sysmlc.frontends.base import FileNames
from sysmlc.frontends.sysml.detection import is_description, is_xml, language_of
from sysmlc.frontends.sysml.libraries import FILES, LOWERED
from sysmlc.frontends.sysml.rules import NO_LIBRARY, adapt_shared_rules
from sysmlc.frontends.sysml.unit import lower_unit
from sysmlc.ir import Graph
from sysmlc.ir.pending import TextFile
from sysmlc.language import interchange
from sysmlc.language.checks import check
from sysmlc.language.library import SHIPPED, Library, find_library, load_core, requested_path
from sysmlc.language.names import Model, resolve_all
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node, Reference
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError
from sysmlc.sources.files import read_whole
from sysmlc.support import resources

_ARCHIVE_SUFFIX = ".kpar"
_GLOBAL_SCOPE = "$"


def read(
    sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage, *, library: str = ""
) -> None:
    """Read the files into the graph. Raises SourceError for a file that exceeds the limits."""
    models = [source for source in sources if not is_description(source)]
    documents = [_parse_document(source, sink) for source in models]
    standard = _load_standard_library(library, sink)
    if any(map(_is_interchange, documents)):
        interchange.link(documents, sink, standard)
    if any("!" in source.name for source in sources):
        _check_projects(sources, sink, has_library=not standard.is_core)
    user_documents = [document for document in documents if not _is_shipped_library(document)]
    shipped = [document for document in documents if _is_shipped_library(document)]
    for document in shipped:
        for node in document.root.walk():
            coverage.file(document.path).count(node.kind, Verdict.EXTERNAL)
    if not user_documents:
        return
    shipped += _load_missing_libraries(user_documents, shipped)
    model = Model([*user_documents, *shipped], standard)
    # The model sorts its documents by path.
    user_documents = [document for document in model.documents if document not in shipped]
    resolve_all(model, sink)
    check(model, sink)
    adapt_shared_rules(user_documents, sink)
    graph.store(Model, [*graph.derived(Model), model])
    lowered = [
        document
        for document in shipped
        if document.root.members[0].name in LOWERED and _is_mentioned(document, models)
    ]
    adapt_shared_rules(lowered, sink)
    files = [TextFile(document.path) for document in (*user_documents, *lowered)]
    graph.store(TextFile, [*graph.derived(TextFile), *files])
    lower_unit([*user_documents, *lowered], model, graph, sink, coverage)
    _mark_external(graph, lowered)


def _parse_document(source: Source, sink: Sink) -> Document:
    """Parse one text or interchange file and report its faults."""
    if is_xml(source):
        return interchange.read(source, sink)
    return _parse_text(source, language_of(source), sink)


def _parse_text(source: Source, language: str, sink: Sink) -> Document:
    text = source.data.decode("utf-8-sig", "replace")
    return parse(text, source.name, language, sink, source)


def _is_interchange(document: Document) -> bool:
    """Whether a document was read from XMI, which does not show the names that it refers to."""
    return document.source is not None and is_xml(document.source)


# -- libraries ---------------------------------------------------------------------------------


def _load_standard_library(path: str, sink: Sink) -> Library:
    """Return the standard library; report an unreadable one and return the bundled core."""
    requested = requested_path(path)
    try:
        library = find_library(path or None)
        if requested:
            _check_library_archives(Path(requested), sink)
        return library
    except SourceError as problem:
        sink.report(NO_LIBRARY, Subject(requested), path=requested, problem=problem.message)
        return load_core()


def _check_library_archives(path: Path, sink: Sink) -> None:
    """Report files of archives that differ from the description of their archive.

    ``path`` is an archive or a folder of archives. Raises SourceError for an unreadable archive.
    """
    archives = [path] if path.is_file() else sorted(path.glob(f"*{_ARCHIVE_SUFFIX}"))
    for archive in archives:
        if archive.suffix.lower() == _ARCHIVE_SUFFIX:
            data = read_whole(archive, archive.name, DEFAULT_LIMITS)
            interchange.open_archive(Source(archive.name, data), sink)


def _check_projects(sources: Sequence[Source], sink: Sink, *, has_library: bool) -> None:
    """Report files that differ from their project's description, and missing used projects.

    ``has_library`` states whether the standard library was found; projects use it by its IRI.
    """
    archives: dict[str, list[Source]] = {}
    for source in sources:
        archive, separator, _ = source.name.partition("!")
        if separator:
            archives.setdefault(archive, []).append(source)
    projects = [
        interchange.read_project(archive, entries, sink)
        for archive, entries in archives.items()
        if archive.lower().endswith(_ARCHIVE_SUFFIX) or any(map(is_description, entries))
    ]
    for project in projects:
        interchange.resolve_usages(project, projects, sink, has_standard=has_library)


def _is_shipped_library(document: Document) -> bool:
    """Whether a file is a copy of a shipped library, as the back end ``sysml`` writes it."""
    members = document.root.members
    return bool(members) and all(
        member.kind == "LibraryPackage" and member.name in FILES for member in members
    )


def _load_missing_libraries(
    user_documents: Sequence[Document], shipped: Sequence[Document]
) -> list[Document]:
    """Return the shipped libraries that the documents mention and that the unit does not have."""
    documents = (*user_documents, *shipped)
    present = {member.name for document in documents for member in document.root.members}
    libraries = []
    for name, file in FILES.items():
        is_used = any(
            name in document.text or _is_interchange(document) for document in user_documents
        )
        if is_used and name not in present:
            source = Source(f"{SHIPPED}{file}", resources.read_text("metamodels", file).encode())
            libraries.append(_parse_text(source, "sysml", Sink()))
    return libraries


def _is_mentioned(library: Document, models: Sequence[Source]) -> bool:
    """Whether the bytes of any file contain the name of a library."""
    name = str(library.root.members[0].name).encode()
    return any(name in source.data for source in models)


def _mark_external(graph: Graph, libraries: Sequence[Document]) -> None:
    """Mark the elements of libraries as external: no file of the model contains them."""
    paths = {document.path for document in libraries}
    if not paths:
        return
    for root in graph.roots():
        if root.source in paths:
            for element in graph.subtree(root):
                graph.set(element, external=True)


# -- names between files -----------------------------------------------------------------------


def read_names(source: Source) -> FileNames:
    """Return the names by which files refer to one another (KerML 1.0, 8.2.3.5.5).

    The root namespaces of all files of a unit form the global namespace: a file sees the elements
    of another file by the names of its root members only. ``declared`` has these names, ``local``
    the names of all elements, and ``used`` the first segments of qualified names. A file is a
    library if every root member is a library package.
    """
    root = _parse_root(source)
    nodes = list(root.walk())
    references = (relation.reference for node in nodes for relation in node.relations)
    return FileNames(
        is_library=all(member.kind == "LibraryPackage" for member in root.members),
        declared=_list_names(root.members),
        local=_list_names(nodes),
        used=frozenset(_first_segment(reference) for reference in references),
    )


def _list_names(nodes: Iterable[Node]) -> frozenset[str]:
    return frozenset(name for node in nodes for name in (node.name, node.short_name) if name)


def _first_segment(reference: Reference) -> str:
    """Return the first segment of the name, or the second one behind the global scope ``$``."""
    names = reference.chain[0]
    return names[1] if names[0] == _GLOBAL_SCOPE and len(names) > 1 else names[0]


def _parse_root(source: Source) -> Node:
    """Return the root namespace of the file; its faults are reported when the unit is read."""
    if is_description(source):
        return Node("Namespace")
    try:
        return _parse_document(source, Sink()).root
    except SourceError:
        return Node("Namespace")
