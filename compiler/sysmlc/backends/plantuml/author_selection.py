"""The elements that an author selected for a diagram: a View and its references (docs/ir.md)."""

from functools import cached_property

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, as_texts, list_items

FEATURES = frozenset(
    [
        Kind.PROPERTY,
        Kind.PORT,
        Kind.FLOW_PROPERTY,
        Kind.OPERATION,
        Kind.RECEPTION,
        Kind.ENUMERATION_LITERAL,
        Kind.SLOT,
        Kind.PARAMETER,
        Kind.EXTENSION_POINT,
    ]
)
"""Kinds that stand in a compartment of their owner, or on its border."""
LINES = frozenset(
    [
        Kind.ASSOCIATION,
        Kind.DEPENDENCY,
        Kind.CONNECTOR,
        Kind.CONNECTOR_END,
        Kind.ITEM_FLOW,
        Kind.IMPORT,
        Kind.EXTEND,
        Kind.CONTROL_FLOW,
        Kind.OBJECT_FLOW,
        Kind.TRANSITION,
        Kind.MESSAGE,
        Kind.APPLICATION,
    ]
)
"""Kinds that are lines, or belong to one."""


class Selection(Struct, frozen=True, dict=True):
    """The elements and lines of one author diagram, as its View stores them."""

    graph: Graph
    view: Element

    @cached_property
    def shown(self) -> tuple[Element, ...]:
        """The elements that the diagram shows, in the author's order."""
        return tuple(self.graph.targets(self.view, Edge.REFERENCES))

    @cached_property
    def ids(self) -> frozenset[str]:
        """The ids of the elements that the diagram shows."""
        return frozenset(element.id for element in self.shown)

    @cached_property
    def nesting(self) -> tuple[tuple[str, ...], ...]:
        """The ids along each path of nested shapes, outermost first."""
        return tuple(map(as_texts, list_items(self.view.attrs.get("nesting"))))

    @cached_property
    def listed(self) -> frozenset[str]:
        """The ids of elements that are only listed in a compartment of another shape."""
        return frozenset(as_texts(self.view.attrs.get("listed", ())))

    @cached_property
    def relations(self) -> frozenset[tuple[str, ...]] | None:
        """The drawn lines that have no element, as (edge, source, target).

        The value is None if the tool does not list such lines.
        """
        entries = self.view.attrs.get("relations")
        return frozenset(map(as_texts, entries)) if isinstance(entries, tuple) else None

    @property
    def is_summary(self) -> bool:
        """Whether the diagram lists no feature at all, so that boxes show all their features.

        Some tools store the shown classifiers only.
        """
        return not any(element.kind in FEATURES for element in self.shown)

    @cached_property
    def about(self) -> Element | None:
        """The element that the frame represents."""
        return self.graph.target(self.view, Edge.REPRESENTS) or self.graph.owner(self.view)

    def shows_edge(self, edge: Edge, source: str, target: str) -> bool:
        """Whether the author drew the line of an edge, which has no element of its own.

        True if the tool does not list such lines.
        """
        return self.relations is None or (edge.value, source, target) in self.relations
