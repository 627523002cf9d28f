"""The elements of a plant that AutomationML describes (docs/automationml.md)."""

from collections.abc import Iterator
from functools import cached_property

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query

HIERARCHY = "instance-hierarchy"
LIBRARIES = frozenset({"system-unit-class-lib", "role-class-lib", "interface-class-lib"})
_VALUES = "#values"
"""End of the id of the instance that holds the values of a part (front end ``caex``)."""


class PlantElement(Struct, frozen=True):
    """An InternalElement: its id in the plant, and what stands for it in the graph.

    ``part`` is the property of the block around it, None for a top element; ``instance`` has its
    values, None when nothing is said of them.
    """

    id: str
    element: Element
    part: Element | None
    instance: Element | None
    block: Element | None
    owner: str


def is_of_plant(graph: Graph, element: Element) -> bool:
    """Whether it is in an instance hierarchy, or in a library of classes of AutomationML."""
    root = [element, *graph.ancestors(element)][-1]
    return root.subkind == HIERARCHY or root.subkind in LIBRARIES


class Plant:
    """The plant of a unit; without instance hierarchies it is empty."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        tops = [one for one in graph.roots() if one.kind is Kind.PACKAGE]
        self._hierarchies = [one for one in tops if one.subkind == HIERARCHY]
        self._families: dict[str, frozenset[str]] = {}
        self._kin: dict[str, list[Element]] = {}

    def __bool__(self) -> bool:
        return bool(self._hierarchies)

    @cached_property
    def elements(self) -> dict[str, PlantElement]:
        """InternalElements by their ids, owners before owned."""
        found: dict[str, PlantElement] = {}
        for hierarchy in self._hierarchies:
            for element in self.graph.subtree(hierarchy):
                one = self._plant_element(element)
                if one is not None and (one.id not in found or one.instance is not None):
                    found[one.id] = one
        return found

    def _plant_element(self, element: Element) -> PlantElement | None:
        graph = self.graph
        if element.kind is Kind.INSTANCE:
            part = graph.target(element, Edge.REPRESENTS)
            is_shadow = part is not None and element.id == part.id + _VALUES
            id = part.id if part is not None and is_shadow else element.id
            block = graph.target(element, Edge.INSTANCE_OF)
            return PlantElement(id, element, part, element, block, element.owner or "")
        if element.kind is Kind.PROPERTY and element.role == "part" and not self._valued(element):
            block = query.type_of(graph, element)
            return PlantElement(element.id, element, element, None, block, element.owner or "")
        return None

    def _valued(self, part: Element) -> bool:
        """Whether an instance stands for the part, or for what it redefines there."""
        parts = [part, *query.redefined_features(self.graph, part)]
        users = (one for p in parts for one in self.graph.sources(p, Edge.REPRESENTS))
        return any(one.kind is Kind.INSTANCE for one in users)

    @cached_property
    def _by_graph_id(self) -> dict[str, list[PlantElement]]:
        found: dict[str, list[PlantElement]] = {}
        for one in self.elements.values():
            found.setdefault(one.element.id, []).append(one)
            if one.part is not None and one.part is not one.element:
                found.setdefault(one.part.id, []).append(one)
        return found

    @cached_property
    def _by_block(self) -> dict[str, list[PlantElement]]:
        found: dict[str, list[PlantElement]] = {}
        for one in self.elements.values():
            for id in () if one.block is None else self.family(one.block):
                found.setdefault(id, []).append(one)
        return found

    def meant_by(self, element: Element) -> list[PlantElement]:
        """What an element of the graph stands for in the plant.

        A part of a class may stand for several InternalElements, a class for all of its kind.
        """
        exact = self.elements.get(element.id)
        if exact is not None:
            return [exact]
        return self._by_graph_id.get(element.id) or self._by_block.get(element.id, [])

    def with_id(self, text: str) -> PlantElement | None:
        """The InternalElement with an id; braces and case count only when two differ in them."""
        return self.elements.get(text) or self._by_plain_id.get(_plain(text))

    @cached_property
    def _by_plain_id(self) -> dict[str, PlantElement]:
        return {_plain(id): one for id, one in self.elements.items()}

    def family(self, block: Element) -> frozenset[str]:
        """Ids of a block, of all that it specialises, and of the role classes that it realises."""
        known = self._families.get(block.id)
        if known is None:
            known = self._families[block.id] = frozenset(one.id for one in self.kin(block))
        return known

    def kin(self, block: Element) -> list[Element]:
        """The block, what it specialises, the role classes that these realise; nearest first."""
        known = self._kin.get(block.id)
        if known is None:
            classes = [block, *query.generals(self.graph, block)]
            roles = [role for one in classes for role in self.graph.targets(one, Edge.REALIZES)]
            above = [up for role in roles for up in (role, *query.generals(self.graph, role))]
            known = self._kin[block.id] = list(dict.fromkeys([*classes, *above]))
        return known

    def name_of(self, one: PlantElement) -> str:
        """Qualified name in the hierarchy, in the words of the plant."""
        return self.graph.qualified_name(one.element)

    def around(self, one: PlantElement) -> Iterator[PlantElement]:
        """The InternalElements around one, nearest first."""
        above = self.graph.owner(one.element)
        seen = {one.id}
        while above is not None:
            found = self._holder(above)
            if found is not None and found.id not in seen:
                seen.add(found.id)
                yield found
                above = self.graph.owner(found.element)
            else:
                above = self.graph.owner(above)

    def _holder(self, element: Element) -> PlantElement | None:
        """The InternalElement that an owner is, or whose own class it is."""
        found = self._by_graph_id.get(element.id, [])
        if not found and element.subkind == "internal-element":
            found = [
                one
                for one in self._by_block.get(element.id, [])
                if one.block is element or one.block is None
            ]
        return found[0] if found else None


def _plain(id: str) -> str:
    return id.strip("{} ").casefold()
