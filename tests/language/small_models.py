"""Small models in KerML or SysML v2, resolved with the core library that sysmlc bundles."""

from functools import cache
from textwrap import dedent

from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.language.checks import check
from sysmlc.language.library import Library, load_core
from sysmlc.language.names import Model, resolve
from sysmlc.language.names.implied_relations import implied_relations
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node


@cache
def load_library() -> Library:
    """Return the core library; all tests share it."""
    return load_core()


DECLARE_OR_IMPORT = "declare it, import the package that has it, or give its file as an input too"
"""Advice about a name without a similar one."""


def parse_texts(*texts: str, language: str = "sysml") -> list[Document]:
    """Parse each text as a document of its own; a syntax error fails the test."""
    sink = Sink()
    documents = [
        parse(dedent(text), f"{number}.{language}", language, sink)
        for number, text in enumerate(texts, 1)
    ]
    assert [diagnostic.message for diagnostic in sink] == []
    return documents


def resolve_texts(*texts: str, language: str = "sysml") -> Model:
    """Return the model of *texts*; an unknown name fails the test."""
    sink = Sink({"SM207": None})
    model = resolve(parse_texts(*texts, language=language), load_library(), sink)
    assert [diagnostic.message for diagnostic in sink] == []
    return model


def list_name_errors(*texts: str, language: str = "sysml") -> list[str]:
    """Return the diagnostics about names as ``line: message: help``."""
    sink = Sink({"SM207": None})
    documents = {document.path: document for document in parse_texts(*texts, language=language)}
    resolve(list(documents.values()), load_library(), sink)
    return [_format(diagnostic, documents) for diagnostic in sink]


def _format(diagnostic: Diagnostic, documents: dict[str, Document]) -> str:
    place = diagnostic.subject.place
    line = documents[place.file].text.encode().count(b"\n", 0, place.offset) + 1
    return f"{line}: {diagnostic.message}: {diagnostic.help}"


def check_text(text: str, language: str = "sysml") -> list[Diagnostic]:
    """Return the diagnostics about names and about constraints of a model."""
    sink = Sink({"SM207": None})
    check(resolve(parse_texts(text, language=language), load_library(), sink), sink)
    return list(sink)


def list_codes(text: str, language: str = "sysml") -> set[str]:
    """Return the codes of the rules that a model breaks."""
    return {diagnostic.rule.code for diagnostic in check_text(text, language)}


def list_messages(text: str, language: str = "sysml") -> list[str]:
    """Return the messages about names and about constraints of a model."""
    return [diagnostic.message for diagnostic in check_text(text, language)]


def find_element(model: Model, name: str) -> Node:
    """Return the element with the qualified *name*."""
    for document in model.documents:
        for node in document.root.walk():
            if node.kind != "Membership" and model.qualified_name(node) == name:
                return node
    raise AssertionError(f"there is no {name}")


def target_name(model: Model, name: str, kind: str = "") -> str:
    """Return the qualified name of the target of the first relation of the element *name*."""
    relations = find_element(model, name).relations
    relation = next(relation for relation in relations if not kind or relation.kind == kind)
    target = relation.reference.target
    return model.qualified_name(target) if target else "nowhere"


def list_implied_relations(model: Model, name: str) -> list[str]:
    """Return the relations of the element *name* that its text does not state, as lines."""
    relations = implied_relations(model, find_element(model, name))
    return [f"{relation.kind} {relation.reference}" for relation in relations]
