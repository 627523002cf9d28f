"""Checks of level 1: references, order, machines (REC001, REC002, REC007)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.recipe.checks import Finding
from sysmlc.recipe.derive import Tables, providers_of
from sysmlc.recipe.flow import cycles
from sysmlc.recipe.model import Model, Task

BROKEN_REFERENCE = rule(
    "SM601",
    "recipe-broken-reference",
    Severity.ERROR,
    "'{user}' needs '{missing}', which is no {level}",
    help="apply the stereotype for a {level} to '{missing}', or relate '{user}' to another element",
)
CYCLIC_TASKS = rule(
    "SM602",
    "recipe-cyclic-tasks",
    Severity.ERROR,
    "the tasks {tasks} of recipe '{recipe}' wait for one another",
    help="repetition belongs inside a task, as a loop of services",
)
NO_MACHINE = rule(
    "SM607",
    "task-without-machine",
    Severity.ERROR,
    "task '{task}' cannot be done: {problem}",
    help=(
        "relate the task to machines that offer its services («Capability»), or the service to "
        "those machines"
    ),
)
PROVIDER_OUTSIDE = rule(
    "SM613",
    "provider-outside-equipment",
    Severity.WARNING,
    "service '{service}' could run on '{machine}', but task '{task}' is not related to it",
    help="relate the task to '{machine}' as well, if that is meant",
)


def references(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC001: every id resolves."""
    machines = {one.id for one in model.machines}
    for user, element, names in _users(model):
        for name in names:
            if name not in machines:
                facts = {"user": user, "missing": name, "level": "machine"}
                yield Finding(BROKEN_REFERENCE, element, facts)
    yield from _duplicates(model)


def _users(model: Model) -> Iterator[tuple[str, str, tuple[str, ...]]]:
    for task in model.recipe.tasks:
        for mode in task.equipment:
            yield task.id, task.element, mode.machines
    for service in model.services:
        yield service.id, service.element, tuple(one.machine for one in service.providers)


def _duplicates(model: Model) -> Iterator[Finding]:
    seen: set[str] = set()
    tables = (model.machines, model.materials, model.services, model.functions)
    for one in (item for table in tables for item in table):
        if one.id in seen:
            facts = {"user": one.id, "missing": one.id, "level": "only element of its name"}
            yield Finding(BROKEN_REFERENCE, one.element, facts)
        seen.add(one.id)


def order(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC002: precedence is acyclic, so that every task can be reached from a first one."""
    recipe = model.recipe
    for part in cycles([task.id for task in recipe.tasks], recipe.precedence):
        names = ", ".join(f"'{id.rpartition('::')[2]}'" for id in part)
        yield Finding(CYCLIC_TASKS, recipe.element, {"tasks": names, "recipe": recipe.id})


def machines(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC007: each mode can do the task, each machine service can run in some mode."""
    for task in model.recipe.tasks:
        yield from _task_machines(task, tables)


def _task_machines(task: Task, tables: Tables) -> Iterator[Finding]:
    if not task.equipment:
        yield _cannot(task, "no machine is related to it")
        return
    equipment = {machine for mode in task.equipment for machine in mode.machines}
    offers = {
        service: {one.machine for one in providers}
        for service, providers in providers_of(task, tables).items()
    }
    for service, offering in sorted(offers.items()):
        if not offering & equipment:
            yield _cannot(task, f"none of its machines offers the service '{service}'")
        for machine in sorted(offering - equipment) if offering & equipment else ():
            facts = {"service": service, "machine": machine, "task": task.id}
            yield Finding(PROVIDER_OUTSIDE, tables.services[service].element, facts)
    offered = {machine for offering in offers.values() for machine in offering}
    for machine in sorted(equipment - offered) if offers else ():
        yield _cannot(task, f"its machine '{machine}' offers none of its services")


def _cannot(task: Task, problem: str) -> Finding:
    return Finding(NO_MACHINE, task.element, {"task": task.id, "problem": problem})
