"""Differences of a plant that follow from an InternalElement and are reported with it.

An InternalElement is up to three elements of the graph (docs/automationml.md): a part, an instance
that holds its values, and an *own class* if it has more than its SystemUnitClass.
"""

from collections.abc import Container

from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Edge, Kind

_VALUES = "#values"
"""Suffix of the id of an instance whose part has the id of the InternalElement."""
_TYPES = (Edge.TYPED_BY, Edge.INSTANCE_OF)


def is_own_class(element: Element) -> bool:
    """Return whether *element* is the own class of an InternalElement."""
    return element.kind is Kind.CLASS and element.subkind == "internal-element"


def own_classes(side: Side, element: Element) -> list[Element]:
    """Return the own class of a part or an instance, as a list of at most one."""
    edges = side.edges.get(element.id, {})
    types = [type_ for edge in _TYPES for type_ in edges.get(edge, ())]
    return [type_ for type_ in types if is_own_class(type_)]


def users_of_own_class(side: Side, own_class: Element) -> list[Element]:
    """Return the part and the instance that have the own class."""
    return [user for edge, user in side.incoming.get(own_class.id, ()) if edge in _TYPES]


def declared_class(side: Side, type_: Element) -> Element | str:
    """Return the SystemUnitClass of an own class, "its own" without one; else *type_* itself."""
    if not is_own_class(type_):
        return type_
    return next(iter(side.edges.get(type_.id, {}).get(Edge.SPECIALIZES, ())), "its own")


def is_part_instance(element: Element) -> bool:
    """Return whether *element* is an instance that holds the values of a part."""
    return element.kind is Kind.INSTANCE and element.subkind == "part"


def represented_part(side: Side, instance: Element) -> Element | None:
    """Return the part whose values *instance* holds, or None."""
    return next(iter(side.edges.get(instance.id, {}).get(Edge.REPRESENTS, ())), None)


def follows_internal_element(side: Side, element: Element, paired: Container[str]) -> bool:
    """Return whether an unpaired element is reported with an InternalElement.

    *paired* holds the ids of this side that have a partner in the other model.
    """
    if is_part_instance(element):
        part = represented_part(side, element)
        return part is not None and part.id not in paired
    if is_own_class(element):
        return bool(users_of_own_class(side, element))
    if element.kind is Kind.PROPERTY:
        return any(instance.id in paired for instance in _instances_of_part(side, element))
    return False


def _instances_of_part(side: Side, part: Element) -> list[Element]:
    sources = [source for edge, source in side.incoming.get(part.id, ()) if edge is Edge.REPRESENTS]
    return [source for source in sources if is_part_instance(source)]


def alternate_id(element: Element) -> str:
    """Return the id of an instance after its part gets, or loses, the InternalElement's id."""
    if element.kind is not Kind.INSTANCE:
        return ""
    if element.id.endswith(_VALUES):
        return element.id.removesuffix(_VALUES)
    return element.id + _VALUES
