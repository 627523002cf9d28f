"""Check of connector ends: their paths must lead through existing features."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import ends, features, generals, redefined_features, type_of

BROKEN_PATH = rule(
    "SM318",
    "broken-connector-path",
    Severity.WARNING,
    "an end of connector '{connector}' leads to '{step}', which '{classifier}' does not have",
    help="attach the connector again in the modelling tool",
)


def check_paths(graph: Graph, sink: Sink, connector: Element) -> None:
    """Report each end of the connector with a broken path, at the first missing feature."""
    owner = graph.owner(connector)
    if owner is None or connector.attrs.get("external"):
        return
    for end in ends(graph, connector):
        for classifier, step in _find_breaks(graph, owner, end):
            sink.report(
                BROKEN_PATH,
                graph.subject(end),
                connector=connector.name or graph.qualified_name(connector),
                step=graph.qualified_name(step),
                classifier=graph.qualified_name(classifier),
            )


def begins_elsewhere(graph: Graph, connector: Element, end: Element) -> bool:
    """Whether an end has no path and leads to a feature that the connector's owner does not have.

    Nothing then tells on which side of the feature's block the connector is.
    """
    owner = graph.owner(connector)
    classifier = None if owner is None else _start_of_paths(graph, owner)
    if classifier is None or graph.targets(end, Edge.PATH) or _is_partly_known(graph, classifier):
        return False
    return not all(_has_feature(graph, classifier, role) for role in graph.targets(end, Edge.ROLE))


def _find_breaks(graph: Graph, owner: Element, end: Element) -> Iterator[tuple[Element, Element]]:
    """Yield the first step of a path that is no feature of its classifier, if there is one.

    The result is a pair of the classifier and the step. A step of unknown type ends the search.
    """
    classifier: Element | None = _start_of_paths(graph, owner)
    for step in (*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)):
        if step.kind is Kind.INSTANCE:
            classifier = graph.target(step, Edge.INSTANCE_OF)
            continue
        if classifier is None or step.attrs.get("external") or _is_partly_known(graph, classifier):
            return
        if not _has_feature(graph, classifier, step):
            # Without a path it may be a connector of another block's diagram: Papyrus before 1.0.
            if graph.targets(end, Edge.PATH):
                yield classifier, step
            return
        classifier = type_of(graph, step)


def _start_of_paths(graph: Graph, owner: Element) -> Element | None:
    """Return the classifier whose features start the paths: the owner, or that of an instance."""
    if owner.kind is Kind.INSTANCE:
        return graph.target(owner, Edge.INSTANCE_OF)
    return owner


def _is_partly_known(graph: Graph, classifier: Element) -> bool:
    family = (classifier, *generals(graph, classifier))
    return any(
        ancestor.attrs.get("external") or "unresolved" in ancestor.attrs for ancestor in family
    )


def _has_feature(graph: Graph, classifier: Element, feature: Element) -> bool:
    """Whether an effective feature of the classifier is *feature* or redefines it."""
    effective = features(graph, classifier)
    return feature in effective or any(
        feature in redefined_features(graph, other) for other in effective
    )
