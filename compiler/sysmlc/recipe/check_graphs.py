"""Checks of flow graphs: paths, loops and forks (REC003, REC004)."""

from collections.abc import Iterator
from itertools import takewhile

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir.algorithms import sort_topologically
from sysmlc.recipe.durations import count_rounds, find_unbounded_loops
from sysmlc.recipe.flow import STEPS, find_cycles, find_reachable, list_forward_edges
from sysmlc.recipe.model import FlowGraph, Model, Node
from sysmlc.recipe.tables import Finding, Tables
from sysmlc.support.counts import count

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
    for graph in model.graphs:
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
        yield node.element, f"no path leads from the initial node to '{_local_name(node.id)}'"
    for node in _select_causes(stuck, pairs):
        yield node.element, f"no path leads from '{_local_name(node.id)}' to a final node"


def _select_causes(nodes: list[Node], pairs: list[tuple[str, str]]) -> list[Node]:
    """Return the nodes from which no pair leads to another of *nodes*; in a cycle the first node.

    The faults of the other nodes are consequences: they lead to one of these.
    """
    ids = {node.id for node in nodes}
    sources = {source for source, target in pairs if source != target and target in ids}
    return [node for node in nodes if node.id not in sources] or nodes[:1]


def check_nesting(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC004: every cycle has a loop node, and every fork is closed by a join."""
    for graph in model.graphs:
        for element, problem in (*_iter_endless_cycles(graph), *_iter_fork_problems(graph)):
            facts = {"graph": graph.id, "problem": problem}
            yield Finding(BAD_NESTING, element or graph.element, facts)


def _iter_endless_cycles(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    loops = {node.id for node in graph.nodes if node.kind in ("loop", "forEach")}
    plain = [node.id for node in graph.nodes if node.id not in loops]
    pairs = [(e.source, e.target) for e in graph.edges if not {e.source, e.target} & loops]
    for cycle in find_cycles(plain, pairs):
        names = ", ".join(f"'{_local_name(id)}'" for id in cycle)
        yield graph.element, f"no decision leaves the cycle of {names}"


def _iter_fork_problems(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    """Yield faults of forks: propagate stacks of open forks, and compare them where edges meet."""
    nodes = {node.id: node for node in graph.nodes}
    edges = list_forward_edges(graph)
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
        return _common_prefix(branches), "edges that do not come from branches of one fork meet at"
    return branches[0][:-1], ""


def _merge(branches: list[_Branch]) -> tuple[_Branch, str]:
    """Return the stack of open forks if it is the same for all branches; else a problem."""
    if len(set(branches)) > 1:
        return _common_prefix(branches), "branches of a fork meet without a join at"
    return branches[0], ""


def _common_prefix(branches: list[_Branch]) -> _Branch:
    levels = takewhile(lambda level: len(set(level)) == 1, zip(*branches, strict=False))
    return tuple(level[0] for level in levels)


def _local_name(id: str) -> str:
    return id.rpartition("::")[2]


# -- bounds of loops -----------------------------------------------------------------------------

UNBOUNDED = rule(
    "SM620",
    "loop-without-bound",
    Severity.INFO,
    "the loop at '{loop}' has no bound",
    help="apply «Loop» with maxIterations to the decision",
)


def check_bounds(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM620: each loop has a bound, or the values of variables limit its rounds."""
    for graph in model.graphs:
        for node in find_unbounded_loops(graph):
            yield Finding(UNBOUNDED, node.element, {"loop": node.id})


ROUNDS = rule(
    "SM649",
    "loop-bound-too-small",
    Severity.WARNING,
    "the guards let the loop at '{loop}' run up to {rounds}, but maxIterations is {bound}",
    help="correct maxIterations of «Loop», or the guards",
)


def check_rounds(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM649: the values of variables allow no more rounds of a loop than its bound."""
    for graph in model.graphs:
        for node in graph.nodes:
            if node.kind == "loop" and node.max_iterations is not None:
                rounds = count_rounds(graph, node)
                if rounds is not None and rounds > node.max_iterations:
                    facts = {
                        "loop": node.id,
                        "rounds": count(rounds, "time"),
                        "bound": node.max_iterations,
                    }
                    yield Finding(ROUNDS, node.element, facts)
