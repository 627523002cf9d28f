"""Data derived from a recipe model: sub-tasks, same-machine groups, durations (thesis 6.5)."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic.expressions.expression import Literal
from sysmlc.recipe.flow import compute_duration, find_reachable, forward_edges
from sysmlc.recipe.model import (
    Derived,
    FlowGraph,
    Function,
    Mode,
    Model,
    Node,
    Provider,
    Range,
    SameMachine,
    Service,
    SubTask,
    Task,
)

_NO_TIME = Range(0, 0)


class Tables(Struct, frozen=True):
    """The services, functions and graphs of a model by id, and memoised durations."""

    services: Mapping[str, Service]
    functions: Mapping[str, Function]
    service_graphs: Mapping[str, FlowGraph]
    function_graphs: Mapping[str, FlowGraph]
    _times: dict[tuple[str, ...], Range | None] = field(default_factory=dict)

    @classmethod
    def from_model(cls, model: Model) -> "Tables":
        """Return the tables of a model."""
        return cls(
            {service.id: service for service in model.services},
            {function.id: function for function in model.functions},
            {graph.id: graph for graph in model.service_graphs},
            {graph.id: graph for graph in model.function_graphs},
        )

    def service(self, node: Node) -> Service | None:
        """Return the service that a node calls, or None."""
        return self.services.get(node.ref) if node.kind == "service" else None

    def memoise_time(
        self, key: tuple[str, ...], compute: Callable[[], Range | None]
    ) -> Range | None:
        """Return the duration stored under *key*; compute it at the first call."""
        if key not in self._times:
            self._times[key] = compute()
        return self._times[key]

    def without(self, graph: str) -> "Tables":
        """Return tables without one graph of functions, to stop a recursion of calls."""
        rest = {id: other for id, other in self.function_graphs.items() if id != graph}
        return Tables(self.services, self.functions, self.service_graphs, rest)


def derive(model: Model) -> Model:
    """Return the model with new derived data for every task."""
    tables = Tables.from_model(model)
    tasks = tuple(replace(task, derived=_derive_task(task, tables)) for task in model.recipe.tasks)
    return replace(model, recipe=replace(model.recipe, tasks=tasks))


def _derive_task(task: Task, tables: Tables) -> Derived | None:
    """Return the derived data of a task; None for a task without a service graph."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return None
    return Derived(
        _list_sub_tasks(task, graph, tables),
        same_machine(graph, tables),
        compute_duration(graph, lambda node: node_range(node, tables)),
    )


# -- sub-tasks ---------------------------------------------------------------------------------


def _list_sub_tasks(task: Task, graph: FlowGraph, tables: Tables) -> tuple[SubTask, ...]:
    """Return the sub-tasks of the service nodes, with their alternatives and predecessors."""
    allowed = {machine for mode in task.equipment for machine in mode.machines}
    edges = forward_edges(graph)
    nodes = [node for node in graph.nodes if tables.service(node) is not None]
    steps = {node.id for node in nodes}
    return tuple(
        SubTask(
            node.id,
            _list_alternatives(node, allowed, tables),
            _find_predecessors(node.id, steps, edges),
        )
        for node in nodes
    )


def _list_alternatives(node: Node, allowed: set[str], tables: Tables) -> tuple[Mode, ...]:
    service = tables.service(node)
    providers = () if service is None else service.providers
    return tuple(
        Mode((provider.machine,), provider.duration, provider.power, provider.tools)
        for provider in providers
        if not allowed or provider.machine in allowed
    )


def _find_predecessors(
    node: str, steps: set[str], edges: Iterable[tuple[str, str]]
) -> tuple[str, ...]:
    """Return the steps from which *node* is reachable without a step between."""
    backwards = [(b, a) for a, b in edges if b == node or b not in steps]
    return tuple(sorted((find_reachable([node], backwards) & steps) - {node}))


# -- same machine ------------------------------------------------------------------------------


def same_machine(graph: FlowGraph, tables: Tables) -> tuple[SameMachine, ...]:
    """Return the groups of services that must run on one machine because they share a resource.

    A service belongs to the group of a resource if it acquires, holds, uses or releases it and can
    run after its acquisition and before its release. Groups that share a service are merged.
    """
    groups = [
        group
        for resource in _list_resources(graph, tables)
        for group in _iter_groups(graph, tables, resource)
        if len(group[0]) > 1
    ]
    order = {node.id: number for number, node in enumerate(graph.nodes)}
    merged = [
        SameMachine(tuple(sorted(nodes, key=order.__getitem__)), tuple(because))
        for nodes, because in _merge_groups(groups)
    ]
    return tuple(sorted(merged, key=lambda group: order[group.nodes[0]]))


