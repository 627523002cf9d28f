"""Known stereotypes: their namespaces in all dialects, their generals and their roles.

The stereotypes are those of SysML 1.6 (formal/19-11-01), MagicDraw's additional ones, and FlowPort
and FlowSpecification of SysML 1.1 (SysML 1.6 annex C).
"""

import re
from enum import StrEnum
from functools import cache

from sysmlc.ir import Edge
from sysmlc.passes.resolve.libraries import load_libraries

_LIBRARIES = ("SysML", "MD Customization for SysML", "MD Customization for Requirements")


class Family(StrEnum):
    """The origin of a stereotype's profile."""

    SYSML = "SysML"
    SYSMLC = "sysmlc"
    STANDARD = "UML's standard profile"
    FOREIGN = "another standard's"
    TOOL = "a modelling tool's"
    CUSTOM = "a custom profile's"


_NAMESPACES: tuple[tuple[Family, re.Pattern[str]], ...] = (
    (Family.SYSMLC, re.compile(r"urn:sysmlc:profile:|pathmap://SYSMLC_PROFILES/")),
    (
        Family.SYSML,
        re.compile(
            r"""https?://www\.omg\.org/spec/SysML/
            | https?://www\.eclipse\.org/papyrus/(0\.7\.0/SysML|sysml/[\d.]+/SysML)
            | https?://www\.sparxsystems\.com/profiles/SysML
            | https?://www\.magicdraw\.com/schemas/additional_stereotypes\.xmi
            | https?://www\.magicdraw\.com/spec/Customization/\d+/(SysML|Requirements)
            | pathmap://SysML\w*_PROFILES/
            | (.*/)?(SysML(\ |%20)Profile|MD_customization_for_\w+)\.(mdzip|mdxml|xml)
            """,
            re.VERBOSE,
        ),
    ),
    (
        Family.STANDARD,
        re.compile(
            r"""https?://www\.eclipse\.org/uml2/[\d.]+/UML/Profile/
            | https?://(www|schema)\.omg\.org/spec/UML/[\d.]+/StandardProfile
            | pathmap://UML_PROFILES/
            | (.*/)?UML_Standard_Profile\.(mdzip|mdxml|xml)
            """,
            re.VERBOSE,
        ),
    ),
    (
        # MARTE has a FlowPort and an Allocate of its own, and Papyrus writes its sub-profiles
        # as /papyrus/GCM/1 and so on.
        Family.FOREIGN,
        re.compile(
            r"""https?://www\.omg\.org/spec/(MARTE|UTP|FUML)
            | https?://www\.eclipse\.org/papyrus/(MARTE\w*|GCM|Alloc|FCM|HLAM|HRM|HwLayout|GRM
              |GQAM|SAM|PAM|SRM|RSM|NFPs|Time|VSL|C_Cpp|Codegen|FMIProfile|umlrt)/
            | https?://Papyrus/RobotML/
            | pathmap://(Papyrus_PROFILES/MARTE|FCM_|Robotml_|PapyrusC_Cpp_)
            """,
            re.VERBOSE,
        ),
    ),
    (
        Family.TOOL,
        re.compile(
            r"""https?://(www|schema)\.omg\.org/spec/UML/[\d.]+/MagicDraw
            | https?://www\.magicdraw\.com/schemas/(DSL_Customization|Validation_Profile
              |Dependency_Matrix_Profile|Matrix_Templates_Profile|matrix_templates)
            | https?://UML_Standard_Profile/
            | https?://www\.eclipse\.org/uml2/schemas/Ecore/
            | https?://www\.magicdraw\.com/spec/Customization/
            """,
            re.VERBOSE,
        ),
    ),
)

CLASSIFIER_ROLES = {
    "ConstraintBlock": "constraint block",
    "InterfaceBlock": "interface block",
    "FlowSpecification": "interface block",
    "Block": "block",
    "AbstractRequirement": "requirement",
    "Requirement": "requirement",
    "TestCase": "test case",
    "ValueType": "value type",
    "View": "view",
    "Viewpoint": "viewpoint",
    "Stakeholder": "stakeholder",
    "ControlOperator": "control operator",
}
"""Role of a classifier or package, by stereotype; the first entry that is in the lineage counts."""

