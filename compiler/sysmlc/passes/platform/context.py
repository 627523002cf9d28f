"""The recipes, the plant and the graph of one unit, and statements about machines in the plant."""

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
    """A statement of where something is: the target, its kind (``tag``, ``allocation``,
    ``overlay``), its source.
    """

    target: Element
    how: str
    by: Element


def list_allocations(graph: Graph, element: Element) -> Iterator[Statement]:
    """Yield everything that an element is allocated to (SysML 1.6 clause 15.3.1.1)."""
    allocated: set[str] = set()
    for dependency in graph.sources(element, Edge.CLIENT):
        if dependency.role == "allocate":
            how = "overlay" if dependency.source.endswith(_OVERLAY) else "allocation"
            for target in graph.targets(dependency, Edge.SUPPLIER):
                allocated.add(target.id)
                yield Statement(target, how, dependency)
    for target in graph.targets(element, Edge.ALLOCATED_TO):
        if target.id not in allocated:
            yield Statement(target, "allocation", element)


def list_machine_statements(graph: Graph, machine: Machine) -> Iterator[Statement]:
    """Yield the statements about a machine: its tag ``plantElement``, and allocations.

    Statements about the block of a machine that is a part or an instance hold if there are none
    about the machine itself.
    """
    element = graph[machine.element]
    statements = [*_list_tagged(graph, element), *list_allocations(graph, element)]
    type_ = query.type_of(graph, element) or graph.target(element, Edge.INSTANCE_OF)
    if not statements and type_ is not None:
        statements = [*_list_tagged(graph, type_), *list_allocations(graph, type_)]
    yield from statements


def _list_tagged(graph: Graph, element: Element) -> Iterator[Statement]:
    for application in query.applications(graph, element):
        value = application.attrs.get("tag.plantElement")
        target = graph.get(value) if isinstance(value, str) else None
        if target is not None:
            yield Statement(target, "tag", application)


def is_structure(element: Element) -> bool:
    """Whether an element outside AutomationML can be part of a plant: a block, part or instance."""
    return element.kind in (Kind.CLASS, Kind.COMPONENT, Kind.PROPERTY, Kind.INSTANCE)


_TELLING = 5_000
"""Names that are compared for a suggestion; comparing more takes seconds."""


@dataclass
class Context:
    """One unit: its graph, its recipes, its plant, and the plant elements found so far."""

    graph: Graph
    models: Sequence[Model]
    sink: Sink
    found: dict[str, PlantElement] = field(default_factory=dict)
    """Elements of the plant that something was bound to, by id."""

    @cached_property
    def plant(self) -> Plant:
        """The plant in AutomationML; empty if the unit has none."""
        return Plant(self.graph)

    @cached_property
    def machines(self) -> dict[str, Machine]:
        """The machines of all recipes by id, sorted."""
        by_id = {machine.id: machine for model in self.models for machine in model.machines}
        return {id: by_id[id] for id in sorted(by_id) if by_id[id].element in self.graph}

    @cached_property
    def services(self) -> dict[str, Service]:
        """The services of all recipes by id, sorted; a service of several recipes is one."""
        by_id = {service.id: service for model in self.models for service in model.services}
        return {id: by_id[id] for id in sorted(by_id) if by_id[id].element in self.graph}

    def list_machine_uses(self) -> Iterator[tuple[str, tuple[str, ...], str]]:
        """Yield the machines, the recipes that use each, and its element."""
        uses = _collect_uses(
            (machine.id, model.recipe.id) for model in self.models for machine in model.machines
        )
        return ((id, uses[id], machine.element) for id, machine in self.machines.items())

    def list_service_uses(self) -> Iterator[tuple[str, tuple[str, ...], str]]:
        """Yield the services, the recipes that use each, and its element."""
        uses = _collect_uses(
            (service.id, model.recipe.id) for model in self.models for service in model.services
        )
        return ((id, uses[id], service.element) for id, service in self.services.items())

    def has_plant(self) -> bool:
        """Whether a plant is described, or a machine is stated to be an element outside recipes."""
        return bool(self.plant) or any(
            is_structure(statement.target) and not self.is_machine(statement.target)
            for machine in self.machines.values()
            for statement in list_machine_statements(self.graph, machine)
        )

    def is_machine(self, element: Element) -> bool:
        """Whether the element is a machine of a recipe, or a usage of one."""
        type_ = query.type_of(self.graph, element)
        return element.id in self._machine_ids or (
            type_ is not None and type_.id in self._machine_ids
        )

    @cached_property
    def _machine_ids(self) -> frozenset[str]:
        by_level = (element.id for element in self.graph if element.attrs.get("level") == "machine")
        return frozenset({*by_level, *(machine.element for machine in self.machines.values())})

    def list_meant(self, element: Element) -> list[PlantElement]:
        """Return the plant elements that an element of the graph stands for."""
        if self.plant:
            return self.plant.find_represented(element)
        if not is_structure(element) or self.is_machine(element):
            return []
        is_class = element.kind in (Kind.CLASS, Kind.COMPONENT)
        block = element if is_class else query.type_of(self.graph, element)
        return [PlantElement(element.id, element, None, None, block, element.owner or "")]

    def suggest_similar(self, name: str) -> str:
        """Return a clause that suggests plant elements with a similar name, or ""."""
        if not self.plant or len(self.plant.elements) > _TELLING:
            return ""
        names: dict[str, list[PlantElement]] = {}
        for element in self.plant.elements.values():
            names.setdefault(element.element.name, []).append(element)
        clause = did_you_mean(name, names)
        if not clause.startswith("did you mean '"):
            return ""
        similar = clause.removeprefix("did you mean '").removesuffix("'?")
        suggestions = [
            f"'{self.plant.name_of(element)}' (id {element.id})" for element in names[similar]
        ]
        several = list(dict.fromkeys(suggestions))[:3]
        return f"did you mean {' or '.join(several)}?"


def _collect_uses(pairs: Iterable[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    recipes_by_id: dict[str, set[str]] = {}
    for id, recipe in pairs:
        recipes_by_id.setdefault(id, set()).add(recipe)
    return {id: tuple(sorted(recipes)) for id, recipes in recipes_by_id.items()}
