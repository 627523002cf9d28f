"""Action nodes: accept, send, assign, terminate, if, while, loop, for (SysML 8.2.2.17)."""

from sysmlc.language.text.builders.connections import Tail
from sysmlc.language.text.builders.declarations import (
    Names,
    SpecializationPart,
    apply_names,
    apply_specializations,
)
from sysmlc.language.text.builders.expressions import find_chain
from sysmlc.language.text.builders.nodes import FEATURE, add_members, make_node
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Relation

PARAMETER = "ParameterMembership"


def make_parameter(value: Node | None, start: int) -> Node:
    """Return a parameter of an action node, bound to a value or empty."""
    end = start if value is None else value.end
    node = Node("ReferenceUsage", membership=PARAMETER, start=start, end=end)
    if value is not None:
        node.start = node.name_start = value.start
        value.membership, value.role = "FeatureValue", "="
        node.add_member(value)
    return node


def _build_accept(
    tokens: Tokens,
    stop: int,
    begin: int,
    payload: Node | None,
    trigger: Node | None,
    via: Node | None,
) -> Tail:
    if payload is None:
        payload = make_node("ReferenceUsage", PARAMETER, tokens, begin + 1, max(stop, begin + 2))
    if trigger is not None:
        _take_payload_name(payload)
        payload.add_member(trigger)
    members = [payload]
    if via is not None:
        members.append(make_parameter(via, via.start))
    return Tail("AcceptActionUsage", "step", members)


def _take_payload_name(payload: Node) -> None:
    """Take the only name before a trigger as name of the payload, not as type (8.2.2.17.4)."""
    for relation in payload.relations[:1]:
        chain, start = relation.reference.chain, relation.reference.start
        if payload.name is None and start == payload.start and len(chain[0]) == len(chain) == 1:
            payload.name = chain[0][0]
            payload.name_start = start
            payload.relations.pop(0)


def _build_trigger(tokens: Tokens, stop: int, begin: int, keyword: int, value: Node) -> Node:
    node = make_node("TriggerInvocationExpression", "FeatureValue", tokens, begin, stop)
    node.role = "="
    node.attributes["kind"] = tokens[keyword]
    value.membership = PARAMETER
    # A change condition is evaluated again and again, so it is passed as an expression.
    if tokens[keyword] == "when":
        value.role = "expression"
    node.add_member(value)
    return node


def _build_accept_step(_tokens: Tokens, _stop: int, _begin: int, accept: Tail) -> Tail:
    return accept


def _build_send(
    tokens: Tokens,
    _stop: int,
    begin: int,
    item: Node | None,
    via: Node | None,
    to: Node | None,
) -> Tail:
    arguments = [item, via, to]
    # Parameters are positional, so only absent ones at the end may be omitted.
    while arguments and arguments[-1] is None:
        arguments.pop()
    start = tokens.ends[begin]
    return Tail("SendActionUsage", "step", [make_parameter(value, start) for value in arguments])


def _build_assign(tokens: Tokens, _stop: int, begin: int, target: Node, value: Node) -> Tail:
    tail = Tail("AssignmentActionUsage", "step", [make_parameter(None, tokens.ends[begin])])
    if target.kind == "FeatureChainExpression":
        tail.relations = [target.relations[0]]
        tail.members = [make_parameter(target.members[0], target.start)]
    elif (reference := find_chain(target)) is not None:
        tail.relations = [Relation("Membership", reference)]
    else:
        tail.members = [make_parameter(target, target.start)]
    tail.members.append(make_parameter(value, value.start))
    return tail


def _build_terminate(_tokens: Tokens, _stop: int, _begin: int, value: Node | None) -> Tail:
    return Tail(
        "TerminateActionUsage",
        "step",
        [] if value is None else [make_parameter(value, value.start)],
    )


def _build_block(tokens: Tokens, stop: int, begin: int, body: list[Node]) -> Node:
    return add_members(make_node("ActionUsage", PARAMETER, tokens, begin, stop), body)


def _build_named_block(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    parts: list[SpecializationPart] | None,
    body: list[Node],
) -> Node:
    node = apply_names(make_node("ActionUsage", PARAMETER, tokens, begin, stop), names, tokens)
    return add_members(apply_specializations(node, parts, tokens), body)


def _mark_condition(value: Node) -> Node:
    value.membership = PARAMETER
    return value


def _build_if(
    tokens: Tokens, stop: int, begin: int, condition: Node, *branches: Node | Tail
) -> Tail:
    members = [_mark_condition(condition)]
    for branch in branches:
        if isinstance(branch, Tail):
            nested_if = make_node("IfActionUsage", PARAMETER, tokens, begin, stop)
            nested_if.kind = branch.kind
            for member in branch.members:
                nested_if.add_member(member)
            nested_if.start = nested_if.name_start = branch.members[0].start
            members.append(nested_if)
        else:
            members.append(branch)
    return Tail("IfActionUsage", "step", members)


def _build_while(_tokens: Tokens, _stop: int, _begin: int, *parts: Node) -> Tail:
    for expression in (parts[0], *parts[2:]):
        _mark_condition(expression)
    return Tail("WhileLoopActionUsage", "step", list(parts))


def _build_loop(
    tokens: Tokens, _stop: int, begin: int, body: Node, until: Node | None = None
) -> Tail:
    members = [make_parameter(None, tokens.ends[begin]), body]
    if until is not None:
        members.append(_mark_condition(until))
    return Tail("WhileLoopActionUsage", "step", members)


def _build_for(
    tokens: Tokens,
    _stop: int,
    begin: int,
    names: Names,
    parts: list[SpecializationPart] | None,
    value: Node,
    body: Node,
) -> Tail:
    variable = apply_names(
        make_node("ReferenceUsage", FEATURE, tokens, begin + 1, begin + 2), names, tokens
    )
    apply_specializations(variable, parts, tokens)
    return Tail("ForLoopActionUsage", "step", [variable, make_parameter(value, value.start), body])


ACTIONS = {
    "accept": _build_accept,
    "trigger": _build_trigger,
    "accept_step": _build_accept_step,
    "send": _build_send,
    "assign": _build_assign,
    "terminate": _build_terminate,
    "block_action": _build_block,
    "named_block": _build_named_block,
    "if_then": _build_if,
    "if_else": _build_if,
    "while": _build_while,
    "loop": _build_loop,
    "for": _build_for,
}
