"""Durations of flow graphs, and of the tasks and services that they implement.

The duration of a graph is a range that follows from the durations of its steps. Times are in
milliseconds; an unknown duration is None.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial

from msgspec import Struct

from sysmlc.ir.algorithms import sort_topologically
from sysmlc.logic.expressions.expression import Literal
from sysmlc.recipe.flow import STEPS, find_cycles, find_reachable
from sysmlc.recipe.model import FlowGraph, Mode, Node, Range, Service, Task
from sysmlc.recipe.tables import Tables

Cost = Callable[[Node], Range | None]
"""The duration of a node; None if it is unknown."""
_Edges = list[tuple[str, str]]
_NO_DURATION = Range(0, 0)


# -- tasks, services and nodes -----------------------------------------------------------------


def find_node_duration(node: Node, tables: Tables, machines: tuple[str, ...] = ()) -> Range | None:
    """Return the duration of a node on *machines*, or on any machine if none is given."""
    return _DURATIONS_BY_KIND.get(node.kind, _find_no_duration)(node, tables, machines)


def _find_service_duration(
    service: Service, tables: Tables, machines: tuple[str, ...] = ()
) -> Range | None:
    """Return the duration of a service on *machines*, or on all machines if none of them offers it.

    It is the range over the providers, if the model states a duration for each of them; else the
    duration that the model states for the service itself; else that of its functions.
    """
    providers = [provider for provider in service.providers if provider.machine in machines]
    providers = providers or list(service.providers)
    known = [provider.duration for provider in providers if provider.duration is not None]
    if known and len(known) == len(providers):
        return Range(min(known), max(known))
    if service.duration is not None:
        return Range(service.duration, service.duration)
    return find_refined_duration(service, tables)


def find_refined_duration(service: Service, tables: Tables) -> Range | None:
    """Return the duration of the function graph of a service; None if it is unknown."""
    graph = tables.function_graphs.get(service.implementation)
    if graph is None:
        return None
    compute = partial(compute_duration, graph, lambda node: find_node_duration(node, tables))
    return tables.memoise_duration(("service", service.implementation), compute)


def find_mode_duration(task: Task, mode: Mode, tables: Tables) -> Range | None:
    """Return the duration of the service graph of a task on the machines of one mode."""
    graph = tables.service_graphs.get(task.implementation)
    if graph is None:
        return None
    return compute_duration(graph, lambda node: find_node_duration(node, tables, mode.machines))


def _find_no_duration(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    return _NO_DURATION


def _find_called_service_duration(
    node: Node, tables: Tables, machines: tuple[str, ...]
) -> Range | None:
    service = tables.find_service(node)
    return None if service is None else _find_service_duration(service, tables, machines)


def _find_function_duration(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    function = tables.functions.get(node.ref)
    return None if function is None else function.duration


def _find_helper_duration(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    """Return the duration of the function graph of a helper; without a graph it takes no time."""
    graph = tables.function_graphs.get(node.ref)
    if graph is None:
        return _NO_DURATION
    compute = partial(_compute_helper_duration, graph, tables, machines)
    return tables.memoise_duration(("call", node.ref, *machines), compute)


def _compute_helper_duration(
    graph: FlowGraph, tables: Tables, machines: tuple[str, ...]
) -> Range | None:
    # A helper that calls itself would never end: inside it, it counts as a helper without a graph.
    rest = tables.without_graph(graph.id)
    return compute_duration(graph, lambda node: find_node_duration(node, rest, machines))


def _find_wait_duration(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    # Nothing in the recipe bounds how long a signal can take.
    return Range(0, None)


def _find_delay_duration(node: Node, tables: Tables, machines: tuple[str, ...]) -> Range | None:
    match node.expression:
        case Literal(int(value)):
            return Range(value, value)
        case _:
            return None


_NodeDuration = Callable[[Node, Tables, tuple[str, ...]], Range | None]
_DURATIONS_BY_KIND: dict[str, _NodeDuration] = {
    "service": _find_called_service_duration,
    "function": _find_function_duration,
    "call": _find_helper_duration,
    "wait": _find_wait_duration,
    "delay": _find_delay_duration,
}


# -- graphs ------------------------------------------------------------------------------------


class _Span(Struct, frozen=True):
    """Earliest and latest time at which a node is done; ``latest`` None is unbounded."""

    earliest: float
    latest: float | None

    def extend(self, cost: Range) -> "_Span":
        return _Span(self.earliest + cost.min, _add(self.latest, cost.max))


def compute_duration(graph: FlowGraph, cost: Cost) -> Range | None:
    """Return the shortest and longest time from the initial node to a final one.

    Decisions choose one branch, joins and steps wait for all incoming edges, and a cycle runs at
    most ``max_iterations`` times. Return None for an unknown duration of a step, or if no final
    node is reachable.
    """
    nodes = {node.id: node for node in graph.nodes}
    costs: dict[str, Range] = {}
    for id, node in nodes.items():
        if node.kind in STEPS:
            node_cost = cost(node)
            if node_cost is None:
                return None
            costs[id] = node_cost
    edges = list(dict.fromkeys((e.source, e.target) for e in graph.edges))
    starts = [node.id for node in graph.nodes if node.kind == "initial"]
    spans = _Clock(nodes, costs).run(list(nodes), edges, starts[:1])
    ends = [span for id, span in spans.items() if nodes[id].kind == "final"]
    # A flow final node ends one branch only (UML 2.5.1, 15.3.3.2): it counts without a final node.
    ends = ends or [span for id, span in spans.items() if nodes[id].kind == "flowFinal"]
    if not ends:
        return None
    return _to_range(min(end.earliest for end in ends), _maximum(end.latest for end in ends))


class _Clock(Struct, frozen=True):
    """Computes when nodes are done; ``costs`` has the duration of each step by its id."""

    nodes: Mapping[str, Node]
    costs: Mapping[str, Range]

    def run(self, ids: Iterable[str], edges: _Edges, starts: list[str]) -> dict[str, _Span]:
        """Return the span of each node if the nodes *starts* begin at time 0."""
        spans: dict[str, _Span] = {}
        # A node that no start reaches has no span: it does not delay the nodes behind it.
        for component, is_cycle in _iter_components(ids, edges):
            inside = set(component)
            incoming = [(a, b) for a, b in edges if b in inside and a not in inside and a in spans]
            arrivals = [spans[a] for a, _ in incoming]
            arrivals += [_Span(0, 0)] * (not inside.isdisjoint(starts))
            if not arrivals:
                continue
            heads = [b for _, b in incoming] + [id for id in starts if id in inside]
            start = _combine(self.nodes[heads[0]], arrivals)
            if is_cycle:
                spans.update(self._run_cycle(heads[0], component, edges, start))
            else:
                spans[component[0]] = start.extend(self.costs.get(component[0], Range(0, 0)))
        return spans

    def _run_cycle(
        self, head: str, cycle: list[str], edges: _Edges, start: _Span
    ) -> dict[str, _Span]:
        """Return the spans of the nodes of a cycle that is entered at *head* in the span *start*.

        A node is done earliest in the first round and latest in the last round.
        """
        inside = set(cycle)
        inner = [(a, b) for a, b in edges if a in inside and b in inside and b != head]
        one_round = self.run(cycle, inner, [head])
        rounds = [
            one_round[a].latest for a, b in edges if b == head and a in inside and a in one_round
        ]
        count = self._count_rounds(head, cycle, inner)
        latest = _add(start.latest, _multiply(count, _maximum(rounds)))
        return {
            id: _Span(start.earliest + span.earliest, _add(latest, span.latest))
            for id, span in one_round.items()
        }

    def _count_rounds(self, head: str, cycle: list[str], inner: _Edges) -> int | None:
        """Return how often the edges back to *head* are taken at most, by the bounds of loop nodes.

        Loop nodes of inner cycles do not count. None means that there is no bound.
        """
        nested = {id for inner_cycle in find_cycles(cycle, inner) for id in inner_cycle}
        loops = [self.nodes[id] for id in cycle if id not in nested]
        loops = [node for node in loops if node.kind in ("loop", "forEach")]
        bounds = [node.max_iterations for node in loops if node.max_iterations is not None]
        if not loops or len(bounds) < len(loops):
            return None
        # A loop that is tested first runs its body as often as the bound says, and is closed as
        # often; a loop that is tested last is closed once less, because the last round leaves it.
        is_tested_first = not any(self._has_step(head, loop.id, inner) for loop in loops)
        return sum(bounds) - (0 if is_tested_first else len(loops))

    def _has_step(self, head: str, loop: str, inner: _Edges) -> bool:
        """Whether a step precedes the loop node in a round, which begins at *head*."""
        after_head = find_reachable([head], [(a, b) for a, b in inner if a != loop])
        before_loop = find_reachable([loop], [(b, a) for a, b in inner])
        return any(self.nodes[id].kind in STEPS for id in after_head & before_loop)


def _iter_components(ids: Iterable[str], edges: _Edges) -> Iterator[tuple[list[str], bool]]:
    """Yield cycles and single nodes in topological order, each with whether it is a cycle."""
    nodes = list(ids)
    components = {f"cycle {n}": cycle for n, cycle in enumerate(find_cycles(nodes, edges))}
    component_of = {id: name for name, cycle in components.items() for id in cycle}
    components.update({f"node {id}": [id] for id in nodes if id not in component_of})
    component_of.update({id: f"node {id}" for id in nodes if id not in component_of})
    pairs = ((component_of[a], component_of[b]) for a, b in edges)
    for name in sort_topologically(components, ((a, b) for a, b in pairs if a != b)):
        yield components[name], name.startswith("cycle ")


def _combine(node: Node, arrivals: list[_Span]) -> _Span:
    """Return the earliest and latest time at which a node begins, from the spans that precede it.

    A join or a step waits for all of them, any other node for the first.
    """
    is_waiting = node.kind == "join" or node.kind in STEPS
    choose = max if is_waiting else min
    return _Span(choose(a.earliest for a in arrivals), _maximum(a.latest for a in arrivals))


def _add(left: float | None, right: float | None) -> float | None:
    return None if left is None or right is None else left + right


def _multiply(count: int | None, value: float | None) -> float | None:
    if count == 0:
        return 0
    return None if count is None or value is None else count * value


def _maximum(values: Iterable[float | None]) -> float | None:
    """Return the largest value, 0 for no values; None if one of them is None (unbounded)."""
    largest: float = 0
    for value in values:
        if value is None:
            return None
        largest = max(largest, value)
    return largest


def _to_range(low: float, high: float | None) -> Range:
    return Range(int(low), None if high is None else int(high))
