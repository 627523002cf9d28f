"""Binding of machines of recipes to elements of the plant, by statements of the model."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple, TypeVar

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.recipe.model import Machine, Model, Service
from sysmlc.recipe.plant import Binding, Plant, PlantElement, is_in_plant
from sysmlc.support.counts import list_first
from sysmlc.support.suggestions import did_you_mean

NOT_IN_PLANT = rule(
    "SM624",
    "machine-not-in-plant",
    Severity.WARNING,
    "machine '{machine}' is bound to no element of the plant",
    help="name the element: by amlId of the machine, an allocation, or the overlay",
)
SEVERAL_ELEMENTS = rule(
    "SM625",
    "machine-is-several-elements",
    Severity.ERROR,
    "machine '{machine}' is bound to {number} elements of the plant: {elements}",
    help="bind it to one of them, or model a machine for each",
)
NO_PLANT_ELEMENT = rule(
    "SM626",
    "allocated-to-no-plant-element",
    Severity.WARNING,
    "'{source}' is allocated to '{target}', which is no element of the plant",
    help="allocate it to the element of the instance hierarchy",
)
UNKNOWN_ID = rule(
    "SM628",
    "plant-id-unknown",
    Severity.ERROR,
    "machine '{machine}' has the amlId '{id}', which no element of the plant has",
    help="take the ID of an InternalElement of the plant",
)
SHARED = rule(
    "SM629",
    "machines-share-element",
    Severity.WARNING,
    "the machines {machines} are one element of the plant: '{element}'",
    help="merge these machines, or allocate them to different elements",
)
_OVERLAY = ".overlay.yaml"


_Part = TypeVar("_Part", Machine, Service)
Use = tuple[str, tuple[str, ...], str]
"""The id of a machine or service, the ids of the recipes that use it, and its element."""


class Statement(NamedTuple):
    """A statement of the model that binds a machine or service to an element.

    ``target`` is the element, ``how`` the kind of the statement (``tag``, ``allocation`` or
    ``overlay``), and ``by`` the element that makes the statement.
    """

    target: Element
    how: str
    by: Element


def list_allocations(graph: Graph, element: Element) -> Iterator[Statement]:
    """Yield the elements to which an element is allocated (SysML 1.6 clause 15.3.1.1)."""
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


def _list_machine_statements(graph: Graph, machine: Machine) -> Iterator[Statement]:
    """Yield the statements about a machine: its tag ``plantElement``, and allocations.

    Without statements about the machine itself, statements about its block hold (for a part or an
    instance).
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


def _is_structure(element: Element) -> bool:
    """Whether an element outside AutomationML can be part of a plant: a block, part or instance."""
    return element.kind in (Kind.CLASS, Kind.COMPONENT, Kind.PROPERTY, Kind.INSTANCE)


_MAX_COMPARED = 5_000
"""Limit of plant elements for suggestions; comparing more names takes seconds."""