def _list_resources(graph: FlowGraph, tables: Tables) -> list[str]:
    functions = [f for node in graph.nodes for f in functions_of(node, tables)]
    return sorted({resource.id for f in functions for resource in f.resources})


def functions_of(node: Node, tables: Tables) -> list[Function]:
    """Return the machine functions of the service that a node calls, in the order of its graph."""
    service = tables.service(node)
    return [] if service is None else _collect_functions(service.implementation, tables, {node.id})


def _collect_functions(graph_id: str, tables: Tables, visited: set[str]) -> list[Function]:
    """Return the functions that a graph calls, directly or by the helpers that it calls."""
    graph = tables.function_graphs.get(graph_id)
    functions: list[Function] = []
    visited.add(graph_id)
    for node in () if graph is None else graph.nodes:
        if node.kind == "call" and node.ref not in visited:
            functions += _collect_functions(node.ref, tables, visited)
        elif node.ref in tables.functions:
            functions.append(tables.functions[node.ref])
    return functions


def find_modes(node: Node, resource: str, tables: Tables) -> set[str]:
    """Return the modes in which the service of a node uses a resource, for other services.

    A service that acquires and releases a resource only uses it.
    """
    uses = (use for function in functions_of(node, tables) for use in function.resources)
    modes = {use.mode for use in uses if use.id == resource}
    return {"use"} if {"acquire", "release"} <= modes else modes


def _iter_groups(
    graph: FlowGraph, tables: Tables, resource: str
) -> Iterator[tuple[list[str], list[str]]]:
    """Yield a group of nodes, with its reasons, for each node that acquires the resource."""
    modes_by_node = {node.id: find_modes(node, resource, tables) for node in graph.nodes}
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
        for function in functions_of(node, tables)
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


# -- durations ---------------------------------------------------------------------------------


def node_range(node: Node, tables: Tables, machines: tuple[str, ...] = ()) -> Range | None:
    """Return the duration of a node in milliseconds, on one of *machines* if any are named."""
    return _COSTS.get(node.kind, _no_time)(node, tables, machines)


def service_range(service: Service, tables: Tables, machines: tuple[str, ...] = ()) -> Range | None:
    """Return the duration that the providers, or else the service, or else its functions state."""
    providers = [provider for provider in service.providers if provider.machine in machines]
    providers = providers or list(service.providers)
    known = [provider.duration for provider in providers if provider.duration is not None]
    if known and len(known) == len(providers):
        return Range(min(known), max(known))
    if service.duration is not None:
        return Range(service.duration, service.duration)
    return refined_range(service, tables)


def refined_range(service: Service, tables: Tables) -> Range | None:
    """Return the duration of the functions of a service; None if it is unknown."""
    graph = tables.function_graphs.get(service.implementation)
    if graph is None:
        return None
    compute = partial(compute_duration, graph, lambda node: node_range(node, tables))
    return tables.memoise_time(("service", service.implementation), compute)


def mode_range(task: Task, mode: Mode, tables: Tables) -> Range | None:
    """Return the duration of a task in one mode, by its services."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return None
    return compute_duration(graph, lambda node: node_range(node, tables, mode.machines))


def _no_time(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    return _NO_TIME


def _service_time(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    service = tables.service(node)
    return None if service is None else service_range(service, tables, machines)


def _function_time(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    function = tables.functions.get(node.ref)
    return None if function is None else function.duration


def _call_time(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    """Return the duration of the graph of a helper; a helper without a graph takes no time."""
    graph = tables.function_graphs.get(node.ref)
    if graph is None:
        return _NO_TIME
    compute = partial(_helper_time, graph, tables, machines)
    return tables.memoise_time(("call", node.ref, *machines), compute)


def _helper_time(graph: FlowGraph, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    # A helper that calls itself would never end: inside it, it counts as a helper without a graph.
    rest = tables.without(graph.id)
    return compute_duration(graph, lambda node: node_range(node, rest, machines))


def _wait_time(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    # Nothing in the recipe bounds how long a signal can take.
    return Range(0, None)


def _delay_time(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    match node.expression:
        case Literal(int(value)):
            return Range(value, value)
        case _:
            return None


_Cost = Callable[[Node, Tables, tuple[str, ...]], Range | None]
_COSTS: dict[str, _Cost] = {
    "service": _service_time,
    "function": _function_time,
    "call": _call_time,
    "wait": _wait_time,
    "delay": _delay_time,
}


def providers_of(task: Task, tables: Tables) -> dict[str, tuple[Provider, ...]]:
    """Return the providers of the machine services of a task, by the id of the service."""
    graph = tables.service_graphs.get(task.implementation)
    nodes = () if graph is None else graph.nodes
    services = [tables.service(node) for node in nodes]
    machine_services = [s for s in services if s is not None and s.kind == "machine"]
    return {service.id: service.providers for service in machine_services}
