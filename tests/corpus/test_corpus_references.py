"""Every reference in a real file is an edge or attribute of the graph, or its loss has a reason.

The count contains all references of the metamodel, also those that repeat their opposite
(incoming, association, ...).
"""

from collections import Counter
from collections.abc import Iterator

import pytest
from reading_corpus import list_models, load_files, lower
from xmi_references import Reference, iter_references, list_reference_features

from sysmlc.ir import AttrValue, Edge, Graph

pytestmark = pytest.mark.corpus

REFERENCE_COUNT = 43_889
DANGLING = {("BallotDefinition-noext.xml", "DiagramInfo", "base_Diagram"): 7}
"""MagicDraw's data about diagrams, in a file that was saved without diagrams."""

_EXTENSION = ("Extension", "ExtensionEnd")
_EVENTS = ("SignalEvent", "CallEvent", "TimeEvent", "ChangeEvent")
_TOOL_STEREOTYPES = {
    *("additionalElementImport", "additionalPackageImport", "auxiliaryResource"),
    *("CustomImageHolder", "deprecated", "derivedPropertiesSuite", "DiagramTable"),
    *("ElementReferenceInText", "HyperlinkOwner", "InvisibleStereotype", "MatrixFilter"),
    *("ReportTemplate", "TODO_Owner", "typeModifier"),
}

REASONS = {
    "the extension of a metaclass by a stereotype is a single edge": (
        1341,
        lambda w: w.source in _EXTENSION or w.target_type in _EXTENSION,
    ),
    "properties named base_... are part of that edge": (
        10,
        lambda w: w.feature == "redefinedProperty" and w.source != "ExtensionEnd",
    ),
    "stereotypes describe how MagicDraw shows and stores the model": (
        563,
        lambda w: w.source in _TOOL_STEREOTYPES,
    ),
    "a diagram of MagicDraw is not an element": (161, lambda w: w.target_type == "Diagram"),
    "events are part of the triggers that name them": (
        33,
        lambda w: w.target_type in _EVENTS or w.source in _EVENTS,
    ),
    "the parameters of a template belong to the template itself": (
        76,
        lambda w: w.target_type == "RedefinableTemplateSignature",
    ),
    "the order of clauses in a conditional node is an attribute": (
        6,
        lambda w: w.feature in ("predecessorClause", "successorClause"),
    ),
    "the type of a value is the type of its owner": (
        8,
        lambda w: w.source in ("OpaqueExpression", "InstanceValue"),
    ),
    "stereotypes of edges are not represented": (1, lambda w: w.target_type == "generalization"),
    "drawn edges and tags of XMI are notation": (11, lambda w: w.source in ("UMLEdge", "Tag")),
    "the roles of a collaboration are its properties": (
        1,
        lambda w: w.feature == "collaborationRole",
    ),
}


@pytest.fixture(scope="module")
def features(corpus):
    return list_reference_features(corpus / "xmi" / "metamodel" / "uml.ecore")


@pytest.fixture(scope="module")
def files(corpus, features):
    """Map the name of every file to its graph and references."""
    return {
        path.name: (read_graph(path), find_references(path, features))
        for path in list_models("xmi")
    }


def read_graph(path):
    graph, sink = lower(load_files(path), ("resolve", "classify"))
    assert [d.message for d in sink if d.rule.code in ("SM150", "SM151")] == []
    return graph


def find_references(path, features):
    models = (source for source in load_files(path) if "snapshot" not in source.name)
    return [reference for source in models for reference in iter_references(source.data, features)]


@pytest.mark.long
def test_seven_references_of_all_files_dangle(files):
    dangling = Counter(
        (name, reference.source, reference.feature)
        for name, (_, references) in files.items()
        for reference in references
        if not reference.target_type
    )
    assert dangling == DANGLING
    assert sum(len(references) for _, references in files.values()) == REFERENCE_COUNT


def test_every_reference_is_in_the_graph_or_has_a_reason(files):
    lost = [
        reference
        for graph, references in files.values()
        for reference in _iter_lost(graph, references)
    ]
    explained = Counter(_find_reason(reference) for reference in lost)
    assert [reference for reference in lost if not _find_reason(reference)] == []
    assert explained == {reason: count for reason, (count, _) in REASONS.items()}


def _find_reason(reference: Reference) -> str:
    return next((reason for reason, (_, fits) in REASONS.items() if fits(reference)), "")


def _iter_lost(graph: Graph, references: list[Reference]) -> Iterator[Reference]:
    connected = _connect_ids(graph)
    for reference in references:
        holder = next((id for id in reference.holders if id in graph), "")
        # Enterprise Architect writes Profile__Some_name for Some name of another profile.
        stereotype_name = reference.source.rpartition("__")[2].replace("_", " ")
        is_application = not connected.isdisjoint(
            {(reference.source, reference.target), (stereotype_name, reference.target)}
        )
        if (
            reference.target_type
            and not is_application
            and not _is_connected(holder, reference.target, connected)
        ):
            yield reference


def _is_connected(holder: str, target: str, connected: set[tuple[str, str]]) -> bool:
    return holder == target or (holder, target) in connected


def _connect_ids(graph: Graph) -> set[tuple[str, str]]:
    """Return the pairs of ids that an edge or attribute connects, and stereotypes by name."""
    connected = {
        pair for _, source, target in graph.edges() for pair in ((source, target), (target, source))
    }
    connected |= {(graph[source].name, target) for _, source, target in graph.edges(Edge.SUBJECT)}
    for element in graph:
        for id in _iter_texts(tuple(element.attrs.values())):
            if id in graph:
                connected |= {(element.id, id), (id, element.id)}
    return connected


def _iter_texts(value: AttrValue) -> Iterator[str]:
    if isinstance(value, tuple):
        for item in value:
            yield from _iter_texts(item)
    elif isinstance(value, str):
        yield value
