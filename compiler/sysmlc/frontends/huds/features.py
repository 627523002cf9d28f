"""Attributes of elements, and the stereotypes that are applied to them."""

from collections.abc import Callable

from sysmlc.frontends.huds import vocabulary as v
from sysmlc.frontends.huds.records import Record, stereotypes, tagged_values
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.identity import derived_id

_Read = Callable[[Element, str], None]
_MULTIPLE = frozenset({Kind.PROPERTY, Kind.PORT, Kind.PARAMETER, Kind.PIN})


def _multiplicity(element: Element, text: str) -> None:
    if element.kind in _MULTIPLE and text not in ("1", "1..1", "unspecified"):
        element.attrs["multiplicity"] = "*" if text == "0..*" else text


def _default(element: Element, text: str) -> None:
    element.attrs["default"] = text
    element.attrs["default_language"] = ""


def _put(name: str) -> _Read:
    def put(element: Element, text: str) -> None:
        element.attrs[name] = text

    return put


ATTRIBUTES: dict[str, _Read] = {
    "multiplicity": _multiplicity,
    "defaultValue": _default,
    "direction": _put("direction"),
    "guard": _put("guard"),
    "body": _put("body"),
    "language": _put("language"),
    "valueSpecification": _put("body"),
    "documentation": _put("documentation"),
    "messageSort": _put("message_sort"),
    "text": _put("text"),
    "id": _put("req_id"),
}
"""How each attribute of a record becomes one of the element."""


def apply_stereotypes(graph: Graph, element: Element, record: Record) -> None:
    """Add an application for each stereotype, with its tagged values."""
    for name, profile in stereotypes(record):
        namespace = v.SYSML if profile in v.SYSML_PROFILES else profile
        made = Element(
            derived_id(element.id, f"stereotype {profile}::{name}"),
            Kind.APPLICATION,
            name,
            element.id,
            record.ordinal,
            element.source,
            {"stereotype": name, "namespace": namespace},
        )
        for tag, values in tagged_values(record, name):
            made.attrs[f"tag.{tag}"] = values[0] if len(values) == 1 else values
        graph.add(made)
        graph.connect(Edge.SUBJECT, made, element)
