"""Features of UML 2.5.1 that express attributes and edges of the graph."""

import re
from functools import cache

from sysmlc.ir import Edge, Element, Kind

_WORD_START = re.compile(r"[-_](\w)")
_BOOLEANS = """Abstract Active Assured Behavior CombineDuplicate Composite Conjugated Control
    ControlType Covering Derived DerivedUnion DestroyDuplicates DestroyLinks DestroyOwnedObjects
    Determinate Dimension Direct Disjoint Exception External FinalSpecialization ID
    IndirectlyInstantiated Leaf LocallyReentrant Multicast Multireceive Ordered Orthogonal Query
    ReadOnly Reentrant Relative RemoveDuplicates ReplaceAll Required Service Simple
    SingleExecution Static Stream Strict Substitutable Synchronous TestedFirst Unique
    Unmarshall"""
# The graph names these without the prefix: isReadOnly is read_only.
_FLAGS = {
    re.sub(r"(?<=[a-z0-9])([A-Z])", r"_\1", name).lower(): f"is{name}" for name in _BOOLEANS.split()
}
_BY_ATTRIBUTE = _FLAGS | {"readonly": "isReadOnly", "uri": "URI", "u_r_i": "URI"}
_SAME_NAMES = """
    activity aggregation alias allowSubstitutable concurrency context decider decisionInput
    decisionInputFlow decomposedAs definingEnd effect ordering bodyOutput bodyPart
    changeExpression classifierBehavior condition conveyed deploymentLocation direction end
    exceptionInput exceptionType executionLocation extendedSignature extension fileName
    firstEvent fromAction handlerBody implementingClassifier incoming inputElement insertAt
    inState interruptingEdge interrupts isolated language loopVariable loopVariableInput mapping
    messageKind mode mustIsolate newClassifier oldClassifier onPort outputElement
    parameterSet port predecessorClause successorClause protocol qualifiedName regionAsInput
    regionAsOutput result selection setting setupPart stateInvariant substitutingClassifier test
    transformation transition unmarshallType URI useCase viewpoint replyToCall
    returnInformation instance visibility metamodelReference metaclassReference lower upper
    contract representation symbol priority isSubmachineState selector joinSpec location
    format content target sort value"""
_SAME = frozenset(_SAME_NAMES.split())
"""Features of UML that attributes of the graph are named after, in ``snake_case``."""


@cache
def to_camel_case(name: str) -> str:
    """Return a ``hyphenated-name`` or ``snake_name`` as ``camelCase``."""
    return _WORD_START.sub(lambda match: match[1].upper(), name)


@cache
def to_class_name(name: str) -> str:
    """Return a ``hyphenated-name`` as ``CamelCase``."""
    camel = to_camel_case(name)
    return camel[:1].upper() + camel[1:]


@cache
def find_attribute_feature(attribute: str) -> str:
    """Return the feature for an attribute of the graph, or the empty string."""
    if attribute in _BY_ATTRIBUTE:
        return _BY_ATTRIBUTE[attribute]
    camel = to_camel_case(attribute)
    return camel if camel in _SAME else ""


# -- edges -------------------------------------------------------------------------------------

_BEHAVIOURS = (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION, Kind.TEST_CASE)
_FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION)
_BY_ACTION = {
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
_BY_CALLED_KIND = {
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
_SOURCE_KINDS: dict[Edge, frozenset[Kind]] = {
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
"""Kinds of sources that have the feature, for edges whose other sources have none."""


def find_edge_feature(source: Element, edge: Edge, target: Element) -> str:
    """Return the feature of the source that refers to the target, or the empty string."""
    if edge in _SOURCE_KINDS and source.kind not in _SOURCE_KINDS[edge]:
        return ""
    feature = _BY_KIND.get((source.kind, edge))
    if feature:
        return feature
    if edge in _FINDERS:
        return _FINDERS[edge](source, target)
    return _BY_EDGE.get(edge, "")


def _find_redefining(source: Element, target: Element) -> str:
    if source.kind is Kind.PORT:
        return "redefinedPort" if target.kind is Kind.PORT else "redefinedProperty"
    return ""


def _find_calling(source: Element, target: Element) -> str:
    if source.kind is Kind.ACTION:
        return _BY_ACTION.get(source.subkind) or _BY_CALLED_KIND.get(target.kind, "classifier")
    if source.kind is Kind.EXECUTION:
        return "action" if source.subkind == "action" else "behavior"
    return ""


def _find_referring(source: Element, target: Element) -> str:
    if source.kind is Kind.IMPORT:
        names = {"element": "importedElement", "merge": "mergedPackage"}
        return names.get(source.subkind, "importedPackage")
    if source.subkind == "connection-point":
        return "exit" if target.subkind == "exit-point" else "entry"
    if source.kind in _BEHAVIOURS and target.kind is Kind.OPERATION:
        return "specification"
    return ""


def _find_realizing(_source: Element, target: Element) -> str:
    names = {
        Kind.CONNECTOR: "realizingConnector",
        Kind.CONTROL_FLOW: "realizingActivityEdge",
        Kind.OBJECT_FLOW: "realizingActivityEdge",
        Kind.MESSAGE: "realizingMessage",
    }
    return names.get(target.kind, "realization")


_FINDERS = {
    Edge.REDEFINES: _find_redefining,
    Edge.CALLS: _find_calling,
    Edge.REFERENCES: _find_referring,
    Edge.IN_PARTITION: lambda _, target: (
        "inPartition" if target.kind is Kind.PARTITION else "inInterruptibleRegion"
    ),
    Edge.REALIZING: _find_realizing,
}
"""Functions for edges whose feature depends on the target."""
