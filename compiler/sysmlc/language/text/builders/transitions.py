"""Transitions: source, trigger, guard, effect, target (SysML 8.2.2.17.8, 8.2.2.18.3)."""

from sysmlc.language.text.builders.actions import make_parameter
from sysmlc.language.text.builders.connections import End, Tail, apply_tail, make_connector_end
from sysmlc.language.text.builders.declarations import (
    Names,
    SpecializationPart,
    apply_names,
    apply_specializations,
    apply_value,
)
from sysmlc.language.text.builders.definitions import finish_usage
from sysmlc.language.text.builders.nodes import FEATURE, OWNING, add_members, make_node
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation

_MEMBERSHIP = "TransitionFeatureMembership"
TransitionName = tuple[Names | None, list[SpecializationPart] | None]


def _mark_part(node: Node, role: str) -> Node:
    node.membership, node.role = _MEMBERSHIP, role
    return node


def _build_trigger(tokens: Tokens, stop: int, begin: int, accept: Tail) -> Node:
    return _mark_part(
        apply_tail(make_node(accept.kind, _MEMBERSHIP, tokens, begin, stop), accept, tokens),
        "trigger",
    )


def _build_guard(_tokens: Tokens, _stop: int, _begin: int, condition: Node) -> Node:
    return _mark_part(condition, "guard")


def _build_effect_part(tokens: Tokens, _stop: int, begin: int, effect: Node) -> Node:
    effect.start = tokens.starts[begin]
    return _mark_part(effect, "effect")


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


def make_succession(target: End, tokens: Tokens) -> Node:
    """Return the succession that a transition owns; its source end is empty."""
    node = make_node("SuccessionAsUsage", OWNING, tokens, target.begin, target.stop)
    node.add_member(
        make_node("ReferenceUsage", "EndFeatureMembership", tokens, target.begin, target.stop)
    )
    node.add_member(make_connector_end(target, tokens))
    return node


def _build_absent_name(_tokens: Tokens, _stop: int, _begin: int, _none: None) -> TransitionName:
    return None, None


def _build_name(
    tokens: Tokens, _stop: int, _begin: int, name: int, parts: list[SpecializationPart] | None
) -> TransitionName:
    return Names(None, tokens.read_name(name), name), parts


def _build_short_name(
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
    node.add_member(make_succession(target, tokens))
    return add_members(node, body)


def _build_target_transition(
    tokens: Tokens, stop: int, begin: int, parts: list[Node] | None, target: End, body: list[Node]
) -> Node:
    """Build a transition whose source is the member before it."""
    node = _make_transition(tokens, begin, stop)
    # `if g then s` is a guarded succession, which has no transition parameters.
    if parts and len(parts) == 1 and parts[0].role == "guard" and tokens[begin] == "if":
        node.add_member(parts[0])
        node.add_member(make_succession(target, tokens))
        return add_members(node, body)
    return _add_parts(node, tokens, parts or [], target, body)


def _build_else_transition(
    tokens: Tokens, stop: int, begin: int, target: End, body: list[Node]
) -> Node:
    node = _make_transition(tokens, begin, stop)
    node.add_member(make_succession(target, tokens))
    return add_members(node, body)


def _build_first_if_then(
    tokens: Tokens, _stop: int, _begin: int, source: End, guard: Node, target: End
) -> Tail:
    members = [_mark_part(guard, "guard"), make_succession(target, tokens)]
    return Tail("TransitionUsage", "first", members, [Relation("Membership", source.reference)])


ACTIONS = {
    "trigger_part": _build_trigger,
    "guard_part": _build_guard,
    "effect_part": _build_effect_part,
    "effect": _build_effect,
    "effect_declared": _build_effect_declared,
    "effect_step": _build_effect_step,
    "effect_declared_step": _build_effect_declared_step,
    "transition_unnamed": _build_absent_name,
    "transition_named": _build_name,
    "transition_named_short": _build_short_name,
    "transition_nameless": _build_nameless,
    "transition": _build_transition,
    "target_transition": _build_target_transition,
    "else_transition": _build_else_transition,
    "first_if_then": _build_first_if_then,
}
