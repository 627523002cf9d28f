"""One of the two models that are compared, indexed for the questions that the comparison asks."""

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
    """An index of one graph: visible elements by owner, details by owner, edges by source.

    A detail (comment, stereotype application, slot ...) is compared as a property of its owner.
    Details, headers of files and everything below them are *hidden*; all other elements are
    *visible*. The key None stands for the owner of roots.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.members: dict[str | None, list[Element]] = {}
        self.details: dict[str, list[Element]] = {}
        self.hidden: set[str] = set()
        for root in graph.roots():
            self._index(root)
        self.edges = self._index_edges()

    def _index(self, root: Element) -> None:
        for element in self.graph.subtree(root):
            owner = self.graph.owner(element)
            if element.owner in self.hidden or is_header(element):
                self.hidden.add(element.id)
            elif is_detail(element, owner):
                self.hidden.add(element.id)
                self._add_detail(element, owner)
            else:
                self.members.setdefault(element.owner, []).append(element)

    def _add_detail(self, detail: Element, owner: Element | None) -> None:
        subject = owner if owner is not None else self.graph.target(detail, Edge.SUBJECT)
        if subject is not None:
            self.details.setdefault(subject.id, []).append(detail)

    def _index_edges(self) -> dict[str, dict[Edge, list[Element]]]:
        index: dict[str, dict[Edge, list[Element]]] = {}
        applications = {element.id for element in self.graph.of_kind(Kind.APPLICATION)}
        for edge in _COMPARED:
            # The subject of a stereotype application is the element that it is a detail of.
            skipped = applications if edge is Edge.SUBJECT else ()
            for _, source, target in self.graph.edges(edge):
                if source not in skipped:
                    targets = index.setdefault(source, {}).setdefault(edge, [])
                    targets.append(self.graph[target])
        return index

    @cached_property
    def incoming(self) -> dict[str, list[tuple[Edge, Element]]]:
        """Edges by target, with their sources; the owner of a detail replaces the detail."""
        index: dict[str, list[tuple[Edge, Element]]] = {}
        for source_id, edges in self.edges.items():
            source = self.find_visible(self.graph[source_id])
            for edge, targets in edges.items():
                for target in targets:
                    if source is not None and source is not target:
                        index.setdefault(target.id, []).append((edge, source))
        return index

    @cached_property
    def links(self) -> dict[str, list[tuple[str, Element]]]:
        """Links from and to each element, labelled: edges, and attributes whose values are ids.

        The links of a detail belong to its owner; their labels begin with the detail's own words.
        """
        index: dict[str, list[tuple[str, Element]]] = {}
        for element, label, target in (*self._edge_links(), *self._attribute_links()):
            source = self.find_visible(element)
            if source is None:
                continue
            full_label = label if source is element else f"{_describe(element)} {label}"
            index.setdefault(source.id, []).append((f"{full_label} >", target))
            if source is not target:
                index.setdefault(target.id, []).append((f"< {full_label}", source))
        return index

    def _edge_links(self) -> Iterator[tuple[Element, str, Element]]:
        for source, edges in self.edges.items():
            for edge, targets in edges.items():
                yield from ((self.graph[source], str(edge), target) for target in targets)

    def _attribute_links(self) -> Iterator[tuple[Element, str, Element]]:
        for element in self.graph:
            for name, value in element.attrs.items():
                if name not in WORDS and name not in NOT_CONTENT:
                    for label, id in _iter_texts(value, name):
                        target = self.graph.get(id)
                        if target is not None and target is not element:
                            yield element, label, target

    def find_visible(self, element: Element) -> Element | None:
        """Return *element*, or its nearest owner that is visible, or None."""
        candidate: Element | None = element
        while candidate is not None and candidate.id in self.hidden:
            candidate = self.graph.owner(candidate)
        return candidate

    def children(self, owner: Element | None) -> list[Element]:
        """Return the visible elements that *owner* owns, in order."""
        return self.members.get(None if owner is None else owner.id, [])

    def visible_subtree(self, element: Element) -> Iterator[Element]:
        """Iterate over *element* and the visible elements below it, owners first."""
        stack = [element]
        while stack:
            owner = stack.pop()
            yield owner
            stack.extend(reversed(self.children(owner)))


def _iter_texts(value: AttrValue, label: str) -> Iterator[tuple[str, str]]:
    """Iterate over the texts of an attribute value, each with its position in nested tuples."""
    if isinstance(value, str):
        yield label, value
    elif isinstance(value, tuple):
        for position, item in enumerate(value):
            yield from _iter_texts(item, f"{label} {position}")


def _describe(detail: Element) -> str:
    words = [str(detail.attrs[name]) for name in sorted(WORDS & detail.attrs.keys())]
    return " ".join([detail.kind, detail.name, *words])
