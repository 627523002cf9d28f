"""The kinds of classes in CAEX, and the kind that each classifier of the graph is saved as."""

from enum import StrEnum

from sysmlc.ir import Edge, Element, Graph, Kind


class ClassKind(StrEnum):
    """Tags of classes; a library holds classes of one kind only (IEC 62424, A.2)."""

    SYSTEM_UNIT = "SystemUnitClass"
    ROLE = "RoleClass"
    INTERFACE = "InterfaceClass"
    ATTRIBUTE = "AttributeType"

    @property
    def library(self) -> str:
        """Tag of the library."""
        return f"{self.value}Lib"

    @property
    def base(self) -> str:
        """XML attribute that names the base class."""
        return "RefAttributeType" if self is ClassKind.ATTRIBUTE else "RefBaseClassPath"


_HIERARCHY = "instance-hierarchy"
"""Subkind of a package that was an instance hierarchy (docs/automationml.md)."""
LIBRARIES = {
    "system-unit-class-lib": ClassKind.SYSTEM_UNIT,
    "role-class-lib": ClassKind.ROLE,
    "interface-class-lib": ClassKind.INTERFACE,
    "attribute-type-lib": ClassKind.ATTRIBUTE,
}
"""Subkinds of packages that were libraries (docs/automationml.md)."""
PRIMITIVES = {
    "Boolean": "xs:boolean",
    "Integer": "xs:integer",
    "Real": "xs:double",
    "String": "xs:string",
    # XML Schema has no type of the natural numbers with '*'.
    "UnlimitedNatural": "xs:string",
}
"""XML Schema types of UML's primitive types."""
_INLINE = frozenset({"internal-element", "external-interface", "attribute"})
_CLASSES = frozenset({Kind.CLASS, Kind.COMPONENT, Kind.INTERFACE, Kind.DATA_TYPE, Kind.ENUMERATION})
_BLOCKS = frozenset({"", "block"})
_UNSUPPORTED = frozenset({"collaboration", "artifact"})


def is_hierarchy(package: Element) -> bool:
    """Whether a package was an instance hierarchy of AutomationML."""
    return package.subkind == _HIERARCHY


def is_caex_package(element: Element) -> bool:
    """Whether the element is a library or an instance hierarchy of AutomationML."""
    return element.kind is Kind.PACKAGE and (element.subkind in LIBRARIES or is_hierarchy(element))


def find_class_kind(graph: Graph, element: Element) -> ClassKind | None:
    """Return the kind of class that an element is saved as, or None if it is no class in CAEX."""
    if element.kind not in _CLASSES or is_inline(element) or is_primitive(element):
        return None
    if is_measured_type(element):
        return None
    for ancestor in graph.ancestors(element):
        if ancestor.subkind in LIBRARIES:
            return LIBRARIES[ancestor.subkind]
    return _find_kind_of_uml_class(graph, element)


def _find_kind_of_uml_class(graph: Graph, element: Element) -> ClassKind | None:
    """Return the kind of a class that was in no CAEX library."""
    if element.kind in (Kind.DATA_TYPE, Kind.ENUMERATION):
        return ClassKind.ATTRIBUTE
    if element.role == "interface block":
        return ClassKind.INTERFACE
    if element.role not in _BLOCKS or element.subkind in _UNSUPPORTED:
        return None
    if element.subkind == "role-class" or _is_only_realised(graph, element):
        return ClassKind.ROLE
    return ClassKind.INTERFACE if element.kind is Kind.INTERFACE else ClassKind.SYSTEM_UNIT


def _is_only_realised(graph: Graph, element: Element) -> bool:
    """Whether the element is realised by others, but is no type of a feature or instance."""
    used = graph.source(element, Edge.TYPED_BY) or graph.source(element, Edge.INSTANCE_OF)
    return used is None and graph.source(element, Edge.REALIZES) is not None


def is_inline(element: Element) -> bool:
    """Whether the front end ``caex`` made the type for one feature.

    Such a type holds what the object adds to its class; it is written as part of the object.
    """
    is_type = element.kind in (Kind.CLASS, Kind.DATA_TYPE)
    return is_type and element.subkind in _INLINE


def is_primitive(element: Element) -> bool:
    """Whether the element is a primitive type of UML, or a library's type of that name."""
    is_external = bool(element.attrs.get("external")) and element.name in PRIMITIVES
    return element.kind is Kind.DATA_TYPE and (element.subkind == "primitive" or is_external)


def is_measured_type(element: Element) -> bool:
    """Whether the front end ``caex`` made the value type to combine a type with a unit.

    Its name ends in the unit: ``Real[kg]``.
    """
    is_added = element.attrs.get("library") is True and not element.source
    return is_added and element.kind is Kind.DATA_TYPE and element.name.endswith("]")
