"""The InternalElements of a plant, and the mapping of recipes to them (thesis 3.2).

docs/automationml.md has the elements of the graph that represent an InternalElement. The JSON form
of the mapping, the platform, is described by metamodels/sysmlc-platform.schema.json.
"""

from collections.abc import Iterator
from functools import cached_property

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query

HIERARCHY = "instance-hierarchy"
LIBRARIES = frozenset({"system-unit-class-lib", "role-class-lib", "interface-class-lib"})
_VALUES = "#values"
"""Suffix of the id of an instance that holds the values of a part (front end ``caex``)."""


class PlantElement(Struct, frozen=True):
    """An InternalElement: its id in the plant, and the elements of the graph that represent it.

    ``part`` is a property of the surrounding block, None for a top element; ``instance`` holds the
    values, None if there are none.
    """

    id: str
    element: Element
    part: Element | None
    instance: Element | None
    block: Element | None
    owner: str


def is_in_plant(graph: Graph, element: Element) -> bool:
    """Whether *element* is in an instance hierarchy or class library of AutomationML."""
    root = [element, *graph.ancestors(element)][-1]
    return root.subkind == HIERARCHY or root.subkind in LIBRARIES


class Plant:
    """The plant of a compile unit; it is empty without instance hierarchies."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        packages = [root for root in graph.roots() if root.kind is Kind.PACKAGE]
        self._hierarchies = [package for package in packages if package.subkind == HIERARCHY]
        self._class_ids: dict[str, frozenset[str]] = {}
        self._classes: dict[str, list[Element]] = {}

    def __bool__(self) -> bool:
        return bool(self._hierarchies)

    @cached_property
    def elements(self) -> dict[str, PlantElement]:
        """The InternalElements by their ids, owners before owned elements."""
        elements: dict[str, PlantElement] = {}
        for hierarchy in self._hierarchies:
            for element in self.graph.subtree(hierarchy):
                item = self._make_plant_element(element)
                if item is not None and (item.id not in elements or item.instance is not None):
                    elements[item.id] = item
        return elements

    def _make_plant_element(self, element: Element) -> PlantElement | None:
        graph = self.graph
        if element.kind is Kind.INSTANCE:
            part = graph.target(element, Edge.REPRESENTS)
            is_shadow = part is not None and element.id == part.id + _VALUES
            id = part.id if part is not None and is_shadow else element.id
            block = graph.target(element, Edge.INSTANCE_OF)
            return PlantElement(id, element, part, element, block, element.owner or "")
        if (
            element.kind is Kind.PROPERTY
            and element.role == "part"
            and not self._has_instance(element)
        ):
            block = query.type_of(graph, element)
            return PlantElement(element.id, element, element, None, block, element.owner or "")
        return None

    def _has_instance(self, part: Element) -> bool:
        """Whether an instance represents the part or a feature that the part redefines."""
        parts = [part, *query.redefined_features(self.graph, part)]
        sources = (source for p in parts for source in self.graph.sources(p, Edge.REPRESENTS))
        return any(source.kind is Kind.INSTANCE for source in sources)

    @cached_property
    def _by_graph_id(self) -> dict[str, list[PlantElement]]:
        index: dict[str, list[PlantElement]] = {}
        for item in self.elements.values():
            index.setdefault(item.element.id, []).append(item)
            if item.part is not None and item.part is not item.element:
                index.setdefault(item.part.id, []).append(item)
        return index

    @cached_property
    def _by_block(self) -> dict[str, list[PlantElement]]:
        index: dict[str, list[PlantElement]] = {}
        for item in self.elements.values():
            if item.block is not None:
                for id in self.list_class_ids(item.block):
                    index.setdefault(id, []).append(item)
        return index

    def find_represented(self, element: Element) -> list[PlantElement]:
        """Return the InternalElements that an element of the graph represents.

        A part of a class represents one in each instance of the class, a class all its instances.
        """
        exact = self.elements.get(element.id)
        if exact is not None:
            return [exact]
        return self._by_graph_id.get(element.id) or self._by_block.get(element.id, [])

    def find_by_id(self, text: str) -> PlantElement | None:
        """Return the InternalElement with this id, else one whose id differs in case or braces."""
        return self.elements.get(text) or self._by_normalised_id.get(_normalise_id(text))

    @cached_property
    def _by_normalised_id(self) -> dict[str, PlantElement]:
        return {_normalise_id(id): item for id, item in self.elements.items()}

    def list_class_ids(self, block: Element) -> frozenset[str]:
        """Return the ids of ``list_classes(block)``."""
        if block.id not in self._class_ids:
            self._class_ids[block.id] = frozenset(item.id for item in self.list_classes(block))
        return self._class_ids[block.id]

    def list_classes(self, block: Element) -> list[Element]:
        """Return a block and its generals, then the role classes that they realise with theirs."""
        if block.id not in self._classes:
            classes = [block, *query.generals(self.graph, block)]
            roles = [role for item in classes for role in self.graph.targets(item, Edge.REALIZES)]
            for role in roles:
                classes += [role, *query.generals(self.graph, role)]
            self._classes[block.id] = list(dict.fromkeys(classes))
        return self._classes[block.id]

    def qualified_name(self, item: PlantElement) -> str:
        """Return the qualified name of an InternalElement in its hierarchy."""
        return self.graph.qualified_name(item.element)

    def iter_owners(self, item: PlantElement) -> Iterator[PlantElement]:
        """Yield the InternalElements that contain an InternalElement, nearest first."""
        element = self.graph.owner(item.element)
        visited = {item.id}
        while element is not None:
            owner = self._find_owner(element)
            if owner is not None and owner.id not in visited:
                visited.add(owner.id)
                yield owner
                element = owner.element
            element = self.graph.owner(element)

    def _find_owner(self, element: Element) -> PlantElement | None:
        """Return the InternalElement that *element* represents, or None.

        *element* may be the definition of a single InternalElement instead of its part or instance.
        """
        candidates = self._by_graph_id.get(element.id, [])
        if not candidates and element.subkind == "internal-element":
            candidates = [
                item
                for item in self._by_block.get(element.id, [])
                if item.block is element or item.block is None
            ]
        return candidates[0] if candidates else None


def _normalise_id(id: str) -> str:
    # Some AutomationML editors write ids in braces and in capitals, others do not.
    return id.strip("{} ").casefold()


# -- mapping of machines and services ----------------------------------------------------------


class Binding(Struct, frozen=True):
    """States that a machine of a recipe is an element of the plant.

    ``how`` is ``itself``, ``id``, ``tag``, ``allocation`` or ``overlay``; ``by`` is the id of the
    element of the graph that states it.
    """

    machine: str
    plant: str
    how: str
    by: str


class Offer(Struct, frozen=True):
    """States that an element of the plant offers a service by an operation.

    ``machine`` is empty when the service needs none. ``how`` is ``name``, ``method``, ``call``,
    ``allocation`` or ``overlay``; ``by`` is the id of the element that states it.
    """

    service: str
    machine: str
    plant: str
    operation: str
    how: str
    by: str


class Used(Struct, frozen=True):
    """An element of the plant, which recipes use; ``element`` is its id in the graph."""

    id: str
    name: str
    type: str
    element: str


class Unused(Used, frozen=True):
    """An element of the plant that no recipe uses; ``contents`` counts the elements below it."""

    contents: int


class Platform(Struct, frozen=True):
    """The mapping of the recipes of a unit to its plant; all tuples are sorted.

    ``machines`` and ``services`` list those of the recipes: the qualified name, the ids of the
    recipes that use it, and the id of its element in the graph.
    """

    used: tuple[Used, ...]
    bindings: tuple[Binding, ...]
    offers: tuple[Offer, ...]
    unused: tuple[Unused, ...]
    machines: tuple[tuple[str, tuple[str, ...], str], ...]
    services: tuple[tuple[str, tuple[str, ...], str], ...]
