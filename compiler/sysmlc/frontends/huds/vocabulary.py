"""Tables that map the types and relations of MTIP to kinds and edges of the graph."""

from sysmlc.ir import Edge, Kind

_CLASSES = ("Class", "Block", "InterfaceBlock", "ConstraintBlock", "Requirement")
_PROPERTIES = (
    "Property",
    "PartProperty",
    "ReferenceProperty",
    "ValueProperty",
    "ConstraintProperty",
    "ConstraintParameter",
    "ClassifierBehaviorProperty",
    "FlowProperty",
)
_DEPENDENCIES = {
    "Dependency": "dependency",
    "Usage": "usage",
    "Abstraction": "abstraction",
    "Realization": "realization",
    "Satisfy": "abstraction",
    "Verify": "abstraction",
    "Refine": "abstraction",
    "Trace": "abstraction",
    "DeriveRequirement": "abstraction",
    "Copy": "abstraction",
    "Allocate": "abstraction",
}

_KINDS_BY_NAME = """
    Package Profile Stereotype Interface Signal DataType Enumeration EnumerationLiteral Actor
    UseCase Slot Operation Reception Parameter Constraint Comment Connector ItemFlow Activity
    ControlFlow ObjectFlow StateMachine Region State FinalState Transition Trigger Interaction
    Lifeline Message
"""
"""Types whose kind has the same name."""
KINDS: dict[str, tuple[Kind, str]] = {
    **{name: (Kind(name), "") for name in _KINDS_BY_NAME.split()},
    **dict.fromkeys(_CLASSES, (Kind.CLASS, "")),
    **dict.fromkeys(_PROPERTIES, (Kind.PROPERTY, "")),
    **dict.fromkeys(("Port", "ProxyPort", "FullPort", "FlowPort"), (Kind.PORT, "")),
    **{name: (Kind.DEPENDENCY, subkind) for name, subkind in _DEPENDENCIES.items()},
    **dict.fromkeys(
        ("Association", "Composition", "Aggregation", "AssociationBlock"), (Kind.ASSOCIATION, "")
    ),
    "Model": (Kind.PACKAGE, "model"),
    "ValueType": (Kind.DATA_TYPE, ""),
    "InstanceSpecification": (Kind.INSTANCE, ""),
    "Unit": (Kind.INSTANCE, ""),
    "QuantityKind": (Kind.INSTANCE, ""),
    "InformationFlow": (Kind.ITEM_FLOW, ""),
    "OpaqueBehavior": (Kind.ACTIVITY, "opaque"),
    "FunctionBehavior": (Kind.ACTIVITY, "function"),
    "OpaqueAction": (Kind.ACTION, "opaque"),
    "CallBehaviorAction": (Kind.ACTION, "call-behavior"),
    "CallOperationAction": (Kind.ACTION, "call-operation"),
    "SendSignalAction": (Kind.ACTION, "send"),
    "AcceptEventAction": (Kind.ACTION, "accept"),
    "StructuredActivityNode": (Kind.STRUCTURED, "structured"),
    "InputPin": (Kind.PIN, "argument"),
    "OutputPin": (Kind.PIN, "result"),
    "ActivityParameterNode": (Kind.ACTIVITY_PARAMETER, ""),
    "CentralBufferNode": (Kind.OBJECT_NODE, ""),
    "DataStoreNode": (Kind.DATA_STORE, ""),
    "InitialNode": (Kind.CONTROL, "initial"),
    "ActivityFinalNode": (Kind.CONTROL, "final"),
    "FlowFinalNode": (Kind.CONTROL, "flow-final"),
    "ForkNode": (Kind.CONTROL, "fork"),
    "JoinNode": (Kind.CONTROL, "join"),
    "MergeNode": (Kind.CONTROL, "merge"),
    "DecisionNode": (Kind.CONTROL, "decision"),
    "ActivityPartition": (Kind.PARTITION, ""),
    "InitialPseudoState": (Kind.PSEUDOSTATE, "initial"),
    "ChoicePseudoState": (Kind.PSEUDOSTATE, "choice"),
    "JunctionPseudoState": (Kind.PSEUDOSTATE, "junction"),
    "ForkPseudoState": (Kind.PSEUDOSTATE, "fork"),
    "JoinPseudoState": (Kind.PSEUDOSTATE, "join"),
}
"""Kind and subkind by type without prefix."""

FOLDED = frozenset(
    {"SignalEvent", "TimeEvent", "ChangeEvent", "CallEvent", "TimeExpression", "OpaqueExpression"}
    | {"Generalization", "Include", "Extend"}
)
"""Types whose records become an edge or part of another element."""

RELATIONS: dict[str, Edge] = {
    "typedBy": Edge.TYPED_BY,
    "classifiedBy": Edge.INSTANCE_OF,
    "property": Edge.INSTANCE_OF,
    "constrainedElement": Edge.REFERENCES,
    "behavior": Edge.CALLS,
    "operation": Edge.CALLS,
    "signal": Edge.CALLS,
    "signature": Edge.CALLS,
    "represents": Edge.REPRESENTS,
    "doActivity": Edge.DO,
    "entry": Edge.ENTRY,
    "exit": Edge.EXIT,
    "instanceValue": Edge.REFERENCES,
}
"""Relations that are an edge from the element to its target."""

INSTANCES = frozenset({Kind.INSTANCE, Kind.SLOT})
"""Kinds that are instances of something."""

TARGET_KINDS: dict[str, Kind] = {
    "property": Kind.PROPERTY,
    "behavior": Kind.ACTIVITY,
    "operation": Kind.OPERATION,
    "signal": Kind.SIGNAL,
    "represents": Kind.PROPERTY,
    "doActivity": Kind.ACTIVITY,
    "entry": Kind.ACTIVITY,
    "exit": Kind.ACTIVITY,
}
"""Kinds of targets by relation, for targets that MTIP does not export; otherwise a class."""

PRIMITIVES = frozenset({"Boolean", "Integer", "Real", "String", "UnlimitedNatural"})
"""Ids of UML's primitive types: MTIP writes their names."""
PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"

ENDS: dict[Kind, tuple[Edge, Edge]] = {
    Kind.CONTROL_FLOW: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    Kind.OBJECT_FLOW: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    Kind.TRANSITION: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    Kind.MESSAGE: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    Kind.ITEM_FLOW: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    Kind.DEPENDENCY: (Edge.CLIENT, Edge.SUPPLIER),
}
"""Edges to ``supplier`` and ``client``: in MTIP an arrow starts at its supplier."""

OWNERS: dict[Kind, frozenset[Kind]] = {
    Kind.REGION: frozenset({Kind.STATE_MACHINE, Kind.STATE}),
    Kind.STATE: frozenset({Kind.REGION}),
    Kind.FINAL_STATE: frozenset({Kind.REGION}),
    Kind.ENUMERATION_LITERAL: frozenset({Kind.ENUMERATION}),
    Kind.SLOT: frozenset({Kind.INSTANCE}),
}
"""Owners that elements of a kind may have; elements below other owners are not read."""

SYSML = "http://www.omg.org/spec/SysML/20181001/SysML"
SYSML_PROFILES = frozenset({"SysML", "additional_stereotypes", "SysML Profile"})


def is_notation(type_name: str) -> bool:
    """Whether elements of the type are diagrams, tables or settings of Cameo."""
    return type_name.endswith(("Diagram", "Table", "Matrix", "Map")) or type_name == "Customization"
