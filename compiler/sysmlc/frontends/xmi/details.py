"""What is special about the elements of single kinds when they are made."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.ir import Edge, Element, Kind

if TYPE_CHECKING:
    from sysmlc.frontends.xmi.context import Context

Detail = Callable[["Context", Element, int, str, str], None]
"""Completes an element; takes its row, the name of its metaclass and its feature."""


def _parameter(
    _context: "Context", element: Element, _row: int, _type_name: str, _feature: str
) -> None:
    element.attrs["direction"] = "in"


def _pin(context: "Context", element: Element, _row: int, type_name: str, feature: str) -> None:
    element.attrs["direction"] = v.PIN_DIRECTIONS[type_name]
    element.attrs["subkind"] = metaclasses.hyphenated(feature)
    owner = context.graph.owner(element) if feature == "returnInformation" else None
    if owner is not None and owner.subkind == "reply":
        # Where no type is written the default is that of an accepted call, an output pin.
        element.attrs["direction"] = "in"


def _pseudostate(
    _context: "Context", element: Element, _row: int, type_name: str, _feature: str
) -> None:
    if type_name == "Pseudostate":
        element.attrs["subkind"] = "initial"


def _constraint(
    context: "Context", element: Element, row: int, _type_name: str, feature: str
) -> None:
    if feature in v.CONDITIONS:
        element.attrs["subkind"] = v.CONDITIONS[feature]
    owner = context.graph.owner(element) if feature in ("guard", "preCondition") else None
    if owner is not None:
        context.guards.append((owner, element.id, row))


def _transition(
    context: "Context", element: Element, row: int, _type_name: str, _feature: str
) -> None:
    for target in context.document.targets(row, "guard"):
        context.guards.append((element, target, row))


def _behaviour(
    context: "Context", element: Element, _row: int, _type_name: str, feature: str
) -> None:
    owner = context.graph.owner(element)
    edge = v.STATE_BEHAVIOURS.get(feature)
    if edge is not None and owner is not None:
        context.graph.connect(edge, owner, element)


def _trigger(context: "Context", element: Element, row: int, _type_name: str, feature: str) -> None:
    owner = context.graph.owner(element)
    context.triggers.append((element, row))
    if feature == "deferrableTrigger":
        element.attrs["deferred"] = True
    elif owner is not None:
        context.graph.connect(Edge.TRIGGER, owner, element)


def _dependency(
    _context: "Context", element: Element, _row: int, _type_name: str, feature: str
) -> None:
    if feature == "roleBinding":
        element.attrs["subkind"] = "role-binding"


def _connector_end(
    context: "Context", element: Element, row: int, _type_name: str, _feature: str
) -> None:
    owner = context.graph.owner(element)
    if owner is not None:
        context.graph.connect(Edge.END, owner, element)
    context.ends.append((element, row))


def _activity_parameter(
    context: "Context", element: Element, row: int, _type_name: str, _feature: str
) -> None:
    context.parameters.append((element, row))


OF: dict[Kind, Detail] = {
    Kind.PARAMETER: _parameter,
    Kind.PIN: _pin,
    Kind.PSEUDOSTATE: _pseudostate,
    Kind.CONSTRAINT: _constraint,
    Kind.TRANSITION: _transition,
    Kind.ACTIVITY: _behaviour,
    Kind.STATE_MACHINE: _behaviour,
    Kind.INTERACTION: _behaviour,
    Kind.TRIGGER: _trigger,
    Kind.DEPENDENCY: _dependency,
    Kind.CONNECTOR_END: _connector_end,
    Kind.ACTIVITY_PARAMETER: _activity_parameter,
}
"""What completes the elements of a kind."""
