"""Connectors, bindings and flows between the features of a classifier; associations."""

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.definitions import lower_definition, visibility_attributes
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.features import lower_property
from sysmlc.frontends.sysml.kinds import CLASSIFIERS
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import BEHAVIORS, generals, type_of
from sysmlc.language.tree import Node

_FLOWS = frozenset({"FlowUsage", "SuccessionFlowUsage"})
_PAYLOADS = frozenset({"PayloadFeature", "ReferenceUsage", "Feature"})
_FEATURES = (Kind.PROPERTY, Kind.PORT)
_FLOW_EDGES = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)


# -- connectors --------------------------------------------------------------------------------


def list_linked_ends(node: Node) -> list[Node]:
    """Return the ends after ``connect``, else the ends in the body that refer to a feature."""
    ends = [member for member in nodes.body_of(node) if member.attributes.get("isEnd")]
    named = [end for end in ends if nodes.find_reference(end, "ReferenceSubsetting", "Subsetting")]
    return nodes.ends_of(node) or (named if len(named) > 1 else [])


def lower_connector(lowering: Lowering, node: Node, owner: Element, role: str = "") -> Element:
    """Lower a connection, an interface or a binding between features of a classifier."""
    attributes = visibility_attributes(node)
    connector = lowering.add_element(
        node, Kind.CONNECTOR, nodes.name_of(node), owner, role=role, **attributes
    )
    ends = list_linked_ends(node)
    for end in ends:
        _lower_end(lowering, end, connector)
    for type_ in lowering.trees.types_of(node):
        if lowering.trees.document_of(type_) is not None:
            lowering.defer_edges(Edge.TYPED_BY, connector, [type_])
    for member in nodes.body_of(node):
        if member in ends:
            lowering.lower_annotations(member, connector)
        elif nodes.is_annotation(member):
            lowering.lower(member, connector)
        elif member.kind in _FLOWS:
            lowering.lower(member, owner)
        else:
            lowering.verdicts.mark_approximated(member, "a feature of a connection", "nothing")
    return connector


def _lower_end(lowering: Lowering, node: Node, connector: Element) -> None:
    multiplicity = values.multiplicity_of(lowering.trees, node)
    end = lowering.add_element(
        node, Kind.CONNECTOR_END, node.name or "", connector, multiplicity=multiplicity
    )
    lowering.graph.connect(Edge.END, connector, end)
    lowering.queue.defer_until_elements(lambda: _connect_role(lowering, node, end))


def _connect_role(lowering: Lowering, node: Node, end: Element) -> None:
    """Connect an end to the feature at it, and to the features that lead to that feature."""
    *path, role = nodes.path_of_end(node) or [None]
    lowering.connect_node(Edge.ROLE, end, role)
    for feature in path:
        lowering.connect_node(Edge.PATH, end, _part_of_instance_part(lowering.elements, feature))


def _part_of_instance_part(elements: NodeElements, feature: Node | None) -> Node | None:
    """Return the part that an instance redefines with values, else the feature itself."""
    part = feature
    while part is not None:
        element = elements.find(part)
        if element is None or element.kind is not Kind.INSTANCE or element.subkind != "part":
            return part
        part = nodes.find_target(part, "Redefinition")
    return feature


# -- flows -------------------------------------------------------------------------------------


def lower_item_flow(lowering: Lowering, node: Node, owner: Element | None) -> Element:
    """Lower a flow between features of a classifier; a connector may realise it."""
    flow = lowering.add_element(node, Kind.ITEM_FLOW, node.name or "", owner, role="item flow")
    lowering.set_attributes(flow, **visibility_attributes(node))
    payloads = list_payloads(node)
    for payload in payloads:
        for type_ in nodes.list_references(payload, "FeatureTyping"):
            lowering.connect_reference(Edge.CONVEYS, flow, type_)
    annotations.lower_only_annotations(lowering, node, flow, "a flow", payloads)
    lowering.queue.defer_until_edges(lambda: _connect_flow(lowering, node, flow))
    return flow


def list_payloads(node: Node) -> list[Node]:
    """Return the features that state what a flow or a message carries."""
    members = nodes.iter_by_metaclass(node, *_PAYLOADS)
    return [member for member in members if not nodes.is_annotation(member)]


def _connect_flow(lowering: Lowering, node: Node, flow: Element) -> None:
    """Connect a flow to its ends and to the connector between them; remove one without ends."""
    ends = (nodes.ends_of(node) or nodes.events_of(node))[:2]
    paths = [_find_path_to_port(lowering, end) for end in ends]
    for edge, path in zip(_FLOW_EDGES, paths, strict=False):
        if path:
            lowering.graph.connect(edge, flow, path[-1])
    if len(paths) < 2 or not all(paths):
        lowering.graph.remove(flow)
        lowering.elements.own.pop(id(node), None)
        lowering.verdicts.mark_unsupported(node)
        return
    owner = lowering.graph.owner(flow)
    if owner is None:
        return
    ids = {tuple(feature.id for feature in path) for path in paths}
    for member in lowering.graph.owned(owner):
        if member.kind is Kind.CONNECTOR and ids == _connector_paths(lowering, member):
            lowering.graph.connect(Edge.REALIZING, flow, member)
            return
    _set_ambiguous_paths(lowering, flow, owner, paths)


