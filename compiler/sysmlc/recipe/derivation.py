"""Data derived from a recipe model: sub-tasks, same-machine groups, durations (thesis 6.5)."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec.structs import replace

from sysmlc.recipe.durations import find_task_timing
from sysmlc.recipe.flow import find_reachable, list_forward_edges
from sysmlc.recipe.model import (
    Condition,
    Derived,
    FlowGraph,
    Function,
    Mode,
    Model,
    Node,
    Range,
    SameMachine,
    SubTask,
    Task,
)
from sysmlc.recipe.recipe_times import derive_recipe
from sysmlc.recipe.tables import Tables


def derive(model: Model) -> Model:
    """Return the model with new derived data for every task."""
    tables = Tables.from_model(model)
    tasks = tuple(replace(task, derived=_derive_task(task, tables)) for task in model.recipe.tasks)
    recipe = replace(model.recipe, tasks=tasks)
    return replace(model, recipe=replace(recipe, derived=derive_recipe(recipe)))


def _derive_task(task: Task, tables: Tables) -> Derived | None:
    """Return the derived data of a task; None for a task without a service graph."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return None
    machines = tuple(machine for mode in task.equipment for machine in mode.machines)
    timing = find_task_timing(task, tables, machines)
    sub_tasks = _list_sub_tasks(task, graph, tables, {} if timing is None else timing.runs)
    groups = find_same_machine_groups(graph, tables)
    if timing is None:
        return Derived(sub_tasks, groups)
    return Derived(sub_tasks, groups, timing.duration, timing.expected, timing.because, timing.ends)


# -- sub-tasks ---------------------------------------------------------------------------------


def _list_sub_tasks(
    task: Task, graph: FlowGraph, tables: Tables, runs: Mapping[str, Range]
) -> tuple[SubTask, ...]:
    """Return a sub-task for each service node of the graph of a task; *runs* counts executions."""
    allowed = {machine for mode in task.equipment for machine in mode.machines}
    edges = list_forward_edges(graph)
    nodes = [node for node in graph.nodes if tables.find_service(node) is not None]
    steps = {node.id for node in nodes}
    return tuple(
        SubTask(
            node.id,
            _list_alternatives(node, allowed, tables),
            _find_predecessors(node.id, steps, edges),
            runs.get(node.id),
            _list_conditions(node.id, graph, edges),
        )
        for node in nodes
    )


def _list_conditions(
    node: str, graph: FlowGraph, edges: list[tuple[str, str]]
) -> tuple[Condition, ...]:
    """Return the branches after which *node* runs in any case, and not after their decision.

    *edges* are the forward edges. An execution takes one branch of a decision, so that the node
    runs in any case behind it if each path to an end contains the node.
    """
    ends = {n.id for n in graph.nodes if n.kind in ("final", "flowFinal")}
    choices = {n.id for n in graph.nodes if n.kind in ("decision", "loop", "forEach")}
    before = find_reachable([node], [(b, a) for a, b in edges])
    around = [(a, b) for a, b in edges if node not in (a, b)]
    avoiding = find_reachable(ends - {node}, [(b, a) for a, b in around])
    return tuple(
        Condition(edge.source, edge.guard, edge.text, edge.is_else)
        for edge in graph.edges
        if edge.source in choices & before & avoiding
        and (edge.source, edge.target) in edges
        and edge.target in before
        and edge.target not in avoiding
    )


def _list_alternatives(node: Node, allowed: set[str], tables: Tables) -> tuple[Mode, ...]:
    service = tables.find_service(node)
    providers = () if service is None else service.providers
    return tuple(
        Mode(
            (provider.machine,),
            provider.duration,
            provider.power,
            provider.tools,
            provider.available,
        )
        for provider in providers
        if not allowed or provider.machine in allowed
    )


def _find_predecessors(
    node: str, steps: set[str], edges: Iterable[tuple[str, str]]
) -> tuple[str, ...]:
    """Return the steps from which a path without other steps leads to *node*."""
    backwards = [(b, a) for a, b in edges if b == node or b not in steps]
    return tuple(sorted((find_reachable([node], backwards) & steps) - {node}))


