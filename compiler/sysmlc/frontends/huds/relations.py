"""Relations between records as references of the graph."""

from collections.abc import Callable, Iterable
from typing import Protocol

from sysmlc.frontends.huds import vocabulary as v
from sysmlc.frontends.huds.records import Record
from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.ir.identity import derived_id


class _File(Protocol):
    graph: Graph
    by_id: dict[str, Record]

    def target(self, id: str) -> str: ...

    def lose_end(self, record: Record, flow: Element, edge: Edge) -> None: ...


def relate(file: _File, record: Record, element: Element | None) -> None:
    """Leave the references that a record makes; ``element`` is its own, if it has one."""
    name = record.type.rpartition(".")[2]
    if element is None:
        if name in _BARE:
            _BARE[name](file, record)
        return
    for relation, id in record.relations:
        edge = v.RELATIONS.get(relation)
        if edge is not None:
            _refer(file, edge, element.id, id)
    if element.kind in v.ENDS:
        _ends(file, record, element)
    if element.kind in _SPECIAL:
        _SPECIAL[element.kind](file, record, element)


def _refer(file: _File, edge: Edge, source: str, id: str) -> None:
    file.graph.pending.append(Reference(edge, source, file.target(id)))


def _ends(file: _File, record: Record, element: Element) -> None:
    for edge, relation in zip(v.ENDS[element.kind], ("supplier", "client"), strict=True):
        for id in record.related(relation)[:1]:
            if element.kind in _FLOWS and file.target(id) not in file.graph:
                file.lose_end(record, element, edge)
            else:
                _refer(file, edge, element.id, id)


def _between(edge: Edge) -> Callable[[_File, Record], None]:
    """A record that is only an edge, from where its arrow starts to where it ends."""

    def between(file: _File, record: Record) -> None:
        start, end = record.first("supplier"), record.first("client")
        if file.graph.get(file.target(start)) is not None and end:
            _refer(file, edge, file.target(start), end)

    return between


def _connector(file: _File, record: Record, element: Element) -> None:
    for number, side in enumerate(("supplier", "client")):
        end = Element(
            derived_id(element.id, f"end[{number}]"),
            Kind.CONNECTOR_END,
            "",
            element.id,
            record.ordinal,
            element.source,
        )
        file.graph.add(end)
        file.graph.connect(Edge.END, element, end)
        for id in record.related(side)[:1]:
            _refer(file, Edge.ROLE, end.id, id)
        _refer_all(file, Edge.PATH, end.id, record.related(f"{side}PartWithPort"))


def _refer_all(file: _File, edge: Edge, source: str, ids: Iterable[str]) -> None:
    for id in ids:
        _refer(file, edge, source, id)


def _property(file: _File, record: Record, element: Element) -> None:
    """An end of an association: the association names it, as in UML."""
    above = file.graph.get(element.owner or "")
    for id in record.related("association"):
        association = file.graph.get(file.target(id))
        if association is not None and association.kind is Kind.ASSOCIATION:
            file.graph.connect(Edge.END, association, element)
            is_whole = file.by_id[id].type.endswith("Composition")
            if is_whole and above is not None and above.kind is not Kind.ASSOCIATION:
                element.attrs["aggregation"] = "composite"
    if record.type.endswith("PartProperty"):
        element.attrs["aggregation"] = "composite"


def _trigger(file: _File, record: Record, element: Element) -> None:
    """The event of a trigger is part of it in the graph."""
    above = file.graph.get(element.owner or "")
    if above is not None and above.kind in (Kind.TRANSITION, Kind.ACTION):
        file.graph.connect(Edge.TRIGGER, above, element)
    elif above is not None:
        element.attrs["deferred"] = True
    event = file.by_id.get(record.first("event"))
    if event is None:
        return
    subkind = event.type.rpartition(".")[2].removesuffix("Event").lower()
    element.attrs["subkind"] = subkind
    _refer_all(file, Edge.TYPED_BY, element.id, event.related("signal"))
    _refer_all(file, Edge.TYPED_BY, element.id, event.related("operation"))
    when = file.by_id.get(event.value("when"))
    if when is not None and when.value("expr"):
        element.attrs["when"] = when.value("expr")
        element.attrs["relative"] = True


def _constraint(file: _File, record: Record, element: Element) -> None:
    above = file.graph.get(element.owner or "")
    if above is not None and above.kind is Kind.TRANSITION and element.attrs.get("body"):
        above.attrs["guard"] = element.attrs["body"]
        file.graph.connect(Edge.GUARD, above, element)


def _slot(file: _File, record: Record, element: Element) -> None:
    values = record.values("value")
    if values:
        element.attrs["value"] = values[0] if len(values) == 1 else tuple(values)


def _pin(file: _File, record: Record, element: Element) -> None:
    element.attrs["direction"] = "out" if record.type.endswith("OutputPin") else "in"


_FLOWS = frozenset({Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION})
"""What leads from node to node: a stand-in for a node that is not read would be no node."""
_SPECIAL: dict[Kind, Callable[[_File, Record, Element], None]] = {
    Kind.CONNECTOR: _connector,
    Kind.PROPERTY: _property,
    Kind.TRIGGER: _trigger,
    Kind.CONSTRAINT: _constraint,
    Kind.SLOT: _slot,
    Kind.PIN: _pin,
}
_BARE: dict[str, Callable[[_File, Record], None]] = {
    "Generalization": _between(Edge.SPECIALIZES),
    "Include": _between(Edge.INCLUDES),
    "Extend": _between(Edge.EXTENDS),
}
