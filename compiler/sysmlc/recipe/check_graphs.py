"""Checks of the graphs of levels 2 and 3: ways, loops, forks (REC003, REC004)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.recipe.checks import Finding, graphs
from sysmlc.recipe.derive import Tables
from sysmlc.recipe.flow import STEPS, cycles, forward_edges, reachable
from sysmlc.recipe.model import FlowGraph, Model, Node

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


def ways(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC003: one initial node, a final one, every node on a way between them."""
    for graph in graphs(model):
        for element, problem in _way_problems(graph):
            yield Finding(NO_WAY, element or graph.element, {"graph": graph.id, "problem": problem})


def _way_problems(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    starts = [node.id for node in graph.nodes if node.kind == "initial"]
    ends = [node.id for node in graph.nodes if node.kind in ("final", "flowFinal")]
    if len(starts) > 1:
        yield graph.element, f"there are {len(starts)} initial nodes"
    pairs = [(edge.source, edge.target) for edge in graph.edges]
    begun = reachable(starts, pairs)
    done = reachable(ends, [(b, a) for a, b in pairs])
    lost = [node for node in graph.nodes if node.id not in begun]
    stuck = [node for node in graph.nodes if node.id in begun and node.id not in done]
    for node in _first_of(lost, [(b, a) for a, b in pairs]):
        yield node.element, f"nothing leads to '{_short(node.id)}'"
    for node in _first_of(stuck, pairs):
        yield node.element, f"no way leads from '{_short(node.id)}' to an end"


def _first_of(nodes: list[Node], pairs: list[tuple[str, str]]) -> list[Node]:
    """The nodes from which no pair leads to another of them: the others follow from these."""
    ids = {node.id for node in nodes}
    leading = {a for a, b in pairs if a != b and b in ids}
    return [node for node in nodes if node.id not in leading] or nodes[:1]


def nesting(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC004: a loop node in every cycle, joins that close forks."""
    for graph in graphs(model):
        for element, problem in _nesting_problems(graph):
            facts = {"graph": graph.id, "problem": problem}
            yield Finding(BAD_NESTING, element or graph.element, facts)


def _nesting_problems(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    yield from _endless(graph)
    yield from _forks(graph)


def _endless(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    loops = {node.id for node in graph.nodes if node.kind in ("loop", "forEach")}
    plain = [node.id for node in graph.nodes if node.id not in loops]
    pairs = [(e.source, e.target) for e in graph.edges if not {e.source, e.target} & loops]
    for part in cycles(plain, pairs):
        names = ", ".join(f"'{_short(id)}'" for id in part)
        yield graph.element, f"no decision leaves the cycle of {names}"


def _forks(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    """Follow the open forks along the edges; where edges meet, they must fit."""
    nodes = {node.id: node for node in graph.nodes}
    after: dict[str, list[str]] = {}
    before: dict[str, list[str]] = {}
    for source, target in forward_edges(graph):
        after.setdefault(source, []).append(target)
        before.setdefault(target, []).append(source)
    arriving: dict[str, list[_Branch]] = {}
    for id in _topological(list(nodes), before, after):
        branches = arriving.get(id, [()])
        node, problem = nodes[id], ""
        open_: _Branch = branches[0]
        if len(branches) > 1:
            joins = node.kind == "join" or node.kind in STEPS
            open_, problem = _joined(branches) if joins else _merged(branches)
        if problem:
            yield node.element, f"{problem} '{_short(id)}'"
        targets = after.get(id, [])
        is_fork = len(targets) > 1 and (node.kind == "fork" or node.kind in STEPS)
        for number, target in enumerate(targets):
            branch = (*open_, (id, number)) if is_fork else open_
            arriving.setdefault(target, []).append(branch)


def _joined(branches: list[_Branch]) -> tuple[_Branch, str]:
    """Branches of one fork, each from another of its ways, close it."""
    forks = {(*branch[:-1], (branch[-1][0], 0)) if branch else () for branch in branches}
    if len(forks) > 1 or not all(branches) or len(set(branches)) < len(branches):
        return _common(branches), "ways that are not branches of one fork meet at"
    return branches[0][:-1], ""


def _merged(branches: list[_Branch]) -> tuple[_Branch, str]:
    if len(set(branches)) > 1:
        return _common(branches), "branches of a fork meet without a join at"
    return branches[0], ""


def _common(branches: list[_Branch]) -> _Branch:
    shortest = min(branches, key=len)
    return next(
        shortest[:n]
        for n in range(len(shortest), -1, -1)
        if all(branch[:n] == shortest[:n] for branch in branches)
    )


def _topological(
    ids: list[str], before: dict[str, list[str]], after: dict[str, list[str]]
) -> Iterator[str]:
    missing = {id: len(before.get(id, ())) for id in ids}
    ready = [id for id in ids if not missing[id]]
    while ready:
        id = ready.pop(0)
        yield id
        for target in after.get(id, ()):
            missing[target] -= 1
            if not missing[target]:
                ready.append(target)


def _short(id: str) -> str:
    return id.rpartition("::")[2]
