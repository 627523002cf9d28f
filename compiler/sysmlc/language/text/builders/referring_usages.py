"""Usages that either reference or declare a usage: perform, satisfy, entry ... (SysML 8.2.2)."""

from sysmlc.language.text.builders.actions import make_parameter
from sysmlc.language.text.builders.connections import Tail, apply_tail
from sysmlc.language.text.builders.declarations import Parts, complete_element
from sysmlc.language.text.builders.definitions import (
    Keyword,
    finish_usage,
    join_words,
    read_keyword,
)
from sysmlc.language.text.builders.nodes import FEATURE, make_node
from sysmlc.language.text.builders.usages import Prefix, apply_prefixes
from sysmlc.language.text.lexer import BuildFault, Tokens
from sysmlc.language.tree import Node, Reference, Relation

_SUBACTION = "StateSubactionMembership"
_CONSTRAINT = "RequirementConstraintMembership"
_REFERRING_KINDS = {
    "perform": ("action", "PerformActionUsage", FEATURE, ""),
    "exhibit": ("state", "ExhibitStateUsage", FEATURE, ""),
    "include": ("use case", "IncludeUseCaseUsage", FEATURE, ""),
    "event": ("occurrence", "EventOccurrenceUsage", FEATURE, ""),
    "assert": ("constraint", "AssertConstraintUsage", FEATURE, ""),
    "satisfy": ("requirement", "SatisfyRequirementUsage", FEATURE, ""),
    "assume": ("constraint", "ConstraintUsage", _CONSTRAINT, "assumption"),
    "require": ("constraint", "ConstraintUsage", _CONSTRAINT, "requirement"),
    "frame": ("concern", "ConcernUsage", "FramedConcernMembership", ""),
    "verify": ("requirement", "RequirementUsage", "RequirementVerificationMembership", ""),
    "render": ("rendering", "RenderingUsage", "ViewRenderingMembership", ""),
    "entry": ("action", "PerformActionUsage", _SUBACTION, "entry"),
    "do": ("action", "PerformActionUsage", _SUBACTION, "do"),
    "exit": ("action", "PerformActionUsage", _SUBACTION, "exit"),
}
"""The keyword that may stand between each of these words and the declaration of a new usage, and
the metaclass, membership and role of the usage."""


def _read_referrer(tokens: Tokens, referrer: Keyword) -> tuple[str, bool]:
    """Return the word for the kind of the usage, and whether an assertion is negated."""
    words = read_keyword(tokens, referrer).split()
    return "satisfy" if "satisfy" in words else words[0], "not" in words


def _make_usage(tokens: Tokens, referrer: Keyword, node: Node | None) -> Node:
    word, is_negated = _read_referrer(tokens, referrer)
    _, kind, membership, role = _REFERRING_KINDS[word]
    if node is None:
        node = make_node(kind, membership, tokens)
    node.kind, node.membership, node.role = kind, membership, role
    node.start = tokens.starts[tokens.begin]
    if membership != FEATURE:
        tokens.restricted_nodes.append(node)
    if is_negated:
        node.attributes["isNegated"] = True
    return node


def _finish_usage(tokens: Tokens, node: Node, subject: Reference | None, body: list[Node]) -> Node:
    """Finish a usage, after the element that satisfies a requirement."""
    if subject is not None:
        value = Node("FeatureReferenceExpression", start=subject.start, end=subject.end)
        value.relations.append(Relation("Membership", subject))
        member = node.add_member(make_parameter(value, subject.start))
        member.membership = "SubjectMembership"
    return finish_usage(tokens, node, body)


def _build_reference(
    tokens: Tokens,
    referrer: Keyword,
    name: Reference,
    parts: Parts,
    value: Node | None,
    subject: Reference | None,
    body: list[Node],
) -> Node:
    node = _make_usage(tokens, referrer, None)
    node.relations.append(Relation("ReferenceSubsetting", name))
    return _finish_usage(tokens, complete_element(node, tokens, parts, value), subject, body)


def _build_declaration(
    tokens: Tokens, referrer: Keyword, node: Node, subject: Reference | None, body: list[Node]
) -> Node:
    word = _read_referrer(tokens, referrer)[0]
    keyword = _REFERRING_KINDS[word][0]
    if node.kind != f"{keyword.title().replace(' ', '')}Usage":
        text = f"'{word}' goes with '{keyword}', not with this declaration"
        advice = f"write '{word} {keyword}', or '{word}' before a name alone"
        tokens.build_faults.append(BuildFault("combination", node.start, text, advice))
    return _finish_usage(tokens, _make_usage(tokens, referrer, node), subject, body)


def _build_prefixed(
    tokens: Tokens,
    referrer: Keyword,
    prefixes: list[Prefix],
    node: Node,
    subject: Reference | None,
    body: list[Node],
) -> Node:
    apply_prefixes(tokens, prefixes, node)
    return _build_declaration(tokens, referrer, node, subject, body)


def _build_keywordless(
    tokens: Tokens, referrer: Keyword, prefixes: list[Prefix], node: Node
) -> Node:
    return _make_usage(tokens, referrer, apply_prefixes(tokens, prefixes, node))


def _build_step(
    tokens: Tokens, referrer: Keyword, declared: Node | None, step: Tail, body: list[Node]
) -> Node:
    node = apply_tail(_make_usage(tokens, referrer, declared), step, tokens)
    return finish_usage(tokens, node, body)


def _build_without_action(tokens: Tokens, referrer: Keyword) -> Node:
    node = _make_usage(tokens, referrer, None)
    # `entry;` owns an empty action and performs nothing.
    if node.membership == _SUBACTION:
        node.kind = "ActionUsage"
    return node


ACTIONS = {
    "asserted": join_words,
    "referring": _build_reference,
    "referring_declared": _build_declaration,
    "referring_prefixed": _build_prefixed,
    "referring_loose": _build_keywordless,
    "referring_step": _build_step,
    "referring_nothing": _build_without_action,
}
