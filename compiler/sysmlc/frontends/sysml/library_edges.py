"""Edges from elements of the unit to elements of the standard library."""

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.libraries import SCALARS, ensure_stub, is_base, stub_kind_of
from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.language.tree import Node


class LibraryEdges:
    """Edges to elements of the library, which are pending until the pass ``resolve``."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._generalizations: list[tuple[Element, Element]] = []
        """Generalizations between elements of the unit since the first one to the library."""
        self._has_general = False
        self._scalar_types: dict[str, list[tuple[str, Kind]]] = {}
        """Names and kinds of scalar types, by the id of the typed element."""
        self._stubs: dict[str, str] = {}
        self._names: dict[int, tuple[str, Kind]] = {}
        """Names and kinds of the elements that edges lead to, by the identity of the node."""

    def connect(self, edge: Edge, source: Element, name: str, kind: Kind) -> None:
        """Connect an element to an element of the library, given its qualified name."""
        self._has_general = self._has_general or edge is Edge.SPECIALIZES
        if name not in self._stubs:
            self._stubs[name] = ensure_stub(self._graph, kind, name)
        self._graph.pending.append(Reference(edge, source.id, self._stubs[name], kind, name))
        if edge is Edge.TYPED_BY and name in SCALARS:
            self._scalar_types.setdefault(source.id, []).append((name, kind))

    def connect_node(self, edge: Edge, source: Element, target: Node) -> None:
        """Connect an element to a node of the library, unless all elements specialise it."""
        if id(target) not in self._names:
            self._names[id(target)] = (nodes.qualified_name_of(target), stub_kind_of(target))
        name, kind = self._names[id(target)]
        if not is_base(name):
            self.connect(edge, source, name, kind)

    def note_generalization(self, source: Element, general: Element) -> None:
        """Note a generalization inside the unit, for the order of all generalizations."""
        if self._has_general:
            self._generalizations.append((source, general))

    def copy_types(self, source: Element, target: Element) -> None:
        """Type *target* by the types of *source*, including those of the library."""
        for type_ in self._graph.targets(source, Edge.TYPED_BY):
            self._graph.connect(Edge.TYPED_BY, target, type_)
        for name, kind in self._scalar_types.get(source.id, ()):
            self.connect(Edge.TYPED_BY, target, name, kind)

    def has_scalar_type(self, element: Element) -> bool:
        """Whether a scalar type of the standard library types the element."""
        return element.id in self._scalar_types

    def finish(self) -> None:
        """Make generalizations pending that the text states after one to the library.

        So the pass ``resolve`` adds all of them in the order of the text.
        """
        for source, general in self._generalizations:
            self._graph.disconnect(Edge.SPECIALIZES, source, general)
            self._graph.pending.append(Reference(Edge.SPECIALIZES, source.id, general.id))
