"""Connections, interfaces, bindings, successions, flows (SysML 8.2.2.13 to 8.2.2.16)."""

from dataclasses import dataclass, field

from sysmlc.language.text.build.definitions import USAGES, Keyword, whole
from sysmlc.language.text.build.ends import End, maker
from sysmlc.language.text.build.features import Part, give, multiplicity, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.owning import FEATURE, made
from sysmlc.language.text.scan import Remark, Tokens
from sysmlc.language.tree import Node, Reference, Relation

Rest = End | list[End] | list[Node]
"""What follows the keyword of a connector: ends, one by one or as a list, and its body."""


@dataclass(slots=True)
class Tail:
    """What follows the declaration of a usage and decides what it is.

    ``kind`` is empty where the keyword says it; ``ends`` become features as that kind has them.
    """

    kind: str = ""
    word: str = ""
    members: list[Node] = field(default_factory=list)
    relations: list[Relation] = field(default_factory=list)
    ends: list[End] = field(default_factory=list)


def apply(node: Node, tail: Tail, tokens: Tokens) -> Node:
    """Make the usage what its tail says."""
    if tail.word and node.kind != tail.kind and node.kind not in _TAKEN[tail.word]:
        _remark(node, tail, tokens)
    node.kind = tail.kind or node.kind
    node.relations += tail.relations
    for member in tail.members:
        node.own(member)
    make = maker(node)
    for end in tail.ends:
        node.own(make(end, tokens))
    return node


_TAKEN = {
    "connect": ("ConnectionUsage", "InterfaceUsage"),
    "allocate": ("AllocationUsage",),
    "bind": ("BindingConnectorAsUsage",),
    "first": ("SuccessionAsUsage", "TransitionUsage"),
    "of": ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow"),
    "from": ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow", "Connector"),
    "then": ("Succession",),
    "step": ("ActionUsage", "PerformActionUsage"),
}
"""Words of tails, and the kinds of usages that they go with."""
_OWNERS = {
    "connect": "connections and interfaces",
    "allocate": "allocations",
    "bind": "bindings",
    "first": "successions",
    "of": "flows and messages",
    "from": "flows and messages",
    "then": "successions",
    "step": "actions",
}


def _remark(node: Node, tail: Tail, tokens: Tokens) -> None:
    words = "what an action does" if tail.word == "step" else f"'{tail.word}'"
    text = f"{words} goes with {_OWNERS[tail.word]}, not with this declaration"
    keyword = _OWNERS[tail.word].split(" and ")[0].removesuffix("s")
    advice = f"declare it as {keyword}, or make two declarations of it"
    tokens.remarks.append(Remark("combination", node.start, text, advice))


def _connect(_tokens: Tokens, _at: int, _begin: int, ends: list[End]) -> Tail:
    return Tail("", "connect", ends=ends)


def _allocate(_tokens: Tokens, _at: int, _begin: int, ends: list[End]) -> Tail:
    return Tail("AllocationUsage", "allocate", ends=ends)


def _bind(_tokens: Tokens, _at: int, _begin: int, left: End, right: End) -> Tail:
    return Tail("BindingConnectorAsUsage", "bind", ends=[left, right])


def _first_then(_tokens: Tokens, _at: int, _begin: int, source: End, target: End) -> Tail:
    return Tail("SuccessionAsUsage", "first", ends=[source, target])


def _first_only(_tokens: Tokens, _at: int, _begin: int, end: End) -> Tail:
    return Tail("Membership", "first", relations=[Relation("Membership", end.reference)])


def _flow_of(_tokens: Tokens, _at: int, _begin: int, payload: Node) -> Tail:
    payload.membership = FEATURE
    payload.kind = "PayloadFeature"
    return Tail("", "of", [payload])


def _flow_of_between(
    tokens: Tokens, at: int, begin: int, payload: Node, source: End, target: End
) -> Tail:
    tail = _flow_of(tokens, at, begin, payload)
    tail.ends = [source, target]
    return tail


def _flow_between(_tokens: Tokens, _at: int, _begin: int, source: End, target: End) -> Tail:
    return Tail("", "from", ends=[source, target])


