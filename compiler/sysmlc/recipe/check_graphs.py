"""Checks of the graphs of levels 2 and 3, and of durations and resources.

Paths, loops and forks of the graphs (REC003, REC004), durations and resources on them (REC008,
REC009, REC010).
"""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir.algorithms import sort_topologically
from sysmlc.recipe.checks import Finding, iter_graphs
from sysmlc.recipe.derive import (
    Tables,
    find_modes,
    functions_of,
    mode_range,
    refined_range,
    same_machine,
)
from sysmlc.recipe.flow import STEPS, find_cycles, find_reachable, forward_edges
from sysmlc.recipe.model import FlowGraph, Model, Node, Provider, Range, Service, Task

NO_WAY = rule(
    "SM603",
    "recipe-graph-without-way",
    Severity.ERROR,
    "in '{graph}', {problem}",
    help="connect the node, or delete it",
)
BAD_NESTING = rule(
    "SM604",
    "recipe-graph-ill-nested",
    Severity.ERROR,
    "in '{graph}', {problem}",
    help=(
        "let a decision leave the cycle; join all branches of a fork, and merge those of a decision"
    ),
)

_Branch = tuple[tuple[str, int], ...]
"""Stack of open forks: the node and the number of the branch, outermost first."""


def check_paths(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC003: there is one initial node, and every node is on a path from it to a final node."""
    for graph in iter_graphs(model):
        for element, problem in _iter_path_problems(graph):
            yield Finding(NO_WAY, element or graph.element, {"graph": graph.id, "problem": problem})


def _iter_path_problems(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    starts = [node.id for node in graph.nodes if node.kind == "initial"]
    ends = [node.id for node in graph.nodes if node.kind in ("final", "flowFinal")]
    if len(starts) > 1:
        yield graph.element, f"there are {len(starts)} initial nodes"
    pairs = [(edge.source, edge.target) for edge in graph.edges]
    reverse = [(target, source) for source, target in pairs]
    reached = find_reachable(starts, pairs)
    ending = find_reachable(ends, reverse)
    unreached = [node for node in graph.nodes if node.id not in reached]
    stuck = [node for node in graph.nodes if node.id in reached and node.id not in ending]
    for node in _select_causes(unreached, reverse):
        yield node.element, f"nothing leads to '{_local_name(node.id)}'"
    for node in _select_causes(stuck, pairs):
        yield node.element, f"no way leads from '{_local_name(node.id)}' to an end"


def _select_causes(nodes: list[Node], pairs: list[tuple[str, str]]) -> list[Node]:
    """Return the nodes without an edge to another of *nodes*: the causes of their predecessors."""
    ids = {node.id for node in nodes}
    sources = {source for source, target in pairs if source != target and target in ids}
    return [node for node in nodes if node.id not in sources] or nodes[:1]


def check_nesting(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC004: every cycle has a loop node, and every fork is closed by a join."""
    for graph in iter_graphs(model):
        for element, problem in _iter_nesting_problems(graph):
            facts = {"graph": graph.id, "problem": problem}
            yield Finding(BAD_NESTING, element or graph.element, facts)


def _iter_nesting_problems(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    yield from _iter_endless_cycles(graph)
    yield from _iter_fork_problems(graph)


def _iter_endless_cycles(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    loops = {node.id for node in graph.nodes if node.kind in ("loop", "forEach")}
    plain = [node.id for node in graph.nodes if node.id not in loops]
    pairs = [(e.source, e.target) for e in graph.edges if not {e.source, e.target} & loops]
    for cycle in find_cycles(plain, pairs):
        names = ", ".join(f"'{_local_name(id)}'" for id in cycle)
        yield graph.element, f"no decision leaves the cycle of {names}"


def _iter_fork_problems(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    """Propagate the stack of open forks along the edges; where edges meet, compare the stacks."""
    nodes = {node.id: node for node in graph.nodes}
    edges = forward_edges(graph)
    successors: dict[str, list[str]] = {}
    for source, target in edges:
        successors.setdefault(source, []).append(target)
    arriving: dict[str, list[_Branch]] = {}
    for id in sort_topologically(nodes, edges):
        branches = arriving.get(id, [()])
        node, problem = nodes[id], ""
        open_forks: _Branch = branches[0]
        if len(branches) > 1:
            is_join = node.kind == "join" or node.kind in STEPS
            open_forks, problem = _join(branches) if is_join else _merge(branches)
        # One report for a node; behind it the common prefix continues, so that the consequences
        # of the fault are not reported.
        if problem:
            yield node.element, f"{problem} '{_local_name(id)}'"
        targets = successors.get(id, [])
        is_fork = len(targets) > 1 and (node.kind == "fork" or node.kind in STEPS)
        for number, target in enumerate(targets):
            branch = (*open_forks, (id, number)) if is_fork else open_forks
            arriving.setdefault(target, []).append(branch)


def _join(branches: list[_Branch]) -> tuple[_Branch, str]:
    """Close the innermost fork if each of its branches arrives; else return a problem."""
    forks = {(*branch[:-1], (branch[-1][0], 0)) if branch else () for branch in branches}
    if len(forks) > 1 or not all(branches) or len(set(branches)) < len(branches):
        return _common_prefix(branches), "ways that are not branches of one fork meet at"
    return branches[0][:-1], ""


def _merge(branches: list[_Branch]) -> tuple[_Branch, str]:
    """Return the stack of open forks if it is the same for all branches; else a problem."""
    if len(set(branches)) > 1:
        return _common_prefix(branches), "branches of a fork meet without a join at"
    return branches[0], ""


def _common_prefix(branches: list[_Branch]) -> _Branch:
    shortest = min(branches, key=len)
    return next(
        shortest[:n]
        for n in range(len(shortest), -1, -1)
        if all(branch[:n] == shortest[:n] for branch in branches)
    )


def _local_name(id: str) -> str:
    return id.rpartition("::")[2]


# -- durations and resources -------------------------------------------------------------------

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
    help="let one machine offer all services of the group, or correct which service "
    "takes the resource",
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
    "the loop at '{loop}' has no bound",
    help="apply «Loop» with maxIterations to the decision",
)


def check_task_times(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC008: a task takes no longer than its bound, nor than the duration of each mode."""
    for task in model.recipe.tasks:
        derived = None if task.derived is None else task.derived.duration
        if derived is not None and _exceeds(derived, task.max_duration):
            yield _too_long(task, derived, f"at most {task.max_duration} ms are allowed")
        for mode in task.equipment:
            derived = mode_range(task, mode, tables)
            if derived is not None and _exceeds(derived, mode.duration):
                machines = " and ".join(f"'{machine}'" for machine in mode.machines)
                yield _too_long(task, derived, f"{mode.duration} ms on {machines}")


def _exceeds(duration: Range, limit: int | None) -> bool:
    """Return whether the maximum, or without a maximum the minimum, is above the limit."""
    return limit is not None and (duration.min if duration.max is None else duration.max) > limit


def _too_long(task: Task, derived: Range, declared: str) -> Finding:
    facts = {"task": task.id, "derived": _format_range(derived), "declared": declared}
    return Finding(TASK_TIME, task.element, facts)


def _format_range(duration: Range) -> str:
    if duration.max == duration.min:
        return str(duration.min)
    return f"{duration.min} to {'any number of' if duration.max is None else duration.max}"


def check_service_times(model: Model, tables: Tables, tolerance: float) -> Iterator[Finding]:
    """REC009: the durations of functions and of providers agree within the tolerance."""
    for service in model.services:
        derived = refined_range(service, tables)
        if derived is None:
            continue
        for provider in service.providers:
            if _differs(derived, provider.duration, tolerance):
                yield _make_time_finding(service, provider, derived)


def _differs(derived: Range, duration: int | None, tolerance: float) -> bool:
    if duration is None:
        return False
    too_short = duration < derived.min * (1 - tolerance)
    return too_short or (derived.max is not None and duration > derived.max * (1 + tolerance))


def _make_time_finding(service: Service, provider: Provider, derived: Range) -> Finding:
    facts = {
        "service": service.id,
        "derived": _format_range(derived),
        "declared": provider.duration,
        "machine": provider.machine,
    }
    return Finding(SERVICE_TIME, service.element, facts)


# -- resources ---------------------------------------------------------------------------------


def check_groups(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC010: same-machine groups are up to date; one machine offers all services of a group."""
    for task in model.recipe.tasks:
        graph = tables.service_graphs.get(task.implementation)
        groups = None if graph is None else same_machine(graph, tables)
        if groups != (task.derived and task.derived.same_machine):
            problem = "its same-machine groups are not those that follow from its functions"
            yield Finding(STALE_GROUPS, task.element, {"task": task.id, "problem": problem})
        elif groups is not None:
            for group in groups:
                yield from _check_group(task, group.nodes, tables)


def _check_group(task: Task, group: tuple[str, ...], tables: Tables) -> Iterator[Finding]:
    nodes = {node.id: node for node in tables.service_graphs[task.implementation].nodes}
    services = [tables.service(nodes[id]) for id in group]
    offers = [{p.machine for p in service.providers} for service in services if service]
    equipment = {machine for mode in task.equipment for machine in mode.machines}
    if offers and not set.intersection(*offers, *([equipment] if equipment else [])):
        names = ", ".join(f"'{id.rpartition('::')[2]}'" for id in group)
        problem = f"no machine offers all of {names}, which must run on one machine"
        yield Finding(STALE_GROUPS, task.element, {"task": task.id, "problem": problem})


def check_releases(model: Model, tables: Tables) -> Iterator[Finding]:
    """Each resource that a task acquires is released on every path to the end."""
    for task in model.recipe.tasks:
        graph = tables.service_graphs.get(task.implementation)
        for resource, node, element in () if graph is None else _iter_unreleased(graph, tables):
            facts = {"task": task.id, "resource": resource, "node": node}
            yield Finding(UNRELEASED, element, facts)


def _iter_unreleased(graph: FlowGraph, tables: Tables) -> Iterator[tuple[str, str, str]]:
    ends = {node.id for node in graph.nodes if node.kind == "final"}
    for node in graph.nodes:
        resources = {r.id for f in functions_of(node, tables) for r in f.resources}
        for resource in sorted(resources):
            modes_by_node = {n.id: find_modes(n, resource, tables) for n in graph.nodes}
            releasing = {id for id, modes in modes_by_node.items() if "release" in modes}
            edges = [(e.source, e.target) for e in graph.edges if e.source not in releasing]
            if "acquire" in modes_by_node[node.id] and find_reachable([node.id], edges) & ends:
                yield resource, node.id, node.element


def check_bounds(model: Model, tables: Tables) -> Iterator[Finding]:
    """Each loop has a bound."""
    for graph in iter_graphs(model):
        for node in graph.nodes:
            if node.kind == "loop" and node.max_iterations is None:
                yield Finding(UNBOUNDED, node.element, {"loop": node.id})
