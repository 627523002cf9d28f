"""Mirrors: elements that stand for another one, their master, at a second place.

A mirror names an ID where other elements name a class. The master may be a mirror itself: a chain
of mirrors stands for its last master.
"""

from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import (
    Findings,
    read_class_reference,
    record_unresolved_path,
    report_inexact_id,
)
from sysmlc.frontends.caex.identifiers import Identifiers, LocatedNode
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Graph

_MIRROR_REFERENCES = {
    "InternalElement": "RefBaseSystemUnitPath",
    "ExternalInterface": "RefBaseClassPath",
    "Attribute": "RefAttributeType",
}
MEMBER_FAMILIES = {"Attribute": Family.ATTRIBUTE, "ExternalInterface": Family.INTERFACE}
"""Families of the classes that members of internal elements name."""

_GUID_LENGTH = 36


class Mirrors:
    """The mirrors of a unit and their masters."""

    def __init__(self, graph: Graph, ids: Identifiers, findings: Findings) -> None:
        self._graph = graph
        self._ids = ids
        self._findings = findings
        self.nodes: list[LocatedNode] = []
        """Mirrors of interfaces and attributes, to be connected when all elements exist."""
        self._masters: dict[tuple[Document, Node], Node | str] = {}
        """Final master of each mirror as a file sees it, or the reference that leads nowhere."""
        self._circular: set[Node] = set()
        """Mirrors whose chain of masters leads into a cycle."""
        self._id_references: dict[str, bool] = {}
        """Whether a text in the place of a class path is an ID."""

    def is_mirror(self, node: Node) -> bool:
        """Whether the node names another element and no class."""
        id = _read_master_id(node)
        if self.is_id_reference(id):
            return True
        if node.tag != "Attribute" or "." not in id:
            return False
        # AML.Engine calls `ID.name` a mirror, too, but only finds the master of `ID/name`.
        return self.is_id_reference(id.partition(".")[0])

    def is_id_reference(self, text: str) -> bool:
        """Whether a text in the place of a class path is an ID."""
        is_id = self._id_references.get(text)
        if is_id is None:
            is_id = bool(text) and (self._ids.find(text) is not None or _looks_like_guid(text))
            self._id_references[text] = is_id
        return is_id

    def connect(self) -> None:
        """Connect mirrors of interfaces and attributes to their masters; type them alike."""
        for document, node in self.nodes:
            master = self.connect_to_master(document, node, self._graph[node.element_id])
            if master is not None:
                type = self._graph.target(self._graph[master.element_id], Edge.TYPED_BY)
                if type is not None:
                    self._graph.connect(Edge.TYPED_BY, node.element_id, type)

    def connect_to_master(self, document: Document, node: Node, element: Element) -> Node | None:
        """Connect the element of a mirror to that of its master; return the master."""
        master = self.find_master(document, node)
        if master is not None and master.element_id in self._graph:
            self._graph.connect(Edge.MIRRORS, element.id, master.element_id)
            return master
        return None

    def find_master(self, document: Document, node: Node) -> Node | None:
        """Return the last master of a chain of mirrors; report a missing master and a cycle."""
        chain: dict[Node, None] = {}
        circular = self._circular
        while self.is_mirror(node) and node not in chain and node not in circular:
            chain[node] = None
            master = self._masters.get((document, node)) or self._find_next(document, node)
            if isinstance(master, str):
                self._masters.update(((document, mirror), master) for mirror in chain)
                self._report_missing(document, next(iter(chain)), master)
                return None
            node = master
        first = next(iter(chain), node)
        if chain:
            report_inexact_id(self._findings, self._ids, document, first, _read_master_id(first))
        if node in chain or node in circular:
            circular.update(chain)
            self._report_cycle(document, first)
            return None
        self._masters.update(((document, mirror), node) for mirror in chain)
        return node

    def _find_next(self, document: Document, mirror: Node) -> Node | str:
        """Return the node that a mirror names, or its reference if that leads nowhere."""
        located = self._ids.find(_read_master_id(mirror), document)
        if located is None:
            return read_class_reference(mirror)
        if mirror.tag == "Attribute":
            return _find_attribute(located[1], mirror) or read_class_reference(mirror)
        return located[1]

    def _report_missing(self, document: Document, node: Node, reference: str) -> None:
        self._record_path(node)
        facts = {"element": node.name, "reference": reference}
        self._findings.report(
            rules.MIRROR_WITHOUT_MASTER, document, node, f"no master {reference}", **facts
        )

    def _report_cycle(self, document: Document, node: Node) -> None:
        self._record_path(node)
        facts = {"element": node.name, "reference": _read_master_id(node)}
        self._findings.report(rules.MIRROR_CYCLE, document, node, **facts)

    def _record_path(self, node: Node) -> None:
        if node.element_id in self._graph:
            record_unresolved_path(self._graph, self._graph[node.element_id], node)


def _read_master_id(node: Node) -> str:
    """Return the ID that a reference holds in place of a class path, or the empty string."""
    text = node.attributes.get(_MIRROR_REFERENCES.get(node.tag, ""), "").strip()
    return text.partition("/")[0] if node.tag == "Attribute" else text


def _looks_like_guid(text: str) -> bool:
    id = text.strip("{}")
    return len(id) == _GUID_LENGTH and id.count("-") == 4 and "/" not in id


def _find_attribute(owner: Node, mirror: Node) -> Node | None:
    """Return the attribute of *owner* that ``ID/name`` or ``ID/name/inner`` means."""
    names = mirror.attributes["RefAttributeType"].strip().split("/")[1:] or [mirror.name]
    node: Node | None = owner
    for name in names:
        if node is not None:
            inner = node.iter_children("Attribute")
            node = next((attribute for attribute in inner if attribute.name == name), None)
    return node
