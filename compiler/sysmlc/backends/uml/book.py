"""What all writers of parts share: the graph, the nodes that are made, ids and losses."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from sysmlc.backends.uml.hrefs import is_outside, reference
from sysmlc.backends.uml.identity import part_id, xml_ids
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.rules import UNSAID_EDGE, Losses
from sysmlc.ir import Edge, Element, Graph

_EDGES = frozenset(edge.value for edge in Edge)


@dataclass(slots=True)
class Book:
    """The document as far as it is written."""

    graph: Graph
    losses: Losses
    nodes: dict[str, Node] = field(default_factory=dict)
    """By the id of the element in the graph."""
    ids: dict[str, str] = field(default_factory=dict)
    parts: Counter[tuple[str, str]] = field(default_factory=Counter)
    tops: list[Node] = field(default_factory=list)
    relations: list[tuple[str, str]] = field(default_factory=list)
    """SysML stereotypes of dependencies that only an edge tells of, with the dependency's id."""

    edges: tuple[Edge, ...] = ()
    """Kinds of edges that the graph has and that are written: ownership and features are not."""

    def __post_init__(self) -> None:
        self.ids = xml_ids(self.graph)
        used = (edge for edge in Edge if next(self.graph.edges(edge), None) is not None)
        self.edges = tuple(edge for edge in used if edge not in (Edge.OWNS, Edge.FEATURE))

    def node(self, element: Element) -> Node:
        """The node of an element that is written."""
        return self.nodes[element.id]

    def part(self, holder: Element, above: Node, tag: str, metaclass: str) -> Node:
        """A new node that is part of an element; its id comes from the element and the tag."""
        number = self.parts[holder.id, tag]
        self.parts[holder.id, tag] += 1
        id = part_id(holder.id, f"{tag}[{number}]")
        return above.add(Node(tag, {"xmi:type": f"uml:{metaclass}", "xmi:id": id}))

    def refer(
        self, holder: Element, node: Node, feature: str, targets: Sequence[Element], edge: str
    ) -> None:
        """Write references: an attribute when all are in the file, else a child for each."""
        known = [one for one in targets if is_outside(one) or one.id in self.nodes]
        for one in targets:
            if one not in known:
                self.lost(holder, edge, one)
        if not any(map(is_outside, known)):
            if known:
                node.attributes[feature] = " ".join(self.ids[one.id] for one in known)
            return
        for one in known:
            local = Node(feature, {"xmi:idref": self.ids[one.id]})
            node.add(reference(self.graph, feature, one) if is_outside(one) else local)

    def lost(self, holder: Element, edge: str, target: Element) -> None:
        """A relation that UML cannot say."""
        if self.losses.kept is not None and edge in _EDGES:
            self.losses.kept.edge(edge, holder, target)
        kinds = {"kind": str(holder.kind), "target": str(target.kind)}
        self.losses.note(UNSAID_EDGE, holder, edge=edge, **kinds)
