"""Assumptions of an activity's contract: actions end, guards open, and loops are left.

A loop whose exit depends on the environment gets the assumption
``GF(!inside | at the decision & exit guard)``. The plain ``GF(exit guard)`` is too weak, because
the guard could be true only while the token is elsewhere in the loop (docs/decisions/0011).
"""

from collections.abc import Collection, Iterator
from itertools import product
from math import prod

from msgspec import Struct

from sysmlc.ir.algorithms import strongly_connected_components
from sysmlc.logic import formula as f
from sysmlc.logic.activities.step_formulas import StepFormulas, token_at
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    NodeKind,
    TokenEdge,
    TokenNode,
)
from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.simplification import is_satisfiable, substitute

_MAX_CHOICES = 256
"""Most combinations of inputs that are tried; nothing is assumed of a condition with more."""


class Loop(Struct, frozen=True):
    """Nodes that reach each other, as ids in the order of the graph, and edges that leave them."""

    nodes: tuple[str, ...]
    exits: tuple[TokenEdge, ...]


def _find_loops(graph: TokenGraph) -> list[Loop]:
    """Return the loops with at least one exit that the environment opens, outer before inner.

    A loop is a strongly connected component. The inner loops are the components that remain when
    the decisions with exits are removed.
    """
    return list(_iter_loops(graph, [node.id for node in graph.nodes]))


def find_endless_entries(graph: TokenGraph) -> list[TokenNode]:
    """Return one entry node of each loop without exits; a run passes it infinitely often."""
    heads = (
        _find_endless_entry(graph, component)
        for component in _find_components(graph, [node.id for node in graph.nodes])
    )
    return [head for head in heads if head is not None]


def _find_endless_entry(graph: TokenGraph, component: Collection[str]) -> TokenNode | None:
    if any(_is_exit(graph, edge, component) for edge in graph.edges):
        return None
    nodes = [graph.node(id) for id in component]
    entries = [
        node
        for node in nodes
        if any(edge.source not in component or edge.marked for edge in graph.incoming(node))
    ]
    return next(iter(entries), nodes[0])


def _iter_loops(graph: TokenGraph, nodes: Collection[str]) -> Iterator[Loop]:
    for component in _find_components(graph, nodes):
        component_nodes = frozenset(component)
        exits = [edge for edge in graph.edges if _is_exit(graph, edge, component_nodes)]
        if any(_is_decided_outside(graph, edge) for edge in exits):
            yield Loop(component, tuple(exits))
        deciders = {edge.source for edge in exits}
        if deciders:
            yield from _iter_loops(graph, [node for node in component if node not in deciders])


def _find_components(graph: TokenGraph, nodes: Collection[str]) -> list[tuple[str, ...]]:
    allowed = frozenset(nodes)
    arcs = [*((edge.source, edge.target) for edge in graph.edges), *_structured_edges(graph)]
    successors: dict[str, dict[str, None]] = {id: {} for id in nodes}
    for source, target in arcs:
        if source in allowed and target in allowed:
            successors[source][target] = None
    order = {node.id: position for position, node in enumerate(graph.nodes)}
    components = [
        tuple(sorted(component, key=order.__getitem__))
        for component in strongly_connected_components(successors)
        if len(component) > 1 or component[0] in successors[component[0]]
    ]
    return sorted(components, key=lambda component: order[component[0]])


def _structured_edges(graph: TokenGraph) -> Iterator[tuple[str, str]]:
    """Yield an arc from each structured node to each node at which its content starts.

    Flows may leave a structured node from its content, so that a loop may lead through both.
    """
    for edge in graph.edges:
        if edge.marked and edge.region != ACTIVITY_REGION:
            yield edge.region, edge.target


def _is_exit(graph: TokenGraph, edge: TokenEdge, component: Collection[str]) -> bool:
    if edge.source not in component or edge.target in component:
        return False
    return graph.node(edge.source).firing is Firing.CHOICE


def _is_decided_outside(graph: TokenGraph, edge: TokenEdge) -> bool:
    """Whether the guard of the branch reads an input.

    An else branch is decided by the guards of the other branches.
    """
    guard = edge.guard
    if guard is None or isinstance(guard.condition, Const):
        return False
    if guard.condition is not None:
        return graph.is_decided_outside(guard.condition)
    guards = (
        guard_of_sibling.guard for guard_of_sibling in graph.outgoing(graph.node(edge.source))
    )
    conditions = [
        guard_of_sibling.condition
        for guard_of_sibling in guards
        if guard_of_sibling is not None and guard_of_sibling.condition is not None
    ]
    return not conditions or not all(map(graph.is_decided_inside, conditions))


