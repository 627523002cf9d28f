"""Checks of durations and of machines and resources that services share (REC008 to REC010)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.recipe.derivation import find_resource_modes, find_same_machine_groups, list_functions
from sysmlc.recipe.durations import (
    find_full_duration,
    find_mode_duration,
    find_refined_duration,
    find_untimed_steps,
    format_range,
)
from sysmlc.recipe.flow import find_reachable
from sysmlc.recipe.model import FlowGraph, Model, Range, Service, Task
from sysmlc.recipe.tables import Finding, Tables

TASK_TIME = rule(
    "SM608",
    "task-takes-too-long",
    Severity.WARNING,
    "task '{task}' takes {derived} ms by its services, but {declared}",
    help="correct the duration of the task or of a service, or bound a loop",
)
SERVICE_TIME = rule(
    "SM609",
    "service-time-differs",
    Severity.WARNING,
    "service '{service}' takes {derived} ms by its functions, but {declared} ms on '{machine}'",
    help="correct the duration of a function or of the «Capability»",
)
TASK_TIME_DIFFERS = rule(
    "SM650",
    "task-time-differs",
    Severity.WARNING,
    "task '{task}' takes {derived} ms by its services, but {declared} ms on {machines}, more than "
    "twice as long",
    help="correct the duration of the «Capability» of the task or of a service",
)
NO_DURATION = rule(
    "SM651",
    "recipe-duration-missing",
    Severity.WARNING,
    "no times are derived for task '{task}': '{step}' has no duration",
    help="state its duration: in the «Capability» of each machine, or at the service",
)
UNAVAILABLE = rule(
    "SM646",
    "recipe-machine-unavailable",
    Severity.WARNING,
    "{machines} is not available for '{user}'{consequence}",
    help="remove 'available = false' when it can be used again, or relate another machine",
)
STALE_GROUPS = rule(
    "SM610",
    "same-machine-differs",
    Severity.ERROR,
    "task '{task}': {problem}",
    help="let one machine offer all services of the group, or correct which service "
    "takes the resource",
)
UNRELEASED = rule(
    "SM618",
    "resource-never-released",
    Severity.WARNING,
    "task '{task}' can end while '{resource}', acquired at '{node}', is not released",
    help=(
        "call a service that releases it on every path to the end, or mark the function's use of it"
    ),
)


def check_task_times(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC008: a task takes no longer than its bound, nor than the duration of each mode."""
    for task in model.recipe.tasks:
        derived = None if task.derived is None else find_full_duration(task.derived)
        if derived is not None and _exceeds(derived, task.max_duration):
            yield _too_long(task, derived, f"at most {task.max_duration} ms are allowed")
        for mode in task.equipment:
            derived = find_mode_duration(task, mode, tables)
            if derived is not None and _exceeds(derived, mode.duration):
                declared = f"{mode.duration} ms on {_join_names(mode.machines)}"
                yield _too_long(task, derived, declared)


def _exceeds(duration: Range, limit: int | None) -> bool:
    """Whether the maximum, or without a maximum the minimum, is above the limit."""
    return limit is not None and (duration.min if duration.max is None else duration.max) > limit


def _too_long(task: Task, derived: Range, declared: str) -> Finding:
    facts = {"task": task.id, "derived": format_range(derived), "declared": declared}
    return Finding(TASK_TIME, task.element, facts)


