"""Split what is too much for one picture: connected things stay together as far as they fit."""

from collections.abc import Collection, Iterator, Mapping, Sequence

from msgspec.structs import replace

from sysmlc.backends.plantuml.views import GraphView, Line, Node, Note

LIMIT = 40
"""Boxes in one diagram; above it pictures measured on real models are no longer readable."""


def chunks(
    items: Sequence[str],
    neighbours: Mapping[str, Collection[str]],
    limit: int = LIMIT,
    sizes: Mapping[str, int] | None = None,
) -> list[list[str]]:
    """Divide ``items`` so that each part with its neighbours has at most ``limit`` members.

    ``sizes`` says for how many members an item counts (1 when it is not there). An item that
    has more neighbours than fit is a part of its own. Inside a part the order of ``items`` is
    kept.
    """
    size = sizes or {}
    every = {*items, *(near for item in items for near in neighbours.get(item, ()))}
    if items and sum(size.get(member, 1) for member in every) <= limit:
        return [list(dict.fromkeys(items))]
    place = {item: index for index, item in enumerate(items)}
    parts: list[list[str]] = []
    shown: set[str] = set()
    for item in _connected(items, neighbours):
        wider = shown | {item} | set(neighbours.get(item, ()))
        if not parts or sum(size.get(member, 1) for member in wider) > limit:
            parts.append([])
            wider = {item} | set(neighbours.get(item, ()))
        parts[-1].append(item)
        shown = wider
    return [sorted(part, key=place.__getitem__) for part in parts]


def _connected(items: Sequence[str], neighbours: Mapping[str, Collection[str]]) -> Iterator[str]:
    """The items component by component, each breadth first from its first item."""
    waiting = dict.fromkeys(items)
    for start in items:
        queue = [start] if start in waiting else []
        waiting.pop(start, None)
        for item in queue:
            yield item
            near = [o for o in dict.fromkeys(neighbours.get(item, ())) if o in waiting]
            for other in near:
                del waiting[other]
            queue.extend(near)


def numbered(name: str, index: int, count: int) -> str:
    """Name of one part: the name itself when there is only one."""
    return name if count == 1 else f"{name}::{index + 1}-of-{count}"


def footer(index: int, count: int, whole: str) -> str:
    """The note on a part that says what it is a part of; nothing when it is the whole."""
    return "" if count == 1 else f"part {index + 1} of {count} of {whole}; grey: shown elsewhere"


def split_view(view: GraphView, limit: int = LIMIT) -> list[GraphView]:
    """The view itself when it is small, else parts of it.

    A node with more than ``limit`` nodes inside is closed in its own part and opened in parts
    that follow. A line that leaves a part ends at a grey stub. Notes stand in the first part.
    """
    if _total(view.nodes) <= limit:
        return [view]
    parts = [_part(view, group) for group in _groups(view.nodes, view.lines, limit)]
    return [replace(parts[0], notes=_bare(view.notes)), *parts[1:]]


def _total(nodes: Sequence[Node]) -> int:
    return sum(1 + _total(node.children) for node in nodes)


def _bare(notes: tuple[Note, ...]) -> tuple[Note, ...]:
    return tuple(replace(note, targets=()) for note in notes)


def _groups(nodes: Sequence[Node], lines: Sequence[Line], limit: int) -> Iterator[tuple[Node, ...]]:
    """Sets of nodes that are drawn together, large ones closed; then what the large ones hold."""
    large = [node for node in nodes if 1 + _total(node.children) > limit]
    shown = [_close_node(node) if node in large else node for node in nodes]
    by_alias = {node.alias: node for node in shown}
    near = _neighbours(shown, lines)
    sizes = {node.alias: 1 + _total(node.children) for node in shown}
    if len(shown) > 1 or not large:
        for part in chunks(list(by_alias), near, limit, sizes):
            yield tuple(by_alias[alias] for alias in part)
    for node in large:
        yield from _groups(node.children, lines, limit)


def _close_node(node: Node) -> Node:
    return replace(node, children=(), rows=(*node.rows, "⋯ opened in another part"))


def _neighbours(nodes: Sequence[Node], lines: Sequence[Line]) -> dict[str, list[str]]:
    home = {alias: node.alias for node in nodes for alias in _aliases(node)}
    near: dict[str, list[str]] = {node.alias: [] for node in nodes}
    for line in lines:
        for one, other in ((line.source, line.target), (line.target, line.source)):
            if one in home and home[one] != home.get(other, other):
                near[home[one]].append(home.get(other, other))
    return near


def _aliases(node: Node) -> Iterator[str]:
    yield node.alias
    for child in node.children:
        yield from _aliases(child)


def _part(view: GraphView, group: tuple[Node, ...]) -> GraphView:
    inside = {alias for node in group for alias in _aliases(node)}
    every = {node.alias: node for top in view.nodes for node in _all(top)}
    lines = [line for line in view.lines if line.source in inside or line.target in inside]
    lines = [line for line in lines if not _is_hidden(line, inside, every)]
    ends = dict.fromkeys(end for line in lines for end in (line.source, line.target))
    stubs = tuple(_stub(every[end]) for end in ends if end not in inside)
    return GraphView((*group, *stubs), tuple(lines))


def _is_hidden(line: Line, inside: set[str], every: dict[str, Node]) -> bool:
    """A line between a closed node and what it holds is shown where the node is open."""
    for one, other in ((line.source, line.target), (line.target, line.source)):
        if one in inside and other not in inside and other in set(_aliases(every[one])):
            return True
    return False


def _all(node: Node) -> Iterator[Node]:
    yield node
    for child in node.children:
        yield from _all(child)


def _stub(node: Node) -> Node:
    return Node(node.alias, node.label or node.alias, "elsewhere", shows=())
