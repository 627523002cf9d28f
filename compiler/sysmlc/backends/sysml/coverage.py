"""Losses by omission: elements, edges, attributes and names that no line of the text expresses."""

from collections.abc import Mapping

from sysmlc.backends.sysml.attribute_coverage import iter_unexpressed_attributes
from sysmlc.backends.sysml.edge_coverage import iter_unexpressed_edges
from sysmlc.backends.sysml.rules import (
    NAME_LEFT_OUT,
    UNSAID_ATTRIBUTE,
    UNSAID_EDGE,
    UNSAID_KIND,
)
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind

_EXPRESSED_BY_OTHERS = frozenset(
    {
        Kind.APPLICATION,
        Kind.CONNECTOR_END,
        Kind.SLOT,
        Kind.CONTROL_FLOW,
        Kind.OBJECT_FLOW,
        Kind.TRIGGER,
        Kind.VIEW,
        Kind.UNIT,
        Kind.QUANTITY_KIND,
    }
)
"""Kinds that passes add, or that another element expresses and reports losses for."""
_TRANSPARENT = frozenset({Kind.REGION, Kind.ACTIVITY_PARAMETER, Kind.FINAL_STATE})
"""Kinds that need no member of their own."""
_EXPRESSED_SUBKINDS = frozenset({"initial", "final", "flow-final"})
"""Control nodes and pseudostates that ``start`` and ``done`` express."""
_NAMELESS_KINDS = {
    Kind.REGION: "a region that is the only one",
    Kind.FINAL_STATE: "a final state",
    Kind.PSEUDOSTATE: "an initial pseudostate",
    Kind.CONTROL: "an initial or final node",
    Kind.TRIGGER: "a trigger",
    Kind.ACTIVITY_PARAMETER: "a parameter node",
    Kind.OBJECT_FLOW: "an object flow between control nodes",
    Kind.SLOT: "a slot",
    Kind.CONNECTOR_END: "an end of a connector",
}
"""Descriptions of kinds whose names the text may omit."""


def record_omissions(writer: Writer, dropped: Mapping[str, str]) -> None:
    """Record the loss of everything that the text omits.

    Elements come first, then the attributes and edges of the elements that the text expresses.
    *dropped* maps the ids of dropped elements to the edge whose target has no name.
    """
    for element in writer.graph:
        if element.attrs.get("external") or _is_below_dropped(writer, element, dropped):
            continue
        if element.id in dropped:
            writer.record_unreachable(element, dropped[element.id])
            continue
        if _is_omitted(writer, element):
            writer.losses.record(UNSAID_KIND, element, kind=str(element.kind))
        else:
            _record_name(writer, element)
            _record_attributes(writer, element)
    _record_edges(writer)


def _is_below_dropped(writer: Writer, element: Element, dropped: Mapping[str, str]) -> bool:
    return bool(dropped) and any(
        ancestor.id in dropped for ancestor in writer.graph.ancestors(element)
    )


def _is_omitted(writer: Writer, element: Element) -> bool:
    if element.kind is Kind.APPLICATION and element.id not in writer.expressed:
        # A partition is metadata of its actions, which has no metadata of its own.
        subject = writer.graph.target(element, Edge.SUBJECT)
        return subject is not None and subject.kind is Kind.PARTITION
    if element.id in writer.expressed or element.kind in (_EXPRESSED_BY_OTHERS | _TRANSPARENT):
        return False
    if element.kind is Kind.PARTITION:
        return not writer.graph.sources(element, Edge.IN_PARTITION)
    is_node = element.kind in (Kind.CONTROL, Kind.PSEUDOSTATE)
    if is_node and element.subkind in _EXPRESSED_SUBKINDS:
        return False
    owners = (element, *writer.graph.ancestors(element))
    return not any(owner.attrs.get("external") for owner in owners)


def _record_name(writer: Writer, element: Element) -> None:
    description = _NAMELESS_KINDS.get(element.kind)
    is_stored = (element.id, "name") in writer.stored_attributes
    if description is None or not element.name or is_stored:
        return
    member = writer.plan.find(element)
    if member is not None and member.name:
        return
    feature = writer.graph.target(element, Edge.INSTANCE_OF) or writer.graph.target(
        element, Edge.REFERENCES
    )
    if feature is None or feature.name != element.name:
        writer.losses.record(NAME_LEFT_OUT, element, construct=description)


def _record_attributes(writer: Writer, element: Element) -> None:
    for key in iter_unexpressed_attributes(writer, writer.plan.find(element), element):
        is_stored = (element.id, key) in writer.stored_attributes
        if not is_stored and element.attrs[key] != "":
            facts = {"attribute": key, "kind": str(element.kind)}
            writer.losses.record(UNSAID_ATTRIBUTE, element, **facts)


def _record_edges(writer: Writer) -> None:
    for element in writer.graph:
        if element.id not in writer.expressed:
            continue
        for edge, target in iter_unexpressed_edges(writer, element):
            if (edge, element.id, target.id) not in writer.stored_edges:
                facts = {
                    "edge": str(edge.value),
                    "kind": str(element.kind),
                    "target": str(target.kind),
                }
                writer.losses.record(UNSAID_EDGE, element, **facts)
