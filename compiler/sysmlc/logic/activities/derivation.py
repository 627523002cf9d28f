"""Contracts of activities: the token game as assumptions and guarantees.

The system owns the tokens; the environment owns the ends of actions and the values that guards
read. The next state is a function of the present step, so there is one equivalence for each
variable. Only a decision with several open branches leaves a choice.

If several nodes write one variable in the same step, any of them may be the last (UML 2.5.1,
15.2.3: actions that no flow orders happen in any order).
"""

from collections.abc import Iterator
from functools import lru_cache

from sysmlc.logic import formula as f
from sysmlc.logic.activities.assumptions import derive_assumptions, find_endless_entries
from sysmlc.logic.activities.handshakes import derive_handshake
from sysmlc.logic.activities.step_formulas import StepFormulas, token_at
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    NO_START,
    Duration,
    Guard,
    Store,
    TokenEdge,
    TokenNode,
    Write,
)
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Owner,
    Variable,
    drop_trivial,
    equals,
)
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.logic.region_formulas import print_worded

_CACHE_SIZE = 256
"""Cache size: a process that compiles again reuses contracts of activities without edits."""


@lru_cache(_CACHE_SIZE)
def derive_contract(graph: TokenGraph) -> Contract:
    """Return the contract of an activity.

    It guarantees that the tokens move as drawn and, if the environment keeps the assumptions, that
    each performance ends.
    """
    formulas = StepFormulas(graph)
    return Contract(
        component=graph.component,
        origin=graph.activity,
        variables=list_variables(graph),
        assumptions=drop_trivial(derive_assumptions(formulas)),
        guarantees=drop_trivial(_derive_guarantees(formulas)),
    )


def _derive_guarantees(formulas: StepFormulas) -> Iterator[Conjunct]:
    """Yield how the activity starts, how its tokens and variables change, and its progress."""
    graph = formulas.graph
    if graph.handshake is not None:
        yield from derive_handshake(formulas, graph.handshake)
    yield from _derive_start_tokens(graph)
    for store in graph.stores:
        yield from _derive_initial_value(store)
    yield from derive_token_updates(formulas)
    for node in graph.workers():
        yield derive_run_update(formulas, node)
    for store in graph.stores:
        yield from _derive_store_updates(formulas, store)
    yield from _derive_progress(formulas)


def derive_token_updates(formulas: StepFormulas) -> Iterator[Conjunct]:
    """Yield how tokens move, and which regions are complete."""
    graph = formulas.graph
    for id, name in _list_named_conditions(graph):
        yield _derive_named_condition(formulas, id, name)
    for edge in graph.edges:
        if graph.can_hold(edge) and not formulas.is_chosen(edge):
            yield _derive_edge_update(formulas, edge)
    for node in filter(graph.can_choose, graph.nodes):
        yield from _derive_choice(formulas, node)


def list_variables(graph: TokenGraph) -> tuple[Variable, ...]:
    """List the variables of an activity.

    These are inputs, written variables, and Booleans for the handshake, nodes, tokens and regions.
    """
    run_variables = [(node.run, node.origin) for node in graph.workers()]
    handshake = graph.handshake
    inputs = (name for name in (handshake.start, handshake.stop) if name) if handshake else ()
    outputs = (handshake.running, handshake.finished) if handshake else ()
    token_variables = [(edge.variable, edge.origin) for edge in graph.edges if graph.can_hold(edge)]
    conditions = [(name, _origin_of(graph, id)) for id, name in _list_named_conditions(graph)]
    system_variables = (
        Variable(name, Owner.SYSTEM, BooleanDomain(), origin)
        for name, origin in (*((name, graph.activity) for name in outputs), *run_variables)
    )
    auxiliary_variables = (
        Variable(name, Owner.SYSTEM, BooleanDomain(), origin, is_auxiliary=True)
        for name, origin in (*token_variables, *conditions)
    )
    calls = (Variable(name, Owner.ENVIRONMENT, BooleanDomain(), graph.activity) for name in inputs)
    stored = (store.variable for store in graph.stores)
    return (*calls, *graph.inputs, *stored, *system_variables, *auxiliary_variables)


def _list_named_conditions(graph: TokenGraph) -> list[tuple[str, str]]:
    """List the conditions with a variable, except an end that the handshake has."""
    ends = [] if graph.handshake is None else [ACTIVITY_REGION]
    return [condition for condition in graph.named_conditions if condition[0] not in ends]


