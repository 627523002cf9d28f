"""Durations of flow graphs, and of the tasks and services that they implement.

The duration of a graph is a range that follows from the durations of its steps. Times are in
milliseconds; an unknown duration is None.
"""

import operator
from collections.abc import Callable, Iterator, Mapping
from functools import partial, reduce

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir.expressions import Expression, Literal
from sysmlc.recipe.costs import Measures, NodeCost, to_maximum
from sysmlc.recipe.executions import (
    Exploration,
    Precision,
    Result,
    TooManySituationsError,
    UnstructuredError,
)
from sysmlc.recipe.flow import STEPS, find_early_ends, find_loop_cycles
from sysmlc.recipe.model import (
    Derived,
    EndTime,
    FlowEdge,
    FlowGraph,
    Mode,
    Node,
    Range,
    Service,
    Task,
)
from sysmlc.recipe.tables import Tables
from sysmlc.recipe.valuation import Variables

_NO_DURATION = Range(0, 0)


# -- tasks, services and nodes -----------------------------------------------------------------


def _find_node_duration(  # noqa: PLR0911 - one for each kind
    node: Node, tables: Tables, machines: tuple[str, ...] = ()
) -> Range | None:
    """Return the duration of a node on *machines*, or on any machine if none is given."""
    match node.kind, node.expression:
        case "service", _:
            service = tables.find_service(node)
            return None if service is None else _find_service_duration(service, tables, machines)
        case "function", _:
            function = tables.functions.get(node.ref)
            return None if function is None else function.duration
        case "call", _:
            return _find_helper_duration(node, tables, machines)
        case "delay", Literal(int(value)):
            return Range(value, value)
        case "delay", _:
            return None
        case "wait", _:
            # Nothing in the recipe bounds how long a signal can take.
            return Range(0, None)
        case _:
            return _NO_DURATION


def _find_service_duration(
    service: Service, tables: Tables, machines: tuple[str, ...] = ()
) -> Range | None:
    """Return the duration of a service on *machines*, or on all machines if none of them offers it.

    It is the range over the providers, if the model states a duration for each of them; else the
    duration that the model states for the service itself; else that of its functions.
    """
    providers = [provider for provider in service.providers if provider.machine in machines]
    providers = providers or list(service.providers)
    durations = [provider.duration for provider in providers if provider.duration is not None]
    if durations and len(durations) == len(providers):
        return Range(min(durations), max(durations))
    if service.duration is not None:
        return Range(service.duration, service.duration)
    return find_refined_duration(service, tables)


def find_refined_duration(service: Service, tables: Tables) -> Range | None:
    """Return the duration of the function graph of a service; None if it is unknown."""
    graph = tables.function_graphs.get(service.implementation)
    if graph is None:
        return None
    compute = partial(_compute_functions_duration, graph, tables, ())
    return tables.memoise_duration(("service", service.implementation), compute)


def _compute_functions_duration(
    graph: FlowGraph, tables: Tables, machines: tuple[str, ...]
) -> Range | None:
    timing = compute_timing(graph, lambda node: _find_function_cost(node, tables, machines))
    return None if timing is None else timing.full_duration


def _find_function_cost(node: Node, tables: Tables, machines: tuple[str, ...]) -> NodeCost | None:
    duration = _find_node_duration(node, tables, machines)
    if duration is None:
        return None
    # A service may hold a resource for functions that run at the same time.
    return NodeCost(duration, frozenset(_iter_resources(node, tables)), is_exclusive=False)


def _iter_resources(node: Node, tables: Tables) -> Iterator[str]:
    """Yield the resources that a function uses, directly or through the graph of a helper."""
    function = tables.functions.get(node.ref)
    if function is not None:
        yield from (resource.id for resource in function.resources)
    graph = tables.function_graphs.get(node.ref) if node.kind == "call" else None
    if graph is not None:
        rest = tables.without_graph(graph.id)
        for inner in graph.nodes:
            yield from _iter_resources(inner, rest)


def find_mode_duration(task: Task, mode: Mode, tables: Tables) -> Range | None:
    """Return the duration of the service graph of a task on the machines of one mode."""
    timing = find_task_timing(task, tables, mode.machines)
    return None if timing is None else timing.full_duration


