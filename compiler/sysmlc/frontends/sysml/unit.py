"""A compile unit: its documents are analysed together, lowered one by one and accounted for."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, pairwise
from operator import attrgetter
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.coverage import count_verdicts
from sysmlc.frontends.sysml.declarations import store_declarations
from sysmlc.frontends.sysml.handlers import HANDLERS
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.object_nodes import ensure_pin
from sysmlc.frontends.sysml.unread_members import report_losses
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query.activities import pin_subkind
from sysmlc.language.library import SHIPPED
from sysmlc.language.tree import Document, Node
from sysmlc.support.interpreter import allow_recursion

if TYPE_CHECKING:
    from sysmlc.language.names import Model

NodesByKind = Mapping[str, Sequence[Node]]
_FLOWS = ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow")
_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)
_list_members = attrgetter("members")


def lower_unit(
    documents: Sequence[Document],
    model: "Model",
    graph: Graph,
    sink: Sink,
    coverage: Coverage,
) -> None:
    """Add the elements of all documents to the graph and count the verdict of every node."""
    lowering = Lowering(documents, model, graph, sink, HANDLERS)
    indexes, depth = [], 0
    for document in documents:
        index, levels = _index_by_kind(document.root)
        lowering.assign_document(document, chain.from_iterable(index.values()))
        indexes.append(index)
        depth = max(depth, levels)
    nodes_by_kind = _merge_indexes(indexes)
    lowering.signals = _find_signals(nodes_by_kind)
    lowering.flow_features = _find_flow_features(nodes_by_kind)
    # Deferred work, such as that of ends of connections, recurs as deep as the lowering.
    with allow_recursion(depth):
        for root in lowering.roots:
            lowering.lower_all(root.members, None)
        lowering.defer_until_edges(lambda: _add_pins_of_chains(lowering, nodes_by_kind))
        lowering.finish()
    lowering.mark_flow_finals()
    store_declarations(lowering, depth)
    _set_pin_subkinds(graph)
    report_losses(lowering)
    _relate_errors(lowering)
    for document, index in zip(documents, indexes, strict=True):
        if not document.path.startswith(SHIPPED):
            count_verdicts(lowering, document, index, coverage)


# -- analysis before the lowering --------------------------------------------------------------


def _index_by_kind(root: Node) -> tuple[NodesByKind, int]:
    """Return the nodes of a document by metaclass, owners first, and the depth of the tree."""
    index: dict[str, list[Node]] = defaultdict(list)
    depth, level = 0, [root]
    while level:
        for node in level:
            index[node.kind].append(node)
        depth, level = depth + 1, list(chain.from_iterable(map(_list_members, level)))
    return index, depth


def _merge_indexes(indexes: Iterable[NodesByKind]) -> NodesByKind:
    """Return the nodes of all documents by metaclass, one document after the other."""
    merged: dict[str, list[Node]] = {}
    for index in indexes:
        for kind, members in index.items():
            merged.setdefault(kind, []).extend(members)
    return merged


def _find_signals(nodes_by_kind: NodesByKind) -> set[int]:
    """Return the identities of the definitions that are signals.

    A signal is sent or accepted, or it is an item definition that types no feature.
    """
    signals = {id(definition) for definition in _iter_payload_types(nodes_by_kind)}
    items = {id(definition) for definition in nodes_by_kind.get("ItemDefinition", ())}
    if not items:
        return signals
    return signals | (items - {id(type_) for type_ in _iter_feature_types(nodes_by_kind)})


def _find_flow_features(nodes_by_kind: NodesByKind) -> set[int]:
    """Return the identities of the features at which flows start or end."""
    flows = (flow for kind in _FLOWS for flow in nodes_by_kind.get(kind, ()))
    paths = (nodes.path_of_end(end) for flow in flows for end in nodes.ends_of(flow))
    return {id(path[-1]) for path in paths if path and path[-1] is not None}


def _iter_payload_types(nodes_by_kind: NodesByKind) -> Iterator[Node]:
    """Yield the types that accept actions accept, expressions instantiate, and messages carry."""
    for node in nodes_by_kind.get("AcceptActionUsage", ()):
        for parameter in nodes.iter_by_membership(node, "ParameterMembership"):
            yield from _iter_targets(parameter, "FeatureTyping")
    for kind in ("ConstructorExpression", "InvocationExpression"):
        for node in nodes_by_kind.get(kind, ()):
            yield from _iter_targets(node, "Membership", "FeatureTyping")
    for message in filter(nodes.is_message, nodes_by_kind.get("FlowUsage", ())):
        for member in message.members:
            yield from _iter_targets(member, "FeatureTyping")


def _iter_feature_types(nodes_by_kind: NodesByKind) -> Iterator[Node]:
    """Yield the types of usages, except for payloads of accept actions."""
    for kind, features in nodes_by_kind.items():
        if kind.endswith("Usage") or kind == "PayloadFeature":
            for feature in features:
                if kind == "PayloadFeature" or not _is_accepted_payload(feature):
                    yield from _iter_targets(feature, "FeatureTyping")


def _is_accepted_payload(node: Node) -> bool:
    owner = node.owner
    return owner is not None and owner.kind == "AcceptActionUsage"


def _iter_targets(node: Node, *kinds: str) -> Iterator[Node]:
    for reference in nodes.list_references(node, *kinds):
        if reference.target is not None:
            yield reference.target


# -- pins --------------------------------------------------------------------------------------


def _add_pins_of_chains(lowering: Lowering, nodes_by_kind: NodesByKind) -> None:
    """Add output pins of steps whose values feature chains read, such as ``pick.ok``."""
    for node in sorted(nodes_by_kind.get("FeatureChainExpression", ()), key=_member_indexes):
        path = (lowering.element_of(feature) for feature in nodes.path_of_expression(node))
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
    documents = {document.path: document for document in lowering.documents}
    for diagnostic in list(lowering.sink):
        place = diagnostic.subject.place
        document = None if place is None else documents.get(place.file)
        if place is None or document is None or not document.text:
            continue
        if diagnostic.subject.id or not diagnostic.is_error:
            continue
        character = document.byte_offsets.character_at(place.offset)
        element = _find_element_at(lowering, document.root, character)
        if element is not None:
            lowering.sink.set_element(diagnostic, element.id)


def _find_element_at(lowering: Lowering, root: Node, offset: int) -> Element | None:
    """Return the stereotype application at an offset, else the outermost element in a package."""
    outermost: Element | None = None
    for node in _iter_nodes_at(root, offset):
        element = lowering.elements.get(id(node))
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