def _origin_of(graph: TokenGraph, id: str) -> str:
    """Return the origin of a region or an edge."""
    if id == ACTIVITY_REGION:
        return graph.activity
    edge = graph.find_edge(id)
    return graph.node(id).origin if edge is None else edge.origin


def _derive_start_tokens(graph: TokenGraph) -> Iterator[Conjunct]:
    is_started = graph.handshake is None or graph.handshake.is_started
    start = graph.start_all(ACTIVITY_REGION) if is_started else NO_START
    for edge in filter(graph.can_hold, graph.edges):
        is_marked = edge.id in start.tokens
        value = token_at(edge) if is_marked else f.negate(token_at(edge))
        yield Conjunct(value, Class.INIT, edge.origin, _describe_start(graph, edge, is_marked))
    for node in graph.workers():
        is_first = node.id in start.running
        text = f"At the start {node.label} is {'' if is_first else 'not '}running."
        value = f.var(node.run) if is_first else f.negate(f.var(node.run))
        yield Conjunct(value, Class.INIT, node.origin, text)


def _describe_start(graph: TokenGraph, edge: TokenEdge, is_marked: bool) -> str:
    if edge.source == edge.target:
        verb = "begins to listen" if is_marked else "does not listen"
        return f"{_capitalize(graph.node(edge.source).label)} {verb} at the start."
    verb = "starts with a token" if is_marked else "has no token at the start"
    return f"{_capitalize(edge.label)} {verb}."


def _derive_edge_update(formulas: StepFormulas, edge: TokenEdge) -> Conjunct:
    """Return the conjunct that determines whether the edge holds a token in the next step."""
    cleared = formulas.cleared_formula(edge.region, {edge.source, edge.target})
    rests = f.both(formulas.resting_formula(edge), f.negate(cleared))
    holds_token = f.either(_begin_with_token(formulas, edge), rests)
    return Conjunct(
        _next_value(edge.variable, holds_token),
        Class.SAFETY,
        edge.origin,
        _describe_edge(formulas, edge),
    )


def _begin_with_token(formulas: StepFormulas, edge: TokenEdge) -> Formula:
    """Return that the region of the edge starts in the next step, with a token on the edge."""
    is_first = edge.id in formulas.graph.start(edge.region).tokens
    return formulas.begin_formula(edge.region) if is_first else f.FALSE


def _derive_named_condition(formulas: StepFormulas, id: str, name: str) -> Conjunct:
    """Return the conjunct that defines the variable of a region or an edge."""
    graph, edge = formulas.graph, formulas.graph.find_edge(id)
    if edge is None:
        label = graph.label if id == ACTIVITY_REGION else graph.node(id).label
        text = (
            f"'{name}' is true in the last step of {label}: a token reaches a final node, "
            "or nothing is left in it after this step."
        )
        condition = formulas.completion_formula(id)
    else:
        text = f"'{name}' is true when {edge.label} gets a token."
        condition = formulas.arrival_condition(edge)
    value = f.fold_iff(f.var(name), condition)
    return Conjunct(value, Class.SAFETY, _origin_of(graph, id), text)


def _next_value(variable: str, value: Formula) -> Formula:
    return f.fold_iff(f.prime(f.var(variable)), value)


def _describe_edge(formulas: StepFormulas, edge: TokenEdge) -> str:
    source, target = formulas.graph.node(edge.source), formulas.graph.node(edge.target)
    if source is target:
        return _describe_listening(formulas, edge)
    cause = f"{source.label} gives one"
    if edge.marked:
        labels = [node.label for node in formulas.graph.regions_around(edge.region)]
        cause = f"{next(iter(labels), 'the activity')} starts"
    guard = "" if edge.guard is None else f" and {_describe_guard(edge.guard)}"
    return (
        f"{_capitalize(edge.label)} gets a token when {cause}{guard}, and keeps it "
        f"until {target.label} takes it."
    )


