"""Regions of activities: loops, conditionals, groups, interruptible and expansion regions.

UML lists only the executable nodes of a part. A fork, decision or buffer between them is assigned
to the part from which its tokens come. If they come from outside all parts, it is assigned to the
part to which they go.
"""

from collections.abc import Callable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, as_items, list_items, query
from sysmlc.ir.element import derived_id

NODES = (
    Kind.ACTION,
    Kind.STRUCTURED,
    Kind.CONTROL,
    Kind.ACTIVITY_PARAMETER,
    Kind.OBJECT_NODE,
    Kind.DATA_STORE,
)


class Part(Struct, frozen=True):
    """A test, body or set-up of the structured node ``owner``, or the body of an expansion region.

    ``word`` names the part inside its owner. ``nodes`` are the ids of its direct members.
    """

    id: str
    owner: Element
    word: str
    nodes: tuple[str, ...]


def parts_of(graph: Graph, node: Element) -> list[Part]:
    """Return the parts of a structured node, in the order in which they first run."""
    members = [(word, tuple(query.ids_in(ids))) for word, ids in _list_members(graph, node)]
    parts = [Part(derived_id(node.id, word), node, word, ids) for word, ids in members if ids]
    return _assign_unlisted(graph, node, parts) if parts else []


def _list_members(graph: Graph, node: Element) -> list[tuple[str, object]]:
    if node.subkind == "loop":
        words = ("setup_part", "test", "body_part")
        return [(word.removesuffix("_part"), node.attrs.get(word)) for word in words]
    if node.subkind == "expansion":
        members = tuple(inner.id for inner in graph.owned(node) if inner.kind in NODES)
        return [("element", members)]
    if node.subkind != "conditional":
        return []
    clauses = list_items(node.attrs.get("clauses"))
    return [
        (f"{word} {number}", ids)
        for number, clause in enumerate(clauses, 1)
        if isinstance(clause, tuple)
        for word, ids in zip(("test", "body"), clause, strict=False)
    ]


# -- nodes that no part lists ------------------------------------------------------------------


def _assign_unlisted(graph: Graph, node: Element, parts: list[Part]) -> list[Part]:
    home = {id: part.id for part in parts for id in part.nodes}
    unlisted = [
        member for member in graph.owned(node) if member.kind in NODES and member.id not in home
    ]
    # Sources first: a buffer belongs to the part that fills it.
    for neighbours in (_sources, _targets):
        # any() stops at the first node that was assigned; the others are then tried again, because
        # they may be its neighbours.
        while any(_assign_to_part(graph, node, member, home, neighbours) for member in unlisted):
            unlisted = [member for member in unlisted if member.id not in home]
    members = {part.id: [id for id, place in home.items() if place == part.id] for part in parts}
    return [replace(part, nodes=tuple(members[part.id])) for part in parts]


def _assign_to_part(
    graph: Graph,
    owner: Element,
    node: Element,
    home: dict[str, str],
    neighbours: Callable[[Graph, Element], Iterator[Element]],
) -> bool:
    """Assign the node to the part of its neighbours if all of them are in the same part."""
    if node.id in home:
        return False
    members = [_find_member(graph, owner, neighbour) for neighbour in neighbours(graph, node)]
    parts = {
        home[neighbour.id]
        for neighbour in members
        if neighbour is not None and neighbour.id in home
    }
    if len(parts) != 1:
        return False
    home[node.id] = parts.pop()
    return True


def _find_member(graph: Graph, owner: Element, element: Element) -> Element | None:
    """Return the direct member of *owner* that is the element or contains it."""
    member: Element | None = element
    while member is not None and member.owner != owner.id:
        member = graph.owner(member)
    return member


def _with_pins(graph: Graph, node: Element) -> list[Element]:
    return [node, *(pin for pin in graph.owned(node) if pin.kind is Kind.PIN)]


def _sources(graph: Graph, node: Element) -> Iterator[Element]:
    for end in _with_pins(graph, node):
        for flow in query.incoming(graph, end):
            yield from graph.targets(flow, Edge.FLOW_SOURCE)


def _targets(graph: Graph, node: Element) -> Iterator[Element]:
    for end in _with_pins(graph, node):
        for flow in query.outgoing(graph, end):
            yield from graph.targets(flow, Edge.FLOW_TARGET)


FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
Regions = list[tuple[Element, list[Element]]]
"""Interruptible regions, each with its nodes."""


class Handler(Struct, frozen=True):
    """An exception handler: its body, and the ids of the types that it catches."""

    body: Element
    types: tuple[str, ...]


def handlers_of(graph: Graph, node: Element) -> list[Handler]:
    """Return the handlers of a protected node whose body is in the graph, in order."""
    value = node.attrs.get("handlers")
    handlers = []
    for bodies, _, types in _list_handler_parts(value):
        body = graph.get(next(query.ids_in(bodies), None))
        if body is not None:
            handlers.append(Handler(body, tuple(query.ids_in(types))))
    return handlers