# -- same machine ------------------------------------------------------------------------------


def find_same_machine_groups(graph: FlowGraph, tables: Tables) -> tuple[SameMachine, ...]:
    """Return the groups of services that must run on one machine because they share a resource.

    A service belongs to the group of a resource if it acquires, holds, uses or releases it and can
    run after its acquisition and before its release. Groups that share a service are merged.
    """
    functions = [f for node in graph.nodes for f in list_functions(node, tables)]
    resources = sorted({resource.id for f in functions for resource in f.resources})
    groups = [
        group
        for resource in resources
        for group in _iter_groups(graph, tables, resource)
        if len(group[0]) > 1
    ]
    order = {node.id: number for number, node in enumerate(graph.nodes)}
    merged = [
        SameMachine(tuple(sorted(nodes, key=order.__getitem__)), tuple(because))
        for nodes, because in _merge_groups(groups)
    ]
    return tuple(sorted(merged, key=lambda group: order[group.nodes[0]]))


def list_functions(node: Node, tables: Tables) -> list[Function]:
    """Return the machine functions of the service that a node calls, in the order of its graph."""
    service = tables.find_service(node)
    return [] if service is None else _collect_functions(service.implementation, tables, {node.id})


def _collect_functions(graph_id: str, tables: Tables, visited: set[str]) -> list[Function]:
    """Return the functions that a graph calls, directly or through helpers."""
    visited.add(graph_id)
    graph = tables.function_graphs.get(graph_id)
    if graph is None:
        return []
    functions: list[Function] = []
    for node in graph.nodes:
        if node.kind == "call" and node.ref not in visited:
            functions += _collect_functions(node.ref, tables, visited)
        elif node.ref in tables.functions:
            functions.append(tables.functions[node.ref])
    return functions


def find_resource_modes(node: Node, resource: str, tables: Tables) -> set[str]:
    """Return the modes in which the functions of a node's service use a resource.

    A service that both acquires and releases the resource only uses it, as other services see it.
    """
    uses = (use for function in list_functions(node, tables) for use in function.resources)
    modes = {use.mode for use in uses if use.id == resource}
    return {"use"} if {"acquire", "release"} <= modes else modes


def _iter_groups(
    graph: FlowGraph, tables: Tables, resource: str
) -> Iterator[tuple[list[str], list[str]]]:
    """Yield a group for each node that acquires the resource: the ids of its nodes, and reasons."""
    modes_by_node = {node.id: find_resource_modes(node, resource, tables) for node in graph.nodes}
    edges = [(edge.source, edge.target) for edge in graph.edges]
    releasing = {id for id, modes in modes_by_node.items() if "release" in modes}
    for start in (id for id, modes in modes_by_node.items() if "acquire" in modes):
        held = find_reachable([start], [(a, b) for a, b in edges if a not in releasing])
        to_release = find_reachable(releasing & held, [(b, a) for a, b in edges if b != start])
        members = {id for id in held & to_release if modes_by_node[id]}
        nodes = [node for node in graph.nodes if node.id in members]
        yield [node.id for node in nodes], _list_reasons(nodes, resource, tables)


def _list_reasons(nodes: list[Node], resource: str, tables: Tables) -> list[str]:
    reasons = (
        f"{function.id} {use.mode}s {resource}"
        for node in nodes
        for function in list_functions(node, tables)
        for use in function.resources
        if use.id == resource
    )
    return list(dict.fromkeys(reasons))


def _merge_groups(groups: list[tuple[list[str], list[str]]]) -> list[tuple[list[str], list[str]]]:
    result: list[tuple[list[str], list[str]]] = []
    for nodes, reasons in groups:
        overlapping = [group for group in result if set(group[0]) & set(nodes)]
        result = [group for group in result if group not in overlapping]
        merged = [*overlapping, (nodes, reasons)]
        all_nodes = [node for group_nodes, _ in merged for node in group_nodes]
        all_reasons = [reason for _, group_reasons in merged for reason in group_reasons]
        result.append((all_nodes, all_reasons))
    return [(list(dict.fromkeys(ns)), list(dict.fromkeys(rs))) for ns, rs in result]
