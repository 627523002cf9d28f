"""What accept actions and transitions wait for."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes, values
from sysmlc.frontends.sysml.connections import steps_of_value
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_CALL = "SysMLC::Call"
_TIMES = {"after": True, "at": False}


def trigger(low: "Lowering", accepting: Node, owner: Element) -> Element:
    """The trigger of an accept action, owned by the action or transition that waits."""
    payload, port = _parts(accepting)
    made = low.make(payload or accepting, Kind.TRIGGER, "", owner)
    low.graph.connect(Edge.TRIGGER, owner, made)
    value = None if payload is None else nodes.value_of(payload)
    if value is not None and value.kind == "TriggerInvocationExpression":
        _timed(low, made, value)
    elif payload is not None:
        _received(low, made, payload)
    if port is not None:
        low.later(lambda: _at(low, made, port))
    return made


def _parts(accepting: Node) -> tuple[Node | None, Node | None]:
    """The payload, and the expression for the port."""
    found = list(nodes.held(accepting, "ParameterMembership"))
    payload = found[0] if found else None
    port = nodes.value_of(found[1]) if len(found) > 1 else None
    return payload, port


def _timed(low: "Lowering", made: Element, value: Node) -> None:
    kind = str(value.attributes.get("kind", ""))
    given = next(iter(nodes.arguments(value)), None)
    if kind in _TIMES:
        when = "" if given is None else duration(low, given)
        low.set(made, subkind="time", when=when, relative=_TIMES[kind])
    else:
        low.set(made, subkind="change")
        low.later(lambda: low.set(made, condition=values.texts(given, low)))


def duration(low: "Lowering", node: Node) -> str:
    """A point in time or a duration as text: ``5 s``."""
    unit = values.measure(node)
    number = values.constant(node)
    if unit and number is not None:
        return f"{number} {unit}"
    return values.texts(node, low)


def _received(low: "Lowering", made: Element, payload: Node) -> None:
    types = types_of(low, payload)
    names = [nodes.path_of(one) for one in types]
    if _CALL in names:
        low.set(made, subkind="call")
        name = nodes.name_of(payload)
        low.later(lambda: _called(low, made, name))
    elif names == ["Base::Anything"] or not payload.relations:
        low.set(made, subkind="any")
    else:
        low.set(made, subkind="signal", payload=nodes.name_of(payload))
        low.later(lambda: low.lead_all(Edge.TYPED_BY, made, types))
        if not types:
            low.lead(Edge.TYPED_BY, made, None)
        low.later(lambda: _by_kind(low, made))


def _by_kind(low: "Lowering", made: Element) -> None:
    """An action that is accepted is a call."""
    type_ = low.graph.target(made, Edge.TYPED_BY)
    if type_ is not None and type_.kind in (Kind.ACTIVITY, Kind.OPERATION):
        low.set(made, subkind="call")


def _called(low: "Lowering", made: Element, name: str) -> None:
    """The operation that is called: of the nearest classifier that has one of this name."""
    for above in low.graph.ancestors(made):
        found = [one for one in _operations(low, above) if one.name == name]
        if found:
            low.graph.connect(Edge.TYPED_BY, made, found[0])
            return
    known = [one for one in low.graph.of_kind(Kind.OPERATION) if one.name == name]
    if len(known) == 1:
        low.graph.connect(Edge.TYPED_BY, made, known[0])
    else:
        low.graph.set(made, unresolved=("typed-by",))


def _operations(low: "Lowering", above: Element) -> list[Element]:
    seen, stack, found = {above.id}, [above], []
    while stack:
        top = stack.pop()
        found += [one for one in low.graph.owned(top) if one.kind is Kind.OPERATION]
        for general in low.graph.targets(top, Edge.SPECIALIZES):
            if general.id not in seen:
                seen.add(general.id)
                stack.append(general)
    return found


def _at(low: "Lowering", made: Element, port: Node) -> None:
    steps = steps_of_value(port)
    known = low.element(steps[-1]) if steps else None
    if known is not None:
        low.graph.set(made, port=known.id)
