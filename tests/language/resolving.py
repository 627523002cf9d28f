"""Small models resolved with the library of our own, for tests."""

from functools import cache
from textwrap import dedent

from sysmlc.diagnostics import Sink
from sysmlc.language.library import Library, load_core
from sysmlc.language.names import Model, resolve
from sysmlc.language.names.implied_relations import implied_relations
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node


@cache
def library() -> Library:
    """The core, read once for all tests."""
    return load_core()


def documents(*texts: str, language: str = "sysml") -> list[Document]:
    """Each text as one document; a text that does not parse fails the test."""
    sink = Sink()
    made = [
        parse(dedent(text), f"{number}.{language}", language, sink)
        for number, text in enumerate(texts, 1)
    ]
    assert [found.message for found in sink] == []
    return made


def resolved(*texts: str, language: str = "sysml") -> Model:
    """The model of texts in which every name must be known."""
    sink = Sink({"SM207": None})
    model = resolve(documents(*texts, language=language), library(), sink)
    assert [found.message for found in sink] == []
    return model


def told(*texts: str, language: str = "sysml") -> list[str]:
    """What is reported about the names of texts: line, message, help."""
    sink = Sink({"SM207": None})
    read = {document.path: document for document in documents(*texts, language=language)}
    resolve(list(read.values()), library(), sink)
    return [_line(read, found) for found in sink]


def _line(read, found) -> str:
    place = found.subject.place
    line = read[place.file].text.encode().count(b"\n", 0, place.offset) + 1
    return f"{line}: {found.message}: {found.help}"


def leads(model: Model, path: str, kind: str = "", index: int = 0) -> str:
    """The qualified name of what the relation of an element leads to, by the element's name."""
    node = element(model, path)
    relations = [r for r in node.relations if not kind or r.kind == kind]
    target = relations[index].reference.target
    return model.qualified_name(target) if target else "nowhere"


def element(model: Model, path: str) -> Node:
    """The element with that qualified name among the documents."""
    for document in model.documents:
        for node in document.root.walk():
            if node.kind != "Membership" and model.qualified_name(node) == path:
                return node
    raise AssertionError(f"there is no {path}")


def implied(model: Model, path: str) -> list[str]:
    """The relations of an element that its text does not say, as lines."""
    return [f"{r.kind} {r.reference}" for r in implied_relations(model, element(model, path))]
