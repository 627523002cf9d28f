"""Back end ``sysmlx``: the model as interchange files of SysML v2 (XMI).

They are written from the syntax trees of SysML v2 inputs. For other inputs, the back end ``sysml``
prints the graph as text, which is parsed again: the interchange form contains what the text
expresses.
"""

from collections.abc import Sequence
from functools import lru_cache, partial
from os import environ

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.sysml import BACKEND as TEXT
from sysmlc.backends.sysml.author_texts import BYTE_ORDER_MARK, list_texts, path_of_text
from sysmlc.diagnostics import Diagnostic, Severity, Sink, rule
from sysmlc.ir import Element, Graph
from sysmlc.language.interchange.writer import InterchangeFiles, interchange_path, write
from sysmlc.language.library import SHIPPED, VARIABLE, Library, find_library, load_core
from sysmlc.language.names import Model, resolve
from sysmlc.language.names.implied_relations import implied_redefinitions
from sysmlc.language.text import parse
from sysmlc.language.text.nesting import MAX_DEPTH
from sysmlc.language.text.rules import DEEP
from sysmlc.language.tree import Document
from sysmlc.sources import SourceError
from sysmlc.support.output import Output

TOO_DEEP = rule(
    "SM748",
    "sysmlx-too-deep",
    Severity.ERROR,
    "'{name}' is nested more than {limit} levels deep: the model is not written as interchange",
    help="omit the back end sysmlx, or nest fewer elements in one another",
)
OWN_TEXT = rule(
    "SM749",
    "sysmlx-own-text",
    Severity.ERROR,
    "the SysML v2 text generated for '{name}' cannot be read (line {line}: {message}): "
    "the model is not written as interchange",
    help="--emit +sysml writes the text; please report it with the model, and omit sysmlx "
    "until then",
)

_LIBRARY = "sysml.library.xmi"
"""Folder of the standard library's interchange files in its releases; references lead there."""


class SysmlxBackend(Struct, frozen=True):
    """Writes SysML v2 models as they were read, other models with what SysML v2 text expresses."""

    name: str = "sysmlx"
    summary: str = "the model as SysML v2 interchange (XMI), sysmlx/*.sysmlx"
    is_default: bool = False
    needs: tuple[str, ...] = ("recipe",)

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add a file for each file of the model; report what the files cannot express."""
        models = graph.derived(Model)
        if not models or any(file.language != "sysml" for file in options.inputs):
            model = _build_model(graph, sink, options)
            models = [] if model is None else [model]
        for model in models:
            library = _index_library(tuple(model.library.loaded_documents()))
            files = InterchangeFiles(
                model.documents, library, partial(implied_redefinitions, model)
            )
            for document in model.documents:
                # Faults of the libraries of sysmlc are not faults of the model; the same holds
                # for unresolved names in them.
                is_foreign = model.library.is_core and document.path.startswith(SHIPPED)
                document_sink = Sink() if is_foreign else sink
                data = write(document, files, document_sink, _FileLocations(model.documents))
                path = f"sysmlx/{interchange_path(document)}"
                output.add(path, data.decode(), (), self.name)


class _FileLocations:
    """Paths of the interchange files of documents, relative to the output folder ``sysmlx``."""

    def __init__(self, documents: Sequence[Document]) -> None:
        self._roots = {document.root for document in documents}

    def __call__(self, document: Document) -> str:
        path = interchange_path(document)
        return path if document.root in self._roots else f"{_LIBRARY}/{path}"


def _build_model(graph: Graph, sink: Sink, options: EmitOptions) -> Model | None:
    """Return the graph as a SysML v2 model with resolved names; report the losses of the text.

    None, and a diagnostic, for a graph that is nested deeper than the parser allows, and for any
    other syntax error in printed text, which is a fault of the back end ``sysml``. Syntax errors
    in texts of authors were reported when they were read.
    """
    text_output = Output()
    TEXT.emit(graph, text_output, sink, options)
    author_paths = {path_of_text(document) for document in list_texts(graph)}
    syntax_errors = Sink()
    documents = []
    for file in text_output.artefacts():
        path = file.path.removeprefix("sysml/")
        language = "kerml" if path.lower().endswith(".kerml") else "sysml"
        document_sink = Sink() if path in author_paths else syntax_errors
        text = file.text.removeprefix(BYTE_ORDER_MARK)
        documents.append(parse(text, path, language, document_sink))
    if syntax_errors.has_errors():
        first = next(iter(syntax_errors))
        if first.rule is DEEP:
            deepest = _find_deepest(graph)
            sink.report(TOO_DEEP, graph.subject(deepest), name=deepest.name, limit=MAX_DEPTH)
        else:
            _report_syntax_error(graph, documents, first, sink)
        return None
    return resolve(documents, _find_library(environ.get(VARIABLE, "")), syntax_errors)


def _report_syntax_error(
    graph: Graph, documents: Sequence[Document], error: Diagnostic, sink: Sink
) -> None:
    """Report a syntax error of the printed text at the element whose text contains it."""
    place = error.subject.place
    documents_by_path = {document.path: document for document in documents}
    line, name = 0, ""
    if place is not None and place.file in documents_by_path:
        line, name = _locate(documents_by_path[place.file], place.offset or 0)
    namesakes = (element for element in graph if element.name == name)
    element = next(namesakes, None) or _find_deepest(graph)
    name = element.name or element.kind
    subject = graph.subject(element)
    sink.report(OWN_TEXT, subject, name=name, line=line, message=error.message)


def _locate(document: Document, byte_offset: int) -> tuple[int, str]:
    """Return the line at an offset, and the name of the innermost element around it."""
    before = document.text.encode()[:byte_offset].decode(errors="replace")
    offset = len(before)
    names = [
        node.name for node in document.root.walk() if node.name and node.start <= offset < node.end
    ]
    return before.count("\n") + 1, names[-1] if names else ""


def _find_deepest(graph: Graph) -> Element:
    """Return the first of the elements that are nested deepest."""
    level = graph.roots()
    while children := [child for owner in level for child in graph.owned(owner)]:
        level = children
    return level[0]


def _find_library(path: str) -> Library:
    """Return the library at *path*, or the installed one; the bundled core if there is none."""
    try:
        return find_library(path or None)
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
