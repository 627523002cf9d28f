"""Kinds of elements and of edges.

Generated from metamodels/ir.ecore by ``python -m sysmlc.ir.generate``; do not edit.
"""

from enum import StrEnum


class Kind(StrEnum):
    """Kind of an element, in the words of the standards."""

    # Namespace of elements; a UML Package or Model, a SysML v2 package.
    PACKAGE = "Package"
    # Classifier with identity; a SysML block when its role says so. UML 2.5.1 clause 11.4.
    CLASS = "Class"
    # Classifier of values. UML 2.5.1 clause 10.2.
    DATA_TYPE = "DataType"
    # Data type with named literals.
    ENUMERATION = "Enumeration"
    # One value of an enumeration.
    ENUMERATION_LITERAL = "EnumerationLiteral"
    # Type of what is sent asynchronously between objects.
    SIGNAL = "Signal"
    # Set of operations and receptions that a classifier offers.
    INTERFACE = "Interface"
    # Class that is a replaceable unit.
    COMPONENT = "Component"
    # Relation between classifiers; its ends are Property elements.
    ASSOCIATION = "Association"
    # Set of generalizations that divide a classifier in one respect. UML 2.5.1 clause 9.7.
    GENERALIZATION_SET = "GeneralizationSet"
    # Feature that holds values: part, reference, value, constraint property.
    PROPERTY = "Property"
    # Interaction point of a classifier. UML 2.5.1 clause 11.3, SysML 1.6 clause 9.
    PORT = "Port"
    # Behavioural feature that can be called.
    OPERATION = "Operation"
    # Declaration that a classifier reacts to a signal.
    RECEPTION = "Reception"
    # Parameter of an operation or a behaviour.
    PARAMETER = "Parameter"
    # Alternative set of the parameters of a behaviour or operation. UML 2.5.1 clause 9.4.
    PARAMETER_SET = "ParameterSet"
    # Formal parameter of a template, owned by the template. UML 2.5.1 clause 7.3.
    TEMPLATE_PARAMETER = "TemplateParameter"
    # Binding of an element to the template of which it is made. UML 2.5.1 clause 7.3.
    TEMPLATE_BINDING = "TemplateBinding"
    # Actual parameter for one formal parameter of a template.
    TEMPLATE_SUBSTITUTION = "TemplateSubstitution"
    # What flows: a classifier used only as the type of item flows.
    ITEM = "Item"
    # Measurement unit.
    UNIT = "Unit"
    # Kind of quantity that a unit measures.
    QUANTITY_KIND = "QuantityKind"
    # Package of stereotypes.
    PROFILE = "Profile"
    # Extension of a metaclass by a profile.
    STEREOTYPE = "Stereotype"
    # One stereotype applied to one element, with its tagged values.
    APPLICATION = "Application"
    # Instance specification or an AutomationML top element.
    INSTANCE = "Instance"
    # Values of one feature in one instance.
    SLOT = "Slot"
    # Link between parts or ports; has two ConnectorEnd elements.
    CONNECTOR = "Connector"
    # One end of a connector: a role and the path of parts that leads to it.
    CONNECTOR_END = "ConnectorEnd"
    # Use of a collaboration in a classifier, whose parts play its roles. UML 2.5.1 clause 11.7.
    COLLABORATION_USE = "CollaborationUse"
    # Direction in which one kind of item may pass a port. SysML 1.6 clause 9.3.2.7.
    FLOW_PROPERTY = "FlowProperty"
    # Items conveyed over connectors or associations. SysML 1.6 clause 9.3.2.5.
    ITEM_FLOW = "ItemFlow"
    # Condition on the elements that it constrains.
    CONSTRAINT = "Constraint"
    # Value specification; a tree when it has operands.
    EXPRESSION = "Expression"
    # Capability or condition that must be satisfied. SysML 1.6 clause 16.
    REQUIREMENT = "Requirement"
    # Behaviour that verifies requirements.
    TEST_CASE = "TestCase"
    # Set of actions performed for an actor.
    USE_CASE = "UseCase"
    # Role played by what is outside the system.
    ACTOR = "Actor"
    # Extension of a use case by another, with its condition and extension points. UML 2.5.1 clause
    # 18.1.
    EXTEND = "Extend"
    # Point of a use case at which others may extend it.
    EXTENSION_POINT = "ExtensionPoint"
    # Viewpoint-conforming selection of the model.
    VIEW = "View"
    # Behaviour made of actions that tokens order. UML 2.5.1 clause 15.
    ACTIVITY = "Activity"
    # Step of an activity; `subkind` says which one. UML 2.5.1 clause 16.
    ACTION = "Action"
    # Structured node; `subkind`: conditional, loop, for-each, sequence, expansion, interruptible.
    STRUCTURED = "Structured"
    # Object node of an action. UML 2.5.1 clause 16.2.
    PIN = "Pin"
    # Object node for a parameter of the activity.
    ACTIVITY_PARAMETER = "ActivityParameter"
    # Object node that is no pin: central buffer or typed object.
    OBJECT_NODE = "ObjectNode"
    # Object node that keeps what it received.
    DATA_STORE = "DataStore"
    # Control node; `subkind`: initial, final, flow-final, decision, merge, fork, join.
    CONTROL = "Control"
    # Activity edge that passes control tokens.
    CONTROL_FLOW = "ControlFlow"
    # Activity edge that passes object tokens.
    OBJECT_FLOW = "ObjectFlow"
    # Activity partition (swimlane).
    PARTITION = "Partition"
    # Behaviour made of states and transitions. UML 2.5.1 clause 14.
    STATE_MACHINE = "StateMachine"
    # Orthogonal part of a state or a state machine.
    REGION = "Region"
    # Situation in which an invariant holds.
    STATE = "State"
    # Transient vertex; `subkind`: initial, choice, junction, fork, join, deep-history,
    # shallow-history, entry-point, exit-point, terminate.
    PSEUDOSTATE = "Pseudostate"
    # State that ends its region.
    FINAL_STATE = "FinalState"
    # Directed relation between two vertices.
    TRANSITION = "Transition"
    # Event that can fire a transition or end an accept action; `subkind`: signal, call, time,
    # change, any.
    TRIGGER = "Trigger"
    # Behaviour made of messages between lifelines.
    INTERACTION = "Interaction"
    # Participant of an interaction.
    LIFELINE = "Lifeline"
    # Communication between two lifelines.
    MESSAGE = "Message"
    # Point on a lifeline at which something happens; `subkind`: message, execution, destruction.
    # UML 2.5.1 clause 17.5.
    OCCURRENCE = "Occurrence"
    # Time in which a lifeline executes something; `subkind`: behavior, action. UML 2.5.1 clause
    # 17.5.
    EXECUTION = "Execution"
    # Part of an interaction; `subkind` is the operator of a combined fragment (alt, opt, loop,
    # break, par, seq, strict, critical, neg, assert, ignore, consider), or ref, state-invariant,
    # continuation. UML 2.5.1 clauses 17.2, 17.6, 17.7.
    FRAGMENT = "Fragment"
    # One alternative, repetition or thread of a combined fragment. UML 2.5.1 clause 17.6.
    OPERAND = "Operand"
    # Point at which messages enter or leave an interaction, an interaction use or a combined
    # fragment. UML 2.5.1 clause 17.4.
    GATE = "Gate"
    # Demand that one occurrence comes before another. UML 2.5.1 clause 17.5.
    GENERAL_ORDERING = "GeneralOrdering"
    # Name for when something happens or how long it takes; `subkind`: time, duration. UML 2.5.1
    # clause 8.5.
    OBSERVATION = "Observation"
    # Client-supplier relation; its role (satisfy, allocate, ...) comes from its stereotype.
    DEPENDENCY = "Dependency"
    # Text attached to elements.
    COMMENT = "Comment"
    # External document that the model refers to.
    DOCUMENT = "Document"
    # Annotation of a SysML v2 element, or information about the model file.
    METADATA = "Metadata"
    # Import of a package or an element into a namespace.
    IMPORT = "Import"
    # Second name of an element.
    ALIAS = "Alias"
    # Named view of an element's attributes and interfaces (AutomationML).
    FACET = "Facet"
    # Set of mirrored elements (AutomationML).
    GROUP = "Group"


