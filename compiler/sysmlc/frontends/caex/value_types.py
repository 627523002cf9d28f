"""Types of values: UML primitives, and value types with a unit and its quantity kind."""

from functools import lru_cache

from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.data_types import PRIMITIVES, local_name
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ATTRIBUTE
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, Reference, list_items
from sysmlc.support import units

_PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
_HREFS = {name: _PRIMITIVE_TYPES + name for name in ("String", *PRIMITIVES.values())}
_PACKAGE_ID = "values#"


def connect_type(
    graph: Graph,
    findings: Findings,
    element: Element,
    node: Node,
    document: Document,
    type: Type | None,
) -> None:
    """Connect a value property to its class, to a value type with its unit, or to a primitive."""
    unit = _read_unit(findings, node, document)
    if unit:
        element.attrs["unit"] = unit
    if unit and unit not in _list_units(type):
        value_type = graph[_find_measured_type(graph, node, type, unit)]
        graph.connect(Edge.TYPED_BY, element, value_type)
    elif type is not None:
        graph.connect(Edge.TYPED_BY, element, graph[type.id])
    else:
        data_type = node.attributes.get("AttributeDataType", "")
        _refer_to_primitive(graph, Edge.TYPED_BY, element.id, data_type, element.ordinal)


def set_multiplicity(attrs: dict[str, AttrValue], declared: Type | None) -> None:
    """Give a list any number of values.

    CAEX 3.0 has attribute types for lists, CAEX 2.15 marks lists by semantics (IEC 62714-1).
    """
    markers = list_items(attrs.get("semantics"))
    for name in ("ListType", "OrderedListType"):
        is_typed = declared is not None and declared.conforms_to(*BASE_ATTRIBUTE, name)
        if name in markers or is_typed:
            attrs["multiplicity"] = "*"
            if name == "OrderedListType":
                attrs["ordered"] = True


def complete_attribute_type(graph: Graph, findings: Findings, type: Type) -> None:
    """Give an attribute type its primitive and its unit."""
    node, element = type.node, graph[type.id]
    data_type = node.attributes.get("AttributeDataType")
    if data_type:
        element.attrs["data_type"] = data_type
    if data_type and type.base is None:
        _refer_to_primitive(graph, Edge.SPECIALIZES, type.id, data_type, element.ordinal)
    unit = _read_unit(findings, node, type.document)
    if unit:
        element.attrs["unit"] = unit
        _add_unit(graph, type.id, unit)


@lru_cache(1024)
def find_primitive(data_type: str) -> str:
    """Return the UML primitive of an XML Schema data type."""
    return PRIMITIVES.get(local_name(data_type), "String")


def _refer_to_primitive(
    graph: Graph, edge: Edge, source: str, data_type: str, ordinal: int
) -> None:
    """Add a pending reference to the UML primitive of an XML Schema data type."""
    name = find_primitive(data_type)
    reference = Reference(edge, source, _HREFS[name], Kind.DATA_TYPE, name, ordinal)
    graph.pending.append(reference)


# -- units -----------------------------------------------------------------------------------------


def _read_unit(findings: Findings, node: Node, document: Document) -> str:
    """Return the unit as it is written, known or not; nothing for the name of a type."""
    text = node.attributes.get("Unit", "").strip()
    if not text or units.find_unit(text) is not None or document.is_built_in:
        return text
    findings.unknown_units.setdefault((document, text), []).append(node)
    return "" if text in units.TYPE_NAMES else text


def report_unknown_units(findings: Findings) -> None:
    """Report each text that stands in place of a unit but is no unit, once for each file."""
    for (document, text), nodes in findings.unknown_units.items():
        count = f" and {len(nodes) - 1} more" if len(nodes) > 1 else ""
        problem = "is the name of a type" if text in units.TYPE_NAMES else "is not known"
        facts = {"unit": text, "problem": problem, "element": nodes[0].name, "more": count}
        findings.report(rules.UNKNOWN_UNIT, document, nodes[0], **facts)


def _list_units(type: Type | None) -> list[str | None]:
    """Return the units that an attribute type and those that it specialises state."""
    chain = type.iter_chain() if type is not None else ()
    return [general.node.attributes.get("Unit") for general in chain]


# -- value types with a unit -----------------------------------------------------------------------


def _find_measured_type(graph: Graph, node: Node, type: Type | None, unit: str) -> str:
    """Return the id of the value type for a unit; all attributes of one unit and type share it."""
    stated = node.attributes.get("AttributeDataType", "")
    primitive = find_primitive(stated)
    id = f"{type.id if type else primitive}[{unit}]"
    if id in graph:
        return id
    name = f"{type.node.name if type else _name_quantity(unit, primitive)}[{unit}]"
    owner = type.id if type else _find_package(graph)
    value_type = Element(id, Kind.DATA_TYPE, name, owner)
    value_type.attrs.update(role="value type", external=True, library=True)
    graph.add(value_type)
    _add_unit(graph, id, unit)
    if type is not None:
        graph.connect(Edge.SPECIALIZES, id, type.id)
    else:
        _refer_to_primitive(graph, Edge.SPECIALIZES, id, stated, -1)
    return id


def _name_quantity(unit: str, primitive: str) -> str:
    """Return the quantity of a unit, after the primitive unless that is Real.

    Value types of one unit and different primitives need different names.
    """
    known_unit = units.find_unit(unit)
    if known_unit is None:
        return primitive
    return known_unit.quantity if primitive == "Real" else f"{primitive} {known_unit.quantity}"


def _find_package(graph: Graph) -> str:
    """Return the id of the package of value types without an attribute type."""
    if _PACKAGE_ID not in graph:
        package = Element(_PACKAGE_ID, Kind.PACKAGE, "Values")
        package.attrs.update(subkind="attribute-type-lib", external=True, library=True)
        graph.add(package)
    return _PACKAGE_ID


def _add_unit(graph: Graph, id: str, text: str) -> None:
    """Add the unit and quantity kind of a value type, which owns both, as no file holds them."""
    known_unit = units.find_unit(text)
    value_type = graph[id]
    unit = Element(f"{id}#unit", Kind.UNIT, known_unit.name if known_unit else text, id)
    unit.source, unit.ordinal = value_type.source, value_type.ordinal
    symbol = known_unit.symbol if known_unit else text
    unit.attrs.update(symbol=symbol, external=True, library=True)
    graph.add(unit)
    graph.connect(Edge.REFERENCES, id, unit.id)
    if known_unit is not None:
        quantity = Element(f"{id}#quantity", Kind.QUANTITY_KIND, known_unit.quantity, id)
        quantity.source, quantity.ordinal = value_type.source, value_type.ordinal
        quantity.attrs.update(external=True, library=True)
        graph.add(quantity)
        graph.connect(Edge.REFERENCES, id, quantity.id)
        graph.connect(Edge.REFERENCES, unit.id, quantity.id)
