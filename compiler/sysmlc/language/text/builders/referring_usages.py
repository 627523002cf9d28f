"""Usages that either reference or declare a usage: perform, satisfy, entry ... (SysML 8.2.2)."""

from sysmlc.language.text.builders.actions import make_parameter
from sysmlc.language.text.builders.connections import Tail, apply_tail
from sysmlc.language.text.builders.declarations import (
    SpecializationPart,
    apply_specializations,
    apply_value,
)
from sysmlc.language.text.builders.definitions import finish_usage
from sysmlc.language.text.builders.nodes import FEATURE, make_node
from sysmlc.language.text.builders.usages import Prefix, apply_prefixes
from sysmlc.language.text.lexer import BuildFault, Tokens
from sysmlc.language.tree import Node, Reference, Relation

_SUBACTION = "StateSubactionMembership"
_REFERRING_KINDS = {
    "perform": ("PerformActionUsage", FEATURE, ""),
    "exhibit": ("ExhibitStateUsage", FEATURE, ""),
    "include": ("IncludeUseCaseUsage", FEATURE, ""),
    "event": ("EventOccurrenceUsage", FEATURE, ""),
    "assert": ("AssertConstraintUsage", FEATURE, ""),
    "satisfy": ("SatisfyRequirementUsage", FEATURE, ""),
    "assume": ("ConstraintUsage", "RequirementConstraintMembership", "assumption"),
    "require": ("ConstraintUsage", "RequirementConstraintMembership", "requirement"),
    "frame": ("ConcernUsage", "FramedConcernMembership", ""),
    "verify": ("RequirementUsage", "RequirementVerificationMembership", ""),
    "render": ("RenderingUsage", "ViewRenderingMembership", ""),
    "entry": ("PerformActionUsage", _SUBACTION, "entry"),
    "do": ("PerformActionUsage", _SUBACTION, "do"),
    "exit": ("PerformActionUsage", _SUBACTION, "exit"),
}

_DECLARED_AS = {
    "perform": "action",
    "exhibit": "state",
    "include": "use case",
    "event": "occurrence",
    "assert": "constraint",
    "satisfy": "requirement",
    "assume": "constraint",
    "require": "constraint",
    "frame": "concern",
    "verify": "requirement",
    "render": "rendering",
    "entry": "action",
    "do": "action",
    "exit": "action",
}
"""The keyword that may stand between each of these words and the declaration of a new usage."""


def _build_assertion_keyword(
    tokens: Tokens, stop: int, _begin: int, *words: int
) -> tuple[str, bool]:
    texts = [tokens[word] for word in words]
    return ("satisfy" if "satisfy" in texts else "assert", "not" in texts)


def _make_usage(
    tokens: Tokens, stop: int, begin: int, referrer: int | tuple[str, bool], node: Node | None
) -> Node:
    word, is_negated = (tokens[referrer], False) if isinstance(referrer, int) else referrer
    kind, membership, role = _REFERRING_KINDS[word]
    if node is None:
        node = make_node(kind, membership, tokens, begin, stop)
    node.kind, node.membership, node.role = kind, membership, role
    node.start = tokens.starts[begin]
    if membership != FEATURE:
        tokens.restricted_nodes.append(node)
    if is_negated:
        node.attributes["isNegated"] = True
    return node


def _add_subject(node: Node, subject: Reference | None) -> Node:
    if subject is not None:
        value = Node("FeatureReferenceExpression", start=subject.start, end=subject.end)
        value.relations.append(Relation("Membership", subject))
        member = node.add_member(make_parameter(value, subject.start))
        member.membership = "SubjectMembership"
    return node


def _build_reference(
    tokens: Tokens,
    stop: int,
    begin: int,
    referrer: int | tuple[str, bool],
    name: Reference,
    parts: list[SpecializationPart] | None,
    value: Node | None,
    subject: Reference | None,
    body: list[Node],
) -> Node:
    node = _make_usage(tokens, stop, begin, referrer, None)
    node.relations.append(Relation("ReferenceSubsetting", name))
    apply_value(apply_specializations(node, parts, tokens), value)
    return finish_usage(_add_subject(node, subject), tokens, stop, body)


def _build_declaration(
    tokens: Tokens,
    stop: int,
    begin: int,
    referrer: int | tuple[str, bool],
    node: Node,
    subject: Reference | None,
    body: list[Node],
) -> Node:
    _check_keyword(tokens, referrer, node)
    return finish_usage(
        _add_subject(_make_usage(tokens, stop, begin, referrer, node), subject), tokens, stop, body
    )


def _check_keyword(tokens: Tokens, referrer: int | tuple[str, bool], node: Node) -> None:
    """Record a fault for a keyword that does not go with the word before it."""
    word = tokens[referrer] if isinstance(referrer, int) else referrer[0]
    keyword = _DECLARED_AS[word]
    if node.kind != f"{keyword.title().replace(' ', '')}Usage":
        text = f"'{word}' goes with '{keyword}', not with this declaration"
        advice = f"write '{word} {keyword}', or '{word}' before a name alone"
        tokens.build_faults.append(BuildFault("combination", node.start, text, advice))


def _build_prefixed(
    tokens: Tokens,
    stop: int,
    begin: int,
    referrer: int | tuple[str, bool],
    prefixes: list[Prefix],
    node: Node,
    subject: Reference | None,
    body: list[Node],
) -> Node:
    apply_prefixes(tokens, begin, prefixes, node)
    return _build_declaration(tokens, stop, begin, referrer, node, subject, body)


def _build_keywordless(
    tokens: Tokens,
    stop: int,
    begin: int,
    referrer: int | tuple[str, bool],
    prefixes: list[Prefix],
    node: Node,
) -> Node:
    return _make_usage(tokens, stop, begin, referrer, apply_prefixes(tokens, begin, prefixes, node))


def _build_step(
    tokens: Tokens,
    stop: int,
    begin: int,
    referrer: int | tuple[str, bool],
    *parts: Node | Tail | list[Node],
) -> Node:
    declared = parts[0] if isinstance(parts[0], Node) else None
    node = _make_usage(tokens, stop, begin, referrer, declared)
    tail, body = parts[-2:]
    if isinstance(tail, Tail):
        apply_tail(node, tail, tokens)
    return finish_usage(node, tokens, stop, body if isinstance(body, list) else [])


def _build_without_action(
    tokens: Tokens, stop: int, begin: int, referrer: int | tuple[str, bool]
) -> Node:
    node = _make_usage(tokens, stop, begin, referrer, None)
    # `entry;` owns an empty action and performs nothing.
    if node.membership == _SUBACTION:
        node.kind = "ActionUsage"
    return node


ACTIONS = {
    "asserted": _build_assertion_keyword,
    "referring": _build_reference,
    "referring_declared": _build_declaration,
    "referring_prefixed": _build_prefixed,
    "referring_loose": _build_keywordless,
    "referring_step": _build_step,
    "referring_declared_step": _build_step,
    "referring_nothing": _build_without_action,
}