def count_handlers(node: Element) -> int:
    """Count the handlers of a node, including those without a body."""
    value = node.attrs.get("handlers")
    return len(value) if isinstance(value, tuple) else int(value is not None)


def _list_handler_parts(value: AttrValue) -> Iterator[tuple[object, object, object]]:
    if not value:
        return
    for handler in as_items(value):
        body, inputs, types, *_ = (*as_items(handler), (), (), ())
        yield body, inputs, types


def find_expansion_nodes(graph: Graph, elements: list[Element]) -> dict[str, Element]:
    """Map the id of each expansion node to its expansion region."""
    regions_by_node: dict[str, Element] = {}
    for element in elements:
        if element.subkind != "expansion":
            continue
        if element.kind is Kind.STRUCTURED:
            ends = (element.attrs.get("input_element"), element.attrs.get("output_element"))
            regions_by_node |= dict.fromkeys(query.ids_in(ends), element)
        else:
            names = ("region_as_input", "region_as_output")
            regions = (
                graph.get(id) for name in names for id in query.ids_in(element.attrs.get(name))
            )
            region = next(filter(None, regions), None)
            regions_by_node |= {} if region is None else {element.id: region}
    return regions_by_node


# -- groups ------------------------------------------------------------------------------------


def find_groups(graph: Graph, elements: list[Element]) -> dict[str, Element]:
    """Return the structured nodes, by id, that only group nodes.

    No flow starts or ends at such a node, but flows lead from its content to other nodes or back.
    It starts with the region around it and nothing follows it, so that its nodes can be treated as
    nodes of that region.
    """
    structured = [node for node in elements if node.kind is Kind.STRUCTURED]
    if not structured:
        return {}
    guarded = (element for element in elements if "handlers" in element.attrs)
    bodies = {handler.body.id for element in guarded for handler in handlers_of(graph, element)}
    groups: dict[str, Element] = {}
    for node in structured:
        if node.subkind not in ("structured", ""):
            continue
        if node.id in bodies or "handlers" in node.attrs or _has_final_node(graph, node):
            continue
        ends = [node, *(pin for pin in graph.owned(node) if pin.kind is Kind.PIN)]
        if any(query.incoming(graph, e) or query.outgoing(graph, e) for e in ends):
            continue
        inside = {element.id for element in graph.subtree(node)}
        if any(_crosses(graph, e, inside) for e in elements if e.kind in FLOWS):
            groups[node.id] = node
    return groups


def _has_final_node(graph: Graph, node: Element) -> bool:
    return any(e.kind is Kind.CONTROL and e.subkind == "final" for e in graph.owned(node))


def _crosses(graph: Graph, flow: Element, inside: set[str]) -> bool:
    ends = [graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    return len({end.id in inside for end in ends if end is not None}) == 2


def is_entered_again(graph: Graph, group: Element) -> bool:
    """Whether flows lead out of the group and back into it."""
    inside = {element.id for element in graph.subtree(group)}
    outside: dict[str, Element] = {}
    worklist = list(graph.subtree(group))
    while worklist:
        for successor in _find_successors(graph, worklist.pop()):
            if successor.id not in inside and successor.id not in outside:
                outside[successor.id] = successor
                worklist.append(successor)
    return any(
        successor.id in inside
        for element in outside.values()
        for successor in _find_successors(graph, element)
    )


def _find_successors(graph: Graph, element: Element) -> Iterator[Element]:
    """Yield the targets of the flows that leave a node or one of its pins."""
    owner = graph.owner(element) if element.kind is Kind.PIN else element
    pins = [] if owner is None else [e for e in graph.owned(owner) if e.kind is Kind.PIN]
    for end in (element, *pins, *([owner] if owner is not None else ())):
        for flow in query.outgoing(graph, end):
            yield from graph.targets(flow, Edge.FLOW_TARGET)


def find_interruptible_regions(
    graph: Graph, elements: list[Element], nodes: list[Element]
) -> Regions:
    """Return the interruptible regions of an activity with their nodes."""
    return [
        (
            region,
            [
                node
                for node in nodes
                if region in graph.targets(node, Edge.IN_PARTITION) or graph.owner(node) is region
            ],
        )
        for region in elements
        if region.subkind == "interruptible"
    ]


def is_entered_later(graph: Graph, members: list[Element]) -> bool:
    """Whether a flow leads into an interruptible region from a node that is no initial node."""
    pins = (pin for member in members for pin in graph.owned(member) if pin.kind is Kind.PIN)
    inside = dict.fromkeys(member.id for member in (*members, *pins))
    sources = (
        source
        for id in inside
        for flow in graph.sources(graph[id], Edge.FLOW_TARGET)
        if flow.kind in FLOWS
        for source in graph.targets(flow, Edge.FLOW_SOURCE)
    )
    return any(member.id not in inside and member.subkind != "initial" for member in sources)
