"""Tables: the metaclass of UML that each kind of the graph is written as (docs/ir.md)."""

from sysmlc.backends.uml.names import capital
from sysmlc.ir import Element, Graph, Kind

_PLAIN = {
    Kind.PACKAGE: "Package",
    Kind.PROFILE: "Profile",
    Kind.CLASS: "Class",
    Kind.COMPONENT: "Component",
    Kind.INTERFACE: "Interface",
    Kind.DATA_TYPE: "DataType",
    Kind.ENUMERATION: "Enumeration",
    Kind.ENUMERATION_LITERAL: "EnumerationLiteral",
    Kind.SIGNAL: "Signal",
    Kind.ASSOCIATION: "Association",
    Kind.STEREOTYPE: "Stereotype",
    Kind.USE_CASE: "UseCase",
    Kind.ACTOR: "Actor",
    Kind.ITEM: "InformationItem",
    Kind.PROPERTY: "Property",
    Kind.FLOW_PROPERTY: "Property",
    Kind.PORT: "Port",
    Kind.CONNECTOR: "Connector",
    Kind.CONNECTOR_END: "ConnectorEnd",
    Kind.ITEM_FLOW: "InformationFlow",
    Kind.OPERATION: "Operation",
    Kind.RECEPTION: "Reception",
    Kind.PARAMETER: "Parameter",
    Kind.PARAMETER_SET: "ParameterSet",
    Kind.INSTANCE: "InstanceSpecification",
    Kind.UNIT: "InstanceSpecification",
    Kind.QUANTITY_KIND: "InstanceSpecification",
    Kind.SLOT: "Slot",
    Kind.CONSTRAINT: "Constraint",
    Kind.COMMENT: "Comment",
    Kind.REQUIREMENT: "Class",
    Kind.TEST_CASE: "Activity",
    Kind.ACTIVITY: "Activity",
    Kind.ACTIVITY_PARAMETER: "ActivityParameterNode",
    Kind.OBJECT_NODE: "CentralBufferNode",
    Kind.DATA_STORE: "DataStoreNode",
    Kind.CONTROL_FLOW: "ControlFlow",
    Kind.OBJECT_FLOW: "ObjectFlow",
    Kind.PARTITION: "ActivityPartition",
    Kind.STATE_MACHINE: "StateMachine",
    Kind.REGION: "Region",
    Kind.STATE: "State",
    Kind.FINAL_STATE: "FinalState",
    Kind.PSEUDOSTATE: "Pseudostate",
    Kind.TRANSITION: "Transition",
    Kind.TRIGGER: "Trigger",
    Kind.INTERACTION: "Interaction",
    Kind.LIFELINE: "Lifeline",
    Kind.MESSAGE: "Message",
    Kind.OCCURRENCE: "OccurrenceSpecification",
    Kind.FRAGMENT: "CombinedFragment",
    Kind.OPERAND: "InteractionOperand",
    Kind.GATE: "Gate",
    Kind.GENERAL_ORDERING: "GeneralOrdering",
    Kind.EXTEND: "Extend",
    Kind.EXTENSION_POINT: "ExtensionPoint",
    Kind.COLLABORATION_USE: "CollaborationUse",
    Kind.GENERALIZATION_SET: "GeneralizationSet",
    Kind.TEMPLATE_PARAMETER: "TemplateParameter",
    Kind.TEMPLATE_BINDING: "TemplateBinding",
    Kind.TEMPLATE_SUBSTITUTION: "TemplateParameterSubstitution",
    Kind.DEPENDENCY: "Dependency",
    Kind.OBSERVATION: "TimeObservation",
    Kind.EXECUTION: "BehaviorExecutionSpecification",
    Kind.IMPORT: "PackageImport",
    Kind.STRUCTURED: "StructuredActivityNode",
    Kind.ACTION: "OpaqueAction",
    Kind.CONTROL: "MergeNode",
    Kind.PIN: "InputPin",
    Kind.EXPRESSION: "OpaqueExpression",
}
_DIVIDED: dict[tuple[Kind, str], str] = {
    (Kind.PACKAGE, "model"): "Model",
    (Kind.DATA_TYPE, "primitive"): "PrimitiveType",
    (Kind.ASSOCIATION, "association-class"): "AssociationClass",
    (Kind.ASSOCIATION, "communication-path"): "CommunicationPath",
    (Kind.PROPERTY, "variable"): "Variable",
    (Kind.TEMPLATE_PARAMETER, "classifier"): "ClassifierTemplateParameter",
    (Kind.TEMPLATE_PARAMETER, "operation"): "OperationTemplateParameter",
    (Kind.TEMPLATE_PARAMETER, "connectable-element"): "ConnectableElementTemplateParameter",
    (Kind.IMPORT, "element"): "ElementImport",
    (Kind.IMPORT, "merge"): "PackageMerge",
    (Kind.OCCURRENCE, "message"): "MessageOccurrenceSpecification",
    (Kind.OCCURRENCE, "execution"): "ExecutionOccurrenceSpecification",
    (Kind.OCCURRENCE, "destruction"): "DestructionOccurrenceSpecification",
    (Kind.EXECUTION, "action"): "ActionExecutionSpecification",
    (Kind.FRAGMENT, "consider"): "ConsiderIgnoreFragment",
    (Kind.FRAGMENT, "ignore"): "ConsiderIgnoreFragment",
    (Kind.FRAGMENT, "ref"): "InteractionUse",
    (Kind.FRAGMENT, "part-decomposition"): "PartDecomposition",
    (Kind.FRAGMENT, "state-invariant"): "StateInvariant",
    (Kind.FRAGMENT, "continuation"): "Continuation",
    (Kind.OBSERVATION, "duration"): "DurationObservation",
    (Kind.ACTIVITY, "opaque"): "OpaqueBehavior",
    (Kind.ACTIVITY, "function"): "FunctionBehavior",
    (Kind.STATE_MACHINE, "protocol"): "ProtocolStateMachine",
    (Kind.TRANSITION, "protocol"): "ProtocolTransition",
    (Kind.PSEUDOSTATE, "connection-point"): "ConnectionPointReference",
    (Kind.OBJECT_NODE, "expansion"): "ExpansionNode",
    (Kind.CONTROL, "initial"): "InitialNode",
    (Kind.CONTROL, "final"): "ActivityFinalNode",
    (Kind.CONTROL, "flow-final"): "FlowFinalNode",
    (Kind.CONTROL, "decision"): "DecisionNode",
    (Kind.CONTROL, "fork"): "ForkNode",
    (Kind.CONTROL, "join"): "JoinNode",
    (Kind.STRUCTURED, "conditional"): "ConditionalNode",
    (Kind.STRUCTURED, "loop"): "LoopNode",
    (Kind.STRUCTURED, "sequence"): "SequenceNode",
    (Kind.STRUCTURED, "expansion"): "ExpansionRegion",
    (Kind.STRUCTURED, "interruptible"): "InterruptibleActivityRegion",
    **{
        (Kind.CLASS, name): capital(name)
        for name in (
            "collaboration",
            "node",
            "device",
            "execution-environment",
            "artifact",
            "deployment-specification",
        )
    },
    **{
        (Kind.DEPENDENCY, name): capital(name)
        for name in (
            "abstraction",
            "realization",
            "component-realization",
            "substitution",
            "usage",
            "manifestation",
            "deployment",
        )
    },
    **{
        (Kind.CONSTRAINT, name): f"{capital(name)}Constraint"
        for name in ("interaction", "interval", "duration", "time")
    },
}
_ACTIONS = {
    "send": "SendSignal",
    "broadcast": "BroadcastSignal",
    "accept": "AcceptEvent",
    "accept-call": "AcceptCall",
    "read": "ReadStructuralFeature",
    "write": "AddStructuralFeatureValue",
    "clear": "ClearStructuralFeature",
    "remove": "RemoveStructuralFeatureValue",
    "create": "CreateObject",
    "destroy": "DestroyObject",
    "value": "ValueSpecification",
    "raise": "RaiseException",
    "start": "StartObjectBehavior",
}
_OTHER_NAMES = """add-variable-value broadcast-signal call-behavior call-operation clear-association
    clear-variable create-link create-link-object destroy-link opaque read-extent
    read-is-classified-object read-link read-link-object-end read-link-object-end-qualifier
    read-self read-variable reclassify-object reduce remove-variable-value reply send-object
    start-classifier-behavior test-identity unmarshall
    """
