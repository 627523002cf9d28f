"""Tables that map the features of UML to edges and attributes of the graph (docs/ir.md)."""

import re
from functools import cache

from sysmlc.ir import Edge, Kind

_CAPITAL = re.compile(r"(?<=[a-z0-9])([A-Z])")
_FLAG = re.compile(r"is[A-Z]")

NOTATION_FEATURES = frozenset({"eAnnotations", "icon", "Documentation", "Extension", "Diagram"})
"""Features whose content is notation or settings of a tool."""

EXTENSION_CONTENT = ("primitivetypes", "profiles")
"""Parts of Enterprise Architect's extension that contain UML elements."""

_FEATURES_BY_EDGE = {
    Edge.TYPED_BY: "type powertype",
    Edge.SUBSETS: "subsettedProperty",
    Edge.REDEFINES: (
        "redefinedProperty redefinedPort redefinedOperation redefinedClassifier "
        "redefinedBehavior redefinedConnector redefinedNode redefinedEdge redefinedState "
        "redefinedTransition extendedRegion extendedStateMachine"
    ),
    Edge.END: "memberEnd",
    Edge.ROLE: "role",
    Edge.CLIENT: "client realizingClassifier",
    Edge.SUPPLIER: "supplier utilizedElement deployedArtifact",
    Edge.CONVEYS: "conveyed",
    Edge.FLOW_SOURCE: "informationSource source before",
    Edge.FLOW_TARGET: "informationTarget target after",
    Edge.REALIZING: "realization realizingConnector realizingActivityEdge realizingMessage",
    Edge.REPRESENTS: "represented represents",
    Edge.REFERENCES: (
        "annotatedElement constrainedElement importedPackage importedElement mergedPackage "
        "parameter extensionLocation actual parameteredElement generalization entry exit"
    ),
    Edge.CLASSIFIER_BEHAVIOR: "classifierBehavior",
    Edge.METHOD: "method",
    Edge.CALLS: (
        "behavior operation signal structuralFeature variable unmarshallType signature "
        "submachine action refersTo"
    ),
    Edge.INSTANCE_OF: "classifier definingFeature formal",
    Edge.IN_PARTITION: "inPartition inInterruptibleRegion",
    Edge.SUBJECT: "subject",
    Edge.EXTENDS: "extendedCase",
    Edge.COVERS: "covered",
    Edge.SEND_EVENT: "sendEvent",
    Edge.RECEIVE_EVENT: "receiveEvent",
    Edge.START: "start",
    Edge.FINISH: "finish",
}
REFERENCES: dict[str, Edge] = {
    feature: edge for edge, features in _FEATURES_BY_EDGE.items() for feature in features.split()
}
"""Edge of a feature that refers to elements; ``REFERENCES_BY_KIND`` overrides it for some kinds."""

FOLDED_REFERENCES: dict[str, Edge] = {
    "general": Edge.SPECIALIZES,
    "contract": Edge.REALIZES,
    "appliedProfile": Edge.APPLIES,
    "addition": Edge.INCLUDES,
    "generalMachine": Edge.REALIZES,
}
"""References of elements that become an edge; the edge leaves the owner of such an element."""

REFERENCES_BY_KIND: dict[tuple[Kind, str], Edge] = {
    (Kind.ACTION, "classifier"): Edge.CALLS,
    (Kind.RECEPTION, "signal"): Edge.TYPED_BY,
    (Kind.TEMPLATE_BINDING, "signature"): Edge.BINDS,
    (Kind.STATE, "entry"): Edge.ENTRY,
    (Kind.STATE, "exit"): Edge.EXIT,
    (Kind.STATE, "doActivity"): Edge.DO,
    (Kind.TRANSITION, "effect"): Edge.EFFECT,
}
"""Edges of features that have another meaning for these kinds."""

_SUBJECTS = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.INTERFACE,
    Kind.DATA_TYPE,
    Kind.ASSOCIATION,
    Kind.ACTIVITY,
    Kind.STATE_MACHINE,
    Kind.INTERACTION,
)
"""Classifiers that may be the subject of use cases."""

REVERSED: dict[tuple[Kind, str], Edge] = {
    (Kind.ACTIVITY, "specification"): Edge.METHOD,
    (Kind.STATE_MACHINE, "specification"): Edge.METHOD,
    (Kind.INTERACTION, "specification"): Edge.METHOD,
    (Kind.PARTITION, "node"): Edge.IN_PARTITION,
    (Kind.STRUCTURED, "node"): Edge.IN_PARTITION,
    **{(kind, "useCase"): Edge.SUBJECT for kind in _SUBJECTS},
}
"""Features whose edge leads from the target to the element that has the feature."""

