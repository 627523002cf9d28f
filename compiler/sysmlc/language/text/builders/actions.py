"""Action nodes (accept, send, assign, terminate, if, while, loop, for) and transitions.

SysML 8.2.2.17. Transitions have a source, trigger, guard, effect and target (SysML 8.2.2.17.8,
8.2.2.18.3).
"""

from functools import partial

from sysmlc.language.text.builders.connections import (
    End,
    Tail,
    apply_tail,
    build_usage_with_tail,
    make_end,
)
from sysmlc.language.text.builders.declarations import (
    Names,
    Parts,
    apply_names,
    complete_element,
    make_element,
)
from sysmlc.language.text.builders.definitions import finish_usage
from sysmlc.language.text.builders.expressions import find_chain
from sysmlc.language.text.builders.nodes import (
    FEATURE,
    OWNING,
    PARAMETER,
    add_members,
    make_node,
    omit_first,
)
from sysmlc.language.text.builders.operators import make_argument
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation


def make_parameter(value: Node | None, start: int = -1) -> Node:
    """Return a parameter of an action node, bound to a value, or an empty one at ``start``."""
    if value is None:
        return Node("ReferenceUsage", membership=PARAMETER, start=start, end=start)
    node = Node("ReferenceUsage", membership=PARAMETER, start=value.start, end=value.end)
    value.membership, value.role = "FeatureValue", "="
    node.add_member(value)
    return node


def _build_accept(
    tokens: Tokens, payload: Node | None, trigger: Node | None, via: Node | None
) -> Tail:
    if payload is None:
        begin = tokens.begin + 1
        span = (begin, max(tokens.stop, begin + 1))
        payload = make_node("ReferenceUsage", PARAMETER, tokens, span)
    if trigger is not None:
        _take_payload_name(payload)
        payload.add_member(trigger)
    members = [payload] if via is None else [payload, make_parameter(via)]
    return Tail("AcceptActionUsage", "step", members)


def _take_payload_name(payload: Node) -> None:
    """Take the only name before a trigger as name of the payload, not as type (8.2.2.17.4)."""
    for relation in payload.relations[:1]:
        chain, start = relation.reference.chain, relation.reference.start
        if payload.name is None and start == payload.start and len(chain[0]) == len(chain) == 1:
            payload.name = chain[0][0]
            payload.name_start = start
            payload.relations.pop(0)


def _build_trigger(tokens: Tokens, keyword: int, value: Node) -> Node:
    node = make_node("TriggerInvocationExpression", "FeatureValue", tokens)
    node.role = "="
    node.attributes["kind"] = tokens[keyword]
    value.membership = PARAMETER
    # A change condition is evaluated again and again, so it is passed as an expression.
    if tokens[keyword] == "when":
        value.role = "expression"
    node.add_member(value)
    return node


def _build_send(tokens: Tokens, item: Node | None, via: Node | None, to: Node | None) -> Tail:
    arguments = [item, via, to]
    # Parameters are positional, so only absent ones at the end may be omitted.
    while arguments and arguments[-1] is None:
        arguments.pop()
    start = tokens.ends[tokens.begin]
    return Tail("SendActionUsage", "step", [make_parameter(value, start) for value in arguments])


def _build_assign(tokens: Tokens, target: Node, value: Node) -> Tail:
    tail = Tail("AssignmentActionUsage", "step", [make_parameter(None, tokens.ends[tokens.begin])])
    if target.kind == "FeatureChainExpression":
        tail.relations = [target.relations[0]]
        tail.members = [make_parameter(target.members[0], target.start)]
    elif (reference := find_chain(target)) is not None:
        tail.relations = [Relation("Membership", reference)]
    else:
        tail.members = [make_parameter(target)]
    tail.members.append(make_parameter(value))
    return tail


def _build_terminate(_tokens: Tokens, value: Node | None) -> Tail:
    members = [] if value is None else [make_parameter(value)]
    return Tail("TerminateActionUsage", "step", members)


def _build_block(tokens: Tokens, names: Names | None, parts: Parts, body: list[Node]) -> Node:
    return add_members(make_element("ActionUsage", PARAMETER, tokens, names, parts), body)


def _build_if(tokens: Tokens, condition: Node, *branches: Node | Tail) -> Tail:
    members = [make_argument(condition)]
    for branch in branches:
        if isinstance(branch, Tail):
            nested_if = make_node(branch.kind, PARAMETER, tokens)
            for member in branch.members:
                nested_if.add_member(member)
            nested_if.start = nested_if.name_start = branch.members[0].start
            members.append(nested_if)
        else:
            members.append(branch)
    return Tail("IfActionUsage", "step", members)


def _build_while(_tokens: Tokens, condition: Node, body: Node, *until: Node) -> Tail:
    members = [make_argument(condition), body, *map(make_argument, until)]
    return Tail("WhileLoopActionUsage", "step", members)


def _build_loop(tokens: Tokens, body: Node, *until: Node) -> Tail:
    members = [make_parameter(None, tokens.ends[tokens.begin]), body]
    return Tail("WhileLoopActionUsage", "step", [*members, *map(make_argument, until)])


