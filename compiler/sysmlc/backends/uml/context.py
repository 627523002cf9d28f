"""The state that all writers share: the nodes made so far, and the ids of elements in the file."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from sysmlc.backends.uml.hrefs import is_external, make_reference
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.rules import UNSUPPORTED_EDGE, Losses
from sysmlc.ir import Edge, Element, Graph
from sysmlc.ir.element import derived_id

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_.-]*")
"""Ids that are names of XML without colon (NCName), as ``xmi:id`` must be."""
_ADDED_ID = re.compile(r"#(class|part|type|values|unit|quantity|document|required|[AB])(~\d+)?$")
"""Ends of the ids of elements that a front end adds to another; alone they are not unique."""
_EDGES = frozenset(edge.value for edge in Edge)


@dataclass(slots=True)
class Context:
    """The document while it is written."""

    graph: Graph
    losses: Losses
    nodes: dict[str, Node] = field(default_factory=dict)
    """By the id of the element in the graph."""
    ids: dict[str, str] = field(default_factory=dict)
    """The id in the file, by the id in the graph."""
    roots: list[Node] = field(default_factory=list)
    relation_stereotypes: list[tuple[str, str]] = field(default_factory=list)
    """Stereotype and id of each dependency that is written for an edge alone."""
    edges: tuple[Edge, ...] = ()
    """The kinds of edges in the graph, except those that containment expresses."""
    _part_counts: Counter[tuple[str, str]] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self.ids = assign_ids(self.graph)
        used = (edge for edge in Edge if next(self.graph.edges(edge), None) is not None)
        self.edges = tuple(edge for edge in used if edge not in (Edge.OWNS, Edge.FEATURE))

    def find_node(self, element: Element) -> Node:
        """Return the node of an element that is written."""
        return self.nodes[element.id]

    def is_available(self, element: Element) -> bool:
        """Whether the file can refer to an element: it is written, or external."""
        return is_external(element) or element.id in self.nodes

    def add_part(self, holder: Element, parent: Node, tag: str, metaclass: str) -> Node:
        """Add a node for a part of *holder*; its id is derived from the holder and the tag."""
        number = self._part_counts[holder.id, tag]
        self._part_counts[holder.id, tag] += 1
        id = make_part_id(holder.id, f"{tag}[{number}]")
        return parent.add(Node(tag, {"xmi:type": f"uml:{metaclass}", "xmi:id": id}))

    def write_references(
        self, holder: Element, node: Node, feature: str, targets: Sequence[Element], edge: str
    ) -> None:
        """Write the references of a feature; count those to elements that are not written.

        They are one XML attribute if all targets are in the file, else one child each.
        """
        available = [target for target in targets if self.is_available(target)]
        for target in targets:
            if target not in available:
                self.note_lost_edge(holder, edge, target)
        self.add_references(node, feature, available)

    def add_references(self, node: Node, feature: str, targets: Sequence[Element]) -> None:
        """Add references to available elements: an XML attribute, or a child for each."""
        if not any(map(is_external, targets)):
            if targets:
                node.attributes[feature] = " ".join(self.ids[target.id] for target in targets)
            return
        for target in targets:
            if is_external(target):
                node.add(make_reference(self.graph, feature, target))
            else:
                node.add(Node(feature, {"xmi:idref": self.ids[target.id]}))

    def note_lost_edge(self, holder: Element, edge: str, target: Element) -> None:
        """Count an edge that UML cannot express."""
        facts = self.losses.round_trip
        if facts is not None and edge in _EDGES:
            facts.store_edge(Edge(edge), holder, target)
        kinds = {"kind": str(holder.kind), "target": str(target.kind)}
        self.losses.record(UNSUPPORTED_EDGE, holder, edge=edge, **kinds)


# -- ids ---------------------------------------------------------------------------------------


def assign_ids(graph: Graph) -> dict[str, str]:
    """Return a unique ``xmi:id`` for each id in the graph: the same where XML allows it."""
    ids = {element.id: element.id for element in graph if _NAME.fullmatch(element.id)}
    used = set(ids)
    for element in graph:
        if element.id not in ids:
            ids[element.id] = _choose_id(element.id, used)
            used.add(ids[element.id])
    return ids


def _choose_id(id: str, used: set[str]) -> str:
    """Return the id without its file, or a variant of it that is valid XML and not used."""
    original = "" if _ADDED_ID.search(id) else id.rpartition("#")[2]
    for candidate in (original, f"_{id}"):
        if _NAME.fullmatch(candidate) and candidate not in used:
            return candidate
    return make_part_id(id, "id")


def make_part_id(origin: str, role: str) -> str:
    """Return the id of a part of an element, such as a generalization or a value."""
    return f"_{derived_id(origin, f'uml {role}')}"