_OTHER_ACTIONS = frozenset(_OTHER_NAMES.split())
UNSAID = frozenset(
    {Kind.DOCUMENT, Kind.METADATA, Kind.ALIAS, Kind.FACET, Kind.GROUP, Kind.VIEW, Kind.APPLICATION}
)
"""Kinds that are no element of UML."""
APPROXIMATED = frozenset(
    {Kind.REQUIREMENT, Kind.TEST_CASE, Kind.FLOW_PROPERTY, Kind.UNIT, Kind.QUANTITY_KIND}
)
"""Kinds that come back as another kind with the same role."""


def metaclass_of(graph: Graph, element: Element) -> tuple[str, bool]:
    """Metaclass of UML for an element, and whether it says all that the subkind says."""
    kind, subkind = element.kind, element.subkind
    if kind is Kind.ACTION:
        return _action(subkind)
    if kind is Kind.PIN:
        return _pin(graph, element), True
    if kind is Kind.EXPRESSION and subkind:
        return capital(subkind), True
    known = _DIVIDED.get((kind, subkind))
    return known or _PLAIN[kind], bool(known) or not subkind or subkind in _SAID.get(kind, ())


_CONDITIONS = ("precondition", "postcondition", "body", "invariant", "condition")
_OPERATORS = "alt opt loop break par seq strict critical neg assert"
_SAID: dict[Kind, tuple[str, ...]] = {
    Kind.CONSTRAINT: _CONDITIONS,
    Kind.FRAGMENT: tuple(_OPERATORS.split()),
    Kind.IMPORT: ("package",),
    Kind.DEPENDENCY: ("dependency", "role-binding"),
    Kind.OBSERVATION: ("time",),
    Kind.EXECUTION: ("behavior",),
    Kind.STRUCTURED: ("structured",),
    Kind.CONTROL: ("merge",),
    Kind.TRIGGER: ("signal", "call", "time", "change", "any"),
    Kind.TRANSITION: ("internal", "local", "external"),
    Kind.MESSAGE: (
        "synch-call",
        "asynch-call",
        "asynch-signal",
        "reply",
        "create-message",
        "delete-message",
    ),
    Kind.PSEUDOSTATE: (
        "initial",
        "choice",
        "junction",
        "fork",
        "join",
        "deep-history",
        "shallow-history",
        "entry-point",
        "exit-point",
        "terminate",
    ),
}
"""Subkinds that another feature than the metaclass says."""


def _action(subkind: str) -> tuple[str, bool]:
    if subkind in _ACTIONS:
        return f"{_ACTIONS[subkind]}Action", True
    if subkind in _OTHER_ACTIONS:
        return f"{capital(subkind)}Action", True
    return "OpaqueAction", not subkind


def _pin(graph: Graph, pin: Element) -> str:
    if pin.attrs.get("direction") == "out":
        return "OutputPin"
    if any(key == "value" or key.startswith("value_") for key in pin.attrs):
        return "ValuePin"
    owned = graph.owned(pin)
    return "ActionInputPin" if any(one.kind is Kind.ACTION for one in owned) else "InputPin"


EVENTS = {
    "signal": "SignalEvent",
    "call": "CallEvent",
    "time": "TimeEvent",
    "change": "ChangeEvent",
    "any": "AnyReceiveEvent",
}
"""Metaclass of the event of a trigger, by the trigger's subkind."""
