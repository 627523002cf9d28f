"""Tables: tags of CAEX and what they become (docs/automationml.md)."""

from collections.abc import Callable
from enum import StrEnum

from sysmlc.ir import AttrValue


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

PRIMITIVES = {
    **dict.fromkeys(("double", "float", "decimal"), "Real"),
    **dict.fromkeys(
        ("integer", "int", "long", "short", "byte", "negativeInteger", "nonPositiveInteger"),
        "Integer",
    ),
    **dict.fromkeys(
        (
            "nonNegativeInteger",
            "positiveInteger",
            "unsignedInt",
            "unsignedLong",
            "unsignedShort",
            "unsignedByte",
        ),
        "Integer",
    ),
    "boolean": "Boolean",
}
"""UML primitive of an XML Schema data type; every other one holds text."""

DIRECTIONS = {"in": "in", "out": "out", "inout": "inout"}
"""Values of the attribute Direction of an interface (any case)."""


def value_of(text: str, data_type: str) -> AttrValue:
    """The value that a text means in an XML Schema data type; the text where it means none."""
    read = reader_of(data_type)
    return text if read is None else read(text)


def reader_of(data_type: str) -> Callable[[str], AttrValue] | None:
    """How values of an XML Schema data type are read; None for texts."""
    return _READERS.get(PRIMITIVES.get(data_type.rpartition(":")[2], ""))


def _real(text: str) -> AttrValue:
    try:
        return float(text)
    except ValueError:
        return text


def _integer(text: str) -> AttrValue:
    try:
        return int(text)
    except ValueError:
        return text


def _boolean(text: str) -> AttrValue:
    return _TRUTH.get(text.strip().lower(), text)


_TRUTH = {"true": True, "1": True, "false": False, "0": False}
_READERS = {"Real": _real, "Integer": _integer, "Boolean": _boolean}