def _find_path_to_port(lowering: Lowering, end: Node) -> list[Element]:
    """Return the features that lead to the end of a flow, up to the last port among them."""
    elements = (lowering.elements.find(feature) for feature in nodes.path_of_end(end))
    path = [element for element in elements if element is not None]
    ports = [index for index, feature in enumerate(path) if feature.kind is Kind.PORT]
    return path[: ports[-1] + 1] if ports else path


def _connector_paths(lowering: Lowering, connector: Element) -> set[tuple[str, ...]]:
    """Return the ids of the features that lead to each end of a connector."""
    graph, paths = lowering.graph, set()
    for end in graph.targets(connector, Edge.END):
        features = [*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)]
        paths.add(tuple(feature.id for feature in features))
    return paths


def _set_ambiguous_paths(
    lowering: Lowering, flow: Element, owner: Element, paths: list[list[Element]]
) -> None:
    """Set through which parts the ends of a flow are, unless the features at the ends tell."""
    for key, (*parts, _) in zip(("source_path", "target_path"), paths, strict=True):
        if parts and (len(parts) > 1 or _has_similar_part(lowering, owner, parts[0])):
            lowering.set_attributes(flow, **{key: tuple(part.id for part in parts)})


def _has_similar_part(lowering: Lowering, owner: Element, part: Element) -> bool:
    """Whether a second part has the same type, or a type related to it by generalization."""
    graph, type_ = lowering.graph, type_of(lowering.graph, part)
    for classifier in (owner, *generals(graph, owner)):
        for member in graph.owned(classifier):
            other_type = None if member is part else type_of(graph, member)
            if other_type is None:
                continue
            if type_ in (other_type, *generals(graph, other_type)):
                return True
            if type_ is not None and other_type in generals(graph, type_):
                return True
    return False


def lower_flow_definition(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a flow between classifiers (UML 2.5.1 clause 20.1)."""
    ends = [member for member in node.members if nodes.is_end(member)]
    has_types = all(nodes.find_reference(end, "FeatureTyping") for end in ends[:2])
    if len(ends) < 2 or not has_types:
        lowering.verdicts.mark_unsupported(node)
        return
    flow = lowering.add_element(node, Kind.ITEM_FLOW, nodes.name_of(node), owner, role="item flow")
    edges = iter(_FLOW_EDGES)
    for member in node.members:
        if nodes.is_end(member):
            edge = next(edges, None)
            if edge is not None:
                type_ = nodes.find_reference(member, "FeatureTyping")
                lowering.connect_reference(edge, flow, type_)
        elif nodes.is_annotation(member):
            lowering.lower(member, flow)
        elif nodes.name_of(member) == "payload":
            for type_ in nodes.list_references(member, "FeatureTyping"):
                lowering.connect_reference(Edge.CONVEYS, flow, type_)


# -- associations ------------------------------------------------------------------------------


def lower_association(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a connection definition to an association.

    An end with the name and type of a feature of the other end's type is that feature.
    """
    kind, role = CLASSIFIERS[node.kind]
    ends = [member for member in node.members if nodes.is_end(member)]
    lowering.verdicts.skipped.update(id(end) for end in ends)
    association = lower_definition(lowering, node, owner, kind, role)
    lowering.queue.defer_until_edges(lambda: _connect_association(lowering, ends, association))


def _connect_association(lowering: Lowering, ends: list[Node], association: Element) -> None:
    for end in ends:
        feature = _find_opposite_feature(lowering, end, ends)
        if feature is None:
            lowering.verdicts.skipped.discard(id(end))
            feature = lower_property(lowering, end, association)
            # Connect its types before the next end is compared with features.
            lowering.queue.run_until_edges()
        else:
            lowering.elements.own[id(end)] = feature
        lowering.graph.connect(Edge.END, association, feature)


def _find_opposite_feature(lowering: Lowering, end: Node, ends: list[Node]) -> Element | None:
    """Return the feature of the opposite end's type that has the name and type of an end.

    The names are those of the text: metadata may have restored another one in the graph. A feature
    whose type is a behaviour of a class subsets that behaviour, and its end has no type.
    """
    if len(ends) != 2:
        return None
    end_types = [lowering.elements.find(type_) for type_ in lowering.trees.types_of(end)]
    opposite = ends[1] if end is ends[0] else ends[0]
    subsetted = [reference.target for reference in nodes.list_references(opposite, "Subsetting")]
    usages = [usage for usage in subsetted if usage is not None]
    for type_ in lowering.trees.types_of(opposite) or usages:
        for member in type_.members:
            if nodes.name_of(member) != nodes.name_of(end):
                continue
            feature = lowering.elements.find(member)
            if feature is None or feature.kind not in _FEATURES:
                continue
            if type_of(lowering.graph, feature) in end_types:
                return feature
            if not end_types and _subsets_behaviour(lowering, member):
                return feature
    return None


def _subsets_behaviour(lowering: Lowering, usage: Node) -> bool:
    """Whether a usage subsets a behaviour, which is then its type; edges may not exist yet."""
    references = nodes.list_references(usage, "Subsetting")
    elements = [lowering.elements.find(reference.target) for reference in references]
    return any(element is not None and element.kind in BEHAVIORS for element in elements)
