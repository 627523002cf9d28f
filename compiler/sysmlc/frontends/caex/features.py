"""What stands directly below a class: its attributes and interfaces, and the values of a type."""

from sysmlc.frontends.caex import attributes, constraints, fitting, interfaces, measures
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import Family


def lower_own(context: Context, type: Type) -> None:
    """Add the attributes and interfaces that stand directly below a class."""
    if type.family is Family.ATTRIBUTE:
        constraints.lower(context, context.graph[type.id], type.node, type.document)
        measures.complete_type(context, type)
        _type_values(context, type)
    for child in type.node.children:
        if child.tag == "Attribute":
            attributes.attribute(context, type, child, type.document)
        elif child.tag == "ExternalInterface":
            interfaces.interface(context, type, child, type.document)


def _type_values(context: Context, type: Type) -> None:
    """The value that attributes of a type have from the start."""
    node, attrs = type.node, context.graph[type.id].attrs
    value, default = node.text("Value"), node.text("DefaultValue")
    data_type = fitting.data_type_of("", type)
    fitting.know(context, type.document, node.row, data_type)
    given = default if value is None else value
    if given:
        attrs["default"] = fitting.value(context, node, given, data_type, None)
    if default and default != value:
        attrs["default_value"] = default
        if default != given:
            fitting.value(context, node, default, data_type, None)
