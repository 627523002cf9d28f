"""Tables: what the metaclasses of UML become in the graph (docs/ir.md)."""

import re

from sysmlc.ir import Kind

_PLAIN = {
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
}
_DIVIDED = {
    "Model": (Kind.PACKAGE, "model"),
    "PrimitiveType": (Kind.DATA_TYPE, "primitive"),
    "AssociationClass": (Kind.ASSOCIATION, "association-class"),
    "CommunicationPath": (Kind.ASSOCIATION, "communication-path"),
    "Collaboration": (Kind.CLASS, "collaboration"),
    "Node": (Kind.CLASS, "node"),
    "Device": (Kind.CLASS, "device"),
    "ExecutionEnvironment": (Kind.CLASS, "execution-environment"),
    "Artifact": (Kind.CLASS, "artifact"),
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
    "OpaqueBehavior": (Kind.ACTIVITY, "opaque"),
    "FunctionBehavior": (Kind.ACTIVITY, "function"),
    "ProtocolStateMachine": (Kind.STATE_MACHINE, "protocol"),
    "ProtocolTransition": (Kind.TRANSITION, "protocol"),
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

KINDS: dict[str, tuple[Kind, str]] = {name: (kind, "") for name, kind in _PLAIN.items()} | _DIVIDED
"""Kind and subkind of each metaclass that becomes an element; actions are ``kind_of``'s."""

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
    "lifeline": "Lifeline",
    "message": "Message",
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
    "loopVariableInput": "InputPin",
    "structuredNodeInput": "InputPin",
    "result": "OutputPin",
    "outputValue": "OutputPin",
    "output": "OutputPin",
    "loopVariable": "OutputPin",
    "returnInformation": "OutputPin",
    "structuredNodeOutput": "OutputPin",
}
"""Type of an element without ``xmi:type``: the declared type of its feature (UML 2.5.1)."""

EDGE_TYPES = ("Generalization", "InterfaceRealization", "ProfileApplication", "Include", "Extend")
"""Metaclasses that are an edge of their owner."""

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
"""Metaclasses that become part of the triggers that name them, and the triggers' subkind."""

VALUE_TYPES = frozenset(
    {
        "LiteralBoolean",
        "LiteralInteger",
        "LiteralReal",
        "LiteralString",
        "LiteralUnlimitedNatural",
        "LiteralNull",
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
    Kind.REGION: frozenset({Kind.STATE_MACHINE, Kind.STATE}),
    Kind.STATE: frozenset({Kind.REGION}),
    Kind.FINAL_STATE: frozenset({Kind.REGION}),
    Kind.CONNECTOR_END: frozenset({Kind.CONNECTOR}),
    Kind.ENUMERATION_LITERAL: frozenset({Kind.ENUMERATION}),
    Kind.SLOT: frozenset({Kind.INSTANCE}),
}
"""Kinds that can only stand below some others; elsewhere they are not read."""


def kind_of(type_name: str) -> tuple[Kind, str] | None:
    """Kind and subkind of a metaclass that becomes an element, else None."""
    known = KINDS.get(type_name)
    if known is None and _ACTION.match(type_name):
        known = KINDS[type_name] = (Kind.ACTION, _action(type_name))
    return known


def _action(type_name: str) -> str:
    return _ACTIONS.get(type_name) or hyphenated(type_name.removesuffix("Action"))


def hyphenated(name: str) -> str:
    """``camelCase`` as ``camel-case``."""
    return _CAPITAL.sub(r"-\1", name).lower()