_REDUNDANT_WORDS = """
    incoming outgoing clientDependency supplierDependency navigableOwnedEnd association coveredBy
    specialization powertypeExtent endType relatedElement relatedType containedEdge containedNode
    edge group inGroup inStructuredNode node partition structuredNode owner ownedMember member
    metaclassReference metamodelReference interfaceRealization importingNamespace receivingPackage
    applyingPackage informationFlow class ownedEnd container context activity state stateMachine
    owningPackage interaction collaborationRole attribute feature required provided result argument
    owningProperty owningParameter owningExpression subExpression bodyPin message useCase toBefore
    toAfter execution enclosingInteraction enclosingOperand extension includingCase specificMachine
    parameterSet scope activityScope boundElement template templateBinding templateParameter
    owningTemplateParameter ownedRule packageImport elementImport contract specific
    redefinitionContext subsettingContext
"""
REDUNDANT = frozenset(_REDUNDANT_WORDS.split())
"""References that repeat the reference of the other end, or ownership; no edge follows them."""

TRUE = frozenset({"true", "1"})
"""The two ways to write a true xs:boolean (XML Schema part 2, clause 3.2.2)."""

FLAGS = {
    "isAbstract": "abstract",
    "isConjugated": "conjugated",
    "isOrdered": "ordered",
    "isDerived": "derived",
    "isReadOnly": "readonly",
    "isStatic": "static",
    "isActive": "active",
    "isBehavior": "behavior",
    "isTestedFirst": "tested_first",
    "isRelative": "relative",
}
"""Attributes that are true or absent in the graph, with their names there."""

UNLESS_FALSE = {"isUnique": "unique", "isService": "service", "isReentrant": "reentrant"}
"""Attributes whose default is true: false or absent in the graph."""

TEXTS = {
    "aggregation": ("aggregation", "none"),
    "visibility": ("visibility", "public"),
    "direction": ("direction", ""),
    "body": ("body", ""),
    "language": ("language", ""),
    "alias": ("alias", ""),
}
"""Text attributes: their name in the graph, and the value that is not stored."""

_DEFAULTS = {
    "allowSubstitutable": "true",
    "concurrency": "sequential",
    "firstEvent": "true",
    "interactionOperator": "seq",
    "isCombineDuplicate": "true",
    "isIndirectlyInstantiated": "true",
    "isSubstitutable": "true",
    "isSynchronous": "true",
    "messageSort": "synchCall",
    "mode": "iterative",
    "mustIsolate": "false",
    "ordering": "FIFO",
    "setting": "true",
}
"""Default values, which tools write or omit (UML 2.5.1, defaults of the metamodel).

Other flags are false by default; numbers and texts have no default.
"""

PIN_DIRECTIONS = {"InputPin": "in", "ValuePin": "in", "ActionInputPin": "in", "OutputPin": "out"}

CONDITIONS = {
    "precondition": "precondition",
    "postcondition": "postcondition",
    "bodyCondition": "body",
    "localPrecondition": "precondition",
    "localPostcondition": "postcondition",
    "stateInvariant": "invariant",
    "invariant": "invariant",
    "condition": "condition",
    "preCondition": "precondition",
    "postCondition": "postcondition",
}
"""Subkind of a constraint by the feature that owns it or refers to it."""

STATE_BEHAVIOURS = {
    "entry": Edge.ENTRY,
    "doActivity": Edge.DO,
    "exit": Edge.EXIT,
    "effect": Edge.EFFECT,
}

_LISTS_WORDS = """
    test body_part setup_part loop_variable body_output input_element output_element observations
"""
LISTS = frozenset(_LISTS_WORDS.split())
"""Attributes with ids that are tuples even if there is only one id."""

TARGET_KINDS: dict[str, Kind] = {
    "appliedProfile": Kind.PROFILE,
    "importedPackage": Kind.PACKAGE,
    "role": Kind.PORT,
    "partWithPort": Kind.PROPERTY,
    "propertyPath": Kind.PROPERTY,
    "behavior": Kind.ACTIVITY,
    "operation": Kind.OPERATION,
    "signal": Kind.SIGNAL,
    "structuralFeature": Kind.PROPERTY,
    "definingFeature": Kind.PROPERTY,
    "subsettedProperty": Kind.PROPERTY,
    "redefinedProperty": Kind.PROPERTY,
    "redefinedPort": Kind.PORT,
    "redefinedOperation": Kind.OPERATION,
    "contract": Kind.INTERFACE,
    "instance": Kind.INSTANCE,
    "method": Kind.ACTIVITY,
    "realizingConnector": Kind.CONNECTOR,
    "parameter": Kind.PARAMETER,
    "represents": Kind.PROPERTY,
    "addition": Kind.USE_CASE,
    "extendedCase": Kind.USE_CASE,
    "refersTo": Kind.INTERACTION,
    "covered": Kind.LIFELINE,
    "formal": Kind.TEMPLATE_PARAMETER,
    "unit": Kind.UNIT,
    "quantityKind": Kind.QUANTITY_KIND,
    "dimension": Kind.QUANTITY_KIND,
}
"""Likely kind of an external target, by the feature that refers to it."""


@cache
def to_snake_case(name: str) -> str:
    """Return the graph's attribute name for a feature that no table maps."""
    plain = name[2:] if _FLAG.match(name) else name
    return _CAPITAL.sub(r"_\1", plain).lower()


@cache
def default_value(name: str) -> str:
    """Return the default value of an attribute that no other table maps."""
    return _DEFAULTS.get(name, "false" if _FLAG.match(name) else "")
