"""Roles of elements, and the edges that roles of dependencies and partitions imply.

A role follows from the stereotypes, the type and the owner of an element.
"""

from collections.abc import Iterator, Mapping

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import type_of
from sysmlc.passes.classify.vocabulary import (
    CLASSIFIER_ROLES,
    COMMENT_ROLES,
    CONNECTOR_ROLES,
    DEPENDENCY_ROLES,
    FLOW_ROLES,
    PARTITION_ROLES,
    PORT_ROLES,
    PROPERTY_ROLES,
    UNIT_ROLES,
)

_BY_STEREOTYPE: dict[Kind, Mapping[str, str]] = {
    **dict.fromkeys(
        (
            Kind.CLASS,
            Kind.COMPONENT,
            Kind.INTERFACE,
            Kind.ENUMERATION,
            Kind.SIGNAL,
            Kind.ACTOR,
            Kind.USE_CASE,
            Kind.PACKAGE,
            Kind.ACTIVITY,
            Kind.STATE_MACHINE,
            Kind.INTERACTION,
            Kind.OPERATION,
            Kind.ASSOCIATION,
        ),
        CLASSIFIER_ROLES,
    ),
    Kind.DATA_TYPE: UNIT_ROLES | CLASSIFIER_ROLES,
    Kind.INSTANCE: UNIT_ROLES,
    Kind.COMMENT: COMMENT_ROLES,
    Kind.PARTITION: PARTITION_ROLES,
    # MagicDraw's constraint parameters are ports.
    Kind.PORT: PORT_ROLES | {"ConstraintParameter": "constraint parameter"},
    Kind.PROPERTY: PROPERTY_ROLES,
    Kind.CONNECTOR: CONNECTOR_ROLES,
    Kind.ITEM_FLOW: FLOW_ROLES,
    Kind.DEPENDENCY: {name: role for name, (role, _) in DEPENDENCY_ROLES.items()},
}
_BY_KIND = {
    Kind.PORT: "port",
    Kind.REQUIREMENT: "requirement",
    Kind.TEST_CASE: "test case",
    Kind.VIEW: "view",
    Kind.FLOW_PROPERTY: "flow property",
}
STRUCTURED = (Kind.PROPERTY, Kind.CLASS, *_BY_KIND)
"""Kinds of elements to which ``role_by_structure`` may give a role."""

_SYSML_PORTS = frozenset(PORT_ROLES.values())
_VALUE_KINDS = frozenset({Kind.DATA_TYPE, Kind.ENUMERATION})
_OBJECT_KINDS = frozenset({Kind.CLASS, Kind.COMPONENT, Kind.ACTOR, Kind.ITEM})
_REFERENCE_KINDS = frozenset({Kind.INTERFACE, Kind.SIGNAL, Kind.USE_CASE})


def role_by_stereotype(element: Element, meanings: tuple[str, ...]) -> str:
    """Return the role that the SysML stereotypes *meanings* give to the element, or ""."""
    roles = _BY_STEREOTYPE.get(element.kind, {})
    return next((role for name, role in roles.items() if name in meanings), "")


def role_by_structure(graph: Graph, element: Element) -> str:
    """Return the role that follows from kind, type and owner, or "".

    The roles by stereotype must be set before, because the role of a type may decide.
    """
    if element.kind is Kind.PROPERTY:
        return _property_role(graph, element)
    if element.kind is Kind.CLASS:
        return _class_role(graph, element)
    if element.kind is Kind.PORT and _is_in_constraint_block(graph, element):
        return "constraint parameter"
    if element.kind is Kind.VIEW and element.subkind == "diagram":
        return ""
    return _BY_KIND.get(element.kind, "")


def _is_in_constraint_block(graph: Graph, feature: Element) -> bool:
    owner = graph.owner(feature)
    return owner is not None and owner.role == "constraint block"