@dataclass
class Context:
    """The graph, the recipes and the plant of one unit, and the plant elements bound so far."""

    graph: Graph
    models: Sequence[Model]
    sink: Sink
    bound_elements: dict[str, PlantElement] = field(default_factory=dict)
    """Plant elements of bindings and offers, by id."""

    @cached_property
    def plant(self) -> Plant:
        """The plant in AutomationML; empty if the unit has none."""
        return Plant(self.graph)

    @cached_property
    def machines(self) -> dict[str, Machine]:
        """The machines of all recipes by id, sorted."""
        return self._index(machine for model in self.models for machine in model.machines)

    @cached_property
    def services(self) -> dict[str, Service]:
        """The services of all recipes by id, sorted; services with equal ids are the same."""
        return self._index(service for model in self.models for service in model.services)

    def _index(self, parts: Iterable[_Part]) -> dict[str, _Part]:
        by_id = {part.id: part for part in parts}
        return {id: by_id[id] for id in sorted(by_id) if by_id[id].element in self.graph}

    def list_uses(self, parts: Iterable[Machine | Service]) -> Iterator[Use]:
        """Yield for each machine or service its id, the recipes that use it, and its element."""
        used_ids = [
            (model.recipe.id, {m.id for m in model.machines} | {s.id for s in model.services})
            for model in self.models
        ]
        for part in parts:
            users = {recipe for recipe, ids in used_ids if part.id in ids}
            yield part.id, tuple(sorted(users)), part.element

    def has_plant(self) -> bool:
        """Whether the unit has a plant in AutomationML, or binds a machine to another structure."""
        return bool(self.plant) or any(
            _is_structure(statement.target) and not self.is_machine(statement.target)
            for machine in self.machines.values()
            for statement in _list_machine_statements(self.graph, machine)
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

    def find_plant_elements(self, element: Element) -> list[PlantElement]:
        """Return the plant elements that an element of the graph represents."""
        if self.plant:
            return self.plant.find_represented(element)
        if not _is_structure(element) or self.is_machine(element):
            return []
        is_class = element.kind in (Kind.CLASS, Kind.COMPONENT)
        block = element if is_class else query.type_of(self.graph, element)
        return [PlantElement(element.id, element, None, None, block, element.owner or "")]

    def suggest_similar(self, name: str) -> str:
        """Return a question that suggests plant elements with a similar name, or ""."""
        if not self.plant or len(self.plant.elements) > _MAX_COMPARED:
            return ""
        names: dict[str, list[PlantElement]] = {}
        for element in self.plant.elements.values():
            names.setdefault(element.element.name, []).append(element)
        clause = did_you_mean(name, names)
        if not clause.startswith("did you mean '"):
            return ""
        similar = clause.removeprefix("did you mean '").removesuffix("'?")
        suggestions = [
            f"'{self.plant.qualified_name(element)}' (id {element.id})"
            for element in names[similar]
        ]
        several = list(dict.fromkeys(suggestions))[:3]
        return f"did you mean {' or '.join(several)}?"


# -- binding -----------------------------------------------------------------------------------

_MAX_LISTED = 4


def bind_machines(context: Context) -> list[Binding]:
    """Return the bindings of machines to plant elements, and report machines without one.

    Equal names do not bind a machine; they are only suggested (design, section 5).
    """
    bindings: list[Binding] = []
    for machine in context.machines.values():
        bindings += _bind_machine(context, machine)
    _report_shared(context, bindings)
    return bindings


def _bind_machine(context: Context, machine: Machine) -> list[Binding]:
    statements = list(_list_statements(context, machine))
    # Reversed, so that the most direct of several statements about one element remains.
    by_id = {element.id: (element, how, source) for element, how, source in reversed(statements)}
    if len(by_id) > 1:
        _report_several(context, machine, [by_id[id][0] for id in sorted(by_id)])
        return []
    context.bound_elements.update((id, element) for id, (element, _, _) in by_id.items())
    if not by_id and not _report_reasons(context, machine):
        _report_missing(context, machine)
    return [Binding(machine.id, id, how, source) for id, (_, how, source) in by_id.items()]


def _list_statements(context: Context, machine: Machine) -> Iterator[tuple[PlantElement, str, str]]:
    """Yield each plant element bound to the machine, the kind of statement and its source.

    The most direct statement comes first.
    """
    graph = context.graph
    element = graph[machine.element]
    if context.plant and is_in_plant(graph, element):
        yield from (
            (part, "itself", element.id) for part in context.plant.find_represented(element)
        )
    by_id = context.plant.find_by_id(machine.aml_id) if machine.aml_id else None
    if by_id is not None:
        yield by_id, "id", element.id
    for target, how, source in _list_machine_statements(graph, machine):
        if not context.is_machine(target):
            yield from ((part, how, source.id) for part in context.find_plant_elements(target))


def _report_reasons(context: Context, machine: Machine) -> bool:
    """Report statements that name no plant element. Return whether there are any."""
    has_reported = False
    if machine.aml_id and context.plant:
        _report_unknown_id(context, machine)
        has_reported = True
    for target, _, source in _list_machine_statements(context.graph, machine):
        if not context.is_machine(target) and not context.find_plant_elements(target):
            element = context.graph[machine.element]
            _report_misplaced(context, machine.id, element, target, source)
            has_reported = True
    return has_reported


def report_misplaced_services(context: Context) -> None:
    """Report allocations of services to elements that are neither of the plant nor machines."""
    for service in context.services.values():
        element = context.graph[service.element]
        for target, _, source in list_allocations(context.graph, element):
            is_known = context.is_machine(target) or context.find_plant_elements(target)
            if not is_known and target.kind not in (Kind.OPERATION, Kind.RECEPTION):
                _report_misplaced(context, service.id, element, target, source)


# -- findings ----------------------------------------------------------------------------------


def _report_misplaced(
    context: Context, name: str, element: Element, target: Element, statement_source: Element
) -> None:
    context.sink.report(
        NO_PLANT_ELEMENT,
        context.graph.subject(statement_source if statement_source.source else element),
        source=name,
        target=context.graph.qualified_name(target),
    )


def _report_several(context: Context, machine: Machine, elements: list[PlantElement]) -> None:
    names = [f"'{_name_of(context, element)}'" for element in elements]
    context.sink.report(
        SEVERAL_ELEMENTS,
        context.graph.subject(context.graph[machine.element]),
        machine=machine.id,
        number=len(elements),
        elements=list_first(names, _MAX_LISTED),
    )


def _report_missing(context: Context, machine: Machine) -> None:
    element = context.graph[machine.element]
    suggestion = context.suggest_similar(element.name)
    advice = (
        suggestion or "name the element: by amlId of the machine, an allocation, or the overlay"
    )
    subject = context.graph.subject(element)
    context.sink.report(NOT_IN_PLANT, subject, help="{advice}", machine=machine.id, advice=advice)


def _report_unknown_id(context: Context, machine: Machine) -> None:
    element = context.graph[machine.element]
    suggestion = context.suggest_similar(machine.aml_id) or context.suggest_similar(element.name)
    context.sink.report(
        UNKNOWN_ID,
        context.graph.subject(element),
        help="{advice}",
        machine=machine.id,
        id=machine.aml_id,
        advice=suggestion or "take the ID of an InternalElement of the plant",
    )


def _report_shared(context: Context, bindings: list[Binding]) -> None:
    machines_by_element: dict[str, list[str]] = {}
    for binding in bindings:
        machines_by_element.setdefault(binding.plant, []).append(binding.machine)
    for plant, machines in sorted(machines_by_element.items()):
        if len(machines) > 1:
            first = context.graph[context.machines[machines[0]].element]
            context.sink.report(
                SHARED,
                context.graph.subject(first),
                machines=", ".join(f"'{machine}'" for machine in machines),
                element=_name_of(context, context.bound_elements[plant]),
            )


def _name_of(context: Context, element: PlantElement) -> str:
    return context.plant.qualified_name(element)
