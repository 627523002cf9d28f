"""What an action writes, one after the other.

It assigns (``x := e`` in its body), writes a structural feature (UML 2.5.1, 16.8.3: Add Structural
Feature Value, its value given by a literal), or gives an output of what it calls to a feature that
is bound to it (SysML 2.0, 7.16: ``out x = level``).
"""

import re
from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.expressions.expression import (
    Assignment,
    Expression,
    ExpressionError,
    name_of,
    print_expression,
)
from sysmlc.logic.expressions.parsing import parse_effect, parse_expression

_ASSIGNED = re.compile(r"([^\W\d]\w*)\s*:=")
"""The last names of what is assigned to where no name is in quotes."""


class Assigned(Struct, frozen=True):
    """An action gives a named feature a value; None where the model does not say which."""

    action: Element
    name: str
    value: Expression | None
    is_bound: bool = False
    """Whether it is an output of what the action calls: the environment decides it."""

    @property
    def text(self) -> str:
        """The value as it is written."""
        return "" if self.value is None else print_expression(self.value)


def assigned(graph: Graph, action: Element) -> Iterator[Assigned]:
    """What an action assigns, one after the other."""
    if action.subkind == "write":
        yield from _written(graph, action)
    body = action.attrs.get("body")
    if action.subkind in ("opaque", "function") and isinstance(body, str) and ":=" in body:
        yield from _said(action, body)
    for name in bound(graph, action):
        yield Assigned(action, name, None, is_bound=True)


def written_names(graph: Graph, action: Element) -> Iterator[str]:
    """Yield the names that an action writes; a write action refers to its feature instead."""
    body = action.attrs.get("body")
    if action.subkind in ("opaque", "function") and isinstance(body, str) and ":=" in body:
        yield from (one.name for one in _said(action, body))
    yield from bound(graph, action)


def mentioned(graph: Graph, action: Element) -> Iterator[str]:
    """The last names of what an action may write, found without reading its text."""
    if action.subkind == "write":
        yield from (one.name for one in graph.targets(action, Edge.CALLS))
    body = action.attrs.get("body")
    if isinstance(body, str) and ":=" in body:
        if "'" in body:
            yield from (last_of(name) for name in written_names(graph, action))
        else:
            yield from _ASSIGNED.findall(body)
    yield from (last_of(name) for name in bound(graph, action))


def last_of(name: str) -> str:
    """The last step of a path: ``load`` of ``arm.load``."""
    return name.rpartition("::")[2].rpartition(".")[2]


def bound(graph: Graph, action: Element) -> Iterator[str]:
    """The names of features that are outputs of what an action calls."""
    for pin in graph.owned(action) if action.kind is Kind.ACTION else ():
        if pin.attrs.get("direction") in ("out", "inout", "return"):
            text = pin.attrs.get("value")
            name = _name(text) if isinstance(text, str) else None
            if name:
                yield name


def _name(text: str) -> str | None:
    try:
        return name_of(parse_expression(text))
    except ExpressionError:
        return None


def _said(action: Element, body: str) -> Iterator[Assigned]:
    try:
        statements = parse_effect(body)
    except ExpressionError:
        return
    for one in statements:
        name = name_of(one.target) if isinstance(one, Assignment) else None
        if name and isinstance(one, Assignment):
            yield Assigned(action, name.removeprefix("self."), one.value)


def _written(graph: Graph, action: Element) -> Iterator[Assigned]:
    feature = graph.target(action, Edge.CALLS)
    if feature is not None:
        yield Assigned(action, feature.name, _value(graph, action))


def _value(graph: Graph, action: Element) -> Expression | None:
    pins = {pin.subkind or pin.name: pin for pin in graph.owned(action) if pin.kind is Kind.PIN}
    target, value = pins.get("object"), pins.get("value")
    if value is None or not _is_self(graph, target):
        return None
    text = _literal(graph, value)
    try:
        return None if text is None else parse_expression(text)
    except ExpressionError:
        return None


def _is_self(graph: Graph, pin: Element | None) -> bool:
    """Whether what is written to is the object that performs the activity."""
    giver = None if pin is None else _giver(graph, pin)
    return giver is None or giver.subkind == "read-self"


def _literal(graph: Graph, pin: Element) -> str | None:
    giver = _giver(graph, pin)
    from_value = giver is not None and giver.subkind == "value"
    value = giver.attrs.get("value") if giver is not None and from_value else pin.attrs.get("value")
    return None if value is None else print_value(value)


def _giver(graph: Graph, pin: Element) -> Element | None:
    """The action from which the only flow into a pin comes."""
    flows = list(graph.sources(pin, Edge.FLOW_TARGET))
    source = graph.target(flows[0], Edge.FLOW_SOURCE) if len(flows) == 1 else None
    return graph.owner(source) if source is not None and source.kind is Kind.PIN else source


def print_value(value: object) -> str:
    """A literal as expressions write it."""
    return str(value).lower() if isinstance(value, bool) else str(value)
