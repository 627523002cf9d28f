"""Actions and control nodes of activities."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, expressions, nodes, statements, values
from sysmlc.frontends.sysml.connections import steps_of_value
from sysmlc.frontends.sysml.definitions import visibility
from sysmlc.frontends.sysml.events import trigger
from sysmlc.frontends.sysml.successions import steps
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node
from sysmlc.logic.expressions.expression import print_statement

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_STRUCTURED = frozenset(
    {"conditional", "loop", "sequence", "expansion", "interruptible", "structured"}
)
_CONTROLS = {
    "DecisionNode": "decision",
    "MergeNode": "merge",
    "ForkNode": "fork",
    "JoinNode": "join",
}


def action(low: "Lowering", node: Node, owner: Element) -> Element:
    """A step: the call of a behaviour, a group of steps, or an action without a model."""
    subkind = str(annotations.said(node, "Kind", "name") or "")
    body = nodes.body_of(node)
    has_steps = any(map(_is_step, body))
    found = statements.sequence(body) if has_steps else None
    written = None if found is None else statements.effect(found)
    if written is not None:
        return _opaque(low, node, owner, written, found or [])
    if _called(node) is None and (subkind in _STRUCTURED or (has_steps and not subkind)):
        return _structured(low, node, owner, subkind)
    return _action(low, node, owner, subkind, body)


def _is_step(node: Node) -> bool:
    is_reference = node.kind == "ReferenceUsage" and not node.name
    return not (nodes.is_text(node) or "direction" in node.attributes or is_reference)


def _start(
    low: "Lowering", node: Node, owner: Element, subkind: str, **attrs: AttrValue
) -> Element:
    name = nodes.name_of(node)
    made = low.add(node, Kind.ACTION, name, owner, subkind=subkind, **visibility(node), **attrs)
    _partitions(low, node, owner, made)
    return made


def _opaque(
    low: "Lowering", node: Node, owner: Element, written: str, found: list[Node]
) -> Element:
    made = _start(low, node, owner, "opaque", body=written)
    inside = {id(one) for one in found}
    rest = (one for one in nodes.body_of(node) if one.kind != "SuccessionAsUsage")
    low.lower_all((one for one in rest if id(one) not in inside), made)
    return made


def _structured(low: "Lowering", node: Node, owner: Element, subkind: str) -> Element:
    attrs: dict[str, AttrValue] = {"subkind": subkind or "structured"}
    made = low.add(node, Kind.STRUCTURED, nodes.name_of(node), owner, **attrs, **visibility(node))
    _partitions(low, node, owner, made)
    steps(low, nodes.body_of(node), made)
    return made


def _called(node: Node) -> Node | None:
    """The behaviour or operation that a step performs."""
    kinds = ("FeatureTyping", "ReferenceSubsetting", "Subsetting", "Redefinition")
    return nodes.target(node, *kinds)


def _action(low: "Lowering", node: Node, owner: Element, subkind: str, body: list[Node]) -> Element:
    called = _called(node)
    made = _start(low, node, owner, subkind or ("opaque" if called is None else "call-behavior"))
    for one in body:
        if one.kind == "ReferenceUsage" and not one.name and "direction" not in one.attributes:
            for found in nodes.references(one, "FeatureTyping", "Subsetting"):
                low.refer(Edge.CALLS, made, found)
        else:
            low.lower(one, made)
    if called is not None:
        low.later(lambda: _call(low, made, called))
    return made


def _call(low: "Lowering", made: Element, called: Node) -> None:
    low.lead(Edge.CALLS, made, called)
    target = low.graph.target(made, Edge.CALLS)
    if target is not None and target.kind is Kind.OPERATION:
        low.graph.set(made, subkind="call-operation")


def _partitions(low: "Lowering", node: Node, owner: Element, made: Element) -> None:
    """Partitions by the names that metadata of ours gives."""
    if "Partition" not in annotations.ours(node):
        return
    represented = _texts(annotations.said(node, "Partition", "represents"))
    for number, name in enumerate(_texts(annotations.said(node, "Partition", "names"))):
        said = represented[number] if number < len(represented) else ""
        low.later(lambda n=name, s=said: _partition(low, made, owner, (n, s)))  # type: ignore[misc]


def _partition(low: "Lowering", made: Element, owner: Element, said: tuple[str, str]) -> None:
    """The partition, or interruptible region, with a name; it is made when it is not there."""
    name, represented = said
    beside = (one for one in low.graph.owned(owner) if one.kind in _AREAS and one.name == name)
    found = next(beside, None) or low.below(owner, Kind.PARTITION, name)
    low.graph.connect(Edge.IN_PARTITION, made, found)
    known = low.graph.get(low.id_of(represented)) if represented else None
    if known is not None and found.kind is Kind.PARTITION:
        low.graph.connect(Edge.REPRESENTS, found, known)


_AREAS = (Kind.PARTITION, Kind.STRUCTURED)


def _texts(given: AttrValue) -> list[str]:
    values_ = given if isinstance(given, tuple) else () if given is None else (given,)
    return [str(one) for one in values_]


# -- sending, accepting, assigning -------------------------------------------------------------


def send(low: "Lowering", node: Node, owner: Element) -> Element:
    """A send action: the signal that it creates, its arguments, the port or receiver."""
    made = _start(low, node, owner, "send")
    payload, sender, receiver = [*statements.inputs(node), None, None, None][:3]
    if payload is not None:
        _payload(low, made, payload)
    for end in (sender, receiver):
        if end is not None:
            low.later(lambda end=end: _to(low, made, end))  # type: ignore[misc]
    _inside(low, node, made)
    return made


def _payload(low: "Lowering", made: Element, payload: Node) -> None:
    created = nodes.reference(payload, "Membership", "FeatureTyping")
    is_new = payload.kind in ("ConstructorExpression", "InvocationExpression")
    if created is not None and is_new:
        low.refer(Edge.CALLS, made, created)
        for one in expressions.in_order(payload):
            _argument(low, made, one)
    else:
        _argument(low, made, payload)


def _argument(low: "Lowering", made: Element, given: Node) -> None:
    value = nodes.value_of(given) or given
    one = low.make(given, Kind.PIN, nodes.name_of(given), made, direction="in", subkind="argument")
    values.give(low, one, "value", value)


def _to(low: "Lowering", made: Element, end: Node) -> None:
    found = steps_of_value(end)
    known = low.element(found[-1]) if found else None
    if known is not None and known.kind is Kind.PORT:
        low.graph.set(made, on_port=known.id)


def accept(low: "Lowering", node: Node, owner: Element) -> Element:
    """An accept action with its trigger."""
    made = _start(low, node, owner, "accept")
    trigger(low, node, made)
    _inside(low, node, made)
    return made


def _inside(low: "Lowering", node: Node, made: Element) -> None:
    rest = (one for one in nodes.body_of(node) if one.membership != "ParameterMembership")
    low.lower_all(rest, made)


def assign(low: "Lowering", node: Node, owner: Element) -> Element:
    """An assignment: an opaque action with the text of it."""
    said = _assigned(node)
    made = _start(low, node, owner, "opaque")
    if said:
        low.set(made, body=said)
    elif (document := low.document(node)) is not None and node.end > node.start >= 0:
        low.set(made, body=nodes.quoted(node, document.text))
    _inside(low, node, made)
    return made


def _assigned(node: Node) -> str:
    found = statements.statement(node)
    return "" if found is None else print_statement(found)


# -- control -----------------------------------------------------------------------------------


def control(low: "Lowering", node: Node, owner: Element) -> Element:
    """A decision, merge, fork or join."""
    subkind = _CONTROLS[node.kind]
    given: dict[str, AttrValue] = {"subkind": subkind, **visibility(node)}
    made = low.add(node, Kind.CONTROL, nodes.name_of(node), owner, **given)
    _partitions(low, node, owner, made)
    low.lower_all(nodes.body_of(node), made)
    return made


def terminate(low: "Lowering", node: Node, owner: Element) -> Element:
    """The end of the behaviour; the end of something else is an action."""
    if any(one is not None for one in statements.inputs(node)):
        low.approximated(node, "a terminate action for something else", "an opaque action")
        return _start(low, node, owner, "destroy")
    made = low.add(node, Kind.CONTROL, nodes.name_of(node), owner, subkind="final")
    annotations.texts(low, node, made, "a terminate action")
    return made
