"""Uses of elements that must be resolved: pending references, and attributes that hold ids."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.ir.query import ids_in

_ATTRIBUTES: dict[Kind, dict[str, Kind]] = {
    Kind.CONTROL: {"decision_input": Kind.ACTIVITY, "decision_input_flow": Kind.OBJECT_FLOW},
    Kind.CONTROL_FLOW: {"interrupts": Kind.STRUCTURED},
    Kind.OBJECT_FLOW: {"interrupts": Kind.STRUCTURED},
    Kind.ITEM_FLOW: {"item_property": Kind.PROPERTY},
    Kind.ACTION: {"on_port": Kind.PORT},
    Kind.TRIGGER: {"port": Kind.PORT},
    Kind.CONNECTOR_END: {"defining_end": Kind.PROPERTY},
    Kind.MESSAGE: {"connector": Kind.CONNECTOR},
    Kind.OPERATION: {"raised_exception": Kind.CLASS},
    Kind.STRUCTURED: dict.fromkeys(("test", "body_part", "setup_part", "clauses"), Kind.ACTION),
}
"""Attributes that hold ids (docs/ir.md), by the kind of their element: what they name."""


class Use(NamedTuple):
    """One use of an element: a pending edge, or an attribute that holds an id."""

    holder: Element
    target: str
    kind: Kind
    path: str = ""
    ordinal: int = -1
    edge: Edge | None = None
    attribute: str = ""

    @property
    def relation(self) -> str:
        """The name of the edge or of the attribute."""
        return self.edge.value if self.edge else self.attribute

    def location(self) -> tuple[str, int, str]:
        """Return file, ordinal and id of the holder, which order uses by the text."""
        ordinal = self.ordinal if self.ordinal >= 0 else self.holder.ordinal
        return self.holder.source, ordinal, self.holder.id


@dataclass(slots=True)
class Need:
    """All uses in one file that name a target with the same words."""

    graph: Graph
    file: str
    target: str
    kind: Kind
    path: str
    references: list[Reference] = field(default_factory=list)
    """The pending references among the places."""
    held: list[Use] = field(default_factory=list)
    """The attributes among the places."""

    def uses(self) -> list[Use]:
        """Return all uses."""
        return [use_of(self.graph[r.source], r) for r in self.references] + self.held

    def first_use(self) -> Use:
        """Return the first use in the unit, whatever the order in which files are read."""
        return min(self.uses(), key=Use.location)


def use_of(holder: Element, reference: Reference) -> Use:
    """Return the place of a pending reference that leaves *holder*."""
    edge, _, target, kind, path, ordinal = reference
    return Use(holder, target, kind, path, ordinal, edge)


def group_uses(graph: Graph, held_ids: list[Use]) -> list[Need]:
    """Group uses by file, target and description of the target.

    These are the pending references whose target is no id of the graph, and all attributes.
    """
    groups: dict[tuple[str, str, Kind, str], Need] = {}
    for reference in graph.pending:
        holder = graph.get(reference.source)
        if holder is not None and reference.target not in graph:
            key = (holder.source, reference.target, reference.kind, reference.name)
            if key not in groups:
                groups[key] = Need(graph, *key)
            groups[key].references.append(reference)
    for use in held_ids:
        key = (use.holder.source, use.target, use.kind, use.path)
        groups.setdefault(key, Need(graph, *key)).held.append(use)
    return list(groups.values())


def list_held_ids(graph: Graph) -> Iterator[Use]:
    """Yield the uses in attributes that hold ids."""
    for holder_kind, attributes_of_kind in _ATTRIBUTES.items():
        for element in graph.of_kind(holder_kind):
            attrs = element.attrs
            if attrs and not attrs.keys().isdisjoint(attributes_of_kind):
                for name, kind in attributes_of_kind.items():
                    for id in ids_in(attrs.get(name)):
                        yield Use(element, id, kind, attribute=name)
