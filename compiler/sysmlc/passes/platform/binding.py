"""Binding of machines of recipes to elements of the plant."""

from collections.abc import Iterator

from sysmlc.ir import Element
from sysmlc.passes.platform import rules
from sysmlc.passes.platform.context import Context, list_allocations, list_machine_statements
from sysmlc.recipe.model import Machine
from sysmlc.recipe.plant import PlantElement, is_of_plant
from sysmlc.recipe.platform import Binding

_SHOWN = 4


def bind_machines(context: Context) -> list[Binding]:
    """Return the plant element of each machine. An equal name is only suggested (design, 5)."""
    bindings: list[Binding] = []
    for machine in context.machines.values():
        bindings += _bind_machine(context, machine)
    _report_shared(context, bindings)
    return bindings


def _bind_machine(context: Context, machine: Machine) -> list[Binding]:
    statements = list(_list_statements(context, machine))
    by_id = {element.id: (element, how, source) for element, how, source in reversed(statements)}
    if len(by_id) > 1:
        _report_several(context, machine, [by_id[id][0] for id in sorted(by_id)])
        return []
    context.found.update((id, element) for id, (element, _, _) in by_id.items())
    if not by_id and not _report_reasons(context, machine):
        _report_missing(context, machine)
    return [Binding(machine.id, id, how, source) for id, (_, how, source) in by_id.items()]


def _list_statements(context: Context, machine: Machine) -> Iterator[tuple[PlantElement, str, str]]:
    """Yield the elements that are stated to be the machine, the most direct statement first."""
    graph = context.graph
    element = graph[machine.element]
    if context.plant and is_of_plant(graph, element):
        yield from (
            (part, "itself", element.id) for part in context.plant.find_represented(element)
        )
    by_id = context.plant.find_by_id(machine.aml_id) if machine.aml_id else None
    if by_id is not None:
        yield by_id, "id", element.id
    for target, how, source in list_machine_statements(graph, machine):
        if not context.is_machine(target):
            yield from ((part, how, source.id) for part in context.list_meant(target))


def _report_reasons(context: Context, machine: Machine) -> bool:
    """Report stated reasons why a machine has no element. Return whether there are any."""
    has_reported = False
    if machine.aml_id and context.plant:
        _report_unknown_id(context, machine)
        has_reported = True
    for target, _, source in list_machine_statements(context.graph, machine):
        if not context.is_machine(target) and not context.list_meant(target):
            element = context.graph[machine.element]
            _report_misplaced(context, machine.id, element, target, source)
            has_reported = True
    return has_reported


def report_misplaced_services(context: Context) -> None:
    """Report allocations of services to elements that are neither of the plant nor machines."""
    for service in context.services.values():
        element = context.graph[service.element]
        for target, _, source in list_allocations(context.graph, element):
            is_known = context.is_machine(target) or context.list_meant(target)
            if not is_known and not _is_operation(context, target.id):
                _report_misplaced(context, service.id, element, target, source)


def _is_operation(context: Context, id: str) -> bool:
    return context.graph[id].kind in ("Operation", "Reception")


# -- findings ----------------------------------------------------------------------------------


def _report_misplaced(
    context: Context, name: str, element: Element, target: Element, statement_source: Element
) -> None:
    context.sink.report(
        rules.NO_PLANT_ELEMENT,
        context.graph.subject(statement_source if statement_source.source else element),
        source=name,
        target=context.graph.qualified_name(target),
    )


def _report_several(context: Context, machine: Machine, elements: list[PlantElement]) -> None:
    names = [f"'{_name_of(context, element)}'" for element in elements[:_SHOWN]]
    more = f" and {len(elements) - _SHOWN} more" if len(elements) > _SHOWN else ""
    context.sink.report(
        rules.SEVERAL_ELEMENTS,
        context.graph.subject(context.graph[machine.element]),
        machine=machine.id,
        number=len(elements),
        elements=", ".join(names) + more,
    )


def _report_missing(context: Context, machine: Machine) -> None:
    element = context.graph[machine.element]
    suggestion = context.suggest_similar(element.name)
    advice = suggestion or "say which one: amlId of «Machine», an allocation, or the overlay"
    subject = context.graph.subject(element)
    context.sink.report(
        rules.NOT_IN_PLANT, subject, help="{advice}", machine=machine.id, advice=advice
    )


def _report_unknown_id(context: Context, machine: Machine) -> None:
    element = context.graph[machine.element]
    suggestion = context.suggest_similar(machine.aml_id) or context.suggest_similar(element.name)
    context.sink.report(
        rules.UNKNOWN_ID,
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
                rules.SHARED,
                context.graph.subject(first),
                machines=", ".join(f"'{machine}'" for machine in machines),
                element=_name_of(context, context.found[plant]),
            )


def _name_of(context: Context, element: PlantElement) -> str:
    return context.plant.name_of(element)
