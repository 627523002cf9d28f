"""Checks of tasks, their materials, and OPC UA calls (REC001, REC002, REC007, REC011, REC012)."""

import re
from collections.abc import Iterator, Mapping

from sysmlc.diagnostics import Severity, rule
from sysmlc.recipe.flow import find_cycles
from sysmlc.recipe.model import Function, Model, OpcUa, Provider, Service, Task
from sysmlc.recipe.tables import Finding, Tables

BROKEN_REFERENCE = rule(
    "SM601",
    "recipe-broken-reference",
    Severity.ERROR,
    "'{user}' needs '{missing}', which is not a {level}",
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
    "task '{task}' cannot be performed: {problem}",
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


def check_references(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC001: every machine that is named exists, and ids are unique."""
    machines = {machine.id for machine in model.machines}
    for user, element, names in _iter_uses(model):
        for name in names:
            if name not in machines:
                facts = {"user": user, "missing": name, "level": "machine"}
                yield Finding(BROKEN_REFERENCE, element, facts)
    yield from _check_unique_ids(model)


def _iter_uses(model: Model) -> Iterator[tuple[str, str, tuple[str, ...]]]:
    for task in model.recipe.tasks:
        for mode in task.equipment:
            yield task.id, task.element, mode.machines
    for service in model.services:
        yield service.id, service.element, tuple(provider.machine for provider in service.providers)


def _check_unique_ids(model: Model) -> Iterator[Finding]:
    seen: set[str] = set()
    tables = (model.machines, model.materials, model.services, model.functions)
    for item in (item for table in tables for item in table):
        if item.id in seen:
            facts = {"user": item.id, "missing": item.id, "level": "only element of its name"}
            yield Finding(BROKEN_REFERENCE, item.element, facts)
        seen.add(item.id)


def check_precedence(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC002: the precedence of tasks is acyclic."""
    recipe = model.recipe
    for cycle in find_cycles([task.id for task in recipe.tasks], recipe.precedence):
        names = ", ".join(f"'{id.rpartition('::')[2]}'" for id in cycle)
        yield Finding(CYCLIC_TASKS, recipe.element, {"tasks": names, "recipe": recipe.id})


def check_machines(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC007: the machines of a task offer its services, or each service has a machine."""
    for task in model.recipe.tasks:
        yield from _check_machines_of_task(task, tables)


def _check_machines_of_task(task: Task, tables: Tables) -> Iterator[Finding]:
    providers_by_service = _find_providers(task, tables)
    if not task.equipment:
        yield from _check_services_of_task(task, providers_by_service)
        return
    equipment = {machine for mode in task.equipment for machine in mode.machines}
    offers = {
        service: {provider.machine for provider in providers}
        for service, providers in providers_by_service.items()
    }
    for service, offering in sorted(offers.items()):
        if not offering & equipment:
            yield _make_finding(task, f"none of its machines offers the service '{service}'")
        if offering & equipment:
            for machine in sorted(offering - equipment):
                facts = {"service": service, "machine": machine, "task": task.id}
                yield Finding(PROVIDER_OUTSIDE, tables.services[service].element, facts)
    offered = {machine for offering in offers.values() for machine in offering}
    # Services that no machine offers are reported above.
    for machine in sorted(equipment - offered) if offered else ():
        yield _make_finding(task, f"its machine '{machine}' offers none of its services")


def _check_services_of_task(
    task: Task, providers_by_service: Mapping[str, tuple[Provider, ...]]
) -> Iterator[Finding]:
    """Report services without a machine of a task that only its services relate to machines."""
    if not providers_by_service:
        yield _make_finding(task, "no machine is related to it")
    for service, providers in sorted(providers_by_service.items()):
        if not providers:
            yield _make_finding(task, f"no machine is related to it or to its service '{service}'")


def _find_providers(task: Task, tables: Tables) -> dict[str, tuple[Provider, ...]]:
    """Return the providers of each machine service of a task, by the id of the service."""
    graph = tables.service_graphs.get(task.implementation)
    nodes = () if graph is None else graph.nodes
    services = [tables.find_service(node) for node in nodes]
    machine_services = [s for s in services if s is not None and s.kind == "machine"]
    return {service.id: service.providers for service in machine_services}


def _make_finding(task: Task, problem: str) -> Finding:
    return Finding(NO_MACHINE, task.element, {"task": task.id, "problem": problem})


# -- materials and OPC UA calls ----------------------------------------------------------------

MATERIAL_MISSING = rule(
    "SM611",
    "material-not-listed",
    Severity.ERROR,
    "the services of task '{task}' consume {needed} of '{material}', but the task lists {listed}",
    help="give the task an object flow from '{material}' with that quantity",
)
NODE_ID = rule(
    "SM612",
    "opc-ua-node-id-unstable",
    Severity.WARNING,
    "the OPC UA call on '{element}' {problem}",
    help="state namespaceUri, or write the node id with nsu=",
)

_NODE_ID = re.compile(r"(?:(ns)=\d+;|nsu=[^;]+;)?[isgb]=.+", re.DOTALL)


def check_materials(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC011: a task lists the materials that its services consume, in sufficient quantity."""
    for task in model.recipe.tasks:
        listed = {use.material: use.quantity for use in task.materials if use.use != "produced"}
        for material, needed in sorted(_sum_consumption(task, tables).items()):
            if needed > listed.get(material, 0):
                facts = {
                    "task": task.id,
                    "material": material,
                    "needed": needed,
                    "listed": listed.get(material, "none"),
                }
                yield Finding(MATERIAL_MISSING, task.element, facts)


MATERIAL_SHORT = rule(
    "SM647",
    "material-short",
    Severity.WARNING,
    "recipe '{recipe}' needs {needed} of '{material}', but {available}",
    help="correct the quantity of the flow or the available amount of the material",
)


def check_stock(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM647: a recipe needs no more of a material than is available and produced."""
    uses = [(task, use) for task in model.recipe.tasks for use in task.materials]
    for material in model.materials:
        own = [(task, use) for task, use in uses if use.material == material.id]
        consumed = sum(use.quantity for _, use in own if use.use == "consumed")
        produced = sum(use.quantity for _, use in own if use.use == "produced")
        needed = max([consumed, *(use.quantity for _, use in own if use.use == "carried")])
        if material.available is None or needed <= material.available + produced:
            continue
        tasks = {task.element for task, use in own if use.use != "produced"}
        available = f"{_format_amount(material.available, material.unit)} is available"
        facts = {
            "recipe": model.recipe.id,
            "needed": _format_amount(needed, material.unit),
            "material": material.id,
            "available": available + (f" and {produced} is produced" if produced else ""),
        }
        yield Finding(
            MATERIAL_SHORT, tasks.pop() if len(tasks) == 1 else model.recipe.element, facts
        )


def _format_amount(amount: float, unit: str) -> str:
    return f"{amount} {unit}".rstrip()


def _sum_consumption(task: Task, tables: Tables) -> dict[str, float]:
    """Return the quantity of each material that the services of a task consume."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return {}
    consumption: dict[str, float] = {}
    for service in map(tables.find_service, graph.nodes):
        uses = [] if service is None else service.materials
        for use in uses:
            if use.use == "consumed":
                consumption[use.material] = consumption.get(use.material, 0) + use.quantity
    return consumption


def check_opc_ua_calls(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC012: node ids are well-formed and do not depend on a session; calls name a method."""
    for call in _iter_calls(model):
        for problem in _iter_problems(call):
            facts = {"element": _name_owner(model, call), "problem": problem}
            yield Finding(NODE_ID, call.element, facts)


def _iter_calls(model: Model) -> Iterator[OpcUa]:
    owners: tuple[Service | Function, ...] = (*model.services, *model.functions)
    own_calls = [owner.opcua for owner in owners]
    provider_calls = [p.opcua for service in model.services for p in service.providers]
    yield from dict.fromkeys(call for call in (*own_calls, *provider_calls) if call is not None)


def _name_owner(model: Model, call: OpcUa) -> str:
    for service in model.services:
        for provider in service.providers:
            if provider.opcua == call:
                return f"{service.id} on {provider.machine}"
    owners: tuple[Service | Function, ...] = (*model.services, *model.functions)
    return next((owner.id for owner in owners if owner.opcua == call), call.object)


def is_complete(call: OpcUa) -> bool:
    """Whether an executor can perform the call: no node id is missing or malformed."""
    ids = [call.object, *([call.method] if call.method else [])]
    return all(map(_NODE_ID.fullmatch, ids)) and (call.kind != "call" or bool(call.method))


def _iter_problems(call: OpcUa) -> Iterator[str]:
    if not call.object:
        yield "names no object"
    if call.kind == "call" and not call.method:
        yield "names no method"
    for id in (call.object, call.method):
        match = _NODE_ID.fullmatch(id)
        if id and match is None:
            yield f"has '{id}', which is not a node id"
        elif match is not None and match[1] and not call.namespace_uri:
            yield f"has '{id}', which names its namespace by an index only"