def format_range(duration: Range) -> str:
    """Return a duration in the words of diagnostics: ``100`` or ``100 to 300``."""
    if duration.max == duration.min:
        return str(duration.min)
    return f"{duration.min} to {'any number of' if duration.max is None else duration.max}"


def find_full_duration(derived: Derived) -> Range | None:
    """Return the duration of all executions of a task, those that end early included."""
    if derived.duration is None:
        return None
    return _join_ranges([derived.duration, *(end.duration for end in derived.ends)])


def find_task_timing(task: Task, tables: Tables, machines: tuple[str, ...]) -> "Timing | None":
    """Return the times of the service graph of a task on *machines*, or on all if it is empty."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return None
    resources = (r for function in tables.functions.values() for r in function.resources)
    return compute_timing(
        graph,
        lambda node: _find_service_cost(node, tables, machines),
        dict(task.bind),
        holds=any(resource.mode != "use" for resource in resources),
    )


def find_untimed_steps(task: Task, tables: Tables) -> tuple[list[Node], bool]:
    """Return the steps of a task without a duration, and whether a service states its duration."""
    graph = tables.service_graphs.get(task.implementation)
    steps = [node for node in graph.nodes if node.kind in STEPS] if graph else []
    untimed = [node for node in steps if _find_node_duration(node, tables) is None]
    services = [service for node in steps if (service := tables.find_service(node)) is not None]
    stated = [service.duration for service in services]
    stated += [provider.duration for service in services for provider in service.providers]
    return untimed, any(duration is not None for duration in stated)


def _find_service_cost(node: Node, tables: Tables, machines: tuple[str, ...]) -> NodeCost | None:
    duration = _find_node_duration(node, tables, machines)
    service = tables.find_service(node)
    if duration is None or service is None or service.kind != "machine":
        return None if duration is None else NodeCost(duration)
    offering = frozenset(provider.machine for provider in service.providers)
    return NodeCost(duration, (offering & frozenset(machines)) or offering)


def _find_helper_duration(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    """Return the duration of the function graph of a helper; without a graph it takes no time."""
    graph = tables.function_graphs.get(node.ref)
    if graph is None:
        # Nothing bounds how often a helper calls itself.
        return Range(0, None) if node.ref in tables.open_graphs else _NO_DURATION
    compute = partial(_compute_functions_duration, graph, tables.without_graph(graph.id), machines)
    return tables.memoise_duration(("call", node.ref, *machines), compute)


# -- graphs ------------------------------------------------------------------------------------

_MOST_SITUATIONS = 10_000
"""Most situations of one graph that are explored; about half a second."""
_PRECISIONS = (
    Precision(),
    # The bound of a loop contradicts its guards.
    Precision(has_strict_bounds=False),
    # Too many situations: fewer distinctions.
    Precision(has_values=False),
    Precision(has_values=False, has_iterations=False),
)


class Timing(Struct, frozen=True):
    """The times of the executions of a graph, and how often each step runs.

    Times are in milliseconds. ``duration`` has no maximum for the reason ``because``; ``ends`` has
    the times of the final nodes if there are several. ``endless`` has the nodes that executions may
    repeat without a bound, None if there are too many situations to find them.
    """

    duration: Range
    expected: float | None = None
    because: str = ""
    ends: tuple[EndTime, ...] = ()
    runs: Mapping[str, Range] = {}
    endless: tuple[str, ...] | None = ()

    @property
    def full_duration(self) -> Range:
        """The duration of all executions, those that end early included."""
        return _join_ranges([self.duration, *(end.duration for end in self.ends)])


def _join_ranges(ranges: list[Range]) -> Range:
    """Return the smallest range that contains all of *ranges*."""
    maxima = [span.max for span in ranges if span.max is not None]
    highest = max(maxima) if len(maxima) == len(ranges) else None
    return Range(min(span.min for span in ranges), highest)


def compute_timing(
    graph: FlowGraph,
    find_cost: Callable[[Node], NodeCost | None],
    arguments: Mapping[str, Expression] | None = None,
    *,
    holds: bool = False,
) -> Timing | None:
    """Return the times of the executions of a graph.

    Decisions choose one branch by their guards, joins and steps wait for all incoming edges, and
    loops run as often as their guards and bounds allow. Steps of parallel branches that need one
    machine follow one another; *holds* states that branches retain machines between steps. Return
    None for an unknown duration of a step, or if no final node is reachable.
    """
    costs: dict[str, NodeCost] = {}
    for node in graph.nodes:
        if node.kind in STEPS:
            node_cost = find_cost(node)
            if node_cost is None:
                return None
            costs[node.id] = node_cost
    measures = Measures(costs, holds=holds)
    variables = Variables.from_graph(graph, arguments or {})
    for precision in _PRECISIONS:
        exploration = Exploration(graph, measures, variables, precision, _MOST_SITUATIONS)
        try:
            result = exploration.run()
        except TooManySituationsError:
            continue
        except UnstructuredError:
            return None
        if result.ends:
            is_exact = precision.has_iterations and precision.has_values
            return _make_timing(graph, result, costs, measures, is_exact=is_exact)
    return None


def _make_timing(
    graph: FlowGraph,
    result: Result,
    costs: Mapping[str, NodeCost],
    measures: Measures,
    *,
    is_exact: bool,
) -> Timing:
    early = find_early_ends(graph)
    times = [
        EndTime(id, Range(int(end.low[0]), to_maximum(end.high[0])), id in early)
        for id, end in result.ends.items()
    ]
    times.sort(key=lambda end: end.node)
    total = reduce(operator.or_, result.ends.values())
    regular = [result.ends[end.node] for end in times if not end.is_early]
    span = reduce(operator.or_, regular) if regular else total
    duration = Range(int(span.low[0]), to_maximum(span.high[0]))
    is_stated = any(edge.probability is not None for edge in graph.edges)
    return Timing(
        duration,
        result.expected if is_stated and is_exact else None,
        "" if duration.max is not None else _explain_unbounded(graph, result, costs, is_exact),
        tuple(times) if len(times) > 1 else (),
        measures.count_runs(total),
        result.endless if is_exact else None,
    )


def find_unbounded_loops(graph: FlowGraph) -> list[Node]:
    """Return the loop nodes whose rounds neither a bound nor the values of variables limit."""
    loops = [node for node in graph.nodes if node.kind == "loop" and node.max_iterations is None]
    if not loops:
        return []
    timing = compute_timing(graph, lambda node: NodeCost(Range(1, 1)))
    endless = None if timing is None else timing.endless
    return loops if endless is None else [node for node in loops if node.id in endless]


def count_rounds(graph: FlowGraph, loop: Node) -> int | None:
    """Return the most rounds of a loop by the values of variables, without its bound.

    Return None if the values do not limit the rounds, and for a loop within another one.
    """
    cycles = find_loop_cycles(graph)
    if any(id != loop.id and loop.id in cycle.nodes for id, cycle in cycles.items()):
        return None
    mark = Node(f"{loop.id}#round", "action")
    nodes = [replace(node, max_iterations=None) if node is loop else node for node in graph.nodes]
    edges: list[FlowEdge] = []
    for edge in graph.edges:
        is_body = edge.source == loop.id and edge.role == "body"
        edges.append(replace(edge, target=mark.id) if is_body else edge)
        edges += [FlowEdge(mark.id, edge.target)] if is_body else []
    marked = replace(graph, nodes=(*nodes, mark), edges=tuple(edges))
    timing = compute_timing(marked, lambda node: NodeCost(Range(1, 1)))
    if timing is None or timing.endless is None or loop.id in timing.endless:
        return None
    most = timing.runs[mark.id].max
    # The last round of a loop that is tested last leaves it instead of closing it.
    return None if most is None else int(most) + (0 if cycles[loop.id].is_tested_first else 1)


def _explain_unbounded(
    graph: FlowGraph, result: Result, costs: Mapping[str, NodeCost], is_exact: bool
) -> str:
    """Return why executions of the graph have no longest time."""
    if not is_exact:
        return f"the executions reach more than {_MOST_SITUATIONS} situations"
    nodes = [node for node in graph.nodes if node.id in result.endless]
    loops = [node for node in nodes if node.kind in ("loop", "forEach")]
    if nodes:
        return f"the loop at '{(loops or nodes)[0].id}' has no bound"
    unbounded = [id for id, cost in costs.items() if cost.duration.max is None]
    return f"'{unbounded[0]}' has no longest duration" if unbounded else ""