class Edge(StrEnum):
    """Kind of an edge."""

    # From the owner to what it owns, in order.
    OWNS = "owns"
    # From a typed element to its type.
    TYPED_BY = "typed-by"
    # From the specific to the general classifier.
    SPECIALIZES = "specializes"
    # From a feature to a feature that it subsets.
    SUBSETS = "subsets"
    # From a feature to the feature that it redefines.
    REDEFINES = "redefines"
    # From an element to an element it names in no other way.
    REFERENCES = "references"
    # From the realising to the realised element.
    REALIZES = "realizes"
    # From a design element to the requirement it satisfies.
    SATISFIES = "satisfies"
    # From a derived requirement to its source.
    DERIVES = "derives"
    # From a test case to the requirement it verifies.
    VERIFIES = "verifies"
    # From the refining to the refined element.
    REFINES = "refines"
    # From an element to one it is traced to.
    TRACES = "traces"
    # From client to supplier.
    DEPENDS = "depends"
    # From an element to what it is allocated to.
    ALLOCATED_TO = "allocated-to"
    # From an item flow to what it conveys.
    CONVEYS = "conveys"
    # From a flow to where it starts.
    FLOW_SOURCE = "flow-source"
    # From a flow to where it ends.
    FLOW_TARGET = "flow-target"
    # From an item flow to the connector, association or object flow that realises it.
    REALIZING = "realizing"
    # From a connector or association to its ends.
    END = "end"
    # From a connector end to the connected part or port.
    ROLE = "role"
    # From a connector end to the parts that lead to its role, outermost first.
    PATH = "path"
    # From a transition or accept action to its triggers' events.
    TRIGGER = "trigger"
    # From an edge or transition to its guard expression or constraint.
    GUARD = "guard"
    # From a transition to its effect behaviour.
    EFFECT = "effect"
    # From a state to its entry behaviour.
    ENTRY = "entry"
    # From a state to its do behaviour.
    DO = "do"
    # From a state to its exit behaviour.
    EXIT = "exit"
    # From an operation to the behaviour that implements it.
    METHOD = "method"
    # From an action to the operation, signal, feature or behaviour it invokes.
    CALLS = "calls"
    # From a partition, lifeline or connector to what it represents.
    REPRESENTS = "represents"
    # From a node to its activity partition.
    IN_PARTITION = "in-partition"
    # From an occurrence, execution or fragment to the lifelines that it covers.
    COVERS = "covers"
    # From a message to the occurrence or gate at which it is sent.
    SEND_EVENT = "send-event"
    # From a message to the occurrence or gate at which it is received.
    RECEIVE_EVENT = "receive-event"
    # From an execution to the occurrence at which it starts.
    START = "start"
    # From an execution to the occurrence at which it ends.
    FINISH = "finish"
    # From an instance, slot or application to its classifier, feature or stereotype.
    INSTANCE_OF = "instance-of"
    # From a classifier to its features, own and inherited.
    FEATURE = "feature"
    # From a mirror to its master (AutomationML).
    MIRRORS = "mirrors"
    # From one side of a binding to the other: a template binding to its template, a role of a
    # collaboration to what plays it.
    BINDS = "binds"
    # From a requirement, contract, application or use case to the element it is about.
    SUBJECT = "subject"
    # From a requirement to an assumption.
    ASSUMES = "assumes"
    # From a requirement to a required constraint.
    REQUIRES = "requires"
    # From a package to a profile that it applies.
    APPLIES = "applies"
    # From a dependency to its client.
    CLIENT = "client"
    # From a dependency to its supplier.
    SUPPLIER = "supplier"
    # From a class to the behaviour that its instances run.
    CLASSIFIER_BEHAVIOR = "classifier-behavior"
    # From a use case to one it includes.
    INCLUDES = "includes"
    # From a stereotype to its metaclass, or a use case to one it extends.
    EXTENDS = "extends"
