"""The ends of connections, interfaces, flows and messages (SysML 8.2.2.13, 8.2.2.16)."""

from collections.abc import Callable
from typing import NamedTuple

from sysmlc.language.text.build.features import multiplicity
from sysmlc.language.text.build.owning import FEATURE, OWNING, made
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference, Relation

_END = "EndFeatureMembership"


class End(NamedTuple):
    """One end as written: its multiplicity, its name, what it refers to, its tokens."""

    bounds: Node | None
    name: str | None
    reference: Reference
    begin: int
    at: int


def end_feature(end: End, tokens: Tokens) -> Node:
    """The end of a connector (8.2.2.13.1)."""
    return _connector_end("ReferenceUsage", end, tokens)


def _interface_end(end: End, tokens: Tokens) -> Node:
    return _connector_end("PortUsage", end, tokens)


def _connector_end(kind: str, end: End, tokens: Tokens) -> Node:
    node = made(kind, _END, tokens, end.begin, end.at)
    node.name = end.name
    if end.bounds is not None:
        cross = node.own(made("Feature", OWNING, tokens, end.begin, end.at))
        cross.own(multiplicity(end.bounds, tokens, end.begin, end.at))
    node.relations.append(Relation("ReferenceSubsetting", end.reference))
    return node


def _flow_end(end: End, tokens: Tokens) -> Node:
    """The end of a flow: what has the feature, and the feature (8.2.2.16)."""
    node = made("FlowEnd", _END, tokens, end.begin, end.at)
    chain, start, stop = end.reference.chain, end.reference.start, end.reference.end
    if len(chain) > 1:
        node.relations.append(
            Relation("ReferenceSubsetting", Reference(chain[:-1], start, tokens.starts[end.at - 1]))
        )
        start = tokens.starts[end.at - 1]
    feature = node.own(made("ReferenceUsage", FEATURE, tokens, end.begin, end.at))
    feature.relations.append(Relation("Redefinition", Reference(chain[-1:], start, stop)))
    return node


def _message_end(end: End, tokens: Tokens) -> Node:
    node = made("EventOccurrenceUsage", "ParameterMembership", tokens, end.begin, end.at)
    node.relations.append(Relation("ReferenceSubsetting", end.reference))
    return node


def _kernel_end(end: End, tokens: Tokens) -> Node:
    return _connector_end("Feature", end, tokens)


def _kernel_flow_end(end: End, tokens: Tokens) -> Node:
    node = _flow_end(end, tokens)
    node.members[0].kind = "Feature"
    return node


_ENDS: dict[str, Callable[[End, Tokens], Node]] = {
    "Connector": _kernel_end,
    "BindingConnector": _kernel_end,
    "Succession": _kernel_end,
    "Flow": _kernel_flow_end,
    "SuccessionFlow": _kernel_flow_end,
    "InterfaceUsage": _interface_end,
    "FlowUsage": _flow_end,
    "SuccessionFlowUsage": _flow_end,
}


def maker(node: Node) -> Callable[[End, Tokens], Node]:
    """What makes the ends of a usage of this kind; a message is an abstract flow so far."""
    make = _ENDS.get(node.kind, end_feature)
    return _message_end if make is _flow_end and "isAbstract" in node.facts else make


def _end(tokens: Tokens, at: int, begin: int, bounds: Node | None, reference: Reference) -> End:
    return End(bounds, None, reference, begin, at)


def _named_end(
    tokens: Tokens, at: int, begin: int, bounds: Node | None, name: int, reference: Reference
) -> End:
    return End(bounds, tokens.name(name), reference, begin, at)


def _binary(_tokens: Tokens, _at: int, _begin: int, first: End, second: End) -> list[End]:
    return [first, second]


def _nary(_tokens: Tokens, _at: int, _begin: int, first: End, rest: list[End]) -> list[End]:
    return [first, *rest]


ACTIONS = {
    "end": _end,
    "named_end": _named_end,
    "binary": _binary,
    "nary": _nary,
}
