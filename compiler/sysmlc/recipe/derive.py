"""What follows from a recipe model: sub-tasks, same-machine groups, durations (thesis 6.5)."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.recipe.expression import Lit
from sysmlc.recipe.flow import duration, forward_edges, reachable
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
    """The parts of a model by id."""

    services: Mapping[str, Service]
    functions: Mapping[str, Function]
    service_graphs: Mapping[str, FlowGraph]
    function_graphs: Mapping[str, FlowGraph]
    _times: dict[tuple[str, ...], Range | None] = field(default_factory=dict)

    @classmethod
    def of(cls, model: Model) -> "Tables":
        """Tables of the model."""
        return cls(
            {one.id: one for one in model.services},
            {one.id: one for one in model.functions},
            {one.id: one for one in model.service_graphs},
            {one.id: one for one in model.function_graphs},
        )

    def service(self, node: Node) -> Service | None:
        """The service that a node calls."""
        return self.services.get(node.ref) if node.kind == "service" else None

    def time(self, key: tuple[str, ...], find: Callable[[], Range | None]) -> Range | None:
        """How long something takes, found out once."""
        if key not in self._times:
            self._times[key] = find()
        return self._times[key]

    def without(self, graph: str) -> "Tables":
        """The same without one of the graphs of functions."""
        left = {id: one for id, one in self.function_graphs.items() if id != graph}
        return Tables(self.services, self.functions, self.service_graphs, left)


def derive(model: Model) -> Model:
    """The model with ``derived`` filled for every task, whatever was there before."""
    tables = Tables.of(model)
    tasks = tuple(replace(task, derived=derived(task, tables)) for task in model.recipe.tasks)
    return replace(model, recipe=replace(model.recipe, tasks=tasks))


def derived(task: Task, tables: Tables) -> Derived | None:
    """What follows for one task; None when it is not refined."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return None
    return Derived(
        sub_tasks(task, graph, tables),
        same_machine(graph, tables),
        duration(graph, lambda node: node_range(node, tables)),
    )


# -- sub-tasks ---------------------------------------------------------------------------------


def sub_tasks(task: Task, graph: FlowGraph, tables: Tables) -> tuple[SubTask, ...]:
    """Service nodes with their alternatives and the service nodes right before them."""
    allowed = {machine for mode in task.equipment for machine in mode.machines}
    edges = forward_edges(graph)
    nodes = [node for node in graph.nodes if tables.service(node) is not None]
    steps = {node.id for node in nodes}
    return tuple(
        SubTask(node.id, _alternatives(node, allowed, tables), _before(node.id, steps, edges))
        for node in nodes
    )


def _alternatives(node: Node, allowed: set[str], tables: Tables) -> tuple[Mode, ...]:
    service = tables.service(node)
    providers = () if service is None else service.providers
    return tuple(
        Mode((one.machine,), one.duration, one.power, one.tools)
        for one in providers
        if not allowed or one.machine in allowed
    )


