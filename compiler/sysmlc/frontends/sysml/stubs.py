"""What of the standard library the graph refers to: stubs by qualified name."""

from sysmlc.ir import AttrValue, Element, Graph, Kind
from sysmlc.ir.element import derived_id
from sysmlc.language.tree import Node

_PRIMITIVES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
"""Under this href the pass ``resolve`` knows the primitives of every dialect."""
SCALARS = {
    "ScalarValues::Boolean": "Boolean",
    "ScalarValues::Integer": "Integer",
    "ScalarValues::Natural": "UnlimitedNatural",
    "ScalarValues::Positive": "UnlimitedNatural",
    "ScalarValues::Real": "Real",
    "ScalarValues::Rational": "Real",
    "ScalarValues::String": "String",
}
_KINDS = {
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
_NAMES = """
    Base::Anything Base::DataValue Occurrences::Occurrence Objects::Object Parts::Part
    Items::Item Ports::Port Attributes::AttributeValue Actions::Action States::StateAction
    Connections::Connection Interfaces::Interface Constraints::ConstraintCheck
    Requirements::RequirementCheck Calculations::Calculation UseCases::UseCase
    ScalarValues::ScalarValue ScalarValues::NumericalValue ScalarValues::Number
"""
_BASES = frozenset(_NAMES.split())
"""What every element of a kind specialises: no edge leads there."""


def href_of(name: str) -> str:
    """Where the pass ``resolve`` shall look for an element of the library."""
    scalar = SCALARS.get(name)
    return f"{_PRIMITIVES}{scalar}" if scalar else f"sysml2:{name.partition('::')[0]}#{name}"


def stand_in(graph: Graph, kind: Kind, name: str) -> str:
    """Id of an element that stands for one of the library, made when needed; href of a scalar."""
    href = href_of(name)
    if name in SCALARS:
        return href
    found = derived_id(href, "stub")
    if found not in graph:
        attrs: dict[str, AttrValue] = {"external": True, "library": True, "href": href}
        attrs["qualified_name"] = name
        graph.add(Element(found, kind, name.rpartition("::")[2], attrs=attrs))
    return found


def kind_of(node: Node) -> Kind:
    """Kind of the stub that stands for an element of the library."""
    if node.kind.endswith("Usage") or node.kind == "Feature":
        return Kind.PROPERTY
    return _KINDS.get(node.kind, Kind.CLASS)


def is_base(name: str) -> bool:
    """Whether it is one of the library's elements that say nothing beyond the kind."""
    return name in _BASES
