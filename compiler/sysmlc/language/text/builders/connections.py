"""Connections, interfaces, bindings, successions and flows (SysML 8.2.2.13 to 8.2.2.16)."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

from sysmlc.language.text.builders.declarations import (
    Names,
    Parts,
    make_element,
    make_multiplicity,
)
from sysmlc.language.text.builders.definitions import Keyword, build_declaration, finish_usage
from sysmlc.language.text.builders.nodes import FEATURE, OWNING, PARAMETER, make_node, omit_first
from sysmlc.language.text.lexer import BuildFault, Span, Tokens
from sysmlc.language.tree import Node, Reference, Relation

_END = "EndFeatureMembership"
_FLOWS = ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow")
_TAILS = {
    "connect": ("connections and interfaces", ("ConnectionUsage", "InterfaceUsage")),
    "allocate": ("allocations", ("AllocationUsage",)),
    "bind": ("bindings", ("BindingConnectorAsUsage",)),
    "first": ("successions", ("SuccessionAsUsage", "TransitionUsage")),
    "of": ("flows and messages", _FLOWS),
    "from": ("flows and messages", (*_FLOWS, "Connector")),
    "then": ("successions", ("Succession",)),
    "step": ("actions", ("ActionUsage", "PerformActionUsage")),
}
"""For the word that begins a tail: the usages that may have it, in words, and their kinds."""


class End(NamedTuple):
    """An end as it is written: its multiplicity, its name, the referenced feature, its tokens."""

    bounds: Node | None
    name: str | None
    reference: Reference
    span: Span


def make_end(kind: str, end: End, tokens: Tokens) -> Node:
    """Return the end feature of a connector (8.2.2.13.1)."""
    node = make_node(kind, _END, tokens, end.span)
    node.name = end.name
    if end.bounds is not None:
        cross = node.add_member(make_node("Feature", OWNING, tokens, end.span))
        cross.add_member(make_multiplicity(end.bounds, tokens, end.span))
    node.relations.append(Relation("ReferenceSubsetting", end.reference))
    return node


def _make_flow_end(kind: str, end: End, tokens: Tokens) -> Node:
    """Return the end of a flow: it references the chain without its last feature (8.2.2.16).

    ``kind`` is the kind of the feature that redefines the last one.
    """
    node = make_node("FlowEnd", _END, tokens, end.span)
    chain, start, stop = end.reference.chain, end.reference.start, end.reference.end
    if len(chain) > 1:
        last_start = tokens.starts[end.span[1] - 1]
        path = Reference(chain[:-1], start, last_start)
        node.relations.append(Relation("ReferenceSubsetting", path))
        start = last_start
    feature = node.add_member(make_node(kind, FEATURE, tokens, end.span))
    feature.relations.append(Relation("Redefinition", Reference(chain[-1:], start, stop)))
    return node


def _make_message_end(end: End, tokens: Tokens) -> Node:
    node = make_node("EventOccurrenceUsage", PARAMETER, tokens, end.span)
    node.relations.append(Relation("ReferenceSubsetting", end.reference))
    return node


_make_usage_end = partial(make_end, "ReferenceUsage")
_END_MAKERS: dict[str, Callable[[End, Tokens], Node]] = {
    **dict.fromkeys(("Connector", "BindingConnector", "Succession"), partial(make_end, "Feature")),
    **dict.fromkeys(("Flow", "SuccessionFlow"), partial(_make_flow_end, "Feature")),
    **dict.fromkeys(
        ("FlowUsage", "SuccessionFlowUsage"), partial(_make_flow_end, "ReferenceUsage")
    ),
    "InterfaceUsage": partial(make_end, "PortUsage"),
}


def _build_end(tokens: Tokens, bounds: Node | None, reference: Reference) -> End:
    return End(bounds, None, reference, (tokens.begin, tokens.stop))


def _build_named_end(tokens: Tokens, bounds: Node | None, name: int, reference: Reference) -> End:
    return _build_end(tokens, bounds, reference)._replace(name=tokens.read_name(name))


def _build_ends(_tokens: Tokens, first: End, rest: End | list[End]) -> list[End]:
    return [first, *(rest if isinstance(rest, list) else [rest])]


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
    if tail.word and node.kind != tail.kind and node.kind not in _TAILS[tail.word][1]:
        _report_misplaced_tail(node, tail, tokens)
    node.kind = tail.kind or node.kind
    node.relations += tail.relations
    for member in tail.members:
        node.add_member(member)
    make = _END_MAKERS.get(node.kind, _make_usage_end)
    # A message is an abstract flow.
    if node.kind in ("FlowUsage", "SuccessionFlowUsage") and "isAbstract" in node.attributes:
        make = _make_message_end
    for end in tail.ends:
        node.add_member(make(end, tokens))
    return node


def _report_misplaced_tail(node: Node, tail: Tail, tokens: Tokens) -> None:
    subject = "what an action does" if tail.word == "step" else f"'{tail.word}'"
    declarations = _TAILS[tail.word][0]
    text = f"{subject} goes with {declarations}, not with this declaration"
    keyword = declarations.split(" and ")[0].removesuffix("s")
    advice = f"declare it as {keyword}, or make two declarations of it"
    tokens.build_faults.append(BuildFault("combination", node.start, text, advice))


def build_tail_of_ends(kind: str, word: str, _tokens: Tokens, ends: list[End]) -> Tail:
    """Build a tail that consists of ends."""
    return Tail(kind, word, ends=ends)


def _build_first_only(_tokens: Tokens, end: End) -> Tail:
    return Tail("Membership", "first", relations=[Relation("Membership", end.reference)])


def _build_flow_of(_tokens: Tokens, payload: Node, ends: list[End] | None) -> Tail:
    payload.membership = FEATURE
    payload.kind = "PayloadFeature"
    return Tail("", "of", [payload], ends=ends or [])


def _build_payload(tokens: Tokens, reference: Reference, parts: Parts, value: Node | None) -> Node:
    """Build the payload of a flow or accept action: a name with its type, or only the type."""
    # `accept x : T` and `accept T` begin alike; one token of lookahead does not tell.
    is_name = len(reference.chain) == 1 and len(reference.chain[0]) == 1
    is_typed = any(isinstance(part, Relation) for part in parts or ())
    if is_name and (is_typed or value is not None):
        names = Names(None, reference.chain[0][0], tokens.begin)
        return _build_named_payload(tokens, names, parts, value)
    typing = Relation("FeatureTyping", reference)
    return _build_named_payload(tokens, None, [typing, *(parts or ())], value)


def _build_named_payload(
    tokens: Tokens, names: Names | None, parts: Parts, value: Node | None
) -> Node:
    return make_element("ReferenceUsage", PARAMETER, tokens, names, parts, value)


def _build_payload_many(tokens: Tokens, bounds: Node, reference: Reference) -> Node:
    parts: Parts = [Relation("FeatureTyping", reference), make_multiplicity(bounds, tokens)]
    return _build_named_payload(tokens, None, parts, None)


def build_usage_with_tail(
    tokens: Tokens, node: Node, tail: Tail, body: list[Node] | None = None
) -> Node:
    """Build a usage whose declaration is ``node``."""
    return finish_usage(tokens, apply_tail(node, tail, tokens), body)


def _build_tail_usage(tokens: Tokens, tail: Tail, body: list[Node] | None = None) -> Node:
    """Build a usage without a declaration."""
    is_flow = tail.word in ("of", "from")
    kind = tail.kind or ("FlowUsage" if is_flow else "ConnectionUsage")
    membership = "" if kind == "Membership" else FEATURE
    node = apply_tail(make_node(kind, membership, tokens), tail, tokens)
    if is_flow:
        text = f"'{tail.word}' goes with flows and messages, not with a bare declaration"
        fault = BuildFault("combination", node.start, text, f"write 'flow {tail.word}'")
        tokens.build_faults.append(fault)
    if kind.endswith("ActionUsage") or kind == "Membership":
        tokens.restricted_nodes.append(node)
    return finish_usage(tokens, node, body)


def _build_usage_ends(tokens: Tokens, keyword: Keyword, ends: list[End], body: list[Node]) -> Node:
    node = build_declaration(tokens, keyword)
    return build_usage_with_tail(tokens, node, Tail(ends=ends), body)


def _build_usage_named_end(tokens: Tokens, node: Node, end: End, body: list[Node]) -> Node:
    """Build ``interface a ::> x to y``: the parsed declaration is the first end."""
    ends = [end]
    # Without `::>` the declaration is a name, and the interface has this one end only.
    if node.relations:
        span = (tokens.begin + 1, end.span[0] - 1)
        ends.insert(0, End(None, node.name, node.relations.pop().reference, span))
        node.name = None
        node.name_start = node.start
    return build_usage_with_tail(tokens, node, Tail(ends=ends), body)


ACTIONS = {
    "end": _build_end,
    "named_end": _build_named_end,
    "ends": _build_ends,
    "connect": partial(build_tail_of_ends, "", "connect"),
    "allocate": partial(build_tail_of_ends, "AllocationUsage", "allocate"),
    "bind": partial(build_tail_of_ends, "BindingConnectorAsUsage", "bind"),
    "first_then": partial(build_tail_of_ends, "SuccessionAsUsage", "first"),
    "first_only": _build_first_only,
    "flow_of": _build_flow_of,
    "flow_between": partial(build_tail_of_ends, "", "from"),
    "payload": _build_payload,
    "payload_short": _build_named_payload,
    "payload_nameless": omit_first(_build_named_payload),
    "payload_many": _build_payload_many,
    "usage_tail": build_usage_with_tail,
    "tail_usage": _build_tail_usage,
    "usage_ends": _build_usage_ends,
    "usage_named_end": _build_usage_named_end,
}
