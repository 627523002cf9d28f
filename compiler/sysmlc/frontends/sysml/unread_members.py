"""Members of the model that no handler read: each is reported, so that nothing is lost silently."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.coverage import describe_loss
from sysmlc.frontends.sysml.definitions import variation_attributes
from sysmlc.frontends.sysml.rules import APPROXIMATED, UNSUPPORTED
from sysmlc.ir import Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_WITHOUT_CONTENT = frozenset({Verdict.UNSUPPORTED, Verdict.EXTERNAL, Verdict.IGNORED_NOTATION})
"""Verdicts that hold for all members, too."""
_ACTIONS = """
    AssignmentActionUsage SendActionUsage AcceptActionUsage ForLoopActionUsage
    WhileLoopActionUsage IfActionUsage TransitionUsage FlowUsage SuccessionFlowUsage
"""
_READ_PARAMETERS = frozenset(_ACTIONS.split())
"""Metaclasses whose handlers read the parameters: targets, payloads, collections, events."""
_READ_MEMBERS = {
    "TransitionUsage": frozenset({"SuccessionAsUsage", "AcceptActionUsage"}),
    "FlowEnd": frozenset({"ReferenceUsage"}),
    "FlowUsage": frozenset({"PayloadFeature"}),
    "SuccessionFlowUsage": frozenset({"PayloadFeature"}),
    "MetadataUsage": frozenset({"ReferenceUsage"}),
    "SatisfyRequirementUsage": frozenset({"ReferenceUsage"}),
}
"""Metaclasses of members that the handler of the owner's metaclass reads."""
_WITH_MULTIPLICITY = frozenset(
    {
        Kind.PROPERTY,
        Kind.PORT,
        Kind.PARAMETER,
        Kind.PIN,
        Kind.CONNECTOR_END,
        Kind.FLOW_PROPERTY,
        Kind.OBJECT_NODE,
        Kind.DATA_STORE,
        Kind.ACTIVITY_PARAMETER,
    }
)
_VARIATION_ATTRIBUTES = frozenset({"isVariation", "portionKind"})
_VARIANT = "VariantMembership"
_END = "EndFeatureMembership"


def report_losses(lowering: "Lowering") -> None:
    """Report what the graph does not represent, with one diagnostic for each kind of loss."""
    _mark_unread_members(lowering)
    for construct, approximation, nodes_of_loss in lowering.iter_losses():
        # A member that is not allowed in its owner is reported already.
        lost = [node for node in nodes_of_loss if not lowering.is_misplaced(node)]
        if not lost:
            continue
        count, subject = len(lost), lowering.subject_of(lost[0])
        if construct:
            loss = describe_loss(construct, approximation)
            lowering.sink.report(APPROXIMATED, subject, count=count, loss=loss)
        else:
            metaclass = nodes.spell_metaclass(approximation)
            lowering.sink.report(UNSUPPORTED, subject, type=metaclass, count=count)


def _mark_unread_members(lowering: "Lowering") -> None:
    """Mark the members that no handler lowered or read as approximated by nothing."""
    accounted = lowering.lowered.union(
        lowering.verdicts, lowering.skipped, lowering.redundant, lowering.elements
    )
    closed = {
        node_id for node_id, verdict in lowering.verdicts.items() if verdict in _WITHOUT_CONTENT
    }
    for root in lowering.roots:
        for node in _iter_unread(lowering, root, accounted, closed):
            assert node.owner is not None
            owner = nodes.add_article(nodes.spell_metaclass(node.owner.kind))
            part = "the multiplicity" if node.kind == "MultiplicityRange" else "a member"
            lowering.mark_approximated(node, f"{part} of {owner}", "nothing")


def _iter_unread(
    lowering: "Lowering", root: Node, accounted: set[int], closed: set[int]
) -> Iterator[Node]:
    """Yield the outermost unread members, and mark usages whose element lacks a variation."""
    stack = [root]
    while stack:
        owner = stack.pop()
        for member in reversed(owner.members):
            if member.kind in nodes.EXPRESSIONS:
                continue
            if id(member) not in accounted and not _is_read(lowering, member, owner):
                yield member
            elif id(member) not in closed:
                if member.members:
                    stack.append(member)
                variation = _find_lost_variation(lowering, member)
                if variation:
                    construct = nodes.add_article(variation)
                    lowering.mark_approximated(member, construct, "a plain usage")


def _find_lost_variation(lowering: "Lowering", node: Node) -> str:
    """Return which of variation, variant or portion the elements of a usage do not state."""
    is_plain = _VARIATION_ATTRIBUTES.isdisjoint(node.attributes) and node.membership != _VARIANT
    if is_plain or node.kind == "EnumerationUsage":
        return ""
    elements = (lowering.elements.get(id(node)), lowering.usage_classes.get(id(node)))
    lost = [
        key
        for key, value in variation_attributes(node).items()
        if value and not any(element and key in element.attrs for element in elements)
    ]
    if lost == ["portion"]:
        return str(node.attributes["portionKind"])
    return lost[0] if lost else ""


def _is_read(lowering: "Lowering", node: Node, owner: Node) -> bool:
    """Whether the handler of the owner has read a member that was not lowered by itself."""
    if node.membership == _END or node.kind in _READ_MEMBERS.get(owner.kind, ()):
        return True
    if node.kind == "MultiplicityRange":
        return _has_multiplicity(lowering, owner)
    if node.membership == "ParameterMembership" and owner.kind in _READ_PARAMETERS:
        return True
    return _is_in_body(lowering, node, owner) or _is_fact_of_owner(node, owner)


def _has_multiplicity(lowering: "Lowering", feature: Node) -> bool:
    """Whether the multiplicity of a feature is an attribute of its element."""
    element = lowering.elements.get(id(feature))
    is_counted = element is not None and element.kind in _WITH_MULTIPLICITY
    return nodes.is_end(feature) or feature.kind == "Feature" or is_counted


def _is_in_body(lowering: "Lowering", node: Node, owner: Node) -> bool:
    """Whether an action is part of the text that is the body of an opaque behaviour."""
    behaviour = owner
    while behaviour.owner is not None and id(behaviour) not in lowering.elements:
        behaviour = behaviour.owner
    element = lowering.elements.get(id(behaviour))
    return element is not None and "body" in element.attrs and node.kind.endswith("ActionUsage")


def _is_fact_of_owner(node: Node, owner: Node) -> bool:
    """Whether a member is notation of its owner.

    Such members are keywords, ends in bodies, empty actions of states, and cross features.
    """
    if node.kind == "MetadataUsage":
        is_text = "InWords" in nodes.shipped_metadata_of(owner)
        is_named = is_text and nodes.shipped_metadata_name(node) == "Named"
        is_prefix = bool(node.attributes.get("isPrefix"))
        return is_named or (is_prefix and owner.kind != "MetadataUsage")
    if node.kind == "Membership":
        return not node.name
    if node.kind == "Feature" and node.membership == "OwningMembership":
        return True
    if node.attributes.get("isEnd") and owner.kind == "ConnectionUsage":
        return True
    if node.membership == "StateSubactionMembership" and not node.members:
        return True
    return node is nodes.cross_feature_of(owner)
