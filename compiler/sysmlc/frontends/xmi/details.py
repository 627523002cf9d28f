"""What is special about the elements of single kinds when they are made."""

from collections.abc import Callable

from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context
from sysmlc.ir import AttrValue, Edge, Element, Kind

Detail = Callable[[Context, Element, int, str, str], None]
"""Completes an element; takes its row, the name of its metaclass and its feature."""


# -- the same for all elements of a feature and metaclass --------------------------------------


def attributes(kind: Kind, subkind: str, type_name: str, feature: str) -> dict[str, AttrValue]:
    """What elements of this kind, metaclass and feature say without an attribute of their own."""
    said: dict[str, AttrValue] = {"subkind": subkind} if subkind else {}
    if kind is Kind.PARAMETER:
        said["direction"] = "in"
    elif kind is Kind.PIN:
        said["direction"] = v.PIN_DIRECTIONS[type_name]
        said["subkind"] = metaclasses.hyphenated(feature)
    elif kind is Kind.PSEUDOSTATE and type_name == "Pseudostate":
        said["subkind"] = "initial"
    elif kind is Kind.STRUCTURED and subkind == "expansion":
        said["mode"] = v.default("mode")
    elif kind is Kind.CONSTRAINT and feature in v.CONDITIONS:
        said["subkind"] = v.CONDITIONS[feature]
    elif kind is Kind.DEPENDENCY and feature == "roleBinding":
        said["subkind"] = "role-binding"
    return said


def of(kind: Kind, feature: str) -> Detail | None:
    """What else completes elements of this kind and feature."""
    among = _FEATURES.get(kind)
    return _OF.get(kind) if among is None or feature in among else None


# -- what depends on the element ---------------------------------------------------------------


def _pin(context: Context, element: Element, row: int, _type_name: str, _feature: str) -> None:
    owner = context.owner(row)
    if owner is not None and owner.subkind == "reply":
        # Where no type is written the default is that of an accepted call, an output pin.
        element.attrs["direction"] = "in"


def _constraint(
    context: Context, element: Element, row: int, _type_name: str, _feature: str
) -> None:
    owner = context.owner(row)
    if owner is not None:
        context.guards.append((owner, element.id, row))


def _transition(
    context: Context, element: Element, row: int, _type_name: str, _feature: str
) -> None:
    for target in context.document.targets(row, "guard"):
        context.guards.append((element, target, row))


def _behaviour(context: Context, element: Element, row: int, _type_name: str, feature: str) -> None:
    owner = context.owner(row)
    if owner is not None:
        context.graph.connect(v.STATE_BEHAVIOURS[feature], owner, element)


def _trigger(context: Context, element: Element, row: int, _type_name: str, feature: str) -> None:
    owner = context.owner(row)
    context.triggers.append((element, row))
    if feature == "deferrableTrigger":
        element.attrs["deferred"] = True
    elif owner is not None:
        context.graph.connect(Edge.TRIGGER, owner, element)


def _connector_end(
    context: Context, element: Element, row: int, _type_name: str, _feature: str
) -> None:
    owner = context.owner(row)
    if owner is not None:
        context.graph.connect(Edge.END, owner, element)
    context.ends.append((element, row))


def _activity_parameter(
    context: Context, element: Element, row: int, _type_name: str, _feature: str
) -> None:
    context.parameters.append((element, row))


_OF: dict[Kind, Detail] = {
    Kind.PIN: _pin,
    Kind.CONSTRAINT: _constraint,
    Kind.TRANSITION: _transition,
    Kind.ACTIVITY: _behaviour,
    Kind.STATE_MACHINE: _behaviour,
    Kind.INTERACTION: _behaviour,
    Kind.TRIGGER: _trigger,
    Kind.CONNECTOR_END: _connector_end,
    Kind.ACTIVITY_PARAMETER: _activity_parameter,
}
_FEATURES: dict[Kind, frozenset[str]] = {
    Kind.PIN: frozenset({"returnInformation"}),
    Kind.CONSTRAINT: frozenset({"guard", "preCondition"}),
    Kind.ACTIVITY: frozenset(v.STATE_BEHAVIOURS),
    Kind.STATE_MACHINE: frozenset(v.STATE_BEHAVIOURS),
    Kind.INTERACTION: frozenset(v.STATE_BEHAVIOURS),
}
"""Kinds of which only the elements of some features have something special to them."""
