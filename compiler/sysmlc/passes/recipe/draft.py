"""A graph of a recipe while it is made: regions, where it begins and ends, what it gives out."""

from dataclasses import dataclass, field

from msgspec.structs import replace

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.data import Data
from sysmlc.passes.recipe.regions import entries, exits, is_for_each, steps_in
from sysmlc.recipe.model import FlowEdge, Node

_ENDS = ("final", "flow-final")


@dataclass(slots=True)
class Draft:
    """Nodes so far: for each activity node the first and last of the nodes made from it."""

    nodes: list[Node] = field(default_factory=list)
    edges: list[FlowEdge] = field(default_factory=list)
    first: dict[str, str] = field(default_factory=dict)
    last: dict[str, str] = field(default_factory=dict)


# -- regions -----------------------------------------------------------------------------------


def open_region(context: Context, region: Element, draft: Draft) -> None:
    """The initial node of a region's content is the region's own, its final nodes its end."""
    for node in steps_in(context.graph, region):
        if node.kind is Kind.CONTROL and node.subkind in ("initial", *_ENDS):
            draft.nodes = [one for one in draft.nodes if one.id != draft.first[node.id]]
            draft.last[node.id] = draft.first[region.id]
            draft.first[node.id] = draft.last[region.id]


def close_region(context: Context, region: Element, draft: Draft) -> None:
    """Edges into the content of a region and out of it; a for-each node is its begin and end."""
    begin, end = draft.first[region.id], draft.last[region.id]
    starts = [one for one in entries(context.graph, region) if one.subkind != "initial"]
    draft.edges += (FlowEdge(begin, draft.first[one.id], element=region.id) for one in starts)
    ends = [one for one in exits(context.graph, region) if one.subkind not in _ENDS]
    draft.edges += (FlowEdge(draft.last[one.id], end, element=region.id) for one in ends)
    if is_for_each(region):
        draft.edges = [_with_role(context, region, edge, draft) for edge in draft.edges]


def _with_role(context: Context, region: Element, edge: FlowEdge, draft: Draft) -> FlowEdge:
    if edge.source != draft.first[region.id]:
        return edge
    owner = context.graph[edge.element].owner
    is_body = region.id in (edge.element, owner)
    return replace(edge, role="body" if is_body else "exit")


# -- begin and end -----------------------------------------------------------------------------


def add_ends(context: Context, activity: Element, draft: Draft) -> None:
    """Begin and end as UML does where the model draws neither (UML 2.5.1 clause 15.2.3.2)."""
    id = context.name(activity)
    own = [one for one in draft.nodes if context.graph[one.element].owner == activity.id]
    between = [one for one in draft.edges if context.graph[one.element].owner == activity.id]
    kinds = {node.kind for node in own}
    targets = {edge.target for edge in between}
    sources = {edge.source for edge in between}
    if "initial" not in kinds:
        draft.nodes.append(Node(f"{id}::initial", "initial"))
        first = [node.id for node in own if node.id not in targets]
        draft.edges.extend(FlowEdge(f"{id}::initial", one) for one in first)
    if not kinds & {"final", "flowFinal"}:
        draft.nodes.append(Node(f"{id}::final", "final"))
        last = [node for node in own if node.id not in sources]
        draft.edges.extend(_ending(node, f"{id}::final") for node in last)


def _ending(node: Node, final: str) -> FlowEdge:
    return FlowEdge(node.id, final, role="exit" if node.kind == "forEach" else "")


def add_results(context: Context, activity: Element, data: Data, draft: Draft) -> None:
    """Before the end, what outputs are said to be by expressions over the activity."""
    found = [one for one in query.parameters(context.graph, activity, *_OUT) if is_computed(one)]
    ends = [one for one in draft.nodes if one.kind == "final"]
    ends = ends or [one for one in draft.nodes if one.kind == "flowFinal"]
    for number, end in enumerate(ends if found else (), 1):
        mark = "" if number == 1 else f"#{number}"
        made = [_result(context, one, data, mark) for one in found]
        _insert(made, end, draft)


_OUT = ("out", "inout", "return")


def is_computed(parameter: Element) -> bool:
    """Whether an expression gives the value of an output, and not only its first value."""
    is_text = isinstance(parameter.attrs.get("default"), str)
    is_expression = is_text and "default_language" in parameter.attrs
    return is_expression and not parameter.attrs.get("initial")


def _result(context: Context, parameter: Element, data: Data, mark: str) -> Node:
    value = data.read(str(parameter.attrs["default"]))
    name = context.label(parameter)
    id = f"{context.name(parameter)}{mark}"
    return Node(id, "assign", variable=name, expression=value, element=parameter.id)


def _insert(made: list[Node], end: Node, draft: Draft) -> None:
    """Nodes before an end; several ways to it meet first."""
    ways = [edge for edge in draft.edges if edge.target == end.id]
    if len(ways) > 1:
        made = [Node(f"{made[0].id}::merge", "merge", element=made[0].element), *made]
    draft.edges = [replace(e, target=made[0].id) if e in ways else e for e in draft.edges]
    following = [*made[1:], end]
    for one, after in zip(made, following, strict=True):
        draft.edges.append(FlowEdge(one.id, after.id, element=one.element))
    draft.nodes += made
