"""Who writes a feature besides an activity: other behaviours of the block that has it."""

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.expressions.declared import Feature
from sysmlc.passes.activity_written import assigned


def writer_elsewhere(graph: Graph, activity: Element, feature: Feature) -> Element | None:
    """Another behaviour of the block, or of what specialises it, that writes the feature.

    What stands inside ``activity`` is its own.
    """
    owner = graph.owner(feature.element)
    inside = {one.id for one in graph.subtree(activity)}
    name = feature.element.name
    for one in (*graph.of_kind(Kind.ACTION), *graph.of_kind(Kind.ACTIVITY)):
        if one.id in inside or not _may_write(graph, one, feature.element):
            continue
        context = _context(graph, one)
        family = () if context is None else (context, *query.generals(graph, context))
        if owner in family and any(each.name == name for each in assigned(graph, one)):
            return one
    return None


def called(graph: Graph, one: Element) -> str:
    """What is named, or what a nameless effect or action is in."""
    return next((each.name for each in (one, *graph.ancestors(one)) if each.name), one.subkind)


def _may_write(graph: Graph, one: Element, feature: Element) -> bool:
    body = one.attrs.get("body")
    return (isinstance(body, str) and feature.name in body) or (
        one.subkind == "write" and graph.target(one, Edge.CALLS) is feature
    )


def _context(graph: Graph, behaviour: Element) -> Element | None:
    for above in graph.ancestors(behaviour):
        if above.kind in query.CLASSIFIERS and above.kind not in query.BEHAVIORS:
            return above
    return None
