"""Tables that map the metaclasses of UML to kinds of the graph (docs/ir.md)."""

import re
from functools import cache

from sysmlc.ir import Kind
from sysmlc.ir.verify import OWNERS as OWNERS_IN_GRAPHS

_KINDS_BY_NAME = """
    Package Profile Class Component Interface DataType Enumeration EnumerationLiteral Signal
    Association Stereotype UseCase Actor Property Port Connector ConnectorEnd Operation Reception
    Parameter Slot Constraint Comment Activity ControlFlow ObjectFlow StateMachine Region State
    FinalState Pseudostate Transition Trigger Interaction Lifeline Message Gate GeneralOrdering
    Extend ExtensionPoint CollaborationUse ParameterSet GeneralizationSet TemplateParameter
    TemplateBinding
"""
"""Metaclasses whose kind has the same name."""
_WITHOUT_SUBKIND = {
    **{name: Kind(name) for name in _KINDS_BY_NAME.split()},
    "InformationItem": Kind.ITEM,
    "InformationFlow": Kind.ITEM_FLOW,
    "InstanceSpecification": Kind.INSTANCE,
    "ActivityParameterNode": Kind.ACTIVITY_PARAMETER,
    "CentralBufferNode": Kind.OBJECT_NODE,
    "DataStoreNode": Kind.DATA_STORE,
    "ActivityPartition": Kind.PARTITION,
    "OccurrenceSpecification": Kind.OCCURRENCE,
    "InteractionOperand": Kind.OPERAND,
    "TemplateParameterSubstitution": Kind.TEMPLATE_SUBSTITUTION,
}
_WITH_SUBKIND = {
    "Model": (Kind.PACKAGE, "model"),
    "PrimitiveType": (Kind.DATA_TYPE, "primitive"),
    "AssociationClass": (Kind.ASSOCIATION, "association-class"),
    "CommunicationPath": (Kind.ASSOCIATION, "communication-path"),
    "Collaboration": (Kind.CLASS, "collaboration"),
    "Node": (Kind.CLASS, "node"),
    "Device": (Kind.CLASS, "device"),
    "ExecutionEnvironment": (Kind.CLASS, "execution-environment"),
    "Artifact": (Kind.CLASS, "artifact"),
    "DeploymentSpecification": (Kind.CLASS, "deployment-specification"),
    "Variable": (Kind.PROPERTY, "variable"),
    "ClassifierTemplateParameter": (Kind.TEMPLATE_PARAMETER, "classifier"),
    "OperationTemplateParameter": (Kind.TEMPLATE_PARAMETER, "operation"),
    "ConnectableElementTemplateParameter": (Kind.TEMPLATE_PARAMETER, "connectable-element"),
    "PackageImport": (Kind.IMPORT, "package"),
    "ElementImport": (Kind.IMPORT, "element"),
    "PackageMerge": (Kind.IMPORT, "merge"),
    "Dependency": (Kind.DEPENDENCY, "dependency"),
    "Abstraction": (Kind.DEPENDENCY, "abstraction"),
    "Realization": (Kind.DEPENDENCY, "realization"),
    "ComponentRealization": (Kind.DEPENDENCY, "component-realization"),
    "Substitution": (Kind.DEPENDENCY, "substitution"),
    "Usage": (Kind.DEPENDENCY, "usage"),
    "Manifestation": (Kind.DEPENDENCY, "manifestation"),
    "Deployment": (Kind.DEPENDENCY, "deployment"),
    "InteractionConstraint": (Kind.CONSTRAINT, "interaction"),
    "IntervalConstraint": (Kind.CONSTRAINT, "interval"),
    "DurationConstraint": (Kind.CONSTRAINT, "duration"),
    "TimeConstraint": (Kind.CONSTRAINT, "time"),
    "MessageOccurrenceSpecification": (Kind.OCCURRENCE, "message"),
    "ExecutionOccurrenceSpecification": (Kind.OCCURRENCE, "execution"),
    "DestructionOccurrenceSpecification": (Kind.OCCURRENCE, "destruction"),
    "BehaviorExecutionSpecification": (Kind.EXECUTION, "behavior"),
    "ActionExecutionSpecification": (Kind.EXECUTION, "action"),
    "CombinedFragment": (Kind.FRAGMENT, "seq"),
    "ConsiderIgnoreFragment": (Kind.FRAGMENT, "consider"),
    "InteractionUse": (Kind.FRAGMENT, "ref"),
    "PartDecomposition": (Kind.FRAGMENT, "part-decomposition"),
    "StateInvariant": (Kind.FRAGMENT, "state-invariant"),
    "Continuation": (Kind.FRAGMENT, "continuation"),
    # Names of UML 2.0, in old exports of Enterprise Architect and MagicDraw.
    "EventOccurrence": (Kind.OCCURRENCE, "message"),
    "Stop": (Kind.OCCURRENCE, "destruction"),
    "ExecutionOccurrence": (Kind.EXECUTION, "behavior"),
    "InteractionOccurrence": (Kind.FRAGMENT, "ref"),
    "TimeObservation": (Kind.OBSERVATION, "time"),
    "DurationObservation": (Kind.OBSERVATION, "duration"),
    "OpaqueBehavior": (Kind.ACTIVITY, "opaque"),
    "FunctionBehavior": (Kind.ACTIVITY, "function"),
    "ProtocolStateMachine": (Kind.STATE_MACHINE, "protocol"),
    "ProtocolTransition": (Kind.TRANSITION, "protocol"),
    "ConnectionPointReference": (Kind.PSEUDOSTATE, "connection-point"),
    "ExpansionNode": (Kind.OBJECT_NODE, "expansion"),
    "InitialNode": (Kind.CONTROL, "initial"),
    "ActivityFinalNode": (Kind.CONTROL, "final"),
    "FlowFinalNode": (Kind.CONTROL, "flow-final"),
    "DecisionNode": (Kind.CONTROL, "decision"),
    "MergeNode": (Kind.CONTROL, "merge"),
    "ForkNode": (Kind.CONTROL, "fork"),
    "JoinNode": (Kind.CONTROL, "join"),
    "StructuredActivityNode": (Kind.STRUCTURED, "structured"),
    "ConditionalNode": (Kind.STRUCTURED, "conditional"),
    "LoopNode": (Kind.STRUCTURED, "loop"),
    "SequenceNode": (Kind.STRUCTURED, "sequence"),
    "ExpansionRegion": (Kind.STRUCTURED, "expansion"),
    "InterruptibleActivityRegion": (Kind.STRUCTURED, "interruptible"),
    "InputPin": (Kind.PIN, ""),
    "OutputPin": (Kind.PIN, ""),
    "ValuePin": (Kind.PIN, ""),
    "ActionInputPin": (Kind.PIN, ""),
}
_ACTIONS = {
    "CallBehaviorAction": "call-behavior",
    "CallOperationAction": "call-operation",
    "SendSignalAction": "send",
    "BroadcastSignalAction": "broadcast",
    "AcceptEventAction": "accept",
    "AcceptCallAction": "accept-call",
    "ReadStructuralFeatureAction": "read",
    "AddStructuralFeatureValueAction": "write",
    "ClearStructuralFeatureAction": "clear",
    "RemoveStructuralFeatureValueAction": "remove",
    "CreateObjectAction": "create",
    "DestroyObjectAction": "destroy",
    "ValueSpecificationAction": "value",
    "RaiseExceptionAction": "raise",
    "StartObjectBehaviorAction": "start",
}
_ACTION = re.compile(r"[A-Z][A-Za-z]*Action$")
_CAPITAL = re.compile(r"(?<=[a-z0-9])([A-Z])")