def derive_assumptions(formulas: StepFormulas, decided: Collection[str] = ()) -> Iterator[Conjunct]:
    """Yield the assumptions that actions end, that decisions open a branch, and that loops end.

    Nothing is assumed about variables in *decided*, because the model decides them.
    """
    for assumption in _iter_assumptions(formulas):
        if f.variable_names(assumption.formula).isdisjoint(decided):
            yield assumption


def _iter_assumptions(formulas: StepFormulas) -> Iterator[Conjunct]:
    for node in formulas.graph.workers():
        if node.kind is NodeKind.ACTION and node.duration is Duration.TIMED and node.done:
            # The contract cannot assume anything of variables that the activity itself assigns.
            if formulas.graph.is_decided_inside(node.done):
                continue
            ended = f.either(f.negate(f.var(node.run)), _open_if_possible(formulas, node.done))
            end = node.awaited or "the environment ends it"
            text = f"Whenever {node.label} runs, {end} sooner or later."
            yield Conjunct(ended, Class.LIVENESS, node.origin, text, awaited=node.awaited)
    for node in formulas.graph.nodes:
        yield from _decision_assumption(formulas, node)
    for loop in _find_loops(formulas.graph):
        yield from _loop_assumption(formulas, loop)


def _open_if_possible(formulas: StepFormulas, condition: Formula) -> Formula:
    """Return that a condition holds, or that no input makes it true in this step.

    The environment cannot open a guard that a variable of the activity keeps closed.
    """
    memories = [s.variable.name for s in formulas.graph.stores if s.follows is not None]
    # The environment can let a condition become false and then true.
    wanted = substitute(condition, dict.fromkeys(memories, f.FALSE)) if memories else condition
    names = {variable.name for variable in f.variables(wanted)}
    inside = formulas.graph.written_variables & names
    inputs = {variable.name: variable for variable in formulas.graph.inputs}
    if not inside or not names - inside <= inputs.keys():
        return condition
    free = sorted(names - inside)
    if not free:
        return f.TRUE
    choices = [[f.const(value) for value in values(inputs[name].domain)] for name in free]
    if prod(map(len, choices)) > _MAX_CHOICES:
        return f.TRUE
    possible = f.either(
        *(substitute(wanted, dict(zip(free, row, strict=True))) for row in product(*choices))
    )
    domains = {store.variable.name: store.variable.domain for store in formulas.graph.stores}
    if not is_satisfiable(f.negate(possible), domains):
        return condition
    return f.either(condition, f.negate(possible))


def _decision_assumption(formulas: StepFormulas, node: TokenNode) -> Iterator[Conjunct]:
    """Yield the assumption that a waiting token finally finds an open branch.

    A decision whose guards are exhaustive, or read no input, has no such assumption.
    """
    branches = formulas.graph.outgoing(node)
    if node.firing is not Firing.CHOICE or not branches or node.exhaustive:
        return
    opened = f.either(*map(formulas.guard_formula, branches))
    if formulas.graph.is_decided_inside(opened):
        return
    answer = f.either(f.negate(formulas.waiting_formula(node)), _open_if_possible(formulas, opened))
    text = f"Whenever a token waits at {node.label}, one of its guards holds sooner or later."
    awaited = f"a guard of {node.label} holds"
    yield Conjunct(answer, Class.LIVENESS, node.origin, text, awaited=awaited)


def _loop_assumption(formulas: StepFormulas, loop: Loop) -> Iterator[Conjunct]:
    """Yield the assumption that the environment finally opens an exit of the loop."""
    graph = formulas.graph
    exit = f.either(
        *(
            f.both(
                formulas.waiting_formula(graph.node(edge.source)),
                _open_if_possible(formulas, formulas.guard_formula(edge)),
            )
            for edge in loop.exits
        )
    )
    nodes_in = frozenset(loop.nodes)
    inner_edges = (
        edge for edge in graph.edges if edge.source in nodes_in and edge.target in nodes_in
    )
    holding = (edge for edge in inner_edges if graph.can_hold(edge) and not edge.keeps)
    tokens_inside = [token_at(edge) for edge in holding]
    tokens_inside += [f.var(node.run) for node in graph.workers() if node.id in nodes_in]
    nodes = [graph.node(edge.source) for edge in loop.exits]
    names = " or ".join(dict.fromkeys(node.label for node in nodes))
    guards = " or ".join(dict.fromkeys(edge.guard.text for edge in loop.exits if edge.guard))
    text = (
        f"The loop through {names} is left sooner or later: whenever it goes on, "
        f"{guards} holds there eventually."
    )
    formula = f.either(f.both(*map(f.negate, tokens_inside)), exit)
    awaited = f"the loop through {names} is left"
    yield Conjunct(formula, Class.LIVENESS, nodes[0].origin, text, awaited=awaited)
