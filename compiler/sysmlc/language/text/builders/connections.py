"""Connections, interfaces, bindings, successions and flows (SysML 8.2.2.13 to 8.2.2.16)."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

from sysmlc.language.text.builders.declarations import (
    Names,
    SpecializationPart,
    apply_names,
    apply_specializations,
    apply_value,
    make_multiplicity,
)
from sysmlc.language.text.builders.definitions import USAGE_KINDS, Keyword, finish_usage
from sysmlc.language.text.builders.nodes import FEATURE, OWNING, make_node
from sysmlc.language.text.lexer import BuildFault, Tokens
from sysmlc.language.tree import Node, Reference, Relation

_END = "EndFeatureMembership"
_KINDS_BY_WORD = {
    "connect": ("ConnectionUsage", "InterfaceUsage"),
    "allocate": ("AllocationUsage",),
    "bind": ("BindingConnectorAsUsage",),
    "first": ("SuccessionAsUsage", "TransitionUsage"),
    "of": ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow"),
    "from": ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow", "Connector"),
    "then": ("Succession",),
    "step": ("ActionUsage", "PerformActionUsage"),
}
"""Words that begin a tail, and the kinds of usages that may have it."""


class End(NamedTuple):
    """An end as it is written: its multiplicity, its name, the referenced feature, its tokens."""

    bounds: Node | None
    name: str | None
    reference: Reference
    begin: int
    stop: int


def make_connector_end(end: End, tokens: Tokens) -> Node:
    """Return the end feature of a connector (8.2.2.13.1)."""
    return _make_end("ReferenceUsage", end, tokens)


def _make_interface_end(end: End, tokens: Tokens) -> Node:
    return _make_end("PortUsage", end, tokens)


def _make_end(kind: str, end: End, tokens: Tokens) -> Node:
    node = make_node(kind, _END, tokens, end.begin, end.stop)
    node.name = end.name
    if end.bounds is not None:
        cross = node.add_member(make_node("Feature", OWNING, tokens, end.begin, end.stop))
        cross.add_member(make_multiplicity(end.bounds, tokens, end.begin, end.stop))
    node.relations.append(Relation("ReferenceSubsetting", end.reference))
    return node


def _make_flow_end(end: End, tokens: Tokens) -> Node:
    """Return the end of a flow: it references the chain without its last feature (8.2.2.16)."""
    node = make_node("FlowEnd", _END, tokens, end.begin, end.stop)
    chain, start, end_offset = end.reference.chain, end.reference.start, end.reference.end
    if len(chain) > 1:
        node.relations.append(
            Relation(
                "ReferenceSubsetting", Reference(chain[:-1], start, tokens.starts[end.stop - 1])
            )
        )
        start = tokens.starts[end.stop - 1]
    feature = node.add_member(make_node("ReferenceUsage", FEATURE, tokens, end.begin, end.stop))
    feature.relations.append(Relation("Redefinition", Reference(chain[-1:], start, end_offset)))
    return node


def _make_message_end(end: End, tokens: Tokens) -> Node:
    node = make_node("EventOccurrenceUsage", "ParameterMembership", tokens, end.begin, end.stop)
    node.relations.append(Relation("ReferenceSubsetting", end.reference))
    return node


def _make_kernel_end(end: End, tokens: Tokens) -> Node:
    return _make_end("Feature", end, tokens)


def _make_kernel_flow_end(end: End, tokens: Tokens) -> Node:
    node = _make_flow_end(end, tokens)
    node.members[0].kind = "Feature"
    return node


_END_MAKERS: dict[str, Callable[[End, Tokens], Node]] = {
    "Connector": _make_kernel_end,
    "BindingConnector": _make_kernel_end,
    "Succession": _make_kernel_end,
    "Flow": _make_kernel_flow_end,
    "SuccessionFlow": _make_kernel_flow_end,
    "InterfaceUsage": _make_interface_end,
    "FlowUsage": _make_flow_end,
    "SuccessionFlowUsage": _make_flow_end,
}


def _find_end_maker(node: Node) -> Callable[[End, Tokens], Node]:
    """Return the function that makes the ends of a usage; a message is an abstract flow."""
    make = _END_MAKERS.get(node.kind, make_connector_end)
    return _make_message_end if make is _make_flow_end and "isAbstract" in node.attributes else make


def _build_end(
    tokens: Tokens, stop: int, begin: int, bounds: Node | None, reference: Reference
) -> End:
    return End(bounds, None, reference, begin, stop)


def _build_named_end(
    tokens: Tokens, stop: int, begin: int, bounds: Node | None, name: int, reference: Reference
) -> End:
    return End(bounds, tokens.read_name(name), reference, begin, stop)


def _build_two_ends(_tokens: Tokens, _stop: int, _begin: int, first: End, second: End) -> list[End]:
    return [first, second]


def _build_ends(_tokens: Tokens, _stop: int, _begin: int, first: End, rest: list[End]) -> list[End]:
    return [first, *rest]


ConnectorPart = End | list[End] | list[Node]
"""A part of a connector after its keyword: an end, a list of ends, or its body."""


@dataclass(slots=True)
class Tail:
    """The part of a usage after its declaration that decides what the usage is.

    ``kind`` is empty if the keyword decides it. ``word`` is the word that begins the tail. ``ends``
    become features when the kind is known.
    """

    kind: str = ""
    word: str = ""
    members: list[Node] = field(default_factory=list)
    relations: list[Relation] = field(default_factory=list)
    ends: list[End] = field(default_factory=list)


def apply_tail(node: Node, tail: Tail, tokens: Tokens) -> Node:
    """Set the kind and the ends of a usage according to its tail, and return the usage."""
    if tail.word and node.kind != tail.kind and node.kind not in _KINDS_BY_WORD[tail.word]:
        _report_misplaced_tail(node, tail, tokens)
    node.kind = tail.kind or node.kind
    node.relations += tail.relations
    for member in tail.members:
        node.add_member(member)
    make = _find_end_maker(node)
    for end in tail.ends:
        node.add_member(make(end, tokens))
    return node


_DECLARATIONS_BY_WORD = {
    "connect": "connections and interfaces",
    "allocate": "allocations",
    "bind": "bindings",
    "first": "successions",
    "of": "flows and messages",
    "from": "flows and messages",
    "then": "successions",
    "step": "actions",
}


def _report_misplaced_tail(node: Node, tail: Tail, tokens: Tokens) -> None:
    subject = "what an action does" if tail.word == "step" else f"'{tail.word}'"
    text = f"{subject} goes with {_DECLARATIONS_BY_WORD[tail.word]}, not with this declaration"
    keyword = _DECLARATIONS_BY_WORD[tail.word].split(" and ")[0].removesuffix("s")
    advice = f"declare it as {keyword}, or make two declarations of it"
    tokens.build_faults.append(BuildFault("combination", node.start, text, advice))


def _build_connect(_tokens: Tokens, _stop: int, _begin: int, ends: list[End]) -> Tail:
    return Tail("", "connect", ends=ends)


def _build_allocate(_tokens: Tokens, _stop: int, _begin: int, ends: list[End]) -> Tail:
    return Tail("AllocationUsage", "allocate", ends=ends)


def _build_bind(_tokens: Tokens, _stop: int, _begin: int, left: End, right: End) -> Tail:
    return Tail("BindingConnectorAsUsage", "bind", ends=[left, right])


def _build_first_then(_tokens: Tokens, _stop: int, _begin: int, source: End, target: End) -> Tail:
    return Tail("SuccessionAsUsage", "first", ends=[source, target])


def _build_first_only(_tokens: Tokens, _stop: int, _begin: int, end: End) -> Tail:
    return Tail("Membership", "first", relations=[Relation("Membership", end.reference)])


def _build_flow_of(_tokens: Tokens, _stop: int, _begin: int, payload: Node) -> Tail:
    payload.membership = FEATURE
    payload.kind = "PayloadFeature"
    return Tail("", "of", [payload])


def _build_flow_of_between(
    tokens: Tokens, stop: int, begin: int, payload: Node, source: End, target: End
) -> Tail:
    tail = _build_flow_of(tokens, stop, begin, payload)
    tail.ends = [source, target]
    return tail


def _build_flow_between(_tokens: Tokens, _stop: int, _begin: int, source: End, target: End) -> Tail:
    return Tail("", "from", ends=[source, target])


def _build_payload(
    tokens: Tokens,
    stop: int,
    begin: int,
    reference: Reference,
    parts: list[SpecializationPart] | None,
    value: Node | None,
) -> Node:
    """Build the payload of a flow or accept action: a name with its type, or only the type."""
    node = make_node("ReferenceUsage", "ParameterMembership", tokens, begin, stop)
    # `accept x : T` and `accept T` begin alike; one token of lookahead does not tell.
    is_name = len(reference.chain) == 1 and len(reference.chain[0]) == 1
    is_typed = any(isinstance(part, Relation) for part in parts or ())
    if is_name and (is_typed or value is not None):
        node.name = reference.chain[0][0]
    else:
        node.relations.append(Relation("FeatureTyping", reference))
    return apply_value(apply_specializations(node, parts, tokens), value)


def _build_payload_short(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names,
    parts: list[SpecializationPart] | None,
    value: Node | None,
) -> Node:
    node = apply_names(
        make_node("ReferenceUsage", "ParameterMembership", tokens, begin, stop), names, tokens
    )
    return apply_value(apply_specializations(node, parts, tokens), value)


def _build_payload_nameless(
    tokens: Tokens, stop: int, begin: int, parts: list[SpecializationPart], value: Node | None
) -> Node:
    node = make_node("ReferenceUsage", "ParameterMembership", tokens, begin, stop)
    return apply_value(apply_specializations(node, parts, tokens), value)


def _build_payload_many(
    tokens: Tokens, stop: int, begin: int, bounds: Node, reference: Reference
) -> Node:
    node = make_node("ReferenceUsage", "ParameterMembership", tokens, begin, stop)
    node.relations.append(Relation("FeatureTyping", reference))
    node.add_member(make_multiplicity(bounds, tokens, begin, stop))
    return node


def _build_usage_tail(
    tokens: Tokens, stop: int, _begin: int, node: Node, tail: Tail, body: list[Node] | None = None
) -> Node:
    return finish_usage(apply_tail(node, tail, tokens), tokens, stop, body or [])


_KINDS_WITHOUT_DECLARATION = {"of": "FlowUsage", "from": "FlowUsage"}


def _build_tail_usage(
    tokens: Tokens, stop: int, begin: int, tail: Tail, body: list[Node] | None = None
) -> Node:
    """Build a usage without a declaration."""
    kind = tail.kind or _KINDS_WITHOUT_DECLARATION.get(tail.word, "ConnectionUsage")
    membership = "" if kind == "Membership" else FEATURE
    node = apply_tail(make_node(kind, membership, tokens, begin, stop), tail, tokens)
    if tail.word in ("of", "from"):
        text = f"'{tail.word}' goes with flows and messages, not with a bare declaration"
        fault = BuildFault("combination", node.start, text, f"write 'flow {tail.word}'")
        tokens.build_faults.append(fault)
    if kind.endswith("ActionUsage") or kind == "Membership":
        tokens.restricted_nodes.append(node)
    return finish_usage(node, tokens, stop, body or [])


def _build_usage_ends(
    tokens: Tokens, stop: int, begin: int, keyword: Keyword, *rest: ConnectorPart
) -> Node:
    word = keyword if isinstance(keyword, str) else tokens[keyword]
    kind, membership = USAGE_KINDS[word]
    node = make_node(kind, membership, tokens, begin, stop)
    if word == "message":
        node.attributes["isAbstract"] = True
    ends, body = split_ends_and_body(rest)
    return finish_usage(apply_tail(node, Tail(ends=ends), tokens), tokens, stop, body)


def split_ends_and_body(rest: tuple[ConnectorPart, ...]) -> tuple[list[End], list[Node]]:
    """Return the ends, given one by one or as lists, and the members of the body."""
    ends: list[End] = []
    body: list[Node] = []
    for item in rest:
        for part in [item] if isinstance(item, End) else item:
            if isinstance(part, End):
                ends.append(part)
            else:
                body.append(part)
    return ends, body


def _build_usage_named_end(
    tokens: Tokens, stop: int, begin: int, node: Node, end: End, body: list[Node]
) -> Node:
    """Build ``interface a ::> x to y``: the parsed declaration is the first end."""
    # Without `::>` the declaration is a name, and the interface has this one end only.
    if not node.relations:
        return _build_usage_tail(tokens, stop, begin, node, Tail(ends=[end]), body)
    first = End(None, node.name, node.relations.pop().reference, begin + 1, end.begin - 1)
    node.name = None
    node.name_start = node.start
    return _build_usage_tail(tokens, stop, begin, node, Tail(ends=[first, end]), body)


ACTIONS = {
    "end": _build_end,
    "named_end": _build_named_end,
    "binary": _build_two_ends,
    "nary": _build_ends,
    "connect": _build_connect,
    "allocate": _build_allocate,
    "bind": _build_bind,
    "first_then": _build_first_then,
    "first_only": _build_first_only,
    "flow_of": _build_flow_of,
    "flow_of_between": _build_flow_of_between,
    "flow_between": _build_flow_between,
    "payload": _build_payload,
    "payload_short": _build_payload_short,
    "payload_nameless": _build_payload_nameless,
    "payload_many": _build_payload_many,
    "usage_tail": _build_usage_tail,
    "tail_usage": _build_tail_usage,
    "usage_ends": _build_usage_ends,
    "usage_many_ends": _build_usage_ends,
    "usage_named_end": _build_usage_named_end,
}