def _describe_listening(formulas: StepFormulas, edge: TokenEdge) -> str:
    """Describe the self-loop of an accept action without incoming flows.

    The diagram has no flow for it, so that the text must not speak of one.
    """
    node = formulas.graph.node(edge.target)
    text = f"{_capitalize(node.label)} begins to listen again when it has accepted an event"
    if not edge.listens:
        return f"{text}."
    region = next(
        interruptible
        for interruptible in formulas.graph.interruptibles
        if interruptible.id == edge.listens
    )
    name = f"region '{region.label}'" if region.label else "its region"
    return f"{text}, and when a token enters {name} while it does not listen."


def _describe_guard(guard: Guard) -> str:
    return "no other guard holds" if guard.condition is None else f"its guard {guard.text} holds"


def _derive_choice(formulas: StepFormulas, node: TokenNode) -> Iterator[Conjunct]:
    """Yield the conjuncts for a decision with several open branches.

    Each branch gets a token only if its guard holds, and exactly one open branch gets it.
    """
    branches = formulas.graph.outgoing(node)
    for edge in branches:
        yield from _derive_branch_update(formulas, edge)
    fires = f.both(
        formulas.start_formula(node),
        formulas.decision_formula(node),
        f.negate(formulas.ended_formula(node.region)),
    )
    arrivals = [
        f.both(f.prime(token_at(edge)), f.negate(formulas.kept_formula(edge))) for edge in branches
    ]
    exclusions = [
        f.negate(f.both(first, second))
        for index, first in enumerate(arrivals)
        for second in arrivals[index + 1 :]
    ]
    text = f"The token that {node.label} gives goes to exactly one branch whose guard holds."
    interrupted = (
        f.both(formulas.guard_formula(edge), _interruption_of_edge(formulas, edge))
        for edge in branches
    )
    first = f.implies(fires, f.both(f.either(*arrivals, *interrupted), *exclusions))
    yield Conjunct(first, Class.SAFETY, node.origin, text)


def _interruption_of_edge(formulas: StepFormulas, edge: TokenEdge) -> Formula:
    """Return the condition that an interruption removes the token that the edge gets now."""
    return f.either(*formulas.interruption_formulas(edge.region, {edge.source, edge.target}))


def _derive_branch_update(formulas: StepFormulas, edge: TokenEdge) -> Iterator[Conjunct]:
    """Yield the conditions under which a branch may and must hold a token in the next step."""
    # The choice between open branches is free, so that no equivalence determines a branch.
    next_token, cleared = (
        f.prime(token_at(edge)),
        formulas.cleared_formula(edge.region, {edge.source, edge.target}),
    )
    begin = _begin_with_token(formulas, edge)
    allowed = f.either(
        begin,
        f.both(
            f.either(formulas.given_formula(edge), formulas.kept_formula(edge)), f.negate(cleared)
        ),
    )
    required = f.either(begin, f.both(formulas.kept_formula(edge), f.negate(cleared)))
    text = _describe_edge(formulas, edge)
    yield Conjunct(f.implies(next_token, allowed), Class.SAFETY, edge.origin, text)
    yield Conjunct(f.implies(required, next_token), Class.SAFETY, edge.origin, text)


def derive_run_update(formulas: StepFormulas, node: TokenNode) -> Conjunct:
    runs = f.either(
        formulas.start_formula(node), f.both(f.var(node.run), f.negate(formulas.done_formula(node)))
    )
    cleared = formulas.aborted_formula(node.region, {node.id})
    value = f.either(f.both(runs, f.negate(cleared)), formulas.first_formula(node))
    until = "for one step" if node.duration is Duration.PULSE else "until it is done"
    text = f"{_capitalize(node.label)} runs from when all its flows have brought a token {until}."
    return Conjunct(_next_value(node.run, value), Class.SAFETY, node.origin, text)


def _capitalize(text: str) -> str:
    return text[:1].upper() + text[1:]


def _derive_progress(formulas: StepFormulas) -> Iterator[Conjunct]:
    """Yield the liveness guarantees: the activity finishes, or passes its loops, repeatedly."""
    graph, handshake = formulas.graph, formulas.graph.handshake
    idle: Formula = f.FALSE
    if handshake is not None:
        idle = f.either(f.negate(f.var(handshake.running)), formulas.stop_formula())
    if graph.finishes:
        text = f"{_capitalize(graph.label)} finishes again and again."
        if handshake is not None:
            unless = f", unless '{handshake.stop}' abandons it" if handshake.stop else ""
            text = f"Whenever {graph.label} runs, it ends sooner or later{unless}."
        ends = f.either(idle, formulas.complete_formula(ACTIVITY_REGION))
        yield Conjunct(ends, Class.LIVENESS, graph.activity, text)
        return
    condition = "" if handshake is None else f" while {graph.label} runs"
    for entry in find_endless_entries(graph):
        text = f"{_capitalize(entry.label)} is reached again and again{condition}."
        reached = f.either(idle, *map(formulas.present_formula, graph.incoming(entry)))
        yield Conjunct(reached, Class.LIVENESS, entry.origin, text)