KINDS: dict[str, tuple[Kind, str]] = {
    **{name: (kind, "") for name, kind in _WITHOUT_SUBKIND.items()},
    **_WITH_SUBKIND,
}
"""Kind and subkind of each metaclass that becomes an element; ``kind_of`` adds the actions."""

_FEATURES_BY_METACLASS = {
    "Parameter": "ownedParameter",
    "Comment": "ownedComment",
    "Operation": "ownedOperation",
    "Reception": "ownedReception",
    "Property": "ownedAttribute ownedEnd qualifier",
    "EnumerationLiteral": "ownedLiteral",
    "Connector": "ownedConnector",
    "Constraint": (
        "ownedRule precondition postcondition bodyCondition localPrecondition "
        "localPostcondition stateInvariant invariant condition preCondition postCondition"
    ),
    "Port": "ownedPort",
    "Generalization": "generalization",
    "InterfaceRealization": "interfaceRealization",
    "PackageImport": "packageImport metamodelReference",
    "ElementImport": "elementImport metaclassReference",
    "PackageMerge": "packageMerge",
    "ProfileApplication": "profileApplication",
    "Stereotype": "ownedStereotype",
    "DeploymentSpecification": "configuration",
    "Deployment": "deployment",
    "Manifestation": "manifestation",
    "Artifact": "nestedArtifact",
    "Node": "nestedNode",
    "ComponentRealization": "realization",
    "Variable": "variable",
    "Package": "nestedPackage",
    "ConnectorEnd": "end",
    "Slot": "slot",
    "Extend": "extend",
    "Include": "include",
    "ExtensionPoint": "extensionPoint",
    "Region": "region",
    "Transition": "transition",
    "State": "subvertex",
    "Pseudostate": "connectionPoint",
    "Trigger": "trigger deferrableTrigger",
    "StructuredActivityNode": "structuredNode",
    "ActivityPartition": "partition subpartition",
    "Lifeline": "lifeline",
    "Message": "message",
    "InteractionConstraint": "guard",
    "InteractionOperand": "operand",
    "GeneralOrdering": "generalOrdering",
    "Gate": "formalGate actualGate cfragmentGate",
    "UseCase": "ownedUseCase",
    "ConnectionPointReference": "connection",
    "ProtocolConformance": "conformance",
    "ProtocolStateMachine": "protocol",
    "CollaborationUse": "collaborationUse",
    "Dependency": "roleBinding",
    "Substitution": "substitution",
    "ParameterSet": "ownedParameterSet",
    "TemplateSignature": "ownedTemplateSignature",
    "TemplateBinding": "templateBinding",
    "TemplateParameterSubstitution": "parameterSubstitution",
    "ExceptionHandler": "handler",
    "Clause": "clause",
    "LinkEndData": "endData",
    "InputPin": (
        "argument inputValue input object target first second value insertAt removeAt "
        "exception request replyValue collection loopVariableInput structuredNodeInput"
    ),
    "OutputPin": "result outputValue output loopVariable returnInformation structuredNodeOutput",
}
DEFAULT_TYPES = {
    feature: metaclass
    for metaclass, features in _FEATURES_BY_METACLASS.items()
    for feature in features.split()
}
"""Metaclass of an element without ``xmi:type``: the declared type of its feature (UML 2.5.1)."""

