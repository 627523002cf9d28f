"""Binds machines of recipes to elements of the plant."""

from collections.abc import Iterator

from sysmlc.ir import Element
from sysmlc.passes.platform import rules
from sysmlc.passes.platform.context import Context, allocations, of_machine
from sysmlc.recipe.model import Machine
from sysmlc.recipe.plant import PlantElement, is_of_plant
from sysmlc.recipe.platform import Binding

_SHOWN = 4


def bind_machines(context: Context) -> list[Binding]:
    """The element of each machine. An equal name binds nothing: it is suggested (design, 5)."""
    found: list[Binding] = []
    for machine in context.machines.values():
        found += _of(context, machine)
    _report_shared(context, found)
    return found


def _of(context: Context, machine: Machine) -> list[Binding]:
    said = list(_statements(context, machine))
    known = {one.id: (one, how, by) for one, how, by in reversed(said)}
    if len(known) > 1:
        _report_several(context, machine, [known[id][0] for id in sorted(known)])
        return []
    context.found.update((id, one) for id, (one, _, _) in known.items())
    if not known and not _is_told(context, machine):
        _report_missing(context, machine)
    return [Binding(machine.id, id, how, by) for id, (_, how, by) in known.items()]


def _statements(context: Context, machine: Machine) -> Iterator[tuple[PlantElement, str, str]]:
    """Elements that are said to be the machine, what is said most directly first."""
    graph = context.graph
    element = graph[machine.element]
    if context.plant and is_of_plant(graph, element):
        yield from ((one, "itself", element.id) for one in context.plant.find_represented(element))
    by_id = context.plant.find_by_id(machine.aml_id) if machine.aml_id else None
    if by_id is not None:
        yield by_id, "id", element.id
    for target, how, by in of_machine(graph, machine):
        if not context.is_machine(target):
            yield from ((one, how, by.id) for one in context.meant(target))


def _is_told(context: Context, machine: Machine) -> bool:
    """Whether it is said, and reported, why a machine has no element."""
    told = False
    if machine.aml_id and context.plant:
        _report_unknown_id(context, machine)
        told = True
    for target, _, by in of_machine(context.graph, machine):
        if not context.is_machine(target) and not context.meant(target):
            source = context.graph[machine.element]
            _report_misplaced(context, machine.id, source, target, by)
            told = True
    return told


def misplaced(context: Context) -> None:
    """Report allocations of services to what is neither of the plant nor a machine."""
    for service in context.services.values():
        element = context.graph[service.element]
        for target, _, by in allocations(context.graph, element):
            is_known = context.is_machine(target) or context.meant(target)
            if not is_known and not _is_operation(context, target.id):
                _report_misplaced(context, service.id, element, target, by)


def _is_operation(context: Context, id: str) -> bool:
    return context.graph[id].kind in ("Operation", "Reception")


# -- findings ----------------------------------------------------------------------------------


def _report_misplaced(
    context: Context, name: str, element: Element, target: Element, by: Element
) -> None:
    context.sink.report(
        rules.NO_PLANT_ELEMENT,
        context.graph.subject(by if by.source else element),
        source=name,
        target=context.graph.qualified_name(target),
    )


def _report_several(context: Context, machine: Machine, several: list[PlantElement]) -> None:
    names = [f"'{_name(context, one)}'" for one in several[:_SHOWN]]
    more = f" and {len(several) - _SHOWN} more" if len(several) > _SHOWN else ""
    context.sink.report(
        rules.SEVERAL_ELEMENTS,
        context.graph.subject(context.graph[machine.element]),
        machine=machine.id,
        number=len(several),
        elements=", ".join(names) + more,
    )


def _report_missing(context: Context, machine: Machine) -> None:
    element = context.graph[machine.element]
    near = context.nearest(element.name)
    advice = near or "say which one: amlId of «Machine», an allocation, or the overlay"
    subject = context.graph.subject(element)
    context.sink.report(
        rules.NOT_IN_PLANT, subject, help="{advice}", machine=machine.id, advice=advice
    )


def _report_unknown_id(context: Context, machine: Machine) -> None:
    element = context.graph[machine.element]
    near = context.nearest(machine.aml_id) or context.nearest(element.name)
    context.sink.report(
        rules.UNKNOWN_ID,
        context.graph.subject(element),
        help="{advice}",
        machine=machine.id,
        id=machine.aml_id,
        advice=near or "take the ID of an InternalElement of the plant",
    )


def _report_shared(context: Context, found: list[Binding]) -> None:
    sharing: dict[str, list[str]] = {}
    for one in found:
        sharing.setdefault(one.plant, []).append(one.machine)
    for plant, machines in sorted(sharing.items()):
        if len(machines) > 1:
            first = context.graph[context.machines[machines[0]].element]
            context.sink.report(
                rules.SHARED,
                context.graph.subject(first),
                machines=", ".join(f"'{one}'" for one in machines),
                element=_name(context, context.found[plant]),
            )


def _name(context: Context, one: PlantElement) -> str:
    return context.plant.name_of(one)
