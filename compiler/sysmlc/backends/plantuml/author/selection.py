"""What an author chose for a diagram: a View with what it leads to (docs/ir.md)."""

from functools import cached_property

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind

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


class Choice(Struct, frozen=True, dict=True):
    """One diagram of an author."""

    graph: Graph
    view: Element

    @cached_property
    def shown(self) -> tuple[Element, ...]:
        """Everything that the diagram shows, in the author's order."""
        return tuple(self.graph.targets(self.view, Edge.REFERENCES))

    @cached_property
    def ids(self) -> frozenset[str]:
        """Ids of everything that the diagram shows."""
        return frozenset(element.id for element in self.shown)

    @cached_property
    def nesting(self) -> tuple[tuple[str, ...], ...]:
        """Ids of what is drawn inside something else, outermost first."""
        paths = self.view.attrs.get("nesting")
        found = paths if isinstance(paths, tuple) else ()
        return tuple(_texts(path) for path in found)

    @cached_property
    def listed(self) -> frozenset[str]:
        """Ids of what is only named in a compartment of something that is drawn."""
        return frozenset(_texts(self.view.attrs.get("listed", ())))

    @cached_property
    def relations(self) -> frozenset[tuple[str, ...]] | None:
        """Lines that are edges of the graph (edge, from, to); None when the tool lists none."""
        found = self.view.attrs.get("relations")
        return frozenset(map(_texts, found)) if isinstance(found, tuple) else None

    @property
    def is_summary(self) -> bool:
        """Whether its tool does not say which features it shows: then it shows them all."""
        return not any(element.kind in FEATURES for element in self.shown)

    @cached_property
    def about(self) -> Element | None:
        """What the frame stands for."""
        return self.graph.target(self.view, Edge.REPRESENTS) or self.graph.owner(self.view)

    def shows_edge(self, edge: Edge, source: str, target: str) -> bool:
        """Whether a line without an element of its own is drawn between two boxes."""
        return self.relations is None or (edge.value, source, target) in self.relations


def _texts(values: object) -> tuple[str, ...]:
    return tuple(map(str, values)) if isinstance(values, tuple) else (str(values),)
