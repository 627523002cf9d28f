"""Back end ``aml``: the structure of the graph as AutomationML, CAEX 3.0."""

import posixpath

from msgspec import Struct

from sysmlc.backends.aml import instances, libraries, links, omissions
from sysmlc.backends.aml.context import Context, File, ObjectIds
from sysmlc.backends.aml.header import write_header, write_source_document
from sysmlc.backends.aml.node import Node, print_document
from sysmlc.backends.aml.rules import EMPTY, ILLEGAL_CHARACTERS, Losses
from sysmlc.backends.base import EmitOptions, name_compile_unit
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.counts import count
from sysmlc.support.output import Output, assign_file_names, fold_path

FOLDER = "aml"


class AmlBackend(Struct, frozen=True):
    """Saves the structure of the graph of any front end as AutomationML."""

    name: str = "aml"
    summary: str = "the structure as AutomationML, CAEX 3.0, aml/*.aml"
    is_default: bool = False
    needs: tuple[str, ...] = ()

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add a file for each AutomationML file of the unit, or one file for another model."""
        for path, text in write_files(graph, name_compile_unit(graph, options), sink).items():
            output.add(path, text, (), self.name)


BACKEND = AmlBackend()


def write_files(graph: Graph, unit: str, sink: Sink) -> dict[str, str]:
    """Return the CAEX files of the graph, text by path; report what CAEX cannot express.

    There is no file if the plant would lose all its content.
    """
    files = _create_files(graph, unit)
    sources = frozenset(file.name for file in files if file.document is not None and file.name)
    context = Context(graph, Losses(graph), files, ObjectIds(graph, sources))
    _write_file_headers(context)
    # All classes are placed before any content is written, because content refers to their paths.
    libraries.place_classes(context)
    libraries.fill_classes(context)
    libraries.write_hierarchies(context)
    # Links and mirrors refer to objects by ID, so all objects come first.
    links.write_links(context)
    links.resolve_pending_references(context)
    instances.copy_class_attributes(context)
    for file in context.files:
        write_source_document(context, file.document, file.root)
    omissions.note_omissions(context)
    lost = omissions.find_lost_plant(context)
    if lost is not None:
        sink.report(EMPTY, graph.subject(lost[0]), reason=lost[1])
        return {}
    texts, replaced = {}, 0
    for file in context.files:
        texts[file.path], number = print_document(file.root)
        replaced += number
    context.losses.report(sink)
    if replaced:
        subject = next((graph.subject(root) for root in graph.roots()), Subject())
        sink.report(ILLEGAL_CHARACTERS, subject, count=count(replaced, "character"))
    return texts


# -- files -------------------------------------------------------------------------------------


def _create_files(graph: Graph, unit: str) -> list[File]:
    """Return a file for each AutomationML file of the unit, or one file named after the unit.

    A plant that is read from another language has a Document of its header, but no file of it.
    """
    documents = [root for root in graph.roots() if _is_caex_file(root)]
    sources = [document.source for document in documents]
    if not all(sources):
        return [_create_file("", _choose_paths([unit])[unit], f"{unit}.aml", documents[0])]
    paths = _choose_paths(sources or [unit])
    if not documents:
        return [_create_file("", paths[unit], f"{unit}.aml", None)]
    return [
        _create_file(source, paths[source], document.name, document)
        for source, document in zip(sources, documents, strict=True)
    ]


def _is_caex_file(element: Element) -> bool:
    return element.kind is Kind.DOCUMENT and element.subkind == "caex"


def _create_file(name: str, path: str, title: str, document: Element | None) -> File:
    root = Node("CAEXFile", {"SchemaVersion": "3.0", "FileName": title})
    return File(name, path, root, document)


def _choose_paths(names: list[str]) -> dict[str, str]:
    """Return the output path of each source; subfolders of the unit are preserved.

    Paths that differ only in case get underscores, because some file systems ignore case. A
    source in an archive has the path ``archive!entry``.
    """
    stems = {name: posixpath.splitext(name.replace("!", "/"))[0].split("/") for name in names}
    file_names = assign_file_names(sorted({part for stem in stems.values() for part in stem}))
    paths: dict[str, str] = {}
    used: set[str] = set()
    for name, stem in stems.items():
        path = "/".join(file_names[part] for part in stem)
        while fold_path(path) in used:
            path += "_"
        used.add(fold_path(path))
        paths[name] = f"{FOLDER}/{path}.aml"
    return paths


def _write_file_headers(context: Context) -> None:
    """Add what each file states about itself, and its aliases of other files."""
    for file in context.files:
        if file.document is None:
            continue
        document = file.document
        context.register(document, file.root)
        if "description" in document.attrs:
            file.root.add_text("Description", str(document.attrs["description"]))
        if "superior_standard" in document.attrs:
            file.root.add_text("SuperiorStandardVersion", str(document.attrs["superior_standard"]))
        # The version of a Document is its SchemaVersion, not the Version of an object.
        copy = Element(document.id, document.kind, document.name)
        copy.attrs.update({k: v for k, v in document.attrs.items() if k != "version"})
        write_header(context, copy, file.root)
    for element in context.graph.of_kind(Kind.IMPORT):
        if element.subkind == "alias":
            _write_alias(context, element)


def _write_alias(context: Context, element: Element) -> None:
    """Add an ExternalReference; its path leads to the saved file if that is one of the unit."""
    file = context.find_file(element)
    document = context.graph.target(element, Edge.REFERENCES)
    path = str(element.attrs.get("path", ""))
    for target in context.files:
        if document is not None and target.document is document:
            file.aliases.setdefault(target.name, element.name)
            path = posixpath.relpath(target.path, posixpath.dirname(file.path))
            break
    node = Node("ExternalReference", {"Path": path, "Alias": element.name})
    write_header(context, element, context.register(element, file.root.add(node)))
