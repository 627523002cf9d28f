"""The metaclass of UML for each kind of the graph (docs/ir.md)."""

from sysmlc.backends.uml.features import to_class_name
from sysmlc.ir import Element, Graph, Kind

_BY_KIND = {
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
_BY_SUBKIND: dict[tuple[Kind, str], str] = {
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
        (Kind.CLASS, name): to_class_name(name)
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
        (Kind.DEPENDENCY, name): to_class_name(name)
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
        (Kind.CONSTRAINT, name): f"{to_class_name(name)}Constraint"
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
_SAME_ACTION_NAMES = """
    add-variable-value broadcast-signal call-behavior call-operation clear-association
    clear-variable create-link create-link-object destroy-link opaque read-extent
    read-is-classified-object read-link read-link-object-end read-link-object-end-qualifier
    read-self read-variable reclassify-object reduce remove-variable-value reply send-object
    start-classifier-behavior test-identity unmarshall
    """
_SAME_ACTIONS = frozenset(_SAME_ACTION_NAMES.split())
"""Subkinds of actions that are named after the metaclass."""
UNSUPPORTED_KINDS = frozenset(
    {Kind.DOCUMENT, Kind.METADATA, Kind.ALIAS, Kind.FACET, Kind.GROUP, Kind.VIEW, Kind.APPLICATION}
)
"""Kinds without a metaclass of UML."""
RECLASSIFIED_KINDS = frozenset(
    {Kind.REQUIREMENT, Kind.TEST_CASE, Kind.FLOW_PROPERTY, Kind.UNIT, Kind.QUANTITY_KIND}
)
"""Kinds that the front end reads back as another kind, with the same role."""


def find_metaclass(graph: Graph, element: Element) -> tuple[str, bool]:
    """Return the metaclass of an element, and whether UML expresses the subkind."""
    kind, subkind = element.kind, element.subkind
    if kind is Kind.ACTION:
        return _find_action_metaclass(subkind)
    if kind is Kind.PIN:
        return _find_pin_metaclass(graph, element), True
    if kind is Kind.EXPRESSION and subkind:
        return to_class_name(subkind), True
    if (kind, subkind) in _BY_SUBKIND:
        return _BY_SUBKIND[kind, subkind], True
    return _BY_KIND[kind], not subkind or subkind in _EXPRESSED_SUBKINDS.get(kind, ())


_CONDITIONS = ("precondition", "postcondition", "body", "invariant", "condition")
_OPERATORS = "alt opt loop break par seq strict critical neg assert"
_EXPRESSED_SUBKINDS: dict[Kind, tuple[str, ...]] = {
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
"""Subkinds that another feature than the metaclass expresses."""


def _find_action_metaclass(subkind: str) -> tuple[str, bool]:
    """Return the metaclass of an action, and whether UML expresses the subkind."""
    if subkind in _ACTIONS:
        return f"{_ACTIONS[subkind]}Action", True
    if subkind in _SAME_ACTIONS:
        return f"{to_class_name(subkind)}Action", True
    return "OpaqueAction", not subkind


def _find_pin_metaclass(graph: Graph, pin: Element) -> str:
    if pin.attrs.get("direction") == "out":
        return "OutputPin"
    if any(key == "value" or key.startswith("value_") for key in pin.attrs):
        return "ValuePin"
    owned = graph.owned(pin)
    return "ActionInputPin" if any(member.kind is Kind.ACTION for member in owned) else "InputPin"


EVENTS = {
    "signal": "SignalEvent",
    "call": "CallEvent",
    "time": "TimeEvent",
    "change": "ChangeEvent",
    "any": "AnyReceiveEvent",
}
"""Metaclass of the event of a trigger, by the trigger's subkind."""
