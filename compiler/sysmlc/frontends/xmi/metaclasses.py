"""Tables that map the metaclasses of UML to kinds of the graph (docs/ir.md)."""

import re
from functools import cache

from sysmlc.ir import Kind
from sysmlc.ir.verify import OWNERS as OWNERS_IN_GRAPHS

_WITHOUT_SUBKIND = {
    "Package": Kind.PACKAGE,
    "Profile": Kind.PROFILE,
    "Class": Kind.CLASS,
    "Component": Kind.COMPONENT,
    "Interface": Kind.INTERFACE,
    "DataType": Kind.DATA_TYPE,
    "Enumeration": Kind.ENUMERATION,
    "EnumerationLiteral": Kind.ENUMERATION_LITERAL,
    "Signal": Kind.SIGNAL,
    "Association": Kind.ASSOCIATION,
    "Stereotype": Kind.STEREOTYPE,
    "UseCase": Kind.USE_CASE,
    "Actor": Kind.ACTOR,
    "InformationItem": Kind.ITEM,
    "Property": Kind.PROPERTY,
    "Port": Kind.PORT,
    "Connector": Kind.CONNECTOR,
    "ConnectorEnd": Kind.CONNECTOR_END,
    "InformationFlow": Kind.ITEM_FLOW,
    "Operation": Kind.OPERATION,
    "Reception": Kind.RECEPTION,
    "Parameter": Kind.PARAMETER,
    "InstanceSpecification": Kind.INSTANCE,
    "Slot": Kind.SLOT,
    "Constraint": Kind.CONSTRAINT,
    "Comment": Kind.COMMENT,
    "Activity": Kind.ACTIVITY,
    "ActivityParameterNode": Kind.ACTIVITY_PARAMETER,
    "CentralBufferNode": Kind.OBJECT_NODE,
    "DataStoreNode": Kind.DATA_STORE,
    "ControlFlow": Kind.CONTROL_FLOW,
    "ObjectFlow": Kind.OBJECT_FLOW,
    "ActivityPartition": Kind.PARTITION,
    "StateMachine": Kind.STATE_MACHINE,
    "Region": Kind.REGION,
    "State": Kind.STATE,
    "FinalState": Kind.FINAL_STATE,
    "Pseudostate": Kind.PSEUDOSTATE,
    "Transition": Kind.TRANSITION,
    "Trigger": Kind.TRIGGER,
    "Interaction": Kind.INTERACTION,
    "Lifeline": Kind.LIFELINE,
    "Message": Kind.MESSAGE,
    "OccurrenceSpecification": Kind.OCCURRENCE,
    "InteractionOperand": Kind.OPERAND,
    "Gate": Kind.GATE,
    "GeneralOrdering": Kind.GENERAL_ORDERING,
    "Extend": Kind.EXTEND,
    "ExtensionPoint": Kind.EXTENSION_POINT,
    "CollaborationUse": Kind.COLLABORATION_USE,
    "ParameterSet": Kind.PARAMETER_SET,
    "GeneralizationSet": Kind.GENERALIZATION_SET,
    "TemplateParameter": Kind.TEMPLATE_PARAMETER,
    "TemplateBinding": Kind.TEMPLATE_BINDING,
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

DEFAULT_TYPES = {
    "ownedParameter": "Parameter",
    "ownedComment": "Comment",
    "ownedOperation": "Operation",
    "ownedReception": "Reception",
    "ownedAttribute": "Property",
    "ownedEnd": "Property",
    "ownedLiteral": "EnumerationLiteral",
    "ownedConnector": "Connector",
    "ownedRule": "Constraint",
    "ownedPort": "Port",
    "qualifier": "Property",
    "generalization": "Generalization",
    "interfaceRealization": "InterfaceRealization",
    "packageImport": "PackageImport",
    "elementImport": "ElementImport",
    "packageMerge": "PackageMerge",
    "metamodelReference": "PackageImport",
    "metaclassReference": "ElementImport",
    "profileApplication": "ProfileApplication",
    "ownedStereotype": "Stereotype",
    "configuration": "DeploymentSpecification",
    "deployment": "Deployment",
    "manifestation": "Manifestation",
    "nestedArtifact": "Artifact",
    "nestedNode": "Node",
    "realization": "ComponentRealization",
    "variable": "Variable",
    "nestedPackage": "Package",
    "precondition": "Constraint",
    "postcondition": "Constraint",
    "bodyCondition": "Constraint",
    "localPrecondition": "Constraint",
    "localPostcondition": "Constraint",
    "stateInvariant": "Constraint",
    "end": "ConnectorEnd",
    "slot": "Slot",
    "extend": "Extend",
    "include": "Include",
    "extensionPoint": "ExtensionPoint",
    "region": "Region",
    "transition": "Transition",
    "subvertex": "State",
    "connectionPoint": "Pseudostate",
    "trigger": "Trigger",
    "deferrableTrigger": "Trigger",
    "structuredNode": "StructuredActivityNode",
    "partition": "ActivityPartition",
    "subpartition": "ActivityPartition",
    "lifeline": "Lifeline",
    "message": "Message",
    "guard": "InteractionConstraint",
    "invariant": "Constraint",
    "operand": "InteractionOperand",
    "generalOrdering": "GeneralOrdering",
    "formalGate": "Gate",
    "actualGate": "Gate",
    "cfragmentGate": "Gate",
    "condition": "Constraint",
    "ownedUseCase": "UseCase",
    "connection": "ConnectionPointReference",
    "conformance": "ProtocolConformance",
    "protocol": "ProtocolStateMachine",
    "preCondition": "Constraint",
    "postCondition": "Constraint",
    "collaborationUse": "CollaborationUse",
    "roleBinding": "Dependency",
    "substitution": "Substitution",
    "ownedParameterSet": "ParameterSet",
    "ownedTemplateSignature": "TemplateSignature",
    "templateBinding": "TemplateBinding",
    "parameterSubstitution": "TemplateParameterSubstitution",
    "handler": "ExceptionHandler",
    "clause": "Clause",
    "endData": "LinkEndData",
    "argument": "InputPin",
    "inputValue": "InputPin",
    "input": "InputPin",
    "object": "InputPin",
    "target": "InputPin",
    "first": "InputPin",
    "second": "InputPin",
    "value": "InputPin",
    "insertAt": "InputPin",
    "removeAt": "InputPin",
    "exception": "InputPin",
    "request": "InputPin",
    "replyValue": "InputPin",
    "collection": "InputPin",
    "loopVariableInput": "InputPin",
    "structuredNodeInput": "InputPin",
    "result": "OutputPin",
    "outputValue": "OutputPin",
    "output": "OutputPin",
    "loopVariable": "OutputPin",
    "returnInformation": "OutputPin",
    "structuredNodeOutput": "OutputPin",
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

LITERALS = frozenset(
    {
        "LiteralBoolean",
        "LiteralInteger",
        "LiteralReal",
        "LiteralString",
        "LiteralUnlimitedNatural",
        "LiteralNull",
    }
)
VALUE_TYPES = LITERALS | frozenset(
    {
        "InstanceValue",
        "ElementValue",
        "OpaqueExpression",
        "Expression",
        "StringExpression",
        "TimeExpression",
        "Duration",
        "Interval",
        "TimeInterval",
        "DurationInterval",
    }
)
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
        return Kind.ACTION, _action_subkind(type_name)
    return mapped


def _action_subkind(type_name: str) -> str:
    return _ACTIONS.get(type_name) or to_kebab_case(type_name.removesuffix("Action"))


@cache
def to_kebab_case(name: str) -> str:
    """Convert ``camelCase`` to ``camel-case``."""
    return _CAPITAL.sub(r"-\1", name).lower()
