"""Stereotypes that need no metadata: SysML's own, whose meaning the text says in its words."""

from sysmlc.ir import Element

_NAMES = """
    AbstractRequirement AcceptChangeStructuralFeatureEventAction
    AddFlowPropertyValueOnNestedPortAction AdjunctProperty Allocate AllocateActivityPartition
    Allocated BindingConnector Block BlockProperty BoundReference ChangeStructuralFeatureEvent
    ClassifierBehaviorProperty ConjugatedInterfaceBlock ConnectorProperty Conform ConstraintBlock
    ConstraintProperty Continuous ControlOperator Copy DeriveReqt DirectedFeature
    DirectedRelationshipPropertyPath Discrete DistributedProperty ElementGroup
    ElementPropertyPath EndPathMultiplicity Expose FlowPort FlowProperty FlowSpecification
    FullPort InterfaceBlock InvocationOnNestedPortAction ItemFlow NestedConnectorEnd NoBuffer
    Optional Overwrite ParticipantProperty Probability Problem PropertySpecificType ProxyPort
    QuantityKind Rate Rationale Refine Requirement RequirementRelated Satisfy Stakeholder
    TestCase Trace TriggerOnNestedPort Unit Dimension ValueType Verify View Viewpoint
    ~InterfaceBlock PartProperty ReferenceProperty ValueProperty SharedProperty
    extendedRequirement functionalRequirement interfaceRequirement performanceRequirement
    physicalRequirement designConstraint
"""
STANDARD = frozenset(_NAMES.split())


def is_standard(application: Element) -> bool:
    """Whether an application is of a stereotype of SysML itself."""
    name = str(application.attrs.get("stereotype", "")) or application.name
    space = str(application.attrs.get("namespace", ""))
    return name in STANDARD and ("sysml" in space.lower() or not space)