def payload(
    tokens: Tokens,
    at: int,
    begin: int,
    reference: Reference,
    parts: list[Part] | None,
    value: Node | None,
) -> Node:
    """What a flow carries or an action accepts: a name with its type, or only the type."""
    node = made("ReferenceUsage", "ParameterMembership", tokens, begin, at)
    is_name = len(reference.chain) == 1 and len(reference.chain[0]) == 1
    is_typed = any(isinstance(part, Relation) for part in parts or ())
    if is_name and (is_typed or value is not None):
        node.name = reference.chain[0][0]
    else:
        node.relations.append(Relation("FeatureTyping", reference))
    return give(specialize(node, parts, tokens), value)


def _payload_short(
    tokens: Tokens, at: int, begin: int, names: Names, parts: list[Part] | None, value: Node | None
) -> Node:
    node = call(made("ReferenceUsage", "ParameterMembership", tokens, begin, at), names, tokens)
    return give(specialize(node, parts, tokens), value)


def _payload_nameless(
    tokens: Tokens, at: int, begin: int, parts: list[Part], value: Node | None
) -> Node:
    node = made("ReferenceUsage", "ParameterMembership", tokens, begin, at)
    return give(specialize(node, parts, tokens), value)


def _payload_many(tokens: Tokens, at: int, begin: int, bounds: Node, reference: Reference) -> Node:
    node = made("ReferenceUsage", "ParameterMembership", tokens, begin, at)
    node.relations.append(Relation("FeatureTyping", reference))
    node.own(multiplicity(bounds, tokens, begin, at))
    return node


def _usage_tail(
    tokens: Tokens, at: int, _begin: int, node: Node, tail: Tail, body: list[Node] | None = None
) -> Node:
    return whole(apply(node, tail, tokens), tokens, at, body or [])


_BARE = {"of": "FlowUsage", "from": "FlowUsage"}


def tail_usage(
    tokens: Tokens, at: int, begin: int, tail: Tail, body: list[Node] | None = None
) -> Node:
    """A usage without a declaration of its own."""
    kind = tail.kind or _BARE.get(tail.word, "ConnectionUsage")
    membership = "" if kind == "Membership" else FEATURE
    node = apply(made(kind, membership, tokens, begin, at), tail, tokens)
    if kind.endswith("ActionUsage") or kind == "Membership":
        tokens.special.append(node)
    return whole(node, tokens, at, body or [])


def _usage_ends(tokens: Tokens, at: int, begin: int, keyword: Keyword, *rest: Rest) -> Node:
    word = keyword if isinstance(keyword, str) else tokens[keyword]
    kind, membership = USAGES[word]
    node = made(kind, membership, tokens, begin, at)
    if word == "message":
        node.facts["isAbstract"] = True
    ends, body = parted(rest)
    return whole(apply(node, Tail(ends=ends), tokens), tokens, at, body)


def parted(rest: tuple[Rest, ...]) -> tuple[list[End], list[Node]]:
    """The ends, one by one or as lists, and the body, if there is one."""
    ends: list[End] = []
    body: list[Node] = []
    for one in rest:
        for part in [one] if isinstance(one, End) else one:
            if isinstance(part, End):
                ends.append(part)
            else:
                body.append(part)
    return ends, body


def _usage_named_end(
    tokens: Tokens, at: int, begin: int, node: Node, end: End, body: list[Node]
) -> Node:
    """``interface a ::> x to y``: what was read as declaration is the first end."""
    if not node.relations:
        return _usage_tail(tokens, at, begin, node, Tail(ends=[end]), body)
    first = End(None, node.name, node.relations.pop().reference, begin + 1, end.begin - 1)
    node.name = None
    node.name_start = node.start
    return _usage_tail(tokens, at, begin, node, Tail(ends=[first, end]), body)


ACTIONS = {
    "connect": _connect,
    "allocate": _allocate,
    "bind": _bind,
    "first_then": _first_then,
    "first_only": _first_only,
    "flow_of": _flow_of,
    "flow_of_between": _flow_of_between,
    "flow_between": _flow_between,
    "payload": payload,
    "payload_short": _payload_short,
    "payload_nameless": _payload_nameless,
    "payload_many": _payload_many,
    "usage_tail": _usage_tail,
    "tail_usage": tail_usage,
    "usage_ends": _usage_ends,
    "usage_many_ends": _usage_ends,
    "usage_named_end": _usage_named_end,
}