EDGE_TYPES = (
    "Generalization",
    "InterfaceRealization",
    "ProfileApplication",
    "ProtocolConformance",
    "Include",
)
"""Metaclasses whose elements become an edge of their owner."""

EVENT_TYPES = {
    "SignalEvent": "signal",
    "CallEvent": "call",
    "TimeEvent": "time",
    "ChangeEvent": "change",
    "AnyReceiveEvent": "any",
    "ReceiveSignalEvent": "signal",
    "ReceiveOperationEvent": "call",
    "SendSignalEvent": "signal",
    "SendOperationEvent": "call",
}
"""Metaclasses of events and the subkind of the triggers that refer to them.

An event is no element: its content becomes part of these triggers.
"""

_LITERALS_WORDS = """
    LiteralBoolean LiteralInteger LiteralReal LiteralString LiteralUnlimitedNatural LiteralNull
"""
LITERALS = frozenset(_LITERALS_WORDS.split())
_VALUE_TYPES_WORDS = """
    InstanceValue ElementValue OpaqueExpression Expression StringExpression TimeExpression Duration
    Interval TimeInterval DurationInterval
"""
VALUE_TYPES = LITERALS | frozenset(_VALUE_TYPES_WORDS.split())
"""Metaclasses of value specifications (UML 2.5.1 clause 8)."""

OWNERS: dict[Kind, frozenset[Kind]] = {
    **OWNERS_IN_GRAPHS,
    Kind.OPERAND: frozenset({Kind.FRAGMENT}),
    Kind.TEMPLATE_SUBSTITUTION: frozenset({Kind.TEMPLATE_BINDING}),
}
"""Owners that elements of a kind may have; elements below other owners are not read."""


def kind_of(type_name: str) -> tuple[Kind, str] | None:
    """Return kind and subkind of a metaclass that becomes an element, else None."""
    mapped = KINDS.get(type_name)
    if mapped is None and _ACTION.match(type_name):
        subkind = _ACTIONS.get(type_name) or to_kebab_case(type_name.removesuffix("Action"))
        return Kind.ACTION, subkind
    return mapped


@cache
def to_kebab_case(name: str) -> str:
    """Convert ``camelCase`` to ``camel-case``."""
    return _CAPITAL.sub(r"-\1", name).lower()
