"""What of a plant follows from its InternalElements, and is told of them only.

An InternalElement is up to three elements of the graph (docs/automationml.md): a part, an instance
with its values, and a class of its own when it has more than its SystemUnitClass.
"""

from collections.abc import Iterable

from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Edge, Kind

VALUES = "#values"
"""End of the id of an instance whose part has the id of the InternalElement."""
_TYPES = (Edge.TYPED_BY, Edge.INSTANCE_OF)


def is_own_class(element: Element) -> bool:
    """Whether it is the class that only one InternalElement has."""
    return element.kind is Kind.CLASS and element.subkind == "internal-element"


def own_classes(side: Side, element: Element) -> list[Element]:
    """The class that an InternalElement has for itself, if it has one."""
    edges = side.out.get(element.id, {})
    return [one for edge in _TYPES for one in edges.get(edge, ()) if is_own_class(one)]


def holders(side: Side, own_class: Element) -> list[Element]:
    """The part and the instance whose class it is."""
    return [one for edge, one in side.into.get(own_class.id, ()) if edge in _TYPES]


def declared(side: Side, type_: Element) -> Element | str:
    """The SystemUnitClass of which an own class is, else a word for a class without one."""
    if not is_own_class(type_):
        return type_
    return next(iter(side.out.get(type_.id, {}).get(Edge.SPECIALIZES, ())), "its own")


def is_part_instance(element: Element) -> bool:
    """Whether it holds the values of a part."""
    return element.kind is Kind.INSTANCE and element.subkind == "part"


def represented(side: Side, instance: Element) -> Element | None:
    """The part whose values an instance holds."""
    return next(iter(side.out.get(instance.id, {}).get(Edge.REPRESENTS, ())), None)


def representing(side: Side, part: Element) -> list[Element]:
    """The instances that hold the values of a part."""
    found = (one for edge, one in side.into.get(part.id, ()) if edge is Edge.REPRESENTS)
    return [one for one in found if is_part_instance(one)]


def is_told_of_another(side: Side, element: Element, known: Iterable[str]) -> bool:
    """Whether what one side alone has comes with an InternalElement that is told, or is paired."""
    if is_part_instance(element):
        part = represented(side, element)
        return part is not None and part.id not in known
    if is_own_class(element):
        return bool(holders(side, element))
    if element.kind is Kind.PROPERTY:
        return any(one.id in known for one in representing(side, element))
    return False


def other_id(element: Element) -> str:
    """The id that an instance has when its part gets, or loses, the InternalElement's id."""
    if element.kind is not Kind.INSTANCE:
        return ""
    is_shadow = element.id.endswith(VALUES)
    return element.id.removesuffix(VALUES) if is_shadow else element.id + VALUES
