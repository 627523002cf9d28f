"""Tables: the feature of UML that each edge of the graph is written as, by kind of its source."""

from sysmlc.ir import Edge, Element, Kind

_BEHAVIOURS = (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION, Kind.TEST_CASE)
_FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION)
_CALLS = {
    "call-behavior": "behavior",
    "call-operation": "operation",
    "send": "signal",
    "broadcast": "signal",
    "read": "structuralFeature",
    "write": "structuralFeature",
    "clear": "structuralFeature",
    "remove": "structuralFeature",
    "add-variable-value": "variable",
    "clear-variable": "variable",
    "read-variable": "variable",
    "remove-variable-value": "variable",
    "create": "classifier",
    "create-link-object": "classifier",
    "read-extent": "classifier",
    "read-is-classified-object": "classifier",
    "unmarshall": "unmarshallType",
}
_CALLED = {
    Kind.OPERATION: "operation",
    Kind.SIGNAL: "signal",
    Kind.PROPERTY: "structuralFeature",
    Kind.PORT: "structuralFeature",
    **dict.fromkeys(_BEHAVIOURS, "behavior"),
}

_BY_EDGE: dict[Edge, str] = {
    Edge.TYPED_BY: "type",
    Edge.SUBSETS: "subsettedProperty",
    Edge.CLIENT: "client",
    Edge.SUPPLIER: "supplier",
    Edge.CONVEYS: "conveyed",
    Edge.ROLE: "role",
    Edge.METHOD: "method",
    Edge.CLASSIFIER_BEHAVIOR: "classifierBehavior",
    Edge.REPRESENTS: "represents",
    Edge.COVERS: "covered",
    Edge.SEND_EVENT: "sendEvent",
    Edge.RECEIVE_EVENT: "receiveEvent",
    Edge.START: "start",
    Edge.FINISH: "finish",
    Edge.FLOW_SOURCE: "source",
    Edge.FLOW_TARGET: "target",
}
_BY_KIND: dict[tuple[Kind, Edge], str] = {
    (Kind.RECEPTION, Edge.TYPED_BY): "signal",
    (Kind.GENERALIZATION_SET, Edge.TYPED_BY): "powertype",
    (Kind.ASSOCIATION, Edge.END): "memberEnd",
    (Kind.ITEM_FLOW, Edge.FLOW_SOURCE): "informationSource",
    (Kind.ITEM_FLOW, Edge.FLOW_TARGET): "informationTarget",
    (Kind.GENERAL_ORDERING, Edge.FLOW_SOURCE): "before",
    (Kind.GENERAL_ORDERING, Edge.FLOW_TARGET): "after",
    (Kind.INSTANCE, Edge.INSTANCE_OF): "classifier",
    (Kind.UNIT, Edge.INSTANCE_OF): "classifier",
    (Kind.QUANTITY_KIND, Edge.INSTANCE_OF): "classifier",
    (Kind.SLOT, Edge.INSTANCE_OF): "definingFeature",
    (Kind.TEMPLATE_SUBSTITUTION, Edge.INSTANCE_OF): "formal",
    (Kind.ITEM, Edge.REPRESENTS): "represented",
    (Kind.USE_CASE, Edge.SUBJECT): "subject",
    (Kind.EXTEND, Edge.EXTENDS): "extendedCase",
    (Kind.MESSAGE, Edge.CALLS): "signature",
    (Kind.STATE, Edge.CALLS): "submachine",
    (Kind.FRAGMENT, Edge.CALLS): "refersTo",
    (Kind.COMMENT, Edge.REFERENCES): "annotatedElement",
    (Kind.CONSTRAINT, Edge.REFERENCES): "constrainedElement",
    (Kind.ACTIVITY_PARAMETER, Edge.REFERENCES): "parameter",
    (Kind.PARAMETER_SET, Edge.REFERENCES): "parameter",
    (Kind.EXTEND, Edge.REFERENCES): "extensionLocation",
    (Kind.FRAGMENT, Edge.REFERENCES): "message",
    (Kind.OBSERVATION, Edge.REFERENCES): "event",
    (Kind.TEMPLATE_PARAMETER, Edge.REFERENCES): "parameteredElement",
    (Kind.TEMPLATE_SUBSTITUTION, Edge.REFERENCES): "actual",
    **{(kind, Edge.REDEFINES): "redefinedEdge" for kind in _FLOWS},
    (Kind.TRANSITION, Edge.REDEFINES): "redefinedTransition",
    (Kind.PROPERTY, Edge.REDEFINES): "redefinedProperty",
    (Kind.OPERATION, Edge.REDEFINES): "redefinedOperation",
    (Kind.CONNECTOR, Edge.REDEFINES): "redefinedConnector",
    (Kind.STATE, Edge.REDEFINES): "redefinedState",
    (Kind.FINAL_STATE, Edge.REDEFINES): "redefinedState",
    (Kind.REGION, Edge.REDEFINES): "extendedRegion",
    (Kind.STATE_MACHINE, Edge.REDEFINES): "extendedStateMachine",
    (Kind.ACTIVITY, Edge.REDEFINES): "redefinedBehavior",
    (Kind.INTERACTION, Edge.REDEFINES): "redefinedBehavior",
    **{
        (kind, Edge.REDEFINES): "redefinedNode"
        for kind in (Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL, Kind.OBJECT_NODE)
    },
    **{
        (kind, Edge.REDEFINES): "redefinedClassifier"
        for kind in (
            Kind.CLASS,
            Kind.COMPONENT,
            Kind.INTERFACE,
            Kind.DATA_TYPE,
            Kind.SIGNAL,
            Kind.USE_CASE,
            Kind.ACTOR,
            Kind.ASSOCIATION,
        )
    },
}
_SOURCES: dict[Edge, frozenset[Kind]] = {
    Edge.TYPED_BY: frozenset(
        {
            Kind.PROPERTY,
            Kind.FLOW_PROPERTY,
            Kind.PORT,
            Kind.PARAMETER,
            Kind.PIN,
            Kind.OBJECT_NODE,
            Kind.DATA_STORE,
            Kind.ACTIVITY_PARAMETER,
            Kind.CONNECTOR,
            Kind.COLLABORATION_USE,
            Kind.EXPRESSION,
            Kind.GENERALIZATION_SET,
            Kind.RECEPTION,
        }
    ),
    Edge.REPRESENTS: frozenset({Kind.PARTITION, Kind.LIFELINE, Kind.ITEM}),
    Edge.FLOW_SOURCE: frozenset((*_FLOWS, Kind.ITEM_FLOW, Kind.GENERAL_ORDERING)),
    Edge.FLOW_TARGET: frozenset((*_FLOWS, Kind.ITEM_FLOW, Kind.GENERAL_ORDERING)),
    Edge.CLIENT: frozenset({Kind.DEPENDENCY}),
    Edge.SUPPLIER: frozenset({Kind.DEPENDENCY}),
}
"""Kinds that have the feature, where not all that may have the edge do."""


