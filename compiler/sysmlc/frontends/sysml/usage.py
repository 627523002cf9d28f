"""How definitions and features are used in the unit, found out before anything is lowered."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from operator import attrgetter

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.connections import steps_of
from sysmlc.language.tree import Node

_FLOWS = ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow")
ByKind = Mapping[str, Sequence[Node]]


def by_kind(root: Node) -> tuple[ByKind, int]:
    """All nodes of a document by metaclass, owners first, and how many are within one another."""
    found: dict[str, list[Node]] = defaultdict(list)
    depth, level = 0, [root]
    while level:
        for node in level:
            found[node.kind].append(node)
        depth, level = depth + 1, list(chain.from_iterable(map(_members, level)))
    return found, depth


_members = attrgetter("members")


def together(found: Iterable[ByKind]) -> ByKind:
    """The nodes of several documents by metaclass, one document after the other."""
    all_: dict[str, list[Node]] = {}
    for one in found:
        for kind, ours in one.items():
            all_.setdefault(kind, []).extend(ours)
    return all_


def accepted(found: ByKind) -> set[int]:
    """Identities of the item definitions that are signals.

    They are sent, accepted, or specialised by one that is; or no feature is typed by them and
    they have no parts.
    """
    signals = {id(one) for one in _payloads(found)}
    items = {id(one) for one in found.get("ItemDefinition", ())}
    return signals | (items - {id(one) for one in _types(found)} if items else items)


def flowing(found: ByKind) -> set[int]:
    """Identities of the features at which flows begin or end."""
    flows = (node for kind in _FLOWS for node in found.get(kind, ()))
    ways = (steps_of(end) for node in flows for end in nodes.ends_of(node))
    return {id(steps[-1]) for steps in ways if steps and steps[-1] is not None}


def _payloads(found: ByKind) -> Iterator[Node]:
    for node in found.get("AcceptActionUsage", ()):
        for one in nodes.held(node, "ParameterMembership"):
            yield from _targets(one, "FeatureTyping")
    for kind in ("ConstructorExpression", "InvocationExpression"):
        for node in found.get(kind, ()):
            yield from _targets(node, "Membership", "FeatureTyping")
    for node in filter(nodes.is_message, found.get("FlowUsage", ())):
        for one in node.members:
            yield from _targets(one, "FeatureTyping")


def _types(found: ByKind) -> Iterator[Node]:
    for kind, ours in found.items():
        if kind.endswith("Usage") or kind == "PayloadFeature":
            for node in ours:
                if kind == "PayloadFeature" or not _is_payload(node):
                    yield from _targets(node, "FeatureTyping")


def _is_payload(node: Node) -> bool:
    owner = node.owner
    return owner is not None and owner.kind == "AcceptActionUsage"


def _targets(node: Node, *kinds: str) -> Iterable[Node]:
    found = (one.target for one in nodes.references(node, *kinds))
    return (one for one in found if one is not None)
