"""Tables: tags of CAEX and what they become (docs/automationml.md)."""

from enum import StrEnum

from sysmlc.sources.caex import ORDER


class Family(StrEnum):
    """Kinds of classes; a class path is looked up in one family only."""

    SYSTEM_UNIT = "system unit class"
    ROLE = "role class"
    INTERFACE = "interface class"
    ATTRIBUTE = "attribute type"


LIBRARIES = {
    "SystemUnitClassLib": (Family.SYSTEM_UNIT, "SystemUnitClass", "system-unit-class-lib"),
    "RoleClassLib": (Family.ROLE, "RoleClass", "role-class-lib"),
    "InterfaceClassLib": (Family.INTERFACE, "InterfaceClass", "interface-class-lib"),
    "AttributeTypeLib": (Family.ATTRIBUTE, "AttributeType", "attribute-type-lib"),
}
"""Tag of a library: the family of its classes, their tag, subkind of its Package."""

CLASS_TAGS = {tag: family for family, tag, _ in LIBRARIES.values()}

BASE = {
    Family.SYSTEM_UNIT: "RefBaseClassPath",
    Family.ROLE: "RefBaseClassPath",
    Family.INTERFACE: "RefBaseClassPath",
    Family.ATTRIBUTE: "RefAttributeType",
}
"""Attribute that names the base class."""

ROLES: dict[Family, str] = {
    Family.SYSTEM_UNIT: "block",
    Family.ROLE: "block",
    Family.INTERFACE: "interface block",
    Family.ATTRIBUTE: "value type",
}

ROLE_REFERENCES = {
    "SupportedRoleClass": "RefRoleClassPath",
    "RoleRequirements": "RefBaseRoleClassPath",
}
"""Elements that say which role something plays: the attribute that names the role class."""

STANDARD = frozenset(
    {
        "AutomationMLBaseRoleClassLib",
        "AutomationMLInterfaceClassLib",
        "AutomationMLBaseAttributeTypeLib",
    }
)
"""Libraries of IEC 62714-1: the same whoever holds them, so that none is drawn."""

BASE_ROLE = ("AutomationMLBaseRoleClassLib", "AutomationMLBaseRole")
BASE_INTERFACE = ("AutomationMLInterfaceClassLib", "AutomationMLBaseInterface")
BASE_ATTRIBUTE = ("AutomationMLBaseAttributeTypeLib",)
"""Paths of the classes that all roles and interfaces of the standard specialise."""

DIRECTIONS = {"in": "in", "out": "out", "inout": "inout"}
"""Values of the attribute Direction of an interface (any case)."""

FOLDED = ("Description", "Version", "DefaultValue", "Value")
"""Elements that are kept as text of their parent: a third of the elements of a plant."""


class _Signs(dict[str, int]):
    def __missing__(self, tag: str) -> int:
        return 0


SIGNS = _Signs({tag: rank + 1 for tag, rank in ORDER.items()})
"""Numbers of tags, larger for those that stand behind others; 0 for what CAEX does not know."""

STRUCTURE = frozenset(
    {
        "Attribute",
        "AttributeType",
        "ExternalInterface",
        "InterfaceClass",
        "InternalElement",
        "InternalLink",
        "RefSemantic",
        "RoleClass",
        "RoleRequirements",
        "SupportedRoleClass",
        "SystemUnitClass",
    }
)
"""Elements that hold no text of their own."""