def _derive_initial_value(store: Store) -> Iterator[Conjunct]:
    """Yield the initial value of a variable, if the model gives one."""
    if store.first is not None:
        text = f"At the start '{store.variable.name}' is {print_literal(store.first)}."
        value = equals(store.variable, Const(store.first))
        yield Conjunct(value, Class.INIT, store.variable.origin, text)


def _derive_store_updates(formulas: StepFormulas, store: Store) -> Iterator[Conjunct]:
    """Yield the conjuncts for the writes of a variable, its reset at a restart, and its frame."""
    if store.follows is not None:
        text = f"'{store.variable.name}' is true if {print_formula(store.follows)} held in the "
        step = f.fold_iff(f.prime(f.var(store.variable.name)), store.follows)
        yield Conjunct(step, Class.SAFETY, store.variable.origin, f"{text}previous step.")
        return
    restart = (
        formulas.begin_formula(ACTIVITY_REGION)
        if store.local and store.first is not None
        else f.FALSE
    )
    # The new start wins over a write in the last step of the performance before.
    writing = [
        f.both(formulas.finish_formula(formulas.graph.node(write.node)), f.negate(restart))
        for write in store.writes
    ]
    for write, write_formula in zip(store.writes, writing, strict=True):
        yield from _derive_write(
            formulas, store, write, write_formula, _simultaneous_writes(formulas, store, write)
        )
    origin, name = store.variable.origin, store.variable.name
    if store.first is not None and restart != f.FALSE:
        value = equals(store.variable, Const(store.first), is_next=True)
        text = f"'{name}' is {print_literal(store.first)} whenever {formulas.graph.label} starts."
        yield Conjunct(f.implies(restart, value), Class.SAFETY, origin, text)
    unchanged = equals(store.variable, f.var(name), is_next=True)
    frame = f.implies(f.negate(f.either(*writing, restart)), unchanged)
    text = f"'{name}' keeps its value until an action writes another."
    yield Conjunct(frame, Class.SAFETY, origin, text)


def _simultaneous_writes(formulas: StepFormulas, store: Store, write: Write) -> list[Formula]:
    """Return the formulas of the other writes that may happen in the same step."""
    other_writes = (candidate for candidate in store.writes if candidate is not write)
    simultaneous = [
        other_write
        for other_write in other_writes
        if formulas.concurrency.are_concurrent(write.node, other_write.node)
    ]
    return [
        write_formula
        for other_write in simultaneous
        for write_formula in _write_formulas(formulas, store, other_write)
    ]


def _derive_write(
    formulas: StepFormulas,
    store: Store,
    write: Write,
    write_formula: Formula,
    simultaneous: list[Formula],
) -> Iterator[Conjunct]:
    node, name = formulas.graph.node(write.node), store.variable.name
    for condition, value in write.values:
        write_case = f.both(write_formula, condition)
        result = f.either(equals(store.variable, value, is_next=True), *simultaneous)
        cause = f"{node.label} is done{_describe_condition(formulas.graph, condition)}"
        text = f"When {cause}, '{name}' becomes {_describe_value(write, value)}."
        yield Conjunct(f.implies(write_case, result), Class.SAFETY, node.origin, text)


def _describe_condition(graph: TokenGraph, condition: Formula) -> str:
    return "" if condition == f.TRUE else f" and {print_worded(condition, list_variables(graph))}"


def _describe_value(write: Write, value: Formula) -> str:
    return write.text if write.text and len(write.values) == 1 else print_formula(value)


def _write_formulas(formulas: StepFormulas, store: Store, write: Write) -> Iterator[Formula]:
    """Yield, for each value, the formula that the write happens now and assigns the value."""
    write_formula = formulas.finish_formula(formulas.graph.node(write.node))
    for condition, value in write.values:
        yield f.both(write_formula, condition, equals(store.variable, value, is_next=True))
