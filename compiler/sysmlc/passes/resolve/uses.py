"""What needs an element: references to come, and attributes that hold ids."""

from collections.abc import Iterator
from dataclasses import field
from typing import NamedTuple

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import ids_in
from sysmlc.ir.reference import id_of
from sysmlc.values import dataclass

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


@dataclass(slots=True)
class Need:
    """What all places of one file need that name a target by the same words."""

    graph: Graph
    file: str
    target: str
    kind: Kind
    path: str
    numbers: list[int] = field(default_factory=list)
    """The references among them: most are only counted, so that each has no ``Use`` of its own."""
    held: list[Use] = field(default_factory=list)
    """The attributes among them."""

    def uses(self) -> list[Use]:
        """All places."""
        return [*map(self.use, self.numbers), *self.held]

    def use(self, number: int) -> Use:
        """The place of a reference."""
        pending = self.graph.pending
        holder = self.graph[id_of(pending.sources[number])]
        edge, ordinal = pending.edges[number], pending.ordinals[number]
        return Use(holder, self.target, self.kind, self.path, ordinal, edge)

    def first(self) -> Use:
        """The place that comes first, whatever was read first."""
        ordinals = self.graph.pending.ordinals
        least = min(map(ordinals.__getitem__, self.numbers), default=-1)
        if least < 0 or self.held:
            return min(self.uses(), key=Use.place)
        first = (number for number in self.numbers if ordinals[number] == least)
        return min(map(self.use, first), key=Use.place)


def needs(graph: Graph, targets: list[Element | None], held: list[Use]) -> list[Need]:
    """What references need whose target is no id of the graph, and what attributes need."""
    pending, found = graph.pending, _Needs(graph)
    numbers = [number for number, target in enumerate(targets) if target is None]
    holders = graph.find_all(pending.sources[number] for number in numbers)
    for number, holder in zip(numbers, holders, strict=True):
        target = pending.targets[number]
        if holder is not None and isinstance(target, str):
            kind, path = pending.said.get(number, _UNSAID)
            found[holder.source, target, kind, path].numbers.append(number)
    for use in held:
        found[use.holder.source, use.target, use.kind, use.path].held.append(use)
    return list(found.values())


class _Needs(dict[tuple[str, str, Kind, str], Need]):
    """By file, target and what is said of it."""

    def __init__(self, graph: Graph) -> None:
        super().__init__()
        self._graph = graph

    def __missing__(self, key: tuple[str, str, Kind, str]) -> Need:
        made = self[key] = Need(self._graph, *key)
        return made


def attributes(graph: Graph) -> Iterator[Use]:
    """The ids that attributes hold."""
    for holder_kind, named in _ATTRIBUTES.items():
        for element in graph.of_kind(holder_kind):
            attrs = element.attrs
            if attrs and not attrs.keys().isdisjoint(named):
                for name, kind in named.items():
                    for id in ids_in(attrs.get(name)):
                        yield Use(element, id, kind, attribute=name)
