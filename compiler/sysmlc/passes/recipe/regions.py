"""Structured nodes whose content belongs to the graph of a recipe: for-each regions and blocks."""

from collections.abc import Iterator

from sysmlc.ir import Element, Graph, Kind, query

_STEPS = frozenset([Kind.ACTION, Kind.CONTROL, Kind.STRUCTURED])
_ENDS = ("final", "flow-final")


def is_for_each(node: Element) -> bool:
    """Whether a region takes the elements of a list one after the other (SysML v2 ``for``)."""
    is_region = node.kind is Kind.STRUCTURED and node.subkind == "expansion"
    return is_region and node.attrs.get("mode") == "iterative" and "collection" in node.attrs


def is_block(graph: Graph, node: Element) -> bool:
    """Whether a node only holds steps: a structured activity node that repeats nothing."""
    if node.kind is not Kind.STRUCTURED or node.subkind not in ("", "structured"):
        return False
    inner = steps_in(graph, node)
    forks = any(one.subkind == "fork" for one in inner)
    return bool(inner) and not forks and len(entries(graph, node)) == 1


def is_inlined(graph: Graph, node: Element) -> bool:
    """Whether the steps inside are steps of the graph around them."""
    return node.kind is Kind.STRUCTURED and (is_for_each(node) or is_block(graph, node))


def contents(graph: Graph, activity: Element) -> Iterator[Element]:
    """What an activity owns, and behind each inlined node what that owns."""
    for one in graph.owned(activity):
        yield one
        if is_inlined(graph, one):
            yield from contents(graph, one)


def steps_in(graph: Graph, region: Element) -> list[Element]:
    """The nodes that a structured node owns directly, those of data aside."""
    return [one for one in graph.owned(region) if one.kind in _STEPS]


def entries(graph: Graph, region: Element) -> list[Element]:
    """The nodes with which the content begins: an initial node, else what nothing precedes."""
    inner = steps_in(graph, region)
    after = {target for _, target in _order(graph, region)}
    starts = [one for one in inner if one.subkind == "initial"]
    return starts or [one for one in inner if one.id not in after]


def exits(graph: Graph, region: Element) -> list[Element]:
    """The nodes with which the content ends: final nodes, and what nothing follows."""
    before = {source for source, _ in _order(graph, region)}
    inner = steps_in(graph, region)
    return [one for one in inner if one.subkind in _ENDS or one.id not in before]


def _order(graph: Graph, region: Element) -> Iterator[tuple[str, str]]:
    """Which node of the content leads to which."""
    for flow in graph.owned(region):
        if flow.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
            source, target = query.flow_source(graph, flow), query.flow_target(graph, flow)
            if source is not None and target is not None:
                yield _step(graph, source).id, _step(graph, target).id


def _step(graph: Graph, end: Element) -> Element:
    above = graph.owner(end)
    return above if end.kind is Kind.PIN and above is not None else end
