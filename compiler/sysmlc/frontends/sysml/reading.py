"""From the files of a unit to its documents, resolved with the libraries that they refer to."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sysmlc import resources
from sysmlc.diagnostics import Coverage, Sink, Subject, Verdict
from sysmlc.frontends.sysml.detect import is_description, is_xml, language
from sysmlc.frontends.sysml.libraries import FILES, READ, SHIPPED
from sysmlc.frontends.sysml.literals import watched
from sysmlc.frontends.sysml.rules import NO_LIBRARY
from sysmlc.frontends.sysml.settled import settle
from sysmlc.frontends.sysml.unit import lower
from sysmlc.ir import Graph
from sysmlc.language.tree import Document
from sysmlc.sources import Source, SourceError

if TYPE_CHECKING:
    from sysmlc.cache import Cache
    from sysmlc.language.library import Library


def read(
    sources: Sequence[Source],
    graph: Graph,
    sink: Sink,
    coverage: Coverage,
    *,
    library: str = "",
    cache: "Cache | None" = None,
) -> None:
    """Add the files to the graph. Raises SourceError for what exceeds the limits."""
    from sysmlc.language.checks import check
    from sysmlc.language.kept import Kept, keep, take
    from sysmlc.language.names import Model, resolve_all

    models = [source for source in sources if not is_description(source)]
    faulty: set[str] = set()
    is_staying = _is_staying(models, graph, cache)
    kept = take() if is_staying else None
    known = kept.documents(models) if kept else {}
    documents = [known.get(one.name) or _document(one, sink, cache, faulty) for one in models]
    found = _library(library, cache, sink)
    if any(is_xml(one.source) for one in documents if one.source is not None):
        from sysmlc.language.exchange import link

        link(documents, sink, found)
    if any("!" in source.name for source in sources):
        from sysmlc.frontends.sysml.projects import examine

        examine(sources, sink, has_library=not found.is_core)
    own = [one for one in documents if not _is_ours(one)]
    ours = [one for one in documents if _is_ours(one)]
    for document in ours:
        for node in document.root.walk():
            coverage.file(document.path).count(node.kind, Verdict.EXTERNAL)
    if not own:
        return
    ours += _missing(own, ours, cache)
    is_staying = is_staying and not (ours or faulty)
    if kept is None or not is_staying or not kept.renew(own, found):
        texts = [one.source for one in own if known and one.source is not None]
        own = [_document(one, Sink(), cache, set()) for one in texts] or own
        kept = Kept(Model([*own, *ours], found))
    model = kept.model
    own = [one for one in model.documents if one not in ours]
    literals = watched([one for one in own if one.path not in faulty], graph, kept.asked)
    resolve_all(model, sink)
    check(model, sink)
    settle(own, sink)
    graph.store(Model, [*graph.derived(Model), model])
    shared = [one for one in ours if one.root.members[0].name in READ and _is_named(one, models)]
    settle(shared, sink)
    lower([*own, *shared], model, graph, sink, coverage, literals)
    _mark(graph, shared)
    if is_staying:
        keep(kept, literals.asked())


def _is_staying(models: Sequence[Source], graph: Graph, cache: "Cache | None") -> bool:
    """Whether what a unit comes to may be kept: of plain texts, where who asks is noted."""
    is_noted = cache is not None and graph.reads is not None
    return is_noted and not any("!" in one.name or is_xml(one) for one in models)


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


def _document(source: Source, sink: Sink, cache: "Cache | None", faulty: set[str]) -> Document:
    """The tree of one file; what is wrong in it is reported by its reader."""
    if is_xml(source):
        from sysmlc.language.exchange import read as read_exchange

        return read_exchange(source, sink)
    from sysmlc.language.stored import read as read_stored

    before = len(sink)
    found = read_stored(source, source.name, language(source), sink, cache, is_library=False)
    if len(sink) > before:
        faulty.add(source.name)
    return found


def _is_ours(document: Document) -> bool:
    """Whether a file is one of our libraries, as the back end ``sysml`` writes them."""
    found = document.root.members
    return bool(found) and all(one.kind == "LibraryPackage" and one.name in FILES for one in found)


def _missing(
    documents: Sequence[Document], known: Sequence[Document], cache: "Cache | None"
) -> list[Document]:
    """Our libraries that the documents name and that are not among the files."""
    from sysmlc.language.stored import read as read_stored

    there = {one.name for document in (*documents, *known) for one in document.root.members}
    found = []
    for name, file in FILES.items():
        is_named = any(name in one.text or not one.text for one in documents)
        if is_named and name not in there:
            source = Source(f"{SHIPPED}{file}", resources.text("metamodels", file).encode())
            found.append(read_stored(source, source.name, "sysml", Sink(), cache))
    return found


def _library(path: str, cache: "Cache | None", sink: Sink) -> "Library":
    """The standard library, or our small one with what goes wrong told."""
    from sysmlc.language.library import asked_for, core, find

    asked = asked_for(path)
    try:
        found = find(path or None, cache=cache)
        if asked:
            from sysmlc.frontends.sysml.projects import examine_library

            examine_library(Path(asked), sink)
        return found
    except SourceError as problem:
        sink.report(NO_LIBRARY, Subject(asked), path=asked, problem=problem.message)
        return core(cache)