def _before(node: str, steps: set[str], edges: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """The nearest steps from which the edges lead here."""
    backwards = [(b, a) for a, b in edges if b == node or b not in steps]
    return tuple(sorted((reachable([node], backwards) & steps) - {node}))


# -- same machine ------------------------------------------------------------------------------


def same_machine(graph: FlowGraph, tables: Tables) -> tuple[SameMachine, ...]:
    """Services of a task between the acquiring and the releasing of one resource.

    A service belongs to the group when it takes, holds, uses or gives back the resource and can
    run after it was taken and before it was given back. Groups that share a service are one.
    """
    groups = [
        group
        for resource in _resources(graph, tables)
        for group in _groups(graph, tables, resource)
        if len(group[0]) > 1
    ]
    order = {node.id: number for number, node in enumerate(graph.nodes)}
    found = [
        SameMachine(tuple(sorted(nodes, key=order.__getitem__)), tuple(because))
        for nodes, because in _merged(groups)
    ]
    return tuple(sorted(found, key=lambda group: order[group.nodes[0]]))


def _resources(graph: FlowGraph, tables: Tables) -> list[str]:
    found = {
        r.id for node in graph.nodes for one in functions_of(node, tables) for r in one.resources
    }
    return sorted(found)


def functions_of(node: Node, tables: Tables) -> list[Function]:
    """Machine functions of the service that a node calls, in the order of its graph."""
    service = tables.service(node)
    return [] if service is None else _called(service.implementation, tables, {node.id})


def _called(graph: str, tables: Tables, seen: set[str]) -> list[Function]:
    """Functions that a graph calls, those of the helpers that it calls included."""
    found = tables.function_graphs.get(graph)
    called: list[Function] = []
    seen.add(graph)
    for node in () if found is None else found.nodes:
        if node.kind == "call" and node.ref not in seen:
            called += _called(node.ref, tables, seen)
        elif node.ref in tables.functions:
            called.append(tables.functions[node.ref])
    return called


def modes(node: Node, resource: str, tables: Tables) -> set[str]:
    """What the service of a node does with a resource, as seen from outside the service.

    A service that takes a resource and gives it back itself only uses it.
    """
    used = (r for one in functions_of(node, tables) for r in one.resources)
    found = {r.mode for r in used if r.id == resource}
    return {"use"} if {"acquire", "release"} <= found else found


def _groups(
    graph: FlowGraph, tables: Tables, resource: str
) -> Iterator[tuple[list[str], list[str]]]:
    """One group for each node that takes the resource: nodes, and what they do with it."""
    does = {node.id: modes(node, resource, tables) for node in graph.nodes}
    pairs = [(edge.source, edge.target) for edge in graph.edges]
    gives = {id for id, found in does.items() if "release" in found}
    for start in (id for id, found in does.items() if "acquire" in found):
        taken = reachable([start], [(a, b) for a, b in pairs if a not in gives])
        given = reachable(gives & taken, [(b, a) for a, b in pairs if b != start])
        members = {id for id in taken & given if does[id]}
        nodes = [node for node in graph.nodes if node.id in members]
        yield [node.id for node in nodes], _because(nodes, resource, tables)


def _because(nodes: list[Node], resource: str, tables: Tables) -> list[str]:
    found = (
        f"{one.id} {use.mode}s {resource}"
        for node in nodes
        for one in functions_of(node, tables)
        for use in one.resources
        if use.id == resource
    )
    return list(dict.fromkeys(found))


def _merged(groups: list[tuple[list[str], list[str]]]) -> list[tuple[list[str], list[str]]]:
    result: list[tuple[list[str], list[str]]] = []
    for nodes, because in groups:
        same = [group for group in result if set(group[0]) & set(nodes)]
        result = [group for group in result if group not in same]
        whole = [*same, (nodes, because)]
        result.append(([n for ns, _ in whole for n in ns], [b for _, bs in whole for b in bs]))
    return [(list(dict.fromkeys(ns)), list(dict.fromkeys(bs))) for ns, bs in result]


# -- durations ---------------------------------------------------------------------------------


def node_range(node: Node, tables: Tables, machines: tuple[str, ...] = ()) -> Range | None:
    """How long a node takes, in milliseconds; on one of ``machines`` when any is given."""
    return _COSTS.get(node.kind, _free)(node, tables, machines)


def service_range(service: Service, tables: Tables, machines: tuple[str, ...] = ()) -> Range | None:
    """How long a service takes: by its providers, else its own duration, else its functions."""
    providers = [one for one in service.providers if one.machine in machines]
    providers = providers or list(service.providers)
    known = [one.duration for one in providers if one.duration is not None]
    if known and len(known) == len(providers):
        return Range(min(known), max(known))
    if service.duration is not None:
        return Range(service.duration, service.duration)
    return refined_range(service, tables)


def refined_range(service: Service, tables: Tables) -> Range | None:
    """How long the functions of a service take together; None when they do not say it."""
    graph = tables.function_graphs.get(service.implementation)
    if graph is None:
        return None
    find = partial(duration, graph, lambda node: node_range(node, tables))
    return tables.time(("service", service.implementation), find)


def mode_range(task: Task, mode: Mode, tables: Tables) -> Range | None:
    """How long a task takes in one mode, from its services."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return None
    return duration(graph, lambda node: node_range(node, tables, mode.machines))


def _free(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    return _NO_TIME


def _service(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    service = tables.service(node)
    return None if service is None else service_range(service, tables, machines)


def _function(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    function = tables.functions.get(node.ref)
    return None if function is None else function.duration


def _call(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    """A helper takes as long as its graph; one that has none is no matter of time."""
    graph = tables.function_graphs.get(node.ref)
    if graph is None:
        return _NO_TIME
    return tables.time(("call", node.ref, *machines), partial(_of_helper, graph, tables, machines))


def _of_helper(graph: FlowGraph, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    rest = tables.without(graph.id)
    return duration(graph, lambda one: node_range(one, rest, machines))


def _wait(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    return Range(0, None)


def _delay(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    match node.expression:
        case Lit(int(value)):
            return Range(value, value)
        case _:
            return None


_Cost = Callable[[Node, Tables, tuple[str, ...]], Range | None]
_COSTS: dict[str, _Cost] = {
    "service": _service,
    "function": _function,
    "call": _call,
    "wait": _wait,
    "delay": _delay,
}


def providers_of(task: Task, tables: Tables) -> dict[str, tuple[Provider, ...]]:
    """Providers of the machine services of a task, by service id."""
    graph = tables.service_graphs.get(task.implementation)
    nodes = () if graph is None else graph.nodes
    services = [tables.service(node) for node in nodes]
    found = [one for one in services if one is not None and one.kind == "machine"]
    return {one.id: one.providers for one in found}