def _build_for(tokens: Tokens, names: Names, parts: Parts, value: Node, body: Node) -> Tail:
    variable = make_node("ReferenceUsage", FEATURE, tokens, (tokens.begin + 1, tokens.begin + 2))
    complete_element(apply_names(variable, names, tokens), tokens, parts, None)
    return Tail("ForLoopActionUsage", "step", [variable, make_parameter(value), body])


# -- transitions -------------------------------------------------------------------------------


def _mark_transition_part(role: str, _tokens: Tokens, node: Node) -> Node:
    node.membership, node.role = "TransitionFeatureMembership", role
    return node


def _build_trigger_part(tokens: Tokens, accept: Tail) -> Node:
    node = apply_tail(make_node(accept.kind, "", tokens), accept, tokens)
    return _mark_transition_part("trigger", tokens, node)


def _build_effect_part(tokens: Tokens, effect: Node | None = None) -> Node:
    effect = effect or make_node("ActionUsage", FEATURE, tokens)
    effect.start = tokens.starts[tokens.begin]
    return _mark_transition_part("effect", tokens, effect)


def _build_effect(
    tokens: Tokens, name: Reference, parts: Parts, value: Node | None, body: list[Node] | None
) -> Node:
    parts = [Relation("ReferenceSubsetting", name), *(parts or ())]
    node = make_element("PerformActionUsage", FEATURE, tokens, None, parts, value)
    return add_members(node, body or [])


def _build_effect_declared(tokens: Tokens, node: Node, body: list[Node] | None) -> Node:
    node.kind = "PerformActionUsage"
    return finish_usage(tokens, node, body)


def _build_effect_step(tokens: Tokens, tail: Tail, body: list[Node] | None) -> Node:
    return build_usage_with_tail(tokens, make_node(tail.kind, FEATURE, tokens), tail, body)


def _make_succession(target: End, tokens: Tokens) -> Node:
    """Return the succession that a transition owns; its source end is empty."""
    node = make_node("SuccessionAsUsage", OWNING, tokens, target.span)
    node.add_member(make_node("ReferenceUsage", "EndFeatureMembership", tokens, target.span))
    node.add_member(make_end("ReferenceUsage", target, tokens))
    return node


def _make_transition(tokens: Tokens) -> Node:
    node = make_node("TransitionUsage", FEATURE, tokens)
    tokens.restricted_nodes.append(node)
    return node


def _build_transition(
    tokens: Tokens,
    heading: tuple[Names | None, Parts] | None,
    source: Reference,
    parts: list[Node] | None,
    target: End,
    body: list[Node],
) -> Node:
    node = _make_transition(tokens)
    if heading is not None:
        complete_element(apply_names(node, heading[0], tokens), tokens, heading[1], None)
    node.relations.append(Relation("Membership", source))
    return _add_parts(node, tokens, parts or [], target, body)


def _add_parts(
    node: Node, tokens: Tokens, parts: list[Node], target: End, body: list[Node]
) -> Node:
    node.add_member(make_parameter(None, node.start))
    # The first parameter is the source, the second one the payload of the trigger (8.2.2.18.3).
    if any(part.role == "trigger" for part in parts):
        node.add_member(make_parameter(None, node.start))
    for part in (*parts, _make_succession(target, tokens)):
        node.add_member(part)
    return add_members(node, body)


def _build_target_transition(
    tokens: Tokens, parts: list[Node] | None, target: End, body: list[Node]
) -> Node:
    """Build a transition whose source is the member before it."""
    # `if g then s` is a guarded succession, which has no transition parameters.
    if parts and len(parts) == 1 and parts[0].role == "guard" and tokens[tokens.begin] == "if":
        return _build_guarded(tokens, parts[0], target, body)
    return _add_parts(_make_transition(tokens), tokens, parts or [], target, body)


def _build_guarded(tokens: Tokens, guard: Node | None, target: End, body: list[Node]) -> Node:
    node = _make_transition(tokens)
    if guard is not None:
        node.add_member(guard)
    node.add_member(_make_succession(target, tokens))
    return add_members(node, body)


def _build_first_if_then(tokens: Tokens, source: End, guard: Node, target: End) -> Tail:
    members = [_mark_transition_part("guard", tokens, guard), _make_succession(target, tokens)]
    return Tail("TransitionUsage", "first", members, [Relation("Membership", source.reference)])


ACTIONS = {
    "accept": _build_accept,
    "trigger": _build_trigger,
    "send": _build_send,
    "assign": _build_assign,
    "terminate": _build_terminate,
    "block_action": omit_first(_build_block, 2),
    "named_block": _build_block,
    "if": _build_if,
    "while": _build_while,
    "loop": _build_loop,
    "for": _build_for,
    "trigger_part": _build_trigger_part,
    "guard_part": partial(_mark_transition_part, "guard"),
    "effect_part": _build_effect_part,
    "effect": _build_effect,
    "effect_declared": _build_effect_declared,
    "effect_step": _build_effect_step,
    "effect_declared_step": build_usage_with_tail,
    "transition": _build_transition,
    "target_transition": _build_target_transition,
    "else_transition": omit_first(_build_guarded),
    "first_if_then": _build_first_if_then,
}
