"""How definitions and features are used in the unit, found out before anything is lowered."""

from collections.abc import Iterable

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.connections import steps_of
from sysmlc.language.tree import Document, Node

_FLOWS = frozenset({"FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow"})


def accepted(documents: Iterable[Document]) -> set[int]:
    """Identities of the item definitions that are signals.

    They are sent, accepted, or specialised by one that is; or no feature is typed by them and
    they have no parts.
    """
    all_nodes = [node for one in documents for node in one.root.walk()]
    found = {id(one) for node in all_nodes for one in _payloads(node)}
    typing = {id(one) for node in all_nodes for one in _types(node)}
    for node in all_nodes:
        if node.kind == "ItemDefinition" and id(node) not in typing:
            found.add(id(node))
    return found


def flowing(documents: Iterable[Document]) -> set[int]:
    """Identities of the features at which flows begin or end."""
    found: set[int] = set()
    for one in documents:
        for node in one.root.walk():
            if node.kind in _FLOWS:
                ends = (steps_of(end) for end in nodes.ends_of(node))
                found.update(id(steps[-1]) for steps in ends if steps and steps[-1] is not None)
    return found


def _payloads(node: Node) -> Iterable[Node]:
    if node.kind == "AcceptActionUsage":
        for one in nodes.held(node, "ParameterMembership"):
            yield from _targets(one, "FeatureTyping")
    elif node.kind in ("ConstructorExpression", "InvocationExpression"):
        yield from _targets(node, "Membership", "FeatureTyping")
    elif nodes.is_message(node):
        for one in node.members:
            yield from _targets(one, "FeatureTyping")


def _types(node: Node) -> Iterable[Node]:
    if node.kind.endswith("Usage") and not _is_payload(node):
        yield from _targets(node, "FeatureTyping")
    if node.kind == "PayloadFeature":
        yield from _targets(node, "FeatureTyping")


def _is_payload(node: Node) -> bool:
    owner = node.owner
    return owner is not None and owner.kind == "AcceptActionUsage"


def _targets(node: Node, *kinds: str) -> Iterable[Node]:
    found = (one.target for one in nodes.references(node, *kinds))
    return (one for one in found if one is not None)
