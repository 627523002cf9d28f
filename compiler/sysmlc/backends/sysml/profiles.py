"""Stereotypes as metadata definitions: those of the model, and added ones for unknown profiles."""

from collections.abc import Collection, Iterator

from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.shapes import Shape
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import generals
from sysmlc.ir.query.names import spell_for_xml

_UNKNOWN_PROFILES = "Stereotypes"
"""Name of the package for the definitions of stereotypes that no file of the model defines."""
_SYSML_NAMES = """
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
_SYSML_STEREOTYPES = frozenset(_SYSML_NAMES.split())


def is_standard(application: Element) -> bool:
    """Whether the stereotype belongs to SysML itself, so that keywords express it."""
    name = str(application.attrs.get("stereotype", "")) or application.name
    namespace = str(application.attrs.get("namespace", ""))
    return name in _SYSML_STEREOTYPES and ("sysml" in namespace.lower() or not namespace)


def define_stereotypes(plan: Plan) -> dict[str, Member]:
    """Return the metadata definition of each stereotype application, by the application's id.

    Missing definitions, and attributes for tags that a definition lacks, are added to the plan.
    """
    definitions: dict[str, Member] = {}
    added: dict[tuple[str, str], Member] = {}
    for application in plan.graph.of_kind(Kind.APPLICATION):
        if application.attrs.get("external") or is_standard(application):
            continue
        if plan.is_in_author_text(application):
            continue
        definition = plan.find(plan.graph.target(application, Edge.INSTANCE_OF))
        definitions[application.id] = definition or _add_definition(plan, added, application)
    for id, definition in definitions.items():
        _add_tags(plan, definition, plan.graph[id])
    return definitions


def _add_definition(
    plan: Plan, added: dict[tuple[str, str], Member], application: Element
) -> Member:
    """Return the added definition of an unknown stereotype; *added* maps namespace and name."""
    name = str(application.attrs.get("stereotype", "")) or application.name or "Stereotype"
    namespace = str(application.attrs.get("namespace", ""))
    key = (namespace, name)
    if key not in added:
        package = added.get(("", ""))
        if package is None:
            package = added["", ""] = plan.add(Shape("package"), None, _UNKNOWN_PROFILES, None)
        added[key] = plan.add(Shape("metadata def"), package, name, None)
        added[key].profile_namespace = namespace
    return added[key]


def _add_tags(plan: Plan, definition: Member, application: Element) -> None:
    """Add attributes for tags that the definition lacks; widen the types of added ones."""
    names = set(_iter_attribute_names(plan, definition))
    for key, value in application.attrs.items():
        tag = key.removeprefix("tag.")
        if not key.startswith("tag."):
            continue
        if find_tag_name(names, tag) is None:
            plan.add(Shape("attribute"), definition, tag, None)
        candidates = (m for m in definition.members if m.name == tag and m.element is None)
        attribute = next(candidates, None)
        if attribute is not None:
            attribute.added_type = _widen_type(attribute.added_type, value)


def find_tag_name(names: Collection[str], tag: str) -> str | None:
    """Return the name of the attribute for a tag: the same, or one that XML spells like the tag."""
    if tag in names:
        return tag
    return next((name for name in names if spell_for_xml(name) == tag), None)


def _iter_attribute_names(plan: Plan, definition: Member) -> Iterator[str]:
    yield from (member.name for member in definition.members)
    if definition.element is not None:
        for general in generals(plan.graph, definition.element):
            general_definition = plan.find(general)
            if general_definition is not None:
                yield from (member.name for member in general_definition.members)


def _widen_type(known_type: str, value: AttrValue) -> str:
    """Return the type and multiplicity that allow *value* and the values of *known_type*."""
    is_list = isinstance(value, tuple) or "[0..*]" in known_type
    sample = value[0] if isinstance(value, tuple) and value else value
    type_ = "String"
    if isinstance(sample, bool):
        type_ = "Boolean"
    elif isinstance(sample, int):
        type_ = "Integer"
    elif isinstance(sample, float):
        type_ = "Real"
    if known_type and not known_type.startswith(f"ScalarValues::{type_}"):
        type_ = "ScalarValue"
    return f"ScalarValues::{type_}[0..{'*' if is_list else '1'}]"
