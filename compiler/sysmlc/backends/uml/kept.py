"""What UML has no words for in a plant: kept in one comment, for the way back (pass ``kept``)."""

import json
from dataclasses import dataclass, field

from sysmlc.backends.uml.hrefs import href_of
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.round_trip import PREFIX

_ADDED = frozenset({Edge.OWNS, Edge.FEATURE})
"""Edges that ownership says, or that passes add again."""
_Json = str | int | float | bool | None | list["_Json"]


def is_plant(graph: Graph) -> bool:
    """Whether the graph comes from AutomationML."""
    documents = graph.of_kind(Kind.DOCUMENT)
    return any(one.subkind == "caex" and one.owner is None for one in documents)


@dataclass(slots=True)
class Kept:
    """Facts by the ids that elements have in the file."""

    graph: Graph
    ids: dict[str, str]
    elements: dict[str, Element] = field(default_factory=dict)
    attributes: dict[str, dict[str, _Json]] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    owners: dict[str, str | None] = field(default_factory=dict)
    edges: dict[tuple[str, str, str], None] = field(default_factory=dict)
    made: list[str] = field(default_factory=list)
    """Ids of what is only written because UML or SysML want it."""
    applied: list[str] = field(default_factory=list)
    """Ids of packages that apply SysML only because the saved model does."""

    def attribute(self, element: Element, name: str) -> None:
        """Keep an attribute, or the name of what UML gives none."""
        if name == "name":
            self.names[self.ids[element.id]] = element.name
        elif name in element.attrs:
            known = self.attributes.setdefault(self.ids[element.id], {})
            known[name] = self._value(element.attrs[name])

    def owner(self, element: Element) -> None:
        """Keep who owns an element that is saved with another owner."""
        owner = element.owner
        self.owners[self.ids[element.id]] = None if owner is None else self.ids[owner]

    def edge(self, edge: str, source: Element, target: Element) -> None:
        """Keep a relation."""
        self.edges[edge, self.ids[source.id], self.ids[target.id]] = None

    def whole(self, element: Element) -> None:
        """Keep an element with all its attributes and relations."""
        if element.id in self.elements:
            return
        self.elements[element.id] = element
        for name in element.attrs:
            self.attribute(element, name)
        for edge in Edge:
            for target in () if edge in _ADDED else self.graph.targets(element, edge):
                self.edge(edge.value, element, target)
                if "href" in target.attrs:
                    self.whole(target)

    def libraries(self) -> None:
        """Keep the library elements that no file says: standard libraries, units."""
        for one in self.graph:
            if one.attrs.get("library") and not one.attrs.get("href"):
                for below in self.graph.subtree(one):
                    self.whole(below)

    def text(self) -> str:
        """The body of the comment."""
        record = {
            "elements": [self._element(one) for one in self._in_order()],
            "attributes": self.attributes,
            "names": self.names,
            "owners": self.owners,
            "edges": [list(one) for one in self.edges],
            "made": self.made,
            "applied": self.applied,
        }
        return PREFIX + json.dumps(record, ensure_ascii=True, separators=(",", ":"))

    def _in_order(self) -> list[Element]:
        """Owners before what they own."""
        return [
            one
            for root in self.graph.roots()
            for one in self.graph.subtree(root)
            if one.id in self.elements
        ]

    def _element(self, element: Element) -> list[str | None]:
        owner = None if element.owner is None else self.ids[element.owner]
        is_outside = bool(element.attrs.get("external"))
        href = str(element.attrs.get("href") or href_of(self.graph, element))
        made = [self.ids[element.id], element.kind.value, element.name, owner]
        return [*made, href if is_outside else None]

    def _value(self, value: AttrValue) -> _Json:
        if isinstance(value, tuple):
            return [self._value(one) for one in value]
        return self.ids.get(value, value) if isinstance(value, str) else value
