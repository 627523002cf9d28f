"""Regions of activities: mere groups, interruptible regions, expansion nodes, handlers."""

from collections.abc import Callable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.identity import derived_id

NODES = (
    Kind.ACTION,
    Kind.STRUCTURED,
    Kind.CONTROL,
    Kind.ACTIVITY_PARAMETER,
    Kind.OBJECT_NODE,
    Kind.DATA_STORE,
)


class Part(Struct, frozen=True):
    """A part of the structured node ``owner``; ``nodes`` are ids of its direct members."""

    id: str
    owner: Element
    word: str
    nodes: tuple[str, ...]


def parts_of(graph: Graph, node: Element) -> list[Part]:
    """Parts in the order in which they run first."""
    listed = [(word, tuple(query.ids_in(ids))) for word, ids in _listed(graph, node)]
    parts = [Part(derived_id(node.id, word), node, word, ids) for word, ids in listed if ids]
    return _completed(graph, node, parts) if parts else []


def _listed(graph: Graph, node: Element) -> list[tuple[str, object]]:
    if node.subkind == "loop":
        words = ("setup_part", "test", "body_part")
        return [(word.removesuffix("_part"), node.attrs.get(word)) for word in words]
    if node.subkind == "expansion":
        inside = tuple(one.id for one in graph.owned(node) if one.kind in NODES)
        return [("element", inside)]
    if node.subkind != "conditional":
        return []
    clauses = node.attrs.get("clauses") or ()
    return [
        (f"{word} {number}", ids)
        for number, clause in enumerate(clauses if isinstance(clauses, tuple) else (), 1)
        if isinstance(clause, tuple)
        for word, ids in zip(("test", "body"), clause, strict=False)
    ]


# -- nodes that no part lists ------------------------------------------------------------------


def _completed(graph: Graph, node: Element, parts: list[Part]) -> list[Part]:
    home = {id: part.id for part in parts for id in part.nodes}
    loose = [one for one in graph.owned(node) if one.kind in NODES and one.id not in home]
    for beside in (_sources, _targets):
        while any(_assign(graph, node, one, home, beside) for one in loose):
            loose = [one for one in loose if one.id not in home]
    found = {part.id: [id for id, place in home.items() if place == part.id] for part in parts}
    return [replace(part, nodes=tuple(found[part.id])) for part in parts]


def _assign(
    graph: Graph,
    owner: Element,
    node: Element,
    home: dict[str, str],
    beside: Callable[[Graph, Element], Iterator[Element]],
) -> bool:
    """Note the only part that the nodes beside it are in, if there is one."""
    if node.id in home:
        return False
    members = [_member(graph, owner, one) for one in beside(graph, node)]
    places = {home[one.id] for one in members if one is not None and one.id in home}
    if len(places) != 1:
        return False
    home[node.id] = places.pop()
    return True


def _member(graph: Graph, owner: Element, element: Element) -> Element | None:
    """The direct member of the owner that the element is, or is in."""
    found: Element | None = element
    while found is not None and found.owner != owner.id:
        found = graph.owner(found)
    return found


def _own(graph: Graph, node: Element) -> list[Element]:
    return [node, *(one for one in graph.owned(node) if one.kind is Kind.PIN)]


def _sources(graph: Graph, node: Element) -> Iterator[Element]:
    for end in _own(graph, node):
        for flow in query.incoming(graph, end):
            yield from graph.targets(flow, Edge.FLOW_SOURCE)


def _targets(graph: Graph, node: Element) -> Iterator[Element]:
    for end in _own(graph, node):
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
    """Handlers of a protected node, in order, as far as they have a body in the graph."""
    value = node.attrs.get("handlers")
    found = []
    for bodies, _, types in _triples(value):
        body = graph.get(next(query.ids_in(bodies), None))
        if body is not None:
            found.append(Handler(body, tuple(query.ids_in(types))))
    return found


def count_handlers(node: Element) -> int:
    """How many handlers the node was given, with a body or without."""
    value = node.attrs.get("handlers")
    return len(value) if isinstance(value, tuple) else int(value is not None)


def _triples(value: object) -> Iterator[tuple[object, object, object]]:
    for handler in value if isinstance(value, tuple) else (value,) if value else ():
        parts = handler if isinstance(handler, tuple) else (handler,)
        body, inputs, types, *_ = (*parts, (), (), ())
        yield body, inputs, types


