"""What needs an element: references to come, and attributes that hold ids."""

from collections.abc import Iterator
from typing import NamedTuple

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import ids_in
from sysmlc.ir.reference import id_of

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

_UNSAID = (Kind.CLASS, "")
"""What a reference says of its target that says nothing of it."""


class Use(NamedTuple):
    """One place that needs an element: an edge to come, or an attribute that holds an id."""

    holder: Element
    target: str
    kind: Kind
    path: str = ""
    ordinal: int = -1
    edge: Edge | None = None
    attribute: str = ""

    @property
    def relation(self) -> str:
        return self.edge.value if self.edge else self.attribute

    def place(self) -> tuple[str, int, str]:
        ordinal = self.ordinal if self.ordinal >= 0 else self.holder.ordinal
        return self.holder.source, ordinal, self.holder.id


def elsewhere(graph: Graph, targets: list[Element | None]) -> dict[int, Use]:
    """The references, by number, whose target is no id of the graph."""
    pending, uses = graph.pending, {}
    numbers = [number for number, target in enumerate(targets) if target is None]
    holders = graph.find_all(pending.sources[number] for number in numbers)
    for number, holder in zip(numbers, holders, strict=True):
        if holder is not None:
            kind, name = pending.said.get(number, _UNSAID)
            target, ordinal = id_of(pending.targets[number]), pending.ordinals[number]
            uses[number] = Use(holder, target, kind, name, ordinal, pending.edges[number])
    return uses


def attributes(graph: Graph) -> Iterator[Use]:
    """The ids that attributes hold."""
    for holder_kind, named in _ATTRIBUTES.items():
        for element in graph.of_kind(holder_kind):
            attrs = element.attrs
            if attrs and not attrs.keys().isdisjoint(named):
                for name, kind in named.items():
                    for id in ids_in(attrs.get(name)):
                        yield Use(element, id, kind, attribute=name)


def by_target(uses: list[Use]) -> dict[tuple[str, str], list[Use]]:
    """Uses by the file that they stand in, and what they name."""
    found: dict[tuple[str, str], list[Use]] = {}
    for use in uses:
        key = (use.holder.source, use.target)
        known = found.get(key)
        if known is None:
            found[key] = [use]
        else:
            known.append(use)
    return found
