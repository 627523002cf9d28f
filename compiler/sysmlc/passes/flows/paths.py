"""Connector ends whose path leads through what is not there."""

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
    """Report each end of the connector whose path breaks, at its first step that is not there."""
    owner = graph.owner(connector)
    if owner is None or connector.attrs.get("external"):
        return
    for end in ends(graph, connector):
        for classifier, step in _breaks(graph, owner, end):
            sink.report(
                BROKEN_PATH,
                graph.subject(end),
                connector=connector.name or graph.qualified_name(connector),
                step=graph.qualified_name(step),
                classifier=graph.qualified_name(classifier),
            )


def _breaks(graph: Graph, owner: Element, end: Element) -> Iterator[tuple[Element, Element]]:
    """The first step that is no feature of what is before it; what is not known ends the search."""
    at: Element | None = _classifier(graph, owner)
    for step in (*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)):
        if step.kind is Kind.INSTANCE:
            at = graph.target(step, Edge.INSTANCE_OF)
            continue
        if at is None or step.attrs.get("external") or _is_partly_known(graph, at):
            return
        if not _has(graph, at, step):
            # Without a path it may be a connector of another block's diagram: Papyrus before 1.0.
            if graph.targets(end, Edge.PATH):
                yield at, step
            return
        at = type_of(graph, step)


def _classifier(graph: Graph, owner: Element) -> Element | None:
    """What has the features that paths start from: of an instance what classifies it."""
    if owner.kind is Kind.INSTANCE:
        return graph.target(owner, Edge.INSTANCE_OF)
    return owner


def _is_partly_known(graph: Graph, classifier: Element) -> bool:
    family = (classifier, *generals(graph, classifier))
    return any(one.attrs.get("external") or "unresolved" in one.attrs for one in family)


def _has(graph: Graph, classifier: Element, feature: Element) -> bool:
    """Whether it is an effective feature, or one that an effective feature redefines."""
    known = features(graph, classifier)
    return feature in known or any(feature in redefined_features(graph, one) for one in known)
