"""Transitions: source, trigger, guard, effect, target (SysML 8.2.2.17.8, 8.2.2.18.3)."""

from sysmlc.language.text.build.actions import parameter
from sysmlc.language.text.build.connections import Tail, apply
from sysmlc.language.text.build.definitions import whole
from sysmlc.language.text.build.ends import End, end_feature
from sysmlc.language.text.build.features import Part, give, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.owning import FEATURE, OWNING, made, own
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference, Relation

_PART = "TransitionFeatureMembership"
Name = tuple[Names | None, list[Part] | None]


def _part(node: Node, role: str) -> Node:
    node.membership, node.role = _PART, role
    return node


def _trigger(tokens: Tokens, at: int, begin: int, accept: Tail) -> Node:
    return _part(apply(made(accept.kind, _PART, tokens, begin, at), accept, tokens), "trigger")


def _guard(_tokens: Tokens, _at: int, _begin: int, condition: Node) -> Node:
    return _part(condition, "guard")


def _effect_part(tokens: Tokens, _at: int, begin: int, effect: Node) -> Node:
    effect.start = tokens.starts[begin]
    return _part(effect, "effect")


def _effect(
    tokens: Tokens,
    at: int,
    begin: int,
    name: Reference,
    parts: list[Part] | None,
    value: Node | None,
    body: list[Node] | None,
) -> Node:
    node = made("PerformActionUsage", FEATURE, tokens, begin, at)
    node.relations.append(Relation("ReferenceSubsetting", name))
    return own(give(specialize(node, parts, tokens), value), body or [])


def _effect_declared(
    tokens: Tokens, at: int, _begin: int, node: Node, body: list[Node] | None
) -> Node:
    node.kind = "PerformActionUsage"
    return whole(node, tokens, at, body or [])


def _effect_step(tokens: Tokens, at: int, begin: int, tail: Tail, body: list[Node] | None) -> Node:
    node = apply(made(tail.kind, FEATURE, tokens, begin, at), tail, tokens)
    return own(node, body or [])


def _effect_declared_step(
    tokens: Tokens, at: int, _begin: int, node: Node, tail: Tail, body: list[Node] | None
) -> Node:
    return whole(apply(node, tail, tokens), tokens, at, body or [])


def succession(target: End, tokens: Tokens) -> Node:
    """The succession that a transition owns; its source end is empty."""
    node = made("SuccessionAsUsage", OWNING, tokens, target.begin, target.at)
    node.own(made("ReferenceUsage", "EndFeatureMembership", tokens, target.begin, target.at))
    node.own(end_feature(target, tokens))
    return node


def _unnamed(_tokens: Tokens, _at: int, _begin: int, _none: None) -> Name:
    return None, None


def _named(tokens: Tokens, _at: int, _begin: int, name: int, parts: list[Part] | None) -> Name:
    return Names(None, tokens.name(name), name), parts


def _named_short(
    _tokens: Tokens, _at: int, _begin: int, names: Names, parts: list[Part] | None
) -> Name:
    return names, parts


def _nameless(_tokens: Tokens, _at: int, _begin: int, parts: list[Part]) -> Name:
    return None, parts


def _started(tokens: Tokens, begin: int, at: int) -> Node:
    node = made("TransitionUsage", FEATURE, tokens, begin, at)
    tokens.special.append(node)
    return node


def _transition(
    tokens: Tokens,
    at: int,
    begin: int,
    name: Name | None,
    source: Reference,
    parts: list[Node] | None,
    target: End,
    body: list[Node],
) -> Node:
    node = _started(tokens, begin, at)
    if name is not None:
        specialize(call(node, name[0], tokens), name[1], tokens)
    node.relations.append(Relation("Membership", source))
    return _with_parts(node, tokens, parts or [], target, body)


def _with_parts(
    node: Node, tokens: Tokens, parts: list[Node], target: End, body: list[Node]
) -> Node:
    node.own(parameter(None, node.start))
    if any(part.role == "trigger" for part in parts):
        node.own(parameter(None, node.start))
    for part in parts:
        node.own(part)
    node.own(succession(target, tokens))
    return own(node, body)


def _target_transition(
    tokens: Tokens, at: int, begin: int, parts: list[Node] | None, target: End, body: list[Node]
) -> Node:
    """A transition from what stands before it."""
    node = _started(tokens, begin, at)
    if parts and len(parts) == 1 and parts[0].role == "guard" and tokens[begin] == "if":
        node.own(parts[0])
        node.own(succession(target, tokens))
        return own(node, body)
    return _with_parts(node, tokens, parts or [], target, body)


def _else(tokens: Tokens, at: int, begin: int, target: End, body: list[Node]) -> Node:
    node = _started(tokens, begin, at)
    node.own(succession(target, tokens))
    return own(node, body)


def _first_if_then(
    tokens: Tokens, _at: int, _begin: int, source: End, guard: Node, target: End
) -> Tail:
    members = [_part(guard, "guard"), succession(target, tokens)]
    return Tail("TransitionUsage", "first", members, [Relation("Membership", source.reference)])


ACTIONS = {
    "trigger_part": _trigger,
    "guard_part": _guard,
    "effect_part": _effect_part,
    "effect": _effect,
    "effect_declared": _effect_declared,
    "effect_step": _effect_step,
    "effect_declared_step": _effect_declared_step,
    "transition_unnamed": _unnamed,
    "transition_named": _named,
    "transition_named_short": _named_short,
    "transition_nameless": _nameless,
    "transition": _transition,
    "target_transition": _target_transition,
    "else_transition": _else,
    "first_if_then": _first_if_then,
}
