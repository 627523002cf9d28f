"""The files that are written: one for each AutomationML file of the unit, else one for all."""

import posixpath

from sysmlc.backends.aml import header
from sysmlc.backends.aml.book import Book, File
from sysmlc.backends.aml.node import Node
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.file_names import assign_file_names

FOLDER = "aml"


def files(graph: Graph, unit: str) -> list[File]:
    """The files, that of the first Document first; ``unit`` names that of another graph."""
    documents = [one for one in graph.roots() if is_file(one)]
    sources = [one.id.removesuffix("#") for one in documents]
    paths = _paths(sources or [unit])
    if not documents:
        return [_file("", paths[unit], f"{unit}.aml", None)]
    return [
        _file(name, paths[name], document.name, document)
        for name, document in zip(sources, documents, strict=True)
    ]


def is_file(element: Element) -> bool:
    """Whether an element stands for a CAEX file."""
    return element.kind is Kind.DOCUMENT and element.subkind == "caex"


def _file(name: str, path: str, title: str, document: Element | None) -> File:
    root = Node("CAEXFile", {"SchemaVersion": "3.0", "FileName": title})
    return File(name, path, root, document)


def _paths(names: list[str]) -> dict[str, str]:
    """Where each file goes: below the folder as it stands in the unit, ending in ``.aml``."""
    stems = {name: posixpath.splitext(name.replace("!", "/"))[0].split("/") for name in names}
    parts = assign_file_names(sorted({part for stem in stems.values() for part in stem}))
    found: dict[str, str] = {}
    taken: set[str] = set()
    for name, stem in stems.items():
        path = "/".join(parts[part] for part in stem)
        while path.lower() in taken:
            path += "_"
        taken.add(path.lower())
        found[name] = f"{FOLDER}/{path}.aml"
    return found


def heads(book: Book) -> None:
    """Add what each file says of itself, and the files that it names by alias."""
    for file in book.files:
        if file.document is None:
            continue
        document = file.document
        book.put(document, file.root)
        if "description" in document.attrs:
            file.root.say("Description", str(document.attrs["description"]))
        if "superior_standard" in document.attrs:
            file.root.say("SuperiorStandardVersion", str(document.attrs["superior_standard"]))
        plain = Element(document.id, document.kind, document.name)
        plain.attrs.update({k: v for k, v in document.attrs.items() if k != "version"})
        header.write(book, plain, file.root)
    for one in book.graph.of_kind(Kind.IMPORT):
        if one.subkind == "alias":
            _alias(book, one)


def _alias(book: Book, element: Element) -> None:
    file = book.file_of(element)
    target = book.graph.target(element, Edge.REFERENCES)
    path = str(element.attrs.get("path", ""))
    found = next((f for f in book.files if target is not None and f.document is target), None)
    if found is not None:
        file.aliases.setdefault(found.name, element.name)
        path = posixpath.relpath(found.path, posixpath.dirname(file.path))
    node = Node("ExternalReference", {"Path": path, "Alias": element.name})
    header.write(book, element, book.put(element, file.root.add(node)))


def writers(book: Book) -> None:
    """Say of each file who wrote it."""
    for file in book.files:
        header.source_document(book, file.document, file.root)
