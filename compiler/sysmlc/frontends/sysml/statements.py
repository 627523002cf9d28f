"""Assignments, sendings and performances as text of our grammar: bodies of opaque behaviours."""

from collections.abc import Sequence

from sysmlc.frontends.sysml import expressions, nodes
from sysmlc.language.tree import Node
from sysmlc.logic.expressions.expression import (
    Assignment,
    Call,
    Expression,
    Invocation,
    Member,
    Name,
    Send,
    Statement,
    print_effect,
)


def effect(steps: Sequence[Node]) -> str | None:
    """Steps one after the other as one effect; None when one has no words in our grammar."""
    found = [statement(one) for one in steps]
    if not found or None in found:
        return None
    return print_effect(tuple(one for one in found if one is not None))


def statement(node: Node) -> Statement | None:
    """One step as a statement, or None."""
    read = _READERS.get(node.kind)
    return None if read is None else read(node)


def _assignment(node: Node) -> Statement | None:
    found = nodes.reference(node, "Membership")
    inputs = list(nodes.held(node, "ParameterMembership"))
    values = [value for one in inputs if (value := nodes.value_of(one) or _expression(one))]
    if found is None or not values:
        return None
    given = expressions.read(values[-1])
    target = expressions.named(found)
    for one in values[:-1]:
        base = expressions.read(one)
        target = target if base is None else _behind(base, target)
    return None if given is None else Assignment(target, given)


def _behind(base: Expression, target: Expression) -> Expression:
    match target:
        case Member(inner, name):
            return Member(_behind(base, inner), name)
        case Name(path):
            return Member(base, path[-1])
        case _:
            return target


def _expression(node: Node) -> Node | None:
    return node if node.kind in nodes.EXPRESSIONS else None


def _send(node: Node) -> Statement | None:
    payload, *ends = [*inputs(node), None, None, None][:3]
    if payload is None or payload.kind not in _CREATED:
        return None
    call = expressions.read(payload)
    args = call.args if isinstance(call, Call) else ()
    signal = call.function if isinstance(call, Call) else call
    receiver = next((one for one in ends if one is not None), None)
    target = None if receiver is None else expressions.read(receiver)
    is_named = isinstance(signal, Name)
    return Send(signal, args, target) if is_named and isinstance(signal, Name) else None


_CREATED = frozenset(
    {"ConstructorExpression", "InvocationExpression", "FeatureReferenceExpression"}
)


def inputs(node: Node) -> list[Node | None]:
    """The expressions given to a node's parameters, in order; None where nothing is given."""
    found: list[Node | None] = []
    for one in nodes.held(node, "ParameterMembership"):
        found.append(nodes.value_of(one) or _expression(one))
    return found


def _perform(node: Node) -> Statement | None:
    found = nodes.reference(node, "ReferenceSubsetting")
    if found is None or node.name or node.members:
        return None
    return Invocation(expressions.named(found))


_READERS = {
    "AssignmentActionUsage": _assignment,
    "SendActionUsage": _send,
    "PerformActionUsage": _perform,
}


def sequence(body: Sequence[Node]) -> list[Node] | None:
    """Steps of a body that are done one after the other and have no names; None for any other."""
    found = []
    for one in body:
        if one.kind in _READERS and not one.name:
            found.append(one)
        elif one.kind == "SuccessionAsUsage" and len(_named_ends(one)) == 0:
            continue
        elif not nodes.is_text(one) and "direction" not in one.attributes:
            return None
    return found or None


def _named_ends(node: Node) -> list[Node]:
    return [one for one in nodes.ends_of(node) if one.relations]
