"""From the files of a unit to its documents, resolved with the libraries that they refer to."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Coverage, Sink, Subject, Verdict
from sysmlc.frontends.sysml.detect import is_description, is_xml, language
from sysmlc.frontends.sysml.libraries import FILES, READ
from sysmlc.frontends.sysml.rules import NO_LIBRARY
from sysmlc.frontends.sysml.settled import settle
from sysmlc.frontends.sysml.unit import lower
from sysmlc.ir import Graph
from sysmlc.language.library import SHIPPED
from sysmlc.language.tree import Document
from sysmlc.sources import Source, SourceError
from sysmlc.support import resources

if TYPE_CHECKING:
    from sysmlc.language.library import Library


def read(
    sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage, *, library: str = ""
) -> None:
    """Add the files to the graph. Raises SourceError for what exceeds the limits."""
    from sysmlc.language.checks import check
    from sysmlc.language.names import Model, resolve_all

    models = [source for source in sources if not is_description(source)]
    documents = [parse_document(source, sink) for source in models]
    standard = _library(library, sink)
    if any(is_xml(one.source) for one in documents if one.source is not None):
        from sysmlc.language.interchange import link

        link(documents, sink, standard)
    if any("!" in source.name for source in sources):
        from sysmlc.frontends.sysml.projects import examine

        examine(sources, sink, has_library=not standard.is_core)
    own = [one for one in documents if not _is_ours(one)]
    ours = [one for one in documents if _is_ours(one)]
    for document in ours:
        for node in document.root.walk():
            coverage.file(document.path).count(node.kind, Verdict.EXTERNAL)
    if not own:
        return
    ours += _missing(own, ours)
    model = Model([*own, *ours], standard)
    own = [one for one in model.documents if one not in ours]
    resolve_all(model, sink)
    check(model, sink)
    settle(own, sink)
    graph.store(Model, [*graph.derived(Model), model])
    shared = [one for one in ours if one.root.members[0].name in READ and _is_named(one, models)]
    settle(shared, sink)
    lower([*own, *shared], model, graph, sink, coverage)
    _mark(graph, shared)


def _is_named(library: Document, models: Sequence[Source]) -> bool:
    """Whether a file speaks of the library; of an interchange file nothing tells before."""
    name = str(library.root.members[0].name).encode()
    return any(name in one.data for one in models)


def _mark(graph: Graph, libraries: Sequence[Document]) -> None:
    """Say of the elements of libraries that they are in no file of the model."""
    paths = {one.path for one in libraries}
    for root in graph.roots() if paths else ():
        if root.source in paths:
            for one in graph.subtree(root):
                graph.set(one, external=True)


def parse_document(source: Source, sink: Sink) -> Document:
    """Parse one text or interchange file and report its faults."""
    if is_xml(source):
        from sysmlc.language.interchange import read as read_exchange

        return read_exchange(source, sink)
    return _parse(source, language(source), sink)


def _parse(source: Source, language: str, sink: Sink) -> Document:
    from sysmlc.language.text import parse

    text = source.data.decode("utf-8-sig", "replace")
    return parse(text, source.name, language, sink, source)


def _is_ours(document: Document) -> bool:
    """Whether a file is one of our libraries, as the back end ``sysml`` writes them."""
    found = document.root.members
    return bool(found) and all(one.kind == "LibraryPackage" and one.name in FILES for one in found)


def _missing(documents: Sequence[Document], known: Sequence[Document]) -> list[Document]:
    """Our libraries that the documents name and that are not among the files."""
    there = {one.name for document in (*documents, *known) for one in document.root.members}
    found = []
    for name, file in FILES.items():
        is_named = any(name in one.text or _is_interchange(one) for one in documents)
        if is_named and name not in there:
            source = Source(f"{SHIPPED}{file}", resources.read_text("metamodels", file).encode())
            found.append(_parse(source, "sysml", Sink()))
    return found


def _is_interchange(document: Document) -> bool:
    """Whether a document was read from XMI, which does not show the names that it refers to."""
    return document.source is not None and is_xml(document.source)


def _library(path: str, sink: Sink) -> "Library":
    """The standard library, or our small one with what goes wrong told."""
    from sysmlc.language.library import find_library, load_core, requested_path

    asked = requested_path(path)
    try:
        found = find_library(path or None)
        if asked:
            from sysmlc.frontends.sysml.projects import examine_library

            examine_library(Path(asked), sink)
        return found
    except SourceError as problem:
        sink.report(NO_LIBRARY, Subject(asked), path=asked, problem=problem.message)
        return load_core()
