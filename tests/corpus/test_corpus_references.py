"""No reference of a real file is lost: each is an edge or attribute of the graph, or has a reason.

The notes on XMI counted 25,181 local references with 7 that dangle; this count has all references
of the metamodel, those too that say again what their opposite says (incoming, association, ...).
"""

from collections import Counter
from collections.abc import Iterator

import pytest
from references_of import Written, reference_features, written

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import AttrValue, Edge, Graph
from sysmlc.passes import pipeline
from sysmlc.sources import load

pytestmark = pytest.mark.corpus

SUFFIXES = {".uml", ".xmi", ".xml", ".mdxml", ".mdzip"}
WRITTEN = 43_889
DANGLING = {("BallotDefinition-noext.xml", "DiagramInfo", "base_Diagram"): 7}
"""MagicDraw's notes on diagrams, in a file that was saved without diagrams."""

_EXTENSION = ("Extension", "ExtensionEnd")
_EVENTS = ("SignalEvent", "CallEvent", "TimeEvent", "ChangeEvent")
_TOOL = {
    *("additionalElementImport", "additionalPackageImport", "auxiliaryResource"),
    *("CustomImageHolder", "deprecated", "derivedPropertiesSuite", "DiagramTable"),
    *("ElementReferenceInText", "HyperlinkOwner", "InvisibleStereotype", "MatrixFilter"),
    *("ReportTemplate", "TODO_Owner", "typeModifier"),
}

REASONS = {
    "a stereotype's extension of a metaclass is one edge": (
        1341,
        lambda w: w.source in _EXTENSION or w.target_type in _EXTENSION,
    ),
    "properties base_... are that edge too": (
        10,
        lambda w: w.feature == "redefinedProperty" and w.source != "ExtensionEnd",
    ),
    "how MagicDraw shows and stores the model": (563, lambda w: w.source in _TOOL),
    "a diagram of MagicDraw is no element": (161, lambda w: w.target_type == "Diagram"),
    "events are part of the triggers that name them": (
        33,
        lambda w: w.target_type in _EVENTS or w.source in _EVENTS,
    ),
    "the parameters of a template belong to the template itself": (
        76,
        lambda w: w.target_type == "RedefinableTemplateSignature",
    ),
    "clauses of a conditional node are in their order": (
        6,
        lambda w: w.feature in ("predecessorClause", "successorClause"),
    ),
    "the type of a value is that of what has it": (
        8,
        lambda w: w.source in ("OpaqueExpression", "InstanceValue"),
    ),
    "an edge has no stereotypes": (1, lambda w: w.target_type == "generalization"),
    "drawn edges and tags of XMI are notation": (11, lambda w: w.source in ("UMLEdge", "Tag")),
    "the roles of a collaboration are its properties": (
        1,
        lambda w: w.feature == "collaborationRole",
    ),
}


@pytest.fixture(scope="module")
def features(corpus):
    return reference_features(corpus / "xmi" / "metamodel" / "uml.ecore")


@pytest.fixture(scope="module")
def documents(corpus, features):
    """Graph and references of every file, by name."""
    paths = sorted(path for path in (corpus / "xmi").rglob("*") if path.suffix in SUFFIXES)
    return {path.name: (graph(path), find_references(path, features)) for path in paths}


def graph(path):
    made, sink = Graph(), Sink()
    FRONTEND.read(load(path, path.name), made, sink, Coverage())
    pipeline.build_pipeline(("resolve", "classify")).run(made, sink)
    assert [f.message for f in sink if f.rule.code in ("SM150", "SM151")] == []
    return made


def find_references(path, features):
    models = (source for source in load(path, path.name) if "snapshot" not in source.name)
    return [one for source in models for one in written(source.data, features)]


@pytest.mark.long
def test_seven_references_dangle_of_all_that_are_written(documents):
    dangling = Counter(
        (name, one.source, one.feature)
        for name, (_, found) in documents.items()
        for one in found
        if not one.target_type
    )
    assert dangling == DANGLING
    assert sum(len(found) for _, found in documents.values()) == WRITTEN


def test_every_reference_is_in_the_graph_or_has_a_reason(documents):
    lost = [one for graph, found in documents.values() for one in _lost(graph, found)]
    explained = Counter(_reason(one) for one in lost)
    assert [one for one in lost if not _reason(one)] == []
    assert explained == {why: count for why, (count, _) in REASONS.items()}


def _reason(one: Written) -> str:
    return next((why for why, (_, fits) in REASONS.items() if fits(one)), "")


def _lost(graph: Graph, found: list[Written]) -> Iterator[Written]:
    tied = _ties(graph)
    for one in found:
        holder = next((id for id in one.holders if id in graph), "")
        # Enterprise Architect writes Profile__Some_name for Some name of another profile.
        whole = one.source.rpartition("__")[2].replace("_", " ")
        is_applied = not tied.isdisjoint({(one.source, one.target), (whole, one.target)})
        if one.target_type and not is_applied and not _same(holder, one.target, tied):
            yield one


def _same(holder: str, target: str, tied: set[tuple[str, str]]) -> bool:
    return holder == target or (holder, target) in tied


def _ties(graph: Graph) -> set[tuple[str, str]]:
    """Pairs of ids that an edge or attribute ties, both ways; applications by name too."""
    ties = {pair for _, one, other in graph.edges() for pair in ((one, other), (other, one))}
    ties |= {(graph[one].name, other) for _, one, other in graph.edges(Edge.SUBJECT)}
    for element in graph:
        for id in _texts(tuple(element.attrs.values())):
            if id in graph:
                ties |= {(element.id, id), (id, element.id)}
    return ties


def _texts(value: AttrValue) -> Iterator[str]:
    if isinstance(value, tuple):
        for item in value:
            yield from _texts(item)
    elif isinstance(value, str):
        yield value
