"""Libraries that models refer to: those shipped with sysmlc, and stubs for the standard library."""

from sysmlc.ir import AttrValue, Element, Graph, Kind
from sysmlc.ir.element import derived_id
from sysmlc.language.tree import Node

# -- shipped libraries -------------------------------------------------------------------------

OUR_LIBRARY = "SysMLC"
"""Metadata and units that the back end ``sysml`` refers to."""
RECIPES = "RecipeLevels"
"""The levels of a recipe, which models specialise."""
PROFILE = "urn:sysmlc:profile:1"
"""Namespace of the profile that has the same levels for SysML v1."""
ACTIONS = "DIN8580"
"""Elementary actions of machines with their contracts."""
MACHINES = "LineMachines"
"""Other machines of a production line with their contracts."""
FLOORS = "Floors"
"""Robots on a floor, and a mission for them."""
FILES = {
    OUR_LIBRARY: "SysMLC.sysml",
    RECIPES: "RecipeLevels.sysml",
    ACTIONS: "DIN8580.sysml",
    MACHINES: "LineMachines.sysml",
    FLOORS: "Floors.sysml",
}
"""Files of the shipped libraries in ``metamodels``."""
LOWERED = frozenset({ACTIONS, MACHINES, FLOORS})
"""Shipped libraries whose elements are lowered as external ones, because they have contracts."""

# -- stubs for the standard library ------------------------------------------------------------

_PRIMITIVES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
"""The pass ``resolve`` finds the primitive types of every dialect under this href."""
SCALARS = {
    "ScalarValues::Boolean": "Boolean",
    "ScalarValues::Integer": "Integer",
    "ScalarValues::Natural": "UnlimitedNatural",
    "ScalarValues::Positive": "UnlimitedNatural",
    "ScalarValues::Real": "Real",
    "ScalarValues::Rational": "Real",
    "ScalarValues::String": "String",
}
"""Primitive types of UML for scalar types."""
_STUB_KINDS = {
    "AttributeDefinition": Kind.DATA_TYPE,
    "DataType": Kind.DATA_TYPE,
    "EnumerationDefinition": Kind.ENUMERATION,
    "ItemDefinition": Kind.CLASS,
    "MetadataDefinition": Kind.STEREOTYPE,
    "Metaclass": Kind.STEREOTYPE,
    "ActionDefinition": Kind.ACTIVITY,
    "CalculationDefinition": Kind.ACTIVITY,
    "Function": Kind.ACTIVITY,
    "StateDefinition": Kind.STATE_MACHINE,
    "ConnectionDefinition": Kind.ASSOCIATION,
    "InterfaceDefinition": Kind.ASSOCIATION,
    "Package": Kind.PACKAGE,
    "LibraryPackage": Kind.PACKAGE,
}
_BASE_NAMES = """
    Base::Anything Base::DataValue Occurrences::Occurrence Objects::Object Parts::Part
    Items::Item Ports::Port Attributes::AttributeValue Actions::Action States::StateAction
    Connections::Connection Interfaces::Interface Constraints::ConstraintCheck
    Requirements::RequirementCheck Calculations::Calculation UseCases::UseCase
    ScalarValues::ScalarValue ScalarValues::NumericalValue ScalarValues::Number
"""
_BASES = frozenset(_BASE_NAMES.split())


def _href_of(qualified_name: str) -> str:
    """Return the href by which the pass ``resolve`` finds an element of the library."""
    scalar = SCALARS.get(qualified_name)
    if scalar:
        return f"{_PRIMITIVES}{scalar}"
    return f"sysml2:{qualified_name.partition('::')[0]}#{qualified_name}"


def ensure_stub(graph: Graph, kind: Kind, qualified_name: str) -> str:
    """Return the id of the stub for an element of the library; add the stub if it is new.

    A scalar type needs no stub: its href is returned.
    """
    href = _href_of(qualified_name)
    if qualified_name in SCALARS:
        return href
    id_ = derived_id(href, "stub")
    if id_ not in graph:
        attrs: dict[str, AttrValue] = {"external": True, "library": True, "href": href}
        attrs["qualified_name"] = qualified_name
        graph.add(Element(id_, kind, qualified_name.rpartition("::")[2], attrs=attrs))
    return id_


def stub_kind_of(node: Node) -> Kind:
    """Return the kind of the stub for an element of the library."""
    if node.kind.endswith("Usage") or node.kind == "Feature":
        return Kind.PROPERTY
    return _STUB_KINDS.get(node.kind, Kind.CLASS)


def is_base(qualified_name: str) -> bool:
    """Whether every element of a kind specialises this element, so that no edge leads to it."""
    return qualified_name in _BASES
