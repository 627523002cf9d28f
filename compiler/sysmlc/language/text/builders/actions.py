"""Action nodes (accept, send, assign, terminate, if, while, loop, for) and transitions.

SysML 8.2.2.17. Transitions have a source, trigger, guard, effect and target (SysML 8.2.2.17.8,
8.2.2.18.3).
"""

from sysmlc.language.text.builders.connections import End, Tail, apply_tail, make_connector_end
from sysmlc.language.text.builders.declarations import (
    Names,
    SpecializationPart,
    apply_names,
    apply_specializations,
    apply_value,
)
from sysmlc.language.text.builders.definitions import finish_usage
from sysmlc.language.text.builders.expressions import find_chain
from sysmlc.language.text.builders.nodes import FEATURE, OWNING, add_members, make_node
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation

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


# -- transitions -------------------------------------------------------------------------------

_TRANSITION_MEMBERSHIP = "TransitionFeatureMembership"
TransitionName = tuple[Names | None, list[SpecializationPart] | None]


def _mark_transition_part(node: Node, role: str) -> Node:
    node.membership, node.role = _TRANSITION_MEMBERSHIP, role
    return node


def _build_trigger_part(tokens: Tokens, stop: int, begin: int, accept: Tail) -> Node:
    return _mark_transition_part(
        apply_tail(
            make_node(accept.kind, _TRANSITION_MEMBERSHIP, tokens, begin, stop), accept, tokens
        ),
        "trigger",
    )


def _build_guard_part(_tokens: Tokens, _stop: int, _begin: int, condition: Node) -> Node:
    return _mark_transition_part(condition, "guard")


def _build_effect_part(tokens: Tokens, _stop: int, begin: int, effect: Node) -> Node:
    effect.start = tokens.starts[begin]
    return _mark_transition_part(effect, "effect")


def _build_empty_effect(tokens: Tokens, stop: int, begin: int, _none: None) -> Node:
    node = make_node("ActionUsage", FEATURE, tokens, begin, stop)
    return _mark_transition_part(node, "effect")


def _build_effect(
    tokens: Tokens,
    stop: int,
    begin: int,
    name: Reference,
    parts: list[SpecializationPart] | None,
    value: Node | None,
    body: list[Node] | None,
) -> Node:
    node = make_node("PerformActionUsage", FEATURE, tokens, begin, stop)
    node.relations.append(Relation("ReferenceSubsetting", name))
    return add_members(apply_value(apply_specializations(node, parts, tokens), value), body or [])


def _build_effect_declared(
    tokens: Tokens, stop: int, _begin: int, node: Node, body: list[Node] | None
) -> Node:
    node.kind = "PerformActionUsage"
    return finish_usage(node, tokens, stop, body or [])


def _build_effect_step(
    tokens: Tokens, stop: int, begin: int, tail: Tail, body: list[Node] | None
) -> Node:
    node = apply_tail(make_node(tail.kind, FEATURE, tokens, begin, stop), tail, tokens)
    return add_members(node, body or [])


def _build_effect_declared_step(
    tokens: Tokens, stop: int, _begin: int, node: Node, tail: Tail, body: list[Node] | None
) -> Node:
    return finish_usage(apply_tail(node, tail, tokens), tokens, stop, body or [])


def _make_succession(target: End, tokens: Tokens) -> Node:
    """Return the succession that a transition owns; its source end is empty."""
    node = make_node("SuccessionAsUsage", OWNING, tokens, target.begin, target.stop)
    node.add_member(
        make_node("ReferenceUsage", "EndFeatureMembership", tokens, target.begin, target.stop)
    )
    node.add_member(make_connector_end(target, tokens))
    return node


def _build_absent_transition_name(
    _tokens: Tokens, _stop: int, _begin: int, _none: None
) -> TransitionName:
    return None, None


def _build_transition_name(
    tokens: Tokens, _stop: int, _begin: int, name: int, parts: list[SpecializationPart] | None
) -> TransitionName:
    return Names(None, tokens.read_name(name), name), parts


def _build_transition_short_name(
    _tokens: Tokens, _stop: int, _begin: int, names: Names, parts: list[SpecializationPart] | None
) -> TransitionName:
    return names, parts


def _build_nameless(
    _tokens: Tokens, _stop: int, _begin: int, parts: list[SpecializationPart]
) -> TransitionName:
    return None, parts


def _make_transition(tokens: Tokens, begin: int, stop: int) -> Node:
    node = make_node("TransitionUsage", FEATURE, tokens, begin, stop)
    tokens.restricted_nodes.append(node)
    return node


def _build_transition(
    tokens: Tokens,
    stop: int,
    begin: int,
    name: TransitionName | None,
    source: Reference,
    parts: list[Node] | None,
    target: End,
    body: list[Node],
) -> Node:
    node = _make_transition(tokens, begin, stop)
    if name is not None:
        apply_specializations(apply_names(node, name[0], tokens), name[1], tokens)
    node.relations.append(Relation("Membership", source))
    return _add_parts(node, tokens, parts or [], target, body)


def _add_parts(
    node: Node, tokens: Tokens, parts: list[Node], target: End, body: list[Node]
) -> Node:
    node.add_member(make_parameter(None, node.start))
    # The first parameter is the source, the second one the payload of the trigger (8.2.2.18.3).
    if any(part.role == "trigger" for part in parts):
        node.add_member(make_parameter(None, node.start))
    for part in parts:
        node.add_member(part)
    node.add_member(_make_succession(target, tokens))
    return add_members(node, body)


def _build_target_transition(
    tokens: Tokens, stop: int, begin: int, parts: list[Node] | None, target: End, body: list[Node]
) -> Node:
    """Build a transition whose source is the member before it."""
    node = _make_transition(tokens, begin, stop)
    # `if g then s` is a guarded succession, which has no transition parameters.
    if parts and len(parts) == 1 and parts[0].role == "guard" and tokens[begin] == "if":
        node.add_member(parts[0])
        node.add_member(_make_succession(target, tokens))
        return add_members(node, body)
    return _add_parts(node, tokens, parts or [], target, body)


def _build_else_transition(
    tokens: Tokens, stop: int, begin: int, target: End, body: list[Node]
) -> Node:
    node = _make_transition(tokens, begin, stop)
    node.add_member(_make_succession(target, tokens))
    return add_members(node, body)


def _build_first_if_then(
    tokens: Tokens, _stop: int, _begin: int, source: End, guard: Node, target: End
) -> Tail:
    members = [_mark_transition_part(guard, "guard"), _make_succession(target, tokens)]
    return Tail("TransitionUsage", "first", members, [Relation("Membership", source.reference)])


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
    "trigger_part": _build_trigger_part,
    "guard_part": _build_guard_part,
    "effect_part": _build_effect_part,
    "effect_empty": _build_empty_effect,
    "effect": _build_effect,
    "effect_declared": _build_effect_declared,
    "effect_step": _build_effect_step,
    "effect_declared_step": _build_effect_declared_step,
    "transition_unnamed": _build_absent_transition_name,
    "transition_named": _build_transition_name,
    "transition_named_short": _build_transition_short_name,
    "transition_nameless": _build_nameless,
    "transition": _build_transition,
    "target_transition": _build_target_transition,
    "else_transition": _build_else_transition,
    "first_if_then": _build_first_if_then,
}
