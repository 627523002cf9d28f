"""Kinds and roles of the graph for metaclasses of KerML and SysML v2 (docs/ir.md)."""

from sysmlc.ir import Kind

CLASSIFIERS: dict[str, tuple[Kind, str]] = {
    "PartDefinition": (Kind.CLASS, "block"),
    "PortDefinition": (Kind.CLASS, "interface block"),
    "AttributeDefinition": (Kind.DATA_TYPE, "value type"),
    "EnumerationDefinition": (Kind.ENUMERATION, ""),
    "ConnectionDefinition": (Kind.ASSOCIATION, ""),
    "InterfaceDefinition": (Kind.ASSOCIATION, ""),
    "ConstraintDefinition": (Kind.CLASS, "constraint block"),
    "RequirementDefinition": (Kind.CLASS, "requirement"),
    "ConcernDefinition": (Kind.CLASS, "requirement"),
    "ViewDefinition": (Kind.CLASS, "view"),
    "ViewpointDefinition": (Kind.CLASS, "viewpoint"),
    "MetadataDefinition": (Kind.STEREOTYPE, ""),
    "UseCaseDefinition": (Kind.USE_CASE, ""),
    "Type": (Kind.CLASS, ""),
    "Classifier": (Kind.CLASS, ""),
    "Class": (Kind.CLASS, ""),
    "Structure": (Kind.CLASS, "block"),
    "DataType": (Kind.DATA_TYPE, "value type"),
    "Association": (Kind.ASSOCIATION, ""),
    "AssociationStructure": (Kind.ASSOCIATION, ""),
    "Predicate": (Kind.CLASS, "constraint block"),
    "Metaclass": (Kind.STEREOTYPE, ""),
    "Definition": (Kind.CLASS, ""),
}
"""Definitions whose members are features."""
BEHAVIOURS: dict[str, tuple[Kind, str]] = {
    "ActionDefinition": (Kind.ACTIVITY, ""),
    "CalculationDefinition": (Kind.ACTIVITY, ""),
    "AnalysisCaseDefinition": (Kind.ACTIVITY, ""),
    "CaseDefinition": (Kind.ACTIVITY, ""),
    "VerificationCaseDefinition": (Kind.ACTIVITY, "test case"),
    "Behavior": (Kind.ACTIVITY, ""),
    "Function": (Kind.ACTIVITY, ""),
    "Interaction": (Kind.ACTIVITY, ""),
}
"""Definitions whose members are steps."""
FUNCTIONS = frozenset({"CalculationDefinition", "Function", "CalculationUsage"})
KINDS_BY_METADATA = {
    "interface": Kind.INTERFACE,
    "component": Kind.COMPONENT,
    "actor": Kind.ACTOR,
    "item": Kind.ITEM,
    "class": Kind.CLASS,
    "signal": Kind.SIGNAL,
    "profile": Kind.PROFILE,
    "package": Kind.PACKAGE,
    "data-store": Kind.DATA_STORE,
    "object-node": Kind.OBJECT_NODE,
    "property": Kind.PROPERTY,
    "activity": Kind.ACTIVITY,
    "operation": Kind.OPERATION,
    "reception": Kind.RECEPTION,
    "structured": Kind.STRUCTURED,
    "association": Kind.ASSOCIATION,
    "interaction": Kind.INTERACTION,
}
"""Kinds that ``@SysMLC::Kind`` names because no keyword of SysML v2 states them."""
STRUCTURAL = frozenset(
    {
        Kind.CLASS,
        Kind.COMPONENT,
        Kind.INTERFACE,
        Kind.ACTOR,
        Kind.DATA_TYPE,
        Kind.SIGNAL,
        Kind.ITEM,
        Kind.STEREOTYPE,
        Kind.ASSOCIATION,
        Kind.USE_CASE,
        Kind.ENUMERATION,
    }
)
"""Kinds that own features."""
ACTIVITIES = frozenset({Kind.ACTIVITY, Kind.ACTION, Kind.STRUCTURED})
"""Kinds that own nodes of an activity."""
