"""Whether a value of an overlay is one of its type."""

from sysmlc.ir import AttrValue, Element, Graph, Kind
from sysmlc.ir.query import generals

_FORMS: dict[str, tuple[type, ...]] = {
    "Boolean": (bool,),
    "Integer": (int,),
    "UnlimitedNatural": (int,),
    "Real": (int, float),
    "String": (str,),
}
"""What YAML makes of the values of UML's primitives."""


def fits(graph: Graph, value: AttrValue, type_: Element) -> bool:
    """Whether a value is of the primitive or the enumeration that a type is in the end.

    Of any other type nobody can tell, so any value fits it.
    """
    for one in (type_, *generals(graph, type_)):
        if one.kind is Kind.ENUMERATION:
            return value in [literal.name for literal in _literals(graph, one)]
        if one.kind is Kind.DATA_TYPE and one.name in _FORMS:
            return isinstance(value, _FORMS[one.name]) and _is_truth(value, one)
    return True


def _literals(graph: Graph, enumeration: Element) -> list[Element]:
    return [one for one in graph.owned(enumeration) if one.kind is Kind.ENUMERATION_LITERAL]


def _is_truth(value: AttrValue, type_: Element) -> bool:
    """Whether it is a truth value just where one is wanted: to Python true is a number."""
    return isinstance(value, bool) == (type_.name == "Boolean")