PROPERTY_ROLES = {
    "FlowProperty": "flow property",
    "PartProperty": "part",
    "ReferenceProperty": "reference",
    "SharedProperty": "reference",
    "ValueProperty": "value",
    "ConstraintProperty": "constraint property",
    "ConstraintParameter": "constraint parameter",
}
PORT_ROLES = {"FullPort": "full port", "ProxyPort": "proxy port", "FlowPort": "flow port"}
CONNECTOR_ROLES = {"BindingConnector": "binding connector"}
FLOW_ROLES = {"ItemFlow": "item flow"}
COMMENT_ROLES = {"ElementGroup": "element group", "Problem": "problem", "Rationale": "rationale"}
PARTITION_ROLES = {"AllocateActivityPartition": "allocate partition"}
UNIT_ROLES = {
    "Unit": "unit",
    "QuantityKind": "quantity kind",
    "Dimension": "quantity kind",
}
"""Role of a unit or quantity kind, by stereotype: of value types in SysML 1.0, of instances in 1.2.

Since SysML 1.3, units are instances of library blocks with these names (annex E.5).
"""

DEPENDENCY_ROLES: dict[str, tuple[str, Edge]] = {
    "Satisfy": ("satisfy", Edge.SATISFIES),
    "DeriveReqt": ("derive", Edge.DERIVES),
    "Verify": ("verify", Edge.VERIFIES),
    "Copy": ("copy", Edge.TRACES),
    "Refine": ("refine", Edge.REFINES),
    "Trace": ("trace", Edge.TRACES),
    "Allocate": ("allocate", Edge.ALLOCATED_TO),
    "Conform": ("conform", Edge.REALIZES),
    "Expose": ("expose", Edge.DEPENDS),
}
"""Role of a dependency and the edge that it means, by stereotype."""

LEVELS = {
    "Recipe": "recipe",
    "Task": "task",
    "MachineService": "machine service",
    "InfrastructureService": "infrastructure service",
    "MachineFunction": "machine function",
    "Machine": "machine",
    "Material": "material",
    "Capability": "capability",
    "OpcUaCall": "opc ua call",
}
"""Recipe level, by stereotype of the shipped profile (design, section 5)."""

MEANINGFUL = frozenset(
    [
        *CLASSIFIER_ROLES,
        *PROPERTY_ROLES,
        *PORT_ROLES,
        *CONNECTOR_ROLES,
        *FLOW_ROLES,
        *DEPENDENCY_ROLES,
    ]
)
"""SysML stereotypes that give a role; a custom stereotype of the same name counts as one."""

WITHOUT_MEANING = frozenset(
    [
        "AcceptChangeStructuralFeatureEventAction",
        "AddFlowPropertyValueOnNestedPortAction",
        "ClassifierBehaviorProperty",
        "InvocationOnNestedPortAction",
        "NestedConnectorEnd",
        "Optional",
        "RequirementRelated",
        "TriggerOnNestedPort",
    ]
)
"""SysML stereotypes that add no information to the graph.

The graph already has it from a type, a multiplicity, a general stereotype, or a path that the front
end reads. The applications are preserved.
"""


MAGICDRAW_STEREOTYPES = frozenset(
    [
        "Actuator",
        "Boundary_system",
        "Environmental_effect",
        "External_system",
        "RequirementTable",
        "Sensor",
        "User_system",
        "numberOwner",
    ]
)
"""Stereotypes that MagicDraw adds in SysML's namespace: kinds of actors, settings of tables.

They have no meaning here, but their applications are preserved.
"""

ROLES = (
    CLASSIFIER_ROLES,
    PROPERTY_ROLES,
    PORT_ROLES,
    CONNECTOR_ROLES,
    FLOW_ROLES,
    COMMENT_ROLES,
    PARTITION_ROLES,
    UNIT_ROLES,
    DEPENDENCY_ROLES,
)
"""All tables of stereotypes that give a role."""


def is_known(name: str) -> bool:
    """Whether a stereotype in SysML's namespace is in one of the tables of this module."""
    return (
        name in WITHOUT_MEANING
        or name in MAGICDRAW_STEREOTYPES
        or any(name in table for table in ROLES)
    )


def find_family(namespace: str) -> Family:
    """Return the family of a profile from its namespace or its file."""
    for candidate, namespaces in _NAMESPACES:
        if namespaces.match(namespace):
            return candidate
    return Family.CUSTOM


@cache
def mangle(name: str) -> str:
    """Return the name of a stereotype in the form of XML tags: ``SD-DD`` becomes ``SD_DD``."""
    return re.sub(r"\W", "_", name)


@cache
def find_generals(name: str) -> tuple[str, ...]:
    """Return the generals that SysML and MagicDraw define for a stereotype of SysML.

    *name* and the result have the form of XML tags.
    """
    names = (
        general for library in _LIBRARIES for general in load_libraries().generals(library, name)
    )
    return tuple(general for general in dict.fromkeys(map(mangle, names)) if general != name)