def expansion_nodes(graph: Graph, within: list[Element]) -> dict[str, Element]:
    """Expansion nodes of an activity, by id, with the expansion region on whose border they are."""
    found: dict[str, Element] = {}
    for element in within:
        if element.subkind != "expansion":
            continue
        if element.kind is Kind.STRUCTURED:
            ends = (element.attrs.get("input_element"), element.attrs.get("output_element"))
            found |= dict.fromkeys(query.ids_in(ends), element)
        else:
            names = ("region_as_input", "region_as_output")
            regions = (
                graph.get(id) for name in names for id in query.ids_in(element.attrs.get(name))
            )
            region = next(filter(None, regions), None)
            found |= {} if region is None else {element.id: region}
    return found


# -- groups ------------------------------------------------------------------------------------


def groups_of(graph: Graph, within: list[Element]) -> dict[str, Element]:
    """Plain structured nodes that no flow starts or ends at, but whose border flows cross.

    They start with what is around them and nothing follows them, so that only their nodes count.
    """
    structured = [node for node in within if node.kind is Kind.STRUCTURED]
    if not structured:
        return {}
    guarded = (one for one in within if "handlers" in one.attrs)
    bodies = {handler.body.id for one in guarded for handler in handlers_of(graph, one)}
    found: dict[str, Element] = {}
    for node in structured:
        if node.subkind not in ("structured", ""):
            continue
        if node.id in bodies or "handlers" in node.attrs or _ends_itself(graph, node):
            continue
        own = [node, *(pin for pin in graph.owned(node) if pin.kind is Kind.PIN)]
        if any(query.incoming(graph, e) or query.outgoing(graph, e) for e in own):
            continue
        inside = {element.id for element in graph.subtree(node)}
        if any(_crosses(graph, e, inside) for e in within if e.kind in FLOWS):
            found[node.id] = node
    return found


def _ends_itself(graph: Graph, node: Element) -> bool:
    return any(e.kind is Kind.CONTROL and e.subkind == "final" for e in graph.owned(node))


def _crosses(graph: Graph, flow: Element, inside: set[str]) -> bool:
    ends = [graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    return len({end.id in inside for end in ends if end is not None}) == 2


def is_entered_again(graph: Graph, group: Element) -> bool:
    """Whether flows lead out of the group and back into it."""
    inside = {element.id for element in graph.subtree(group)}
    outside: dict[str, Element] = {}
    waiting = list(graph.subtree(group))
    while waiting:
        for after in _after(graph, waiting.pop()):
            if after.id not in inside and after.id not in outside:
                outside[after.id] = after
                waiting.append(after)
    return any(after.id in inside for one in outside.values() for after in _after(graph, one))


def _after(graph: Graph, element: Element) -> Iterator[Element]:
    """What the flows lead to from a node, whichever of its pins they reach and leave."""
    owner = graph.owner(element) if element.kind is Kind.PIN else element
    own = [] if owner is None else [e for e in graph.owned(owner) if e.kind is Kind.PIN]
    for end in (element, *own, *([owner] if owner is not None else ())):
        for flow in query.outgoing(graph, end):
            yield from graph.targets(flow, Edge.FLOW_TARGET)


def interruptible_regions(graph: Graph, within: list[Element], nodes: list[Element]) -> Regions:
    """Interruptible regions of an activity with their nodes."""
    return [
        (
            region,
            [
                n
                for n in nodes
                if region in graph.targets(n, Edge.IN_PARTITION) or graph.owner(n) is region
            ],
        )
        for region in within
        if region.subkind == "interruptible"
    ]


def is_entered_later(graph: Graph, members: list[Element]) -> bool:
    """Whether a token enters an interruptible region later than its activity starts, or again."""
    pins = (pin for one in members for pin in graph.owned(one) if pin.kind is Kind.PIN)
    around = dict.fromkeys(one.id for one in (*members, *pins))
    sources = (
        source
        for id in around
        for flow in graph.sources(graph[id], Edge.FLOW_TARGET)
        if flow.kind in FLOWS
        for source in graph.targets(flow, Edge.FLOW_SOURCE)
    )
    return any(one.id not in around and one.subkind != "initial" for one in sources)