def feature(source: Element, edge: Edge, target: Element) -> str:
    """The feature of the source that leads to the target; empty when UML has none."""
    if edge in _SOURCES and source.kind not in _SOURCES[edge]:
        return ""
    known = _BY_KIND.get((source.kind, edge))
    if known:
        return known
    special = _SPECIAL.get(edge)
    return special(source, target) if special is not None else _BY_EDGE.get(edge, "")


def _redefined(source: Element, target: Element) -> str:
    if source.kind is Kind.PORT:
        return "redefinedPort" if target.kind is Kind.PORT else "redefinedProperty"
    return ""


def _called(source: Element, target: Element) -> str:
    if source.kind is Kind.ACTION:
        return _CALLS.get(source.subkind) or _CALLED.get(target.kind, "classifier")
    if source.kind is Kind.EXECUTION:
        return "action" if source.subkind == "action" else "behavior"
    return ""


def _referred(source: Element, target: Element) -> str:
    if source.kind is Kind.IMPORT:
        names = {"element": "importedElement", "merge": "mergedPackage"}
        return names.get(source.subkind, "importedPackage")
    if source.subkind == "connection-point":
        return "exit" if target.subkind == "exit-point" else "entry"
    if source.kind in _BEHAVIOURS and target.kind is Kind.OPERATION:
        return "specification"
    return ""


def _in(_source: Element, target: Element) -> str:
    return "inPartition" if target.kind is Kind.PARTITION else "inInterruptibleRegion"


def _realizing(_source: Element, target: Element) -> str:
    names = {
        Kind.CONNECTOR: "realizingConnector",
        Kind.CONTROL_FLOW: "realizingActivityEdge",
        Kind.OBJECT_FLOW: "realizingActivityEdge",
        Kind.MESSAGE: "realizingMessage",
    }
    return names.get(target.kind, "realization")


_SPECIAL = {
    Edge.REDEFINES: _redefined,
    Edge.CALLS: _called,
    Edge.REFERENCES: _referred,
    Edge.IN_PARTITION: _in,
    Edge.REALIZING: _realizing,
}
