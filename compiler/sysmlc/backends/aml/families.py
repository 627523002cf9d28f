"""Sorts of classes in CAEX, and which of them each classifier of the graph becomes."""

from dataclasses import dataclass
from enum import StrEnum

from sysmlc.ir import Edge, Element, Graph, Kind


class Family(StrEnum):
    """Sorts of classes: a library holds one of them (IEC 62424, A.2)."""

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
        """Attribute that names the base class."""
        return "RefAttributeType" if self is Family.ATTRIBUTE else "RefBaseClassPath"


HIERARCHY = "instance-hierarchy"
LIBRARIES = {
    "system-unit-class-lib": Family.SYSTEM_UNIT,
    "role-class-lib": Family.ROLE,
    "interface-class-lib": Family.INTERFACE,
    "attribute-type-lib": Family.ATTRIBUTE,
}
"""Subkind of a Package that was a library (docs/automationml.md)."""
INLINE = frozenset({"internal-element", "external-interface", "attribute"})
"""Subkind of a type that only one feature has: it is written where the feature is."""
_CLASSES = frozenset({Kind.CLASS, Kind.COMPONENT, Kind.INTERFACE, Kind.DATA_TYPE, Kind.ENUMERATION})
_BLOCKS = frozenset({"", "block"})
_UNSAID = frozenset({"collaboration", "artifact"})


@dataclass(slots=True)
class Families:
    """Answers for one graph."""

    graph: Graph

    def of(self, element: Element) -> Family | None:
        """The sort of class that an element is saved as; None for all other elements."""
        if element.kind not in _CLASSES or is_inline(element) or is_primitive(element):
            return None
        if is_measured(element):
            return None
        above = next(
            (one for one in self.graph.ancestors(element) if one.subkind in LIBRARIES), None
        )
        return LIBRARIES[above.subkind] if above is not None else self._of_uml(element)

    def _of_uml(self, element: Element) -> Family | None:
        if element.kind in (Kind.DATA_TYPE, Kind.ENUMERATION):
            return Family.ATTRIBUTE
        if element.role == "interface block":
            return Family.INTERFACE
        if element.role not in _BLOCKS or element.subkind in _UNSAID:
            return None
        if element.subkind == "role-class" or self._is_only_realised(element):
            return Family.ROLE
        return Family.INTERFACE if element.kind is Kind.INTERFACE else Family.SYSTEM_UNIT

    def _is_only_realised(self, element: Element) -> bool:
        """A contract that others fulfil, and that nothing is made of."""
        graph = self.graph
        used = graph.source(element, Edge.TYPED_BY) or graph.source(element, Edge.INSTANCE_OF)
        return used is None and graph.source(element, Edge.REALIZES) is not None


def is_inline(element: Element) -> bool:
    """Whether it is a type made for one feature, which is written where that feature is."""
    is_type = element.kind in (Kind.CLASS, Kind.DATA_TYPE)
    return is_type and element.subkind in INLINE


def is_primitive(element: Element) -> bool:
    """Whether it is one of UML's primitive types, or a library's type of that name."""
    is_outside = bool(element.attrs.get("external")) and element.name in PRIMITIVES
    return element.kind is Kind.DATA_TYPE and (element.subkind == "primitive" or is_outside)


def is_measured(element: Element) -> bool:
    """Whether it is a value type that only ties a unit to another type (front end ``caex``)."""
    is_made = element.attrs.get("library") is True and not element.source
    return is_made and element.kind is Kind.DATA_TYPE and element.name.endswith("]")


PRIMITIVES = {
    "Boolean": "xs:boolean",
    "Integer": "xs:integer",
    "Real": "xs:double",
    "String": "xs:string",
    "UnlimitedNatural": "xs:string",
}
"""XML Schema types of UML's primitives."""
