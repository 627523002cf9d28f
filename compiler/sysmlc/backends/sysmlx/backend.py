"""Interchange files of SysML v2: from the syntax of v2 inputs, else from the text of the graph."""

from collections.abc import Sequence
from functools import lru_cache, partial
from os import environ

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.sysml import BACKEND as TEXT
from sysmlc.backends.sysmlx.rules import OWN_TEXT, TOO_DEEP
from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.ir import Element, Graph
from sysmlc.language.interchange import InterchangeFiles, interchange_path, write
from sysmlc.language.library import SHIPPED, VARIABLE, Library, find_library, load_core
from sysmlc.language.names import Model, resolve
from sysmlc.language.names.implied_relations import implied_redefinitions
from sysmlc.language.text import parse
from sysmlc.language.text.nesting import MAX_DEPTH
from sysmlc.language.text.rules import DEEP
from sysmlc.language.tree import Document
from sysmlc.sources import SourceError
from sysmlc.support.output import Output

_LIBRARY = "sysml.library.xmi"
"""The folder of the standard library's interchange files in its releases; references lead there."""


class SysmlxBackend(Struct, frozen=True):
    """Writes models of SysML v2 as they were read, other models as SysML v2 would say them."""

    name: str = "sysmlx"
    summary: str = "the model as SysML v2 interchange (XMI), sysmlx/*.sysmlx"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add a file for each file of the model; report what cannot be said."""
        models = graph.derived(Model)
        if not models or any(one.language != "sysml" for one in options.inputs):
            said = _said(graph, sink, options)
            models = [] if said is None else [said]
        for model in models:
            library = _index_library(tuple(model.library.loaded_documents()))
            known = InterchangeFiles(
                model.documents, library, partial(implied_redefinitions, model)
            )
            for document in model.documents:
                path = f"sysmlx/{interchange_path(document)}"
                # As for unresolved names, faults of our libraries are not those of the model.
                is_foreign = model.library.is_core and document.path.startswith(SHIPPED)
                document_sink = Sink() if is_foreign else sink
                data = write(document, known, document_sink, _Places(model.documents))
                output.add(path, data.decode(), (), self.name)


class _Places:
    """Where the interchange files of documents are, relative to the folder of ours."""

    def __init__(self, own: Sequence[Document]) -> None:
        self._own = {document.root for document in own}

    def __call__(self, document: Document) -> str:
        path = interchange_path(document)
        return path if document.root in self._own else f"{_LIBRARY}/{path}"


def _said(graph: Graph, sink: Sink, options: EmitOptions) -> Model | None:
    """The graph as SysML v2 text says it, with names resolved; losses are those of the text.

    None, and a message, for one that is nested deeper than text is read, and where the text has
    another syntax error, which is a fault of ours.
    """

    written = Output()
    TEXT.emit(graph, written, sink, options)
    unseen = Sink()
    documents = [
        parse(one.text, one.path.removeprefix("sysml/"), "sysml", unseen)
        for one in written.artefacts()
    ]
    if unseen.has_errors():
        first = next(iter(unseen))
        if first.rule is DEEP:
            deepest = _deepest(graph)
            sink.report(TOO_DEEP, graph.subject(deepest), name=deepest.name, limit=MAX_DEPTH)
        else:
            _report(graph, documents, first, sink)
        return None
    return resolve(documents, _find_library(environ.get(VARIABLE, "")), unseen)


def _report(graph: Graph, documents: Sequence[Document], first: Diagnostic, sink: Sink) -> None:
    """Report a syntax error of our own text at the element that the text is about there."""
    place = first.subject.place
    texts = {one.path: one for one in documents}
    line, name = 0, ""
    if place is not None and place.file in texts:
        line, name = _about(texts[place.file], place.offset or 0)
    element = next((one for one in graph if one.name == name), None) or _deepest(graph)
    name = element.name or element.kind
    about = graph.subject(element)
    sink.report(OWN_TEXT, about, name=name, line=line, message=first.message)


def _about(document: Document, offset: int) -> tuple[int, str]:
    """The line of a byte of a text, and the name of the innermost element around it."""
    before = document.text.encode()[:offset].decode(errors="replace")
    at = len(before)
    names = [one.name for one in document.root.walk() if one.name and one.start <= at < one.end]
    return before.count("\n") + 1, names[-1] if names else ""


def _deepest(graph: Graph) -> Element:
    """The first of the elements with the most owners."""
    level = graph.roots()
    while below := [one for owner in level for one in graph.owned(owner)]:
        level = below
    return level[0]


def _find_library(asked: str) -> Library:
    """Return the library at *asked*, else the installed one; the small one if it is missing."""
    try:
        return find_library(asked or None)
    except SourceError:
        return load_core()


@lru_cache(maxsize=1)
def _index_library(documents: tuple[Document, ...]) -> InterchangeFiles:
    """Return the interchange form of library documents.

    A process that compiles again reuses the parsed library, and the ids of its 10,000 elements
    take 0.5 s to compute.
    """
    return InterchangeFiles(documents)


BACKEND = SysmlxBackend()
