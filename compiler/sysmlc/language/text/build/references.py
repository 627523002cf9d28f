"""Usages that refer to another one or declare it: perform, satisfy, entry ... (SysML 8.2.2)."""

from sysmlc.language.text.build.actions import parameter
from sysmlc.language.text.build.connections import Tail, apply
from sysmlc.language.text.build.definitions import whole
from sysmlc.language.text.build.features import Part, give, specialize
from sysmlc.language.text.build.owning import FEATURE, made
from sysmlc.language.text.build.usages import Prefix, prefix
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference, Relation

_SUBACTION = "StateSubactionMembership"
_REFERRERS = {
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


def _asserted(tokens: Tokens, at: int, _begin: int, *words: int) -> tuple[str, bool]:
    written = [tokens[word] for word in words]
    return ("satisfy" if "satisfy" in written else "assert", "not" in written)


def _usage(
    tokens: Tokens, at: int, begin: int, referrer: int | tuple[str, bool], node: Node | None
) -> Node:
    word, negated = (tokens[referrer], False) if isinstance(referrer, int) else referrer
    kind, membership, role = _REFERRERS[word]
    if node is None:
        node = made(kind, membership, tokens, begin, at)
    node.kind, node.membership, node.role = kind, membership, role
    node.start = tokens.starts[begin]
    if membership != FEATURE:
        tokens.special.append(node)
    if negated:
        node.facts["isNegated"] = True
    return node


def _by(node: Node, subject: Reference | None) -> Node:
    if subject is not None:
        value = Node("FeatureReferenceExpression", start=subject.start, end=subject.end)
        value.relations.append(Relation("Membership", subject))
        member = node.own(parameter(value, subject.start))
        member.membership = "SubjectMembership"
    return node


def _referring(
    tokens: Tokens,
    at: int,
    begin: int,
    referrer: int | tuple[str, bool],
    name: Reference,
    parts: list[Part] | None,
    value: Node | None,
    by: Reference | None,
    body: list[Node],
) -> Node:
    node = _usage(tokens, at, begin, referrer, None)
    node.relations.append(Relation("ReferenceSubsetting", name))
    give(specialize(node, parts, tokens), value)
    return whole(_by(node, by), tokens, at, body)


def _declared(
    tokens: Tokens,
    at: int,
    begin: int,
    referrer: int | tuple[str, bool],
    node: Node,
    by: Reference | None,
    body: list[Node],
) -> Node:
    return whole(_by(_usage(tokens, at, begin, referrer, node), by), tokens, at, body)


def _prefixed(
    tokens: Tokens,
    at: int,
    begin: int,
    referrer: int | tuple[str, bool],
    prefixes: list[Prefix],
    node: Node,
    by: Reference | None,
    body: list[Node],
) -> Node:
    prefix(tokens, begin, prefixes, node)
    return _declared(tokens, at, begin, referrer, node, by, body)


def _loose(
    tokens: Tokens,
    at: int,
    begin: int,
    referrer: int | tuple[str, bool],
    prefixes: list[Prefix],
    node: Node,
) -> Node:
    return _usage(tokens, at, begin, referrer, prefix(tokens, begin, prefixes, node))


def _step(
    tokens: Tokens,
    at: int,
    begin: int,
    referrer: int | tuple[str, bool],
    *given: Node | Tail | list[Node],
) -> Node:
    declared = given[0] if isinstance(given[0], Node) else None
    node = _usage(tokens, at, begin, referrer, declared)
    tail, body = given[-2:]
    if isinstance(tail, Tail):
        apply(node, tail, tokens)
    return whole(node, tokens, at, body if isinstance(body, list) else [])


def _nothing(tokens: Tokens, at: int, begin: int, referrer: int | tuple[str, bool]) -> Node:
    node = _usage(tokens, at, begin, referrer, None)
    if node.membership == _SUBACTION:
        node.kind = "ActionUsage"
    return node


ACTIONS = {
    "asserted": _asserted,
    "referring": _referring,
    "referring_declared": _declared,
    "referring_prefixed": _prefixed,
    "referring_loose": _loose,
    "referring_step": _step,
    "referring_declared_step": _step,
    "referring_nothing": _nothing,
}
