"""A compile unit: its documents are analysed together, lowered one by one and accounted for."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Coverage, Sink, Verdict
from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.coverage import count_verdicts, describe_loss
from sysmlc.frontends.sysml.declarations import store_declarations
from sysmlc.frontends.sysml.definitions import variation_attributes
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.handlers import HANDLERS
from sysmlc.frontends.sysml.implied_nodes import mark_flow_finals
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.object_nodes import ensure_pin
from sysmlc.frontends.sysml.rules import APPROXIMATED, UNSUPPORTED
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query.activities import pin_subkind
from sysmlc.language.library import SHIPPED
from sysmlc.language.tree import Document, Node
from sysmlc.support.interpreter import allow_recursion

if TYPE_CHECKING:
    from sysmlc.language.names import Model

_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)


def lower_unit(
    documents: Sequence[Document],
    model: "Model",
    graph: Graph,
    sink: Sink,
    coverage: Coverage,
) -> None:
    """Add the elements of all documents to the graph and count the verdict of every node."""
    trees = Trees(documents, model)
    lowering = Lowering(trees, graph, sink, HANDLERS)
    # Deferred work, such as that of ends of connections, recurs as deep as the lowering.
    with allow_recursion(trees.depth):
        for root in trees.roots:
            lowering.lower_all(root.members, None)
        lowering.queue.defer_until_edges(lambda: _add_pins_of_chains(lowering))
        lowering.queue.run()
    lowering.library.finish()
    mark_flow_finals(lowering)
    store_declarations(lowering)
    _set_pin_subkinds(graph)
    _report_losses(lowering)
    _relate_errors(lowering)
    for document, index in zip(documents, trees.indexes, strict=True):
        if not document.path.startswith(SHIPPED):
            count_verdicts(lowering.verdicts, lowering.elements.own, document, index, coverage)


# -- pins --------------------------------------------------------------------------------------


def _add_pins_of_chains(lowering: Lowering) -> None:
    """Add output pins of steps whose values feature chains read, such as ``pick.ok``."""
    nodes_by_kind = lowering.trees.nodes_by_kind
    for node in sorted(nodes_by_kind.get("FeatureChainExpression", ()), key=_member_indexes):
        path = (lowering.elements.find(feature) for feature in nodes.path_of_expression(node))
        for step, feature in pairwise(path):
            if step is None or feature is None or step.kind is not Kind.ACTION:
                continue
            is_output = feature.attrs.get("direction") in ("out", "return", "inout")
            if feature.kind is Kind.PARAMETER and is_output:
                ensure_pin(lowering, step, feature)


def _member_indexes(node: Node) -> list[int]:
    """Return the member indexes from the root to a node, which sort in the order of the text."""
    indexes: list[int] = []
    while node.owner is not None:
        indexes.append(node.owner.members.index(node))
        node = node.owner
    return indexes[::-1]


def _set_pin_subkinds(graph: Graph) -> None:
    """Set the subkinds of pins of calls and opaque actions that metadata does not state."""
    for pin in graph.of_kind(Kind.PIN):
        owner = None if pin.subkind else graph.owner(pin)
        if owner is not None:
            graph.set(pin, subkind=pin_subkind(owner, pin) or None)


# -- elements of errors ------------------------------------------------------------------------


def _relate_errors(lowering: Lowering) -> None:
    """Relate errors that have only a location to the element there.

    The outputs that the element does not touch are still emitted. An error in metadata concerns the
    metadata. Any other error concerns the whole definition or usage in the package that contains
    it, or the package itself.
    """
    documents = {document.path: document for document in lowering.trees.documents}
    for diagnostic in list(lowering.sink):
        place = diagnostic.subject.place
        document = None if place is None else documents.get(place.file)
        if place is None or document is None or not document.text:
            continue
        if diagnostic.subject.id or not diagnostic.is_error:
            continue
        character = document.byte_offsets.character_at(place.offset)
        element = _find_element_at(lowering.elements, document.root, character)
        if element is not None:
            lowering.sink.set_element(diagnostic, element.id)


def _find_element_at(elements: NodeElements, root: Node, offset: int) -> Element | None:
    """Return the stereotype application at an offset, else the outermost element in a package."""
    outermost: Element | None = None
    for node in _iter_nodes_at(root, offset):
        element = elements.own.get(id(node))
        if element is None:
            continue
        if element.kind is Kind.APPLICATION:
            return element
        if outermost is None or outermost.kind in _PACKAGES:
            outermost = element
    return outermost


def _iter_nodes_at(root: Node, offset: int) -> Iterator[Node]:
    """Yield the nodes that contain a character, the outermost first."""
    node: Node | None = root
    while node is not None:
        children = (child for child in node.members if 0 <= child.start <= offset < child.end)
        node = next(children, None)
        if node is not None:
            yield node


# -- unread members --------------------------------------------------------------------------------

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


def _report_losses(lowering: Lowering) -> None:
    """Report what the graph does not represent, with one diagnostic for each kind of loss."""
    _mark_unread_members(lowering)
    for construct, approximation, nodes_of_loss in lowering.verdicts.iter_losses():
        # A member that is not allowed in its owner is reported already.
        lost = [
            node for node in nodes_of_loss if not lowering.trees.is_misplaced(node, lowering.sink)
        ]
        if not lost:
            continue
        count, subject = len(lost), lowering.trees.subject_of(lost[0])
        if construct:
            loss = describe_loss(construct, approximation)
            lowering.sink.report(APPROXIMATED, subject, count=count, loss=loss)
        else:
            metaclass = nodes.spell_metaclass(approximation)
            lowering.sink.report(UNSUPPORTED, subject, type=metaclass, count=count)


def _mark_unread_members(lowering: Lowering) -> None:
    """Mark the members that no handler lowered or read as approximated by nothing."""
    accounted = lowering.verdicts.lowered.union(
        lowering.verdicts.by_node,
        lowering.verdicts.skipped,
        lowering.elements.redundant,
        lowering.elements.own,
    )
    closed = {
        node_id
        for node_id, verdict in lowering.verdicts.by_node.items()
        if verdict in _WITHOUT_CONTENT
    }
    for root in lowering.trees.roots:
        for node in _iter_unread(lowering, root, accounted, closed):
            assert node.owner is not None
            owner = nodes.add_article(nodes.spell_metaclass(node.owner.kind))
            part = "the multiplicity" if node.kind == "MultiplicityRange" else "a member"
            lowering.verdicts.mark_approximated(node, f"{part} of {owner}", "nothing")


def _iter_unread(
    lowering: Lowering, root: Node, accounted: set[int], closed: set[int]
) -> Iterator[Node]:
    """Yield the outermost unread members, and mark usages whose element lacks a variation."""
    stack = [root]
    while stack:
        owner = stack.pop()
        for member in reversed(owner.members):
            if member.kind in nodes.EXPRESSIONS:
                continue
            if id(member) not in accounted and not _is_read(lowering.elements, member, owner):
                yield member
            elif id(member) not in closed:
                if member.members:
                    stack.append(member)
                variation = _find_lost_variation(lowering, member)
                if variation:
                    construct = nodes.add_article(variation)
                    lowering.verdicts.mark_approximated(member, construct, "a plain usage")


def _find_lost_variation(lowering: Lowering, node: Node) -> str:
    """Return which of variation, variant or portion the elements of a usage do not state."""
    is_plain = _VARIATION_ATTRIBUTES.isdisjoint(node.attributes) and node.membership != _VARIANT
    if is_plain or node.kind == "EnumerationUsage":
        return ""
    elements = (lowering.elements.own.get(id(node)), lowering.elements.usage_classes.get(id(node)))
    lost = [
        key
        for key, value in variation_attributes(node).items()
        if value and not any(element and key in element.attrs for element in elements)
    ]
    if lost == ["portion"]:
        return str(node.attributes["portionKind"])
    return lost[0] if lost else ""


def _is_read(elements: NodeElements, node: Node, owner: Node) -> bool:
    """Whether the handler of the owner has read a member that was not lowered by itself."""
    if node.membership == _END or node.kind in _READ_MEMBERS.get(owner.kind, ()):
        return True
    if node.kind == "MultiplicityRange":
        return _has_multiplicity(elements, owner)
    if node.membership == "ParameterMembership" and owner.kind in _READ_PARAMETERS:
        return True
    return _is_in_body(elements, node, owner) or _is_fact_of_owner(node, owner)


def _has_multiplicity(elements: NodeElements, feature: Node) -> bool:
    """Whether the multiplicity of a feature is an attribute of its element."""
    element = elements.own.get(id(feature))
    is_counted = element is not None and element.kind in _WITH_MULTIPLICITY
    return nodes.is_end(feature) or feature.kind == "Feature" or is_counted


def _is_in_body(elements: NodeElements, node: Node, owner: Node) -> bool:
    """Whether an action is part of the text that is the body of an opaque behaviour."""
    behaviour = owner
    while behaviour.owner is not None and id(behaviour) not in elements.own:
        behaviour = behaviour.owner
    element = elements.own.get(id(behaviour))
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
