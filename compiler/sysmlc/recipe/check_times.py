"""Checks of durations and resources (REC008, REC009, REC010)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.recipe.checks import Finding
from sysmlc.recipe.derive import (
    Tables,
    functions_of,
    mode_range,
    modes,
    refined_range,
    same_machine,
)
from sysmlc.recipe.flow import reachable
from sysmlc.recipe.model import FlowGraph, Model, Provider, Range, Service, Task

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
STALE_GROUPS = rule(
    "SM610",
    "same-machine-differs",
    Severity.ERROR,
    "task '{task}': {problem}",
    help="let one machine offer all services of the group, or correct who takes the resource",
)
UNRELEASED = rule(
    "SM618",
    "resource-never-released",
    Severity.WARNING,
    "task '{task}' can end while '{resource}', taken at '{node}', is not given back",
    help=(
        "call a service that releases it on every way to the end, or mark the function's use of it"
    ),
)
UNBOUNDED = rule(
    "SM620",
    "loop-without-bound",
    Severity.INFO,
    "nothing bounds the loop at '{loop}'",
    help="apply «Loop» with maxIterations to the decision",
)


def task_times(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC008: the longest path fits the bound and, on each mode's machines, the mode's time."""
    for task in model.recipe.tasks:
        found = None if task.derived is None else task.derived.duration
        if found is not None and _exceeds(found, task.max_duration):
            yield _too_long(task, found, f"at most {task.max_duration} ms are allowed")
        for mode in task.equipment:
            found = mode_range(task, mode, tables)
            if found is not None and _exceeds(found, mode.duration):
                where = " and ".join(f"'{one}'" for one in mode.machines)
                yield _too_long(task, found, f"{mode.duration} ms on {where}")


def _exceeds(found: Range, limit: int | None) -> bool:
    """Whether the longest time is above the limit; without a longest time, the shortest."""
    return limit is not None and (found.min if found.max is None else found.max) > limit


def _too_long(task: Task, found: Range, declared: str) -> Finding:
    facts = {"task": task.id, "derived": _shown(found), "declared": declared}
    return Finding(TASK_TIME, task.element, facts)


def _shown(found: Range) -> str:
    if found.max == found.min:
        return str(found.min)
    return f"{found.min} to {'any number of' if found.max is None else found.max}"


def service_times(model: Model, tables: Tables, tolerance: float) -> Iterator[Finding]:
    """REC009: functions and providers agree within the tolerance."""
    for service in model.services:
        found = refined_range(service, tables)
        for provider in service.providers if found is not None else ():
            if found is not None and _differs(found, provider.duration, tolerance):
                yield _disagreement(service, provider, found)


def _differs(found: Range, duration: int | None, tolerance: float) -> bool:
    if duration is None:
        return False
    too_short = duration < found.min * (1 - tolerance)
    return too_short or (found.max is not None and duration > found.max * (1 + tolerance))


def _disagreement(service: Service, provider: Provider, found: Range) -> Finding:
    facts = {
        "service": service.id,
        "derived": _shown(found),
        "declared": provider.duration,
        "machine": provider.machine,
    }
    return Finding(SERVICE_TIME, service.element, facts)


# -- resources ---------------------------------------------------------------------------------


def groups(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC010: groups are as derived again, and one machine can do each of them."""
    for task in model.recipe.tasks:
        graph = tables.service_graphs.get(task.implementation)
        again = None if graph is None else same_machine(graph, tables)
        if again != (task.derived and task.derived.same_machine):
            problem = "its same-machine groups are not those that follow from its functions"
            yield Finding(STALE_GROUPS, task.element, {"task": task.id, "problem": problem})
        elif again is not None:
            for group in again:
                yield from _without_machine(task, group.nodes, tables)


def _without_machine(task: Task, group: tuple[str, ...], tables: Tables) -> Iterator[Finding]:
    nodes = {node.id: node for node in tables.service_graphs[task.implementation].nodes}
    services = [tables.service(nodes[id]) for id in group]
    offers = [{p.machine for p in one.providers} for one in services if one is not None]
    equipment = {machine for mode in task.equipment for machine in mode.machines}
    if offers and not set.intersection(*offers, *([equipment] if equipment else [])):
        names = ", ".join(f"'{id.rpartition('::')[2]}'" for id in group)
        problem = f"no machine offers all of {names}, which must run on one machine"
        yield Finding(STALE_GROUPS, task.element, {"task": task.id, "problem": problem})


def releases(model: Model, tables: Tables) -> Iterator[Finding]:
    """Resources that some way to the end leaves taken."""
    for task in model.recipe.tasks:
        graph = tables.service_graphs.get(task.implementation)
        for resource, node, element in () if graph is None else _kept(graph, tables):
            facts = {"task": task.id, "resource": resource, "node": node}
            yield Finding(UNRELEASED, element, facts)


def _kept(graph: FlowGraph, tables: Tables) -> Iterator[tuple[str, str, str]]:
    ends = {node.id for node in graph.nodes if node.kind == "final"}
    for node in graph.nodes:
        found = {r.id for one in functions_of(node, tables) for r in one.resources}
        for resource in sorted(found):
            does = {one.id: modes(one, resource, tables) for one in graph.nodes}
            gives = {id for id, what in does.items() if "release" in what}
            open_ = [(e.source, e.target) for e in graph.edges if e.source not in gives]
            if "acquire" in does[node.id] and reachable([node.id], open_) & ends:
                yield resource, node.id, node.element


def bounds(model: Model, tables: Tables) -> Iterator[Finding]:
    """Loops without a bound."""
    for graph in (*model.service_graphs, *model.function_graphs):
        for node in graph.nodes:
            if node.kind == "loop" and node.max_iterations is None:
                yield Finding(UNBOUNDED, node.element, {"loop": node.id})
