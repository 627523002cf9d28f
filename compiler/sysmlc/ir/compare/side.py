"""One of the two models that are compared, with what the comparison asks of it often."""

from collections.abc import Iterator
from functools import cached_property

from sysmlc.ir.compare.content import (
    NOT_CONTENT,
    PASSED_OVER,
    WORDS,
    is_detail,
    is_header,
)
from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

_COMPARED = tuple(edge for edge in Edge if edge not in PASSED_OVER)


class Side:
    """A graph, read once: elements below their owners, details apart, and edges by their source.

    ``None`` is the owner of what nothing owns.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.things: dict[str | None, list[Element]] = {}
        self.details: dict[str, list[Element]] = {}
        self.hidden: set[str] = set()
        """Ids of details, headers, and everything below them."""
        for root in graph.roots():
            self._enter(root)
        self.out = self._edges()

    def _enter(self, root: Element) -> None:
        for element in self.graph.subtree(root):
            owner = self.graph.owner(element)
            if element.owner in self.hidden or is_header(element):
                self.hidden.add(element.id)
            elif is_detail(element, owner):
                self.hidden.add(element.id)
                self._tell(element, owner)
            else:
                self.things.setdefault(element.owner, []).append(element)

    def _tell(self, detail: Element, owner: Element | None) -> None:
        told = owner if owner is not None else self.graph.target(detail, Edge.SUBJECT)
        if told is not None:
            self.details.setdefault(told.id, []).append(detail)

    def _edges(self) -> dict[str, dict[Edge, list[Element]]]:
        found: dict[str, dict[Edge, list[Element]]] = {}
        applied = {one.id for one in self.graph.of_kind(Kind.APPLICATION)}
        for edge in _COMPARED:
            passed = applied if edge is Edge.SUBJECT else ()
            for _, source, target in self.graph.edges(edge):
                if source in passed:
                    continue
                found.setdefault(source, {}).setdefault(edge, []).append(self.graph[target])
        return found

    @cached_property
    def into(self) -> dict[str, list[tuple[Edge, Element]]]:
        """Edges by their target; those of details belong to the owner of the detail."""
        found: dict[str, list[tuple[Edge, Element]]] = {}
        for source, edges in self.out.items():
            origin = self.visible(self.graph[source])
            for edge, targets in edges.items():
                for target in targets:
                    if origin is not None and origin is not target:
                        found.setdefault(target.id, []).append((edge, origin))
        return found

    @cached_property
    def ties(self) -> dict[str, list[tuple[str, Element]]]:
        """What leads from an element and to it, and how: edges, and attributes that name others.

        Those of details belong to the owner of the detail, with the words that the detail says.
        """
        found: dict[str, list[tuple[str, Element]]] = {}
        for source, how, target in (*self._leads(), *self._mentions()):
            origin = self.visible(source)
            if origin is None:
                continue
            said = how if origin is source else f"{_words(source)} {how}"
            found.setdefault(origin.id, []).append((f"{said} >", target))
            if origin is not target:
                found.setdefault(target.id, []).append((f"< {said}", origin))
        return found

    def _leads(self) -> Iterator[tuple[Element, str, Element]]:
        for source, edges in self.out.items():
            for edge, targets in edges.items():
                yield from ((self.graph[source], str(edge), target) for target in targets)

    def _mentions(self) -> Iterator[tuple[Element, str, Element]]:
        """Attributes whose values are ids, those in tuples too, with their places there."""
        for element in self.graph:
            for name, raw in element.attrs.items():
                if name not in WORDS and name not in NOT_CONTENT:
                    for how, id in _texts(raw, name):
                        named = self.graph.get(id)
                        if named is not None and named is not element:
                            yield element, how, named

    def visible(self, element: Element) -> Element | None:
        """The element, or the nearest owner that is told for itself."""
        found: Element | None = element
        while found is not None and found.id in self.hidden:
            found = self.graph.owner(found)
        return found

    def children(self, owner: Element | None) -> list[Element]:
        """What the element owns and is told for itself, in order."""
        return self.things.get(None if owner is None else owner.id, [])

    def below(self, element: Element) -> Iterator[Element]:
        """The element and all that is below it and is told for itself."""
        stack = [element]
        while stack:
            top = stack.pop()
            yield top
            stack.extend(reversed(self.children(top)))


def _texts(raw: AttrValue, how: str) -> Iterator[tuple[str, str]]:
    """Texts of a value, each with its place."""
    if isinstance(raw, str):
        yield how, raw
    elif isinstance(raw, tuple):
        for place, part in enumerate(raw):
            yield from _texts(part, f"{how} {place}")


def _words(detail: Element) -> str:
    said = [str(detail.attrs[name]) for name in sorted(WORDS & detail.attrs.keys())]
    return " ".join([detail.kind, detail.name, *said])