def _class_role(graph: Graph, class_: Element) -> str:
    """Return the role of a class without a known stereotype, from its ports.

    Proxy ports are typed by interface blocks, and ports are owned by blocks (SysML 1.6 clauses
    9.3.2.1 and 9.3.2.13).
    """
    if any(element.role == "proxy port" for element in graph.sources(class_, Edge.TYPED_BY)):
        return "interface block"
    return "block" if any(element.role in _SYSML_PORTS for element in graph.owned(class_)) else ""


def _property_role(graph: Graph, feature: Element) -> str:
    owner, type_ = graph.owner(feature), type_of(graph, feature)
    if owner is None or owner.kind is Kind.STEREOTYPE or _is_association_end(graph, owner, feature):
        return ""
    if type_ is not None and type_.role == "constraint block":
        return "constraint property"
    if _is_in_constraint_block(graph, feature):
        return "constraint parameter"
    return _role_by_type(feature, type_)


def _is_association_end(graph: Graph, owner: Element, feature: Element) -> bool:
    return owner.kind is Kind.ASSOCIATION and feature in graph.targets(owner, Edge.END)


def _role_by_type(feature: Element, type_: Element | None) -> str:
    if type_ is None:
        return ""
    if type_.kind in _VALUE_KINDS:
        return "value"
    if type_.kind in _OBJECT_KINDS and feature.attrs.get("aggregation") == "composite":
        return "part"
    return "reference" if type_.kind in _OBJECT_KINDS | _REFERENCE_KINDS else ""


# -- edges of dependencies ---------------------------------------------------------------------

NO_REQUIREMENT = rule(
    "SM212",
    "no-requirement",
    Severity.WARNING,
    "a «{relation}» relation leads to '{element}', which is not a requirement",
    help="reverse the arrow, or apply «Requirement» to '{element}'",
)

_EDGES = dict(DEPENDENCY_ROLES.values())
_EDGES_OF_SUBKINDS = {"realization": Edge.REALIZES, "role-binding": Edge.BINDS}
_OF_REQUIREMENTS = frozenset({"satisfy", "derive", "verify", "copy"})


def add_relations(graph: Graph, sink: Sink) -> None:
    """Add an edge from each client to each supplier; the dependency's role gives its type."""
    for dependency in graph.of_kind(Kind.DEPENDENCY):
        edge = _EDGES.get(dependency.role) or _EDGES_OF_SUBKINDS.get(
            dependency.subkind, Edge.DEPENDS
        )
        for client in graph.targets(dependency, Edge.CLIENT):
            for supplier in graph.targets(dependency, Edge.SUPPLIER):
                graph.connect(edge, client, supplier)
        _check_suppliers(graph, sink, dependency)


def _check_suppliers(graph: Graph, sink: Sink, dependency: Element) -> None:
    if dependency.role not in _OF_REQUIREMENTS:
        return
    for supplier in graph.targets(dependency, Edge.SUPPLIER):
        if supplier.role != "requirement" and not supplier.attrs.get("external"):
            sink.report(
                NO_REQUIREMENT,
                graph.subject(dependency),
                relation=dependency.role,
                element=graph.qualified_name(supplier),
            )


# -- allocate partitions -----------------------------------------------------------------------

_PERFORMED = (Kind.ACTION, Kind.STRUCTURED)


def add_allocations(graph: Graph) -> None:
    """Add ``allocated-to`` from each action to the elements that its allocate partitions represent.

    SysML 1.6 clause 15.3.2.2: the represented elements are the targets of an allocation from the
    actions in the partition. Actions in subpartitions are in it too (UML 2.5.1 clause 15.6.3).
    """
    for partition in graph.of_kind(Kind.PARTITION):
        if partition.role == "allocate partition":
            for target in graph.targets(partition, Edge.REPRESENTS):
                for action in _list_actions(graph, partition):
                    graph.connect(Edge.ALLOCATED_TO, action, target)


def _list_actions(graph: Graph, partition: Element) -> Iterator[Element]:
    for element in graph.subtree(partition):
        if element.kind is Kind.PARTITION:
            nodes = graph.sources(element, Edge.IN_PARTITION)
            yield from (node for node in nodes if node.kind in _PERFORMED)
