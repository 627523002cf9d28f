"""Exact difference of two graphs, for tests of front ends, back ends and round trips.

``ir.compare`` describes a change to the authors of a model; this module compares every detail.
Elements are matched by id or, when ids are ignored, by qualified name, kind and position among
elements with the same name and kind, which two dialects of one model have in common.
"""

from collections import Counter
from collections.abc import Collection, Iterator

from msgspec import Struct

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge

_Key = tuple[object, ...]


class Change(Struct, frozen=True, order=True):
    """A difference; *what* is added, removed, attribute, edge-added, edge-removed or edge-order."""

    element: str
    what: str
    detail: str = ""


def diff(old: Graph, new: Graph, ignore: Collection[str] = ()) -> list[Change]:
    """Return all differences, sorted by qualified name.

    *ignore* may contain ``id``, ``source``, ``trace`` (the attribute ``origin``) and names of
    attributes. With ``id``, references to elements are compared by qualified name too.
    """
    left, right = _Side(old, ignore), _Side(new, ignore)
    changes = [
        Change(left.names[key], "removed", kind) for key, kind in left.iter_missing_in(right)
    ]
    changes += [
        Change(right.names[key], "added", kind) for key, kind in right.iter_missing_in(left)
    ]
    for key, element in left.elements.items():
        if key in right.elements:
            changes.extend(_iter_changes(left, right, key, element))
    return sorted(changes)


class _Side:
    """One of the two graphs, with its elements by the keys that match them."""

    def __init__(self, graph: Graph, ignore: Collection[str]) -> None:
        self.graph = graph
        self.by_name = "id" in ignore
        self.with_source = "source" not in ignore
        self.ignored = frozenset(ignore) | ({"origin"} if "trace" in ignore else set())
        self.keys: dict[str, _Key] = {}
        self.elements: dict[_Key, Element] = {}
        self._equals: Counter[_Key] = Counter()
        for root in graph.roots():
            self._add_tree(root)
        self.names = {key: graph.qualified_name(e) for key, e in self.elements.items()}

    def _add_tree(self, root: Element) -> None:
        for element in self.graph.subtree(root):
            key = self._key(element)
            self.keys[element.id] = key
            self.elements[key] = element

    def _key(self, element: Element) -> _Key:
        if not self.by_name:
            return (element.id,)
        above = self.keys[element.owner] if element.owner is not None else ()
        equals = (*above, element.kind, element.name)
        self._equals[equals] += 1
        return (*above, (element.kind, element.name, self._equals[equals]))

    def iter_missing_in(self, other: "_Side") -> Iterator[tuple[_Key, str]]:
        for key, element in self.elements.items():
            if key not in other.elements:
                yield key, str(element.kind)

    def attributes(self, element: Element) -> dict[str, object]:
        attributes: dict[str, object] = {
            key: self._replace_ids(value)
            for key, value in element.attrs.items()
            if key not in self.ignored
        }
        if self.with_source:
            attributes["source"] = (element.source, element.ordinal)
        return attributes | {"name": element.name, "kind": str(element.kind)}

    def _replace_ids(self, value: object) -> object:
        if isinstance(value, tuple):
            return tuple(self._replace_ids(item) for item in value)
        if self.by_name and isinstance(value, str) and value in self.keys:
            return self.keys[value]
        return value

    def edges(self, element: Element) -> dict[Edge, list[_Key]]:
        return {
            edge: [self.keys[target.id] for target in self.graph.targets(element, edge)]
            for edge in Edge
            if edge is not Edge.OWNS
        }

    def name(self, key: _Key) -> str:
        return self.names.get(key, str(key[0]))


def _iter_changes(left: _Side, right: _Side, key: _Key, element: Element) -> Iterator[Change]:
    name, other = left.names[key], right.elements[key]
    before, after = left.attributes(element), right.attributes(other)
    for attribute in sorted(before.keys() | after.keys()):
        old, new = before.get(attribute), after.get(attribute)
        if old != new:
            yield Change(name, "attribute", f"{attribute}: {old!r} -> {new!r}")
    old_edges, new_edges = left.edges(element), right.edges(other)
    for edge in old_edges:
        yield from _iter_edge_changes(left, right, name, edge, old_edges[edge], new_edges[edge])


def _iter_edge_changes(
    left: _Side, right: _Side, name: str, edge: Edge, old: list[_Key], new: list[_Key]
) -> Iterator[Change]:
    for key in old:
        if key not in new:
            yield Change(name, "edge-removed", f"{edge} {left.name(key)}")
    for key in new:
        if key not in old:
            yield Change(name, "edge-added", f"{edge} {right.name(key)}")
    if sorted(map(repr, old)) == sorted(map(repr, new)) and old != new:
        yield Change(name, "edge-order", str(edge))
