"""Types of values: UML primitives, and value types with a unit and its quantity kind."""

from functools import lru_cache

from sysmlc.frontends.caex import rules, units
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.datatypes import PRIMITIVES, local
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ATTRIBUTE
from sysmlc.ir import AttrValue, Edge, Element, Kind, Reference

_PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
_HREFS = {name: _PRIMITIVE_TYPES + name for name in ("String", *PRIMITIVES.values())}
_PACKAGE = "values#"


def type_value(
    context: Context, element: Element, node: Node, document: Document, type: Type | None
) -> None:
    """Type a value property: by its class, by a value type with its unit, or by a primitive."""
    found = target(context, node, document, type, element.attrs)
    if found is not None:
        context.graph.connect(Edge.TYPED_BY, element, found)
    else:
        data_type = node.attributes.get("AttributeDataType", "")
        refer(context, Edge.TYPED_BY, element.id, data_type, element.ordinal)


def target(
    context: Context,
    node: Node,
    document: Document,
    type: Type | None,
    attrs: dict[str, AttrValue],
) -> Element | None:
    """What types a value property, its unit noted in ``attrs``; None for a primitive."""
    unit = _unit(context, node, document)
    if unit:
        attrs["unit"] = unit
    if unit and unit not in _units(type):
        return context.graph[_measured(context, node, type, unit)]
    return None if type is None else context.graph[type.id]


def multiply(attrs: dict[str, AttrValue], declared: Type | None) -> None:
    """A list has any number of values; CAEX 2.15 tells it by its semantics (IEC 62714-1)."""
    semantics = attrs.get("semantics")
    told = semantics if isinstance(semantics, tuple) else ()
    for name in ("ListType", "OrderedListType"):
        if name in told or (declared is not None and declared.conforms(*BASE_ATTRIBUTE, name)):
            attrs["multiplicity"] = "*"
            if name == "OrderedListType":
                attrs["ordered"] = True


def complete_type(context: Context, type: Type) -> None:
    """Give an attribute type its primitive, and its unit."""
    node, element = type.node, context.graph[type.id]
    data_type = node.attributes.get("AttributeDataType")
    if data_type:
        element.attrs["data_type"] = data_type
    if data_type and type.base is None:
        refer(context, Edge.SPECIALIZES, type.id, data_type, element.ordinal)
    unit = _unit(context, node, type.document)
    if unit:
        element.attrs["unit"] = unit
        _measure(context, type.id, unit)


@lru_cache(1024)
def primitive(data_type: str) -> str:
    """UML primitive of an XML Schema data type."""
    return PRIMITIVES.get(local(data_type), "String")


def refer(context: Context, edge: Edge, source: str, data_type: str, ordinal: int) -> None:
    """Refer to the UML primitive of an XML Schema data type."""
    name = primitive(data_type)
    reference = Reference(edge, source, _HREFS[name], Kind.DATA_TYPE, name, ordinal)
    context.graph.pending.append(reference)


def is_unit(text: str) -> bool:
    """Whether nothing is told of a text in the place of a unit."""
    plain = text.strip()
    return not plain or units.known(plain) is not None


def _unit(context: Context, node: Node, document: Document) -> str:
    """The unit as it is written, or nothing when what is written is none."""
    text = node.attributes.get("Unit", "").strip()
    if not text or units.known(text) is not None or document.is_built_in:
        return text
    is_type = text in units.NO_UNITS
    uses = context.strange_units.setdefault((document, text), [])
    uses.append(node)
    return "" if is_type else text


def report_strange(context: Context) -> None:
    """Tell of each text in the place of a unit that means none, once a file."""
    for (document, text), nodes in context.strange_units.items():
        more = f" and {len(nodes) - 1} more" if len(nodes) > 1 else ""
        problem = "is the name of a type" if text in units.NO_UNITS else "is not known"
        facts = {"unit": text, "problem": problem, "element": nodes[0].name, "more": more}
        context.report(rules.UNKNOWN_UNIT, document, nodes[0], **facts)


def _units(type: Type | None) -> list[str | None]:
    chain = type.chain() if type is not None else ()
    return [one.node.attributes.get("Unit") for one in chain]


# -- value types with a unit -------------------------------------------------------------------


def _measured(context: Context, node: Node, type: Type | None, unit: str) -> str:
    """Id of the value type that has the unit: one for all attributes of that unit and type."""
    data_type = primitive(node.attributes.get("AttributeDataType", ""))
    id = f"{type.id if type else data_type}[{unit}]"
    if id not in context.graph:
        name = f"{type.node.name if type else _quantity(unit, data_type)}[{unit}]"
        made = Element(id, Kind.DATA_TYPE, name, type.id if type else _package(context))
        made.attrs.update(role="value type", external=True, library=True)
        context.graph.add(made)
        _measure(context, id, unit)
        if type is not None:
            context.graph.connect(Edge.SPECIALIZES, id, type.id)
        else:
            refer(context, Edge.SPECIALIZES, id, node.attributes.get("AttributeDataType", ""), -1)
    return id


def _quantity(unit: str, data_type: str) -> str:
    """What is measured, the primitive before it where it is not Real: names are told apart."""
    found = units.known(unit)
    if found is None:
        return data_type
    return found.quantity if data_type == "Real" else f"{data_type} {found.quantity}"


def _package(context: Context) -> str:
    if _PACKAGE not in context.graph:
        package = Element(_PACKAGE, Kind.PACKAGE, "Values")
        package.attrs.update(subkind="attribute-type-lib", external=True, library=True)
        context.graph.add(package)
    return _PACKAGE


def _measure(context: Context, id: str, text: str) -> None:
    """Give a value type its unit and quantity kind; it owns both, as no file holds them."""
    graph = context.graph
    found = units.known(text)
    of_type = graph[id]
    unit = Element(f"{id}#unit", Kind.UNIT, found.name if found else text, id)
    unit.source, unit.ordinal = of_type.source, of_type.ordinal
    unit.attrs.update(symbol=found.symbol if found else text, external=True, library=True)
    graph.add(unit)
    graph.connect(Edge.REFERENCES, id, unit.id)
    if found is not None:
        kind = Element(f"{id}#quantity", Kind.QUANTITY_KIND, found.quantity, id)
        kind.source, kind.ordinal = of_type.source, of_type.ordinal
        kind.attrs.update(external=True, library=True)
        graph.add(kind)
        graph.connect(Edge.REFERENCES, id, kind.id)
        graph.connect(Edge.REFERENCES, unit.id, kind.id)
