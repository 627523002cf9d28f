"""Tables: the tags of CAEX and the elements that they become (docs/automationml.md)."""

from enum import StrEnum
from typing import NamedTuple

from sysmlc.sources.caex_vocabulary import ORDER


class Family(StrEnum):
    """Kinds of classes; a class path is resolved in one family only."""

    SYSTEM_UNIT = "system unit class"
    ROLE = "role class"
    INTERFACE = "interface class"
    ATTRIBUTE = "attribute type"


class LibraryKind(NamedTuple):
    """A kind of library: its family, the tag of its classes, the subkind of its Package."""

    family: Family
    class_tag: str
    subkind: str


LIBRARIES = {
    "SystemUnitClassLib": LibraryKind(
        Family.SYSTEM_UNIT, "SystemUnitClass", "system-unit-class-lib"
    ),
    "RoleClassLib": LibraryKind(Family.ROLE, "RoleClass", "role-class-lib"),
    "InterfaceClassLib": LibraryKind(Family.INTERFACE, "InterfaceClass", "interface-class-lib"),
    "AttributeTypeLib": LibraryKind(Family.ATTRIBUTE, "AttributeType", "attribute-type-lib"),
}
"""Kinds of libraries by their tag."""

CLASS_TAGS = {kind.class_tag: kind.family for kind in LIBRARIES.values()}

BASE_REFERENCES = {
    Family.SYSTEM_UNIT: "RefBaseClassPath",
    Family.ROLE: "RefBaseClassPath",
    Family.INTERFACE: "RefBaseClassPath",
    Family.ATTRIBUTE: "RefAttributeType",
}
"""XML attribute that names the base class."""

SYSML_ROLES: dict[Family, str] = {
    Family.SYSTEM_UNIT: "block",
    Family.ROLE: "block",
    Family.INTERFACE: "interface block",
    Family.ATTRIBUTE: "value type",
}
"""Role of the element that a class becomes."""

ROLE_REFERENCES = {
    "SupportedRoleClass": "RefRoleClassPath",
    "RoleRequirements": "RefBaseRoleClassPath",
}
"""Elements that assign a role, with the XML attribute that names the role class."""

STANDARD_LIBRARIES = frozenset(
    {
        "AutomationMLBaseRoleClassLib",
        "AutomationMLInterfaceClassLib",
        "AutomationMLBaseAttributeTypeLib",
    }
)
"""Libraries of IEC 62714-1. Diagrams omit them, because they are the same in every file."""

BASE_ROLE = ("AutomationMLBaseRoleClassLib", "AutomationMLBaseRole")
BASE_INTERFACE = ("AutomationMLInterfaceClassLib", "AutomationMLBaseInterface")
BASE_ATTRIBUTE = ("AutomationMLBaseAttributeTypeLib",)
"""Paths of the classes that all roles and interfaces of the standard specialise."""

PPR, ORDER_INTERFACE = "ppr", "order"
INTERFACE_MEANINGS: dict[tuple[str, ...], str] = {
    (*BASE_INTERFACE, "PPRConnector"): PPR,
    (*BASE_INTERFACE, "Order"): ORDER_INTERFACE,
    (*BASE_INTERFACE, "ExternalDataConnector", "COLLADAInterface"): "collada",
    (*BASE_INTERFACE, "ExternalDataConnector", "PLCopenXMLInterface"): "plcopen",
    (*BASE_INTERFACE, "ExternalDataConnector"): "external-data",
}
"""Interface classes of IEC 62714-1 that are more than a port, by their path."""

DOCUMENT_MEANINGS = frozenset({"collada", "plcopen", "external-data"})
"""Meanings of interfaces that refer to a file of another language."""

PPR_ROLES: dict[tuple[str, ...], str] = {
    (*BASE_ROLE, "Product"): "product",
    (*BASE_ROLE, "Process"): "process",
    (*BASE_ROLE, "Resource"): "resource",
}
"""Role classes of the product-process-resource concept, by their path."""

DIRECTIONS = {"in": "in", "out": "out", "inout": "inout"}
"""Values of the attribute Direction of an interface (any case)."""

FOLDED_TAGS = ("Description", "Version", "DefaultValue", "Value")
"""Elements that are stored as text of their parent: a third of the elements of a plant."""

_TEXTLESS_TAGS_WORDS = """
    Attribute AttributeType ExternalInterface InterfaceClass InternalElement InternalLink
    RefSemantic RoleClass RoleRequirements SupportedRoleClass SystemUnitClass
"""
TEXTLESS_TAGS = frozenset(_TEXTLESS_TAGS_WORDS.split())
"""Elements that hold no text of their own."""


class _TagCodes(dict[str, int]):
    def __missing__(self, tag: str) -> int:
        return 0


TAG_CODES = _TagCodes({tag: rank + 1 for tag, rank in ORDER.items()})
"""Numbers of tags in the order of the schema; 0 for tags that CAEX does not have."""
