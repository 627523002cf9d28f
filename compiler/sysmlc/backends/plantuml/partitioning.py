"""Partitioning of diagrams that are too large to read; every line remains in some part."""

from collections.abc import Collection, Hashable, Iterator, Mapping, Sequence
from typing import TypeVar

from msgspec.structs import replace

from sysmlc.backends.plantuml.views import Diagram, GraphView, Line, Node
from sysmlc.support.plantuml_text import escape_line

_K = TypeVar("_K", bound=Hashable)
MAX_BOXES = 40
"""The largest number of boxes in a diagram; pictures of real models with more were unreadable."""


def partition(
    items: Sequence[_K],
    neighbours: Mapping[_K, Collection[_K]],
    limit: int = MAX_BOXES,
    sizes: Mapping[_K, int] | None = None,
) -> list[list[_K]]:
    """Divide *items* into parts so that each part and its neighbours have at most *limit* members.

    *sizes* states how many members an item stands for (1 by default). An item with too many
    neighbours is a part by itself. The algorithm is greedy: it fills parts with connected items,
    breadth first. Each part has the order of *items*.
    """
    size = sizes or {}
    all_members = {*items, *(neighbour for item in items for neighbour in neighbours.get(item, ()))}
    if items and sum(size.get(member, 1) for member in all_members) <= limit:
        return [list(dict.fromkeys(items))]
    index_of = {item: index for index, item in enumerate(items)}
    parts: list[list[_K]] = []
    members: set[_K] = set()
    for item in _iter_connected(items, neighbours):
        # A neighbour in another part is drawn as a stub, which needs a place, too.
        grown = members | {item} | set(neighbours.get(item, ()))
        if not parts or sum(size.get(member, 1) for member in grown) > limit:
            parts.append([])
            grown = {item} | set(neighbours.get(item, ()))
        parts[-1].append(item)
        members = grown
    return [sorted(part, key=index_of.__getitem__) for part in parts]


def _iter_connected(items: Sequence[_K], neighbours: Mapping[_K, Collection[_K]]) -> Iterator[_K]:
    """Yield the items by connected component, each in breadth-first order from its first item."""
    unvisited = dict.fromkeys(items)
    for start in items:
        queue = [start] if start in unvisited else []
        unvisited.pop(start, None)
        for item in queue:
            yield item
            adjacent = [
                neighbour
                for neighbour in dict.fromkeys(neighbours.get(item, ()))
                if neighbour in unvisited
            ]
            for neighbour in adjacent:
                del unvisited[neighbour]
            queue.extend(adjacent)


def name_part(diagram: Diagram, index: int, count: int) -> Diagram:
    """Return the diagram with name and footer of part *index* of *count*, if it has several."""
    if count == 1:
        return diagram
    number = f"{index + 1} of {count}"
    footer = escape_line(f"part {number} of {diagram.name}; grey: shown elsewhere")
    return replace(diagram, name=f"{diagram.name}::{number.replace(' ', '-')}", footer=footer)


def split_view(view: GraphView, limit: int = MAX_BOXES) -> list[GraphView]:
    """Return the view itself if it has at most *limit* nodes, else its parts.

    A node with too many nodes inside is drawn without its content; later parts show the content. A
    line that leaves a part ends at a grey stub. All notes are in the first part.
    """
    if _count_nodes(view.nodes) <= limit:
        return [view]
    nodes_by_alias = {node.alias: node for top in view.nodes for node in _iter_nodes(top)}
    groups = _iter_groups(view.nodes, view.lines, limit)
    parts = [_make_part(view, group, nodes_by_alias) for group in groups]
    # The nodes that a note refers to may be in other parts.
    notes = tuple(replace(note, targets=()) for note in view.notes)
    return [replace(parts[0], notes=notes), *parts[1:]]


def _count_nodes(nodes: Sequence[Node]) -> int:
    return sum(1 + _count_nodes(node.children) for node in nodes)


def _iter_groups(
    nodes: Sequence[Node], lines: Sequence[Line], limit: int
) -> Iterator[tuple[Node, ...]]:
    """Yield groups of nodes, in which large nodes have no content, then groups of that content."""
    large = [node for node in nodes if 1 + _count_nodes(node.children) > limit]
    opened = "⋯ opened in another part"
    shown = [
        replace(node, children=(), rows=(*node.rows, opened)) if node in large else node
        for node in nodes
    ]
    by_alias = {node.alias: node for node in shown}
    adjacency = _find_neighbours(shown, lines)
    sizes = {node.alias: 1 + _count_nodes(node.children) for node in shown}
    if len(shown) > 1 or not large:
        for part in partition(list(by_alias), adjacency, limit, sizes):
            yield tuple(by_alias[alias] for alias in part)
    for node in large:
        yield from _iter_groups(node.children, lines, limit)


def _find_neighbours(nodes: Sequence[Node], lines: Sequence[Line]) -> dict[str, list[str]]:
    """Return the nodes that lines connect with each node or its content, all by alias."""
    home = {inner.alias: node.alias for node in nodes for inner in _iter_nodes(node)}
    adjacency: dict[str, list[str]] = {node.alias: [] for node in nodes}
    for line in lines:
        for end, opposite_end in ((line.source, line.target), (line.target, line.source)):
            neighbour = home.get(opposite_end, opposite_end)
            if end in home and home[end] != neighbour:
                adjacency[home[end]].append(neighbour)
    return adjacency


def _make_part(
    view: GraphView, group: tuple[Node, ...], nodes_by_alias: Mapping[str, Node]
) -> GraphView:
    inside = {inner.alias for node in group for inner in _iter_nodes(node)}
    lines = [
        line
        for line in view.lines
        if not inside.isdisjoint((line.source, line.target))
        and not _is_hidden(line, inside, nodes_by_alias)
    ]
    ends = dict.fromkeys(end for line in lines for end in (line.source, line.target))
    outside = [nodes_by_alias[end] for end in ends if end not in inside]
    stubs = (Node(node.alias, node.label or node.alias, "elsewhere", shows=()) for node in outside)
    return GraphView((*group, *stubs), tuple(lines))


def _is_hidden(line: Line, inside: set[str], nodes_by_alias: Mapping[str, Node]) -> bool:
    """Whether the line connects a node that has no content in this part with that content.

    The part with the content shows the line.
    """
    for end, opposite_end in ((line.source, line.target), (line.target, line.source)):
        if end in inside and opposite_end not in inside:
            content = {node.alias for node in _iter_nodes(nodes_by_alias[end])}
            if opposite_end in content:
                return True
    return False


def _iter_nodes(node: Node) -> Iterator[Node]:
    yield node
    for child in node.children:
        yield from _iter_nodes(child)
