"""What the pass ``platform`` asks of recipes, plant and graph."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.recipe.model import Machine, Model, Service
from sysmlc.recipe.plant import Plant, PlantElement
from sysmlc.support.suggestions import did_you_mean

_OVERLAY = ".overlay.yaml"


class Statement(NamedTuple):
    """Where, how it is said (``tag``, ``allocation``, ``overlay``), and what says it."""

    target: Element
    how: str
    by: Element


def allocations(graph: Graph, element: Element) -> Iterator[Statement]:
    """Everything that an element is allocated to (SysML 1.6 clause 15.3.1.1)."""
    said: set[str] = set()
    for one in graph.sources(element, Edge.CLIENT):
        if one.role == "allocate":
            how = "overlay" if one.source.endswith(_OVERLAY) else "allocation"
            for target in graph.targets(one, Edge.SUPPLIER):
                said.add(target.id)
                yield Statement(target, how, one)
    for target in graph.targets(element, Edge.ALLOCATED_TO):
        if target.id not in said:
            yield Statement(target, "allocation", element)


def of_machine(graph: Graph, machine: Machine) -> Iterator[Statement]:
    """What is said about a machine: its tag ``plantElement``, and allocations.

    What is said about the block of a machine that is a part or an instance holds when nothing
    is said about itself.
    """
    element = graph[machine.element]
    own = [*_tagged(graph, element), *allocations(graph, element)]
    type_ = query.type_of(graph, element) or graph.target(element, Edge.INSTANCE_OF)
    if not own and type_ is not None:
        own = [*_tagged(graph, type_), *allocations(graph, type_)]
    yield from own


def _tagged(graph: Graph, element: Element) -> Iterator[Statement]:
    for application in query.applications(graph, element):
        value = application.attrs.get("tag.plantElement")
        target = graph.get(value) if isinstance(value, str) else None
        if target is not None:
            yield Statement(target, "tag", application)


def is_structure(element: Element) -> bool:
    """Whether an element without AutomationML may be one of a plant: block, part, instance."""
    return element.kind in (Kind.CLASS, Kind.COMPONENT, Kind.PROPERTY, Kind.INSTANCE)


_TELLING = 5_000
"""Names among which the nearest is looked for; comparing more takes seconds."""


@dataclass
class Context:
    """One unit: its graph, its recipes, its plant, and what was found of it."""

    graph: Graph
    models: Sequence[Model]
    sink: Sink
    found: dict[str, PlantElement] = field(default_factory=dict)
    """Elements of the plant that something was bound to, by id."""

    @cached_property
    def plant(self) -> Plant:
        """The plant in AutomationML; empty when the unit has none."""
        return Plant(self.graph)

    @cached_property
    def machines(self) -> dict[str, Machine]:
        """Machines of all recipes by id, sorted."""
        found = {one.id: one for model in self.models for one in model.machines}
        return {id: found[id] for id in sorted(found) if found[id].element in self.graph}

    @cached_property
    def services(self) -> dict[str, Service]:
        """Services of all recipes by id, sorted; those in several recipes have one definition."""
        found = {one.id: one for model in self.models for one in model.services}
        return {id: found[id] for id in sorted(found) if found[id].element in self.graph}

    def machine_uses(self) -> Iterator[tuple[str, tuple[str, ...], str]]:
        """Machines, the recipes that use each, and its element."""
        uses = _uses((one.id, model.recipe.id) for model in self.models for one in model.machines)
        return ((id, uses[id], one.element) for id, one in self.machines.items())

    def service_uses(self) -> Iterator[tuple[str, tuple[str, ...], str]]:
        """Services, the recipes that use each, and its element."""
        uses = _uses((one.id, model.recipe.id) for model in self.models for one in model.services)
        return ((id, uses[id], one.element) for id, one in self.services.items())

    def has_plant(self) -> bool:
        """Whether a plant is described, or a machine is said to be something outside recipes."""
        return bool(self.plant) or any(
            is_structure(said.target) and not self.is_machine(said.target)
            for one in self.machines.values()
            for said in of_machine(self.graph, one)
        )

    def is_machine(self, element: Element) -> bool:
        """Whether it is a machine of a recipe, or a usage of one."""
        type_ = query.type_of(self.graph, element)
        return element.id in self._machines or (type_ is not None and type_.id in self._machines)

    @cached_property
    def _machines(self) -> frozenset[str]:
        levels = (one.id for one in self.graph if one.attrs.get("level") == "machine")
        return frozenset({*levels, *(one.element for one in self.machines.values())})

    def meant(self, element: Element) -> list[PlantElement]:
        """Elements of the plant that an element of the graph stands for."""
        if self.plant:
            return self.plant.find_represented(element)
        if not is_structure(element) or self.is_machine(element):
            return []
        is_class = element.kind in (Kind.CLASS, Kind.COMPONENT)
        block = element if is_class else query.type_of(self.graph, element)
        return [PlantElement(element.id, element, None, None, block, element.owner or "")]

    def nearest(self, name: str) -> str:
        """A clause on the elements of the plant that are called nearly so; empty if none is."""
        if not self.plant or len(self.plant.elements) > _TELLING:
            return ""
        names: dict[str, list[PlantElement]] = {}
        for one in self.plant.elements.values():
            names.setdefault(one.element.name, []).append(one)
        clause = did_you_mean(name, names)
        if not clause.startswith("did you mean '"):
            return ""
        near = clause.removeprefix("did you mean '").removesuffix("'?")
        told = [f"'{self.plant.name_of(one)}' (id {one.id})" for one in names[near]]
        several = list(dict.fromkeys(told))[:3]
        return f"did you mean {' or '.join(several)}?"


def _uses(pairs: Iterable[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    found: dict[str, set[str]] = {}
    for id, recipe in pairs:
        found.setdefault(id, set()).add(recipe)
    return {id: tuple(sorted(recipes)) for id, recipes in found.items()}