def check_capability_times(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM650: the duration of a mode is at most twice the time that the services of the task take.

    A smaller surplus is usual: a capability may include set-up times.
    """
    for task in model.recipe.tasks:
        for mode in task.equipment:
            derived = find_mode_duration(task, mode, tables)
            if derived is None or derived.max is None or mode.duration is None:
                continue
            if mode.duration > 2 * derived.max:
                facts = {
                    "task": task.id,
                    "derived": format_range(derived),
                    "declared": mode.duration,
                    "machines": _join_names(mode.machines),
                }
                yield Finding(TASK_TIME_DIFFERS, task.element, facts)


def check_missing_durations(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM651: if a task has times at all, each of its steps has a duration."""
    for task in model.recipe.tasks:
        untimed, has_times = find_untimed_steps(task, tables)
        modes = (mode.duration for mode in task.equipment)
        limits = (task.max_duration, *modes, *task.limits, *model.recipe.limits)
        if untimed and (has_times or any(limit is not None for limit in limits)):
            for node in untimed:
                service = tables.find_service(node)
                step = node.id if service is None else service.id
                element = node.element if service is None else service.element
                yield Finding(NO_DURATION, element, {"task": task.id, "step": step})


def check_availability(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM646: the machines of tasks and services are available."""
    for task in model.recipe.tasks:
        modes = [(mode.machines, mode.available) for mode in task.equipment]
        yield from _check_availability(task, modes)
    for service in model.services:
        yield from _check_availability(
            service, [((provider.machine,), provider.available) for provider in service.providers]
        )


def _check_availability(
    user: Task | Service, modes: list[tuple[tuple[str, ...], bool | None]]
) -> Iterator[Finding]:
    is_last = all(available is False for _, available in modes)
    consequence = ", and nothing else can perform it" if is_last else ""
    for machines, available in modes:
        if available is False:
            facts = {
                "machines": _join_names(machines),
                "user": user.id,
                "consequence": consequence,
            }
            yield Finding(UNAVAILABLE, user.element, facts)


def _join_names(machines: tuple[str, ...]) -> str:
    return " and ".join(f"'{machine}'" for machine in machines)


def check_service_times(model: Model, tables: Tables, tolerance: float) -> Iterator[Finding]:
    """REC009: the durations of functions and of providers agree within the tolerance."""
    for service in model.services:
        derived = find_refined_duration(service, tables)
        if derived is None:
            continue
        for provider in service.providers:
            if _differs(derived, provider.duration, tolerance):
                facts = {
                    "service": service.id,
                    "derived": format_range(derived),
                    "declared": provider.duration,
                    "machine": provider.machine,
                }
                yield Finding(SERVICE_TIME, service.element, facts)


def _differs(derived: Range, duration: int | None, tolerance: float) -> bool:
    if duration is None:
        return False
    too_short = duration < derived.min * (1 - tolerance)
    return too_short or (derived.max is not None and duration > derived.max * (1 + tolerance))


# -- resources ---------------------------------------------------------------------------------


def check_groups(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC010: same-machine groups are up to date; one machine offers all services of a group."""
    for task in model.recipe.tasks:
        graph = tables.service_graphs.get(task.implementation)
        groups = None if graph is None else find_same_machine_groups(graph, tables)
        if groups != (task.derived and task.derived.same_machine):
            problem = "its same-machine groups are not those that follow from its functions"
            yield Finding(STALE_GROUPS, task.element, {"task": task.id, "problem": problem})
        elif groups is not None:
            for group in groups:
                yield from _check_group(task, group.nodes, tables)


def _check_group(task: Task, group: tuple[str, ...], tables: Tables) -> Iterator[Finding]:
    nodes = {node.id: node for node in tables.service_graphs[task.implementation].nodes}
    services = [tables.find_service(nodes[id]) for id in group]
    offers = [{p.machine for p in service.providers} for service in services if service]
    equipment = {machine for mode in task.equipment for machine in mode.machines}
    if offers and not set.intersection(*offers, *([equipment] if equipment else [])):
        names = ", ".join(f"'{id.rpartition('::')[2]}'" for id in group)
        problem = f"no machine offers all of {names}, which must run on one machine"
        yield Finding(STALE_GROUPS, task.element, {"task": task.id, "problem": problem})


def check_releases(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM618: each resource that a task acquires is released on every path to the end."""
    for task in model.recipe.tasks:
        graph = tables.service_graphs.get(task.implementation)
        if graph is not None:
            for resource, node, element in _iter_unreleased(graph, tables):
                facts = {"task": task.id, "resource": resource, "node": node}
                yield Finding(UNRELEASED, element, facts)


def _iter_unreleased(graph: FlowGraph, tables: Tables) -> Iterator[tuple[str, str, str]]:
    ends = {node.id for node in graph.nodes if node.kind == "final"}
    for node in graph.nodes:
        resources = {r.id for f in list_functions(node, tables) for r in f.resources}
        for resource in sorted(resources):
            modes_by_node = {n.id: find_resource_modes(n, resource, tables) for n in graph.nodes}
            releasing = {id for id, modes in modes_by_node.items() if "release" in modes}
            edges = [(e.source, e.target) for e in graph.edges if e.source not in releasing]
            if "acquire" in modes_by_node[node.id] and find_reachable([node.id], edges) & ends:
                yield resource, node.id, node.element
