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
    """Whether a node only groups steps: a structured activity node that repeats nothing."""
    if node.kind is not Kind.STRUCTURED or node.subkind not in ("", "structured"):
        return False
    steps = list_steps(graph, node)
    forks = any(step.subkind == "fork" for step in steps)
    return bool(steps) and not forks and len(find_entries(graph, node)) == 1


def is_inlined(graph: Graph, node: Element) -> bool:
    """Whether the steps inside are steps of the graph around them."""
    return node.kind is Kind.STRUCTURED and (is_for_each(node) or is_block(graph, node))


def list_contents(graph: Graph, activity: Element) -> Iterator[Element]:
    """Yield the elements that an activity owns; each inlined node is followed by its content."""
    for element in graph.owned(activity):
        yield element
        if is_inlined(graph, element):
            yield from list_contents(graph, element)


def list_steps(graph: Graph, region: Element) -> list[Element]:
    """Return the nodes that a structured node owns directly, without object nodes."""
    return [element for element in graph.owned(region) if element.kind in _STEPS]


def find_entries(graph: Graph, region: Element) -> list[Element]:
    """Return the first nodes of the content: initial nodes, else nodes without predecessor."""
    steps = list_steps(graph, region)
    targets = {target for _, target in _list_successions(graph, region)}
    starts = [step for step in steps if step.subkind == "initial"]
    return starts or [step for step in steps if step.id not in targets]


def find_exits(graph: Graph, region: Element) -> list[Element]:
    """Return the last nodes of the content: final nodes, and nodes without successor."""
    sources = {source for source, _ in _list_successions(graph, region)}
    steps = list_steps(graph, region)
    return [step for step in steps if step.subkind in _ENDS or step.id not in sources]


def _list_successions(graph: Graph, region: Element) -> Iterator[tuple[str, str]]:
    """Yield the pairs of consecutive nodes of the content."""
    for flow in graph.owned(region):
        if flow.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
            source, target = query.flow_source(graph, flow), query.flow_target(graph, flow)
            if source is not None and target is not None:
                yield _step_of_end(graph, source).id, _step_of_end(graph, target).id


def _step_of_end(graph: Graph, end: Element) -> Element:
    owner = graph.owner(end)
    return owner if end.kind is Kind.PIN and owner is not None else end
