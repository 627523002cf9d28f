"""Contracts of activities: the token game as assumptions and guarantees (design, section 7).

The system owns the tokens, the environment the ends of actions and the values that guards read.
What the state is in the next step is a function of this step, so the safety guarantees are one
equivalence for each variable; only a decision with several open branches leaves a choice.
"""

from collections.abc import Iterator
from functools import lru_cache

from sysmlc.logic import formula as f
from sysmlc.logic.activities.assumptions import assumptions, endless_entries
from sysmlc.logic.activities.step_formulas import Game, at
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Duration,
    Guard,
    Store,
    TokenEdge,
    TokenGraph,
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
)
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.printing import print_formula, print_literal

_REMEMBERED = 256
"""Contracts that are kept: a process that compiles again finds those of what was not edited."""


@lru_cache(_REMEMBERED)
def derive(graph: TokenGraph) -> Contract:
    """The contract of an activity: as long as the environment ends what it was asked to do, the
    tokens move as drawn and the activity finishes again and again.
    """
    game = Game(graph)
    return Contract(
        component=graph.component,
        origin=graph.activity,
        variables=variables(graph),
        assumptions=tuple(assumptions(game)),
        guarantees=(
            *_starts(graph),
            *(part for store in graph.stores for part in starts(store)),
            *(_quiet(game, region, name) for region, name in graph.quiets),
            *(_edge_update(game, edge) for edge in graph.edges if not game.is_chosen(edge)),
            *(part for node in game.choosers() for part in _choice(game, node)),
            *(_run_update(game, node) for node in graph.workers()),
            *(part for store in graph.stores for part in updates(game, store)),
            *_progress(game),
        ),
    )


def variables(graph: TokenGraph) -> tuple[Variable, ...]:
    """The variables of an activity: inputs, what it writes, running actions, tokens, complete
    regions.
    """
    runs = [(node.run, node.origin) for node in graph.workers()]
    tokens = [(edge.variable, edge.origin) for edge in graph.edges]
    quiets = [(name, _origin(graph, region)) for region, name in graph.quiets]
    own = (Variable(n, Owner.SYSTEM, BooleanDomain(), o) for n, o in (*runs, *tokens, *quiets))
    return (*graph.inputs, *(store.variable for store in graph.stores), *own)


def _origin(graph: TokenGraph, region: str) -> str:
    return graph.activity if region == ACTIVITY_REGION else graph.node(region).origin


def _label(graph: TokenGraph, region: str) -> str:
    return graph.label if region == ACTIVITY_REGION else graph.node(region).label


def _starts(graph: TokenGraph) -> Iterator[Conjunct]:
    for edge in graph.edges:
        is_marked = edge.marked and edge.region == ACTIVITY_REGION
        value = at(edge) if is_marked else f.negate(at(edge))
        yield Conjunct(value, Class.INIT, edge.origin, _start_text(graph, edge, is_marked))
    for node in graph.workers():
        text = f"At the start {node.label} is not running."
        yield Conjunct(f.negate(f.var(node.run)), Class.INIT, node.origin, text)


def _start_text(graph: TokenGraph, edge: TokenEdge, is_marked: bool) -> str:
    if edge.source == edge.target:
        verb = "begins to listen" if is_marked else "does not listen"
        return f"{_capital(graph.node(edge.source).label)} {verb} at the start."
    verb = "starts with a token" if is_marked else "has no token at the start"
    return f"{_capital(edge.label)} {verb}."


def _edge_update(game: Game, edge: TokenEdge) -> Conjunct:
    moves = f.both(
        f.either(game.given(edge), game.kept(edge), game.heard(edge)),
        f.negate(game.cleared(edge.region, {edge.source, edge.target})),
    )
    held = f.either(f.both(game.begins(edge.region), _constant(edge.marked)), moves)
    return Conjunct(_next(edge.variable, held), Class.SAFETY, edge.origin, _edge_text(game, edge))


def _quiet(game: Game, region: str, name: str) -> Conjunct:
    text = (
        f"'{name}' says that {_label(game.graph, region)} is over: a token is at a final node, "
        "or nothing in it can move."
    )
    value = f.iff(f.var(name), game.completion(region))
    return Conjunct(value, Class.SAFETY, _origin(game.graph, region), text)


def _constant(value: bool) -> Formula:
    return f.TRUE if value else f.FALSE


def _next(variable: str, value: Formula) -> Formula:
    return f.iff(f.primed(f.var(variable)), value)


def _edge_text(game: Game, edge: TokenEdge) -> str:
    source, target = game.graph.node(edge.source), game.graph.node(edge.target)
    if source is target:
        return _listening_text(game, edge)
    given = f"{source.label} gives one"
    if edge.marked:
        around = [node.label for node in game.graph.regions_around(edge.region)]
        given = f"{next(iter(around), 'the activity')} starts"
    when = "" if edge.guard is None else f" and {_open(edge.guard)}"
    return (
        f"{_capital(edge.label)} gets a token when {given}{when}, and keeps it "
        f"until {target.label} takes it."
    )


def _listening_text(game: Game, edge: TokenEdge) -> str:
    """The edge of an accept action without flows: nobody draws it."""
    node = game.graph.node(edge.target)
    text = f"{_capital(node.label)} begins to listen again when it has accepted an event"
    if not edge.listens:
        return f"{text}."
    region = next(one for one in game.graph.interruptibles if one.id == edge.listens)
    name = f"region '{region.label}'" if region.label else "its region"
    return f"{text}, and when a token enters {name} while it does not listen."


def _open(guard: Guard) -> str:
    return "no other guard holds" if guard.condition is None else f"its guard {guard.text} holds"


def _choice(game: Game, node: TokenNode) -> Iterator[Conjunct]:
    """Each branch is updated as far as the guards say; one token goes to one open branch."""
    branches = game.graph.outgoing(node)
    for edge in branches:
        yield from _branch_update(game, edge)
    fires = f.both(
        game.starts(node),
        game.decides(node),
        f.negate(game.ended(node.region)),
    )
    arrives = [f.both(f.primed(at(e)), f.negate(game.kept(e))) for e in branches]
    none_twice = [
        f.negate(f.both(one, other))
        for index, one in enumerate(arrives)
        for other in arrives[index + 1 :]
    ]
    text = f"The token that {node.label} gives goes to exactly one branch whose guard holds."
    lost = (f.both(game.opened(edge), _interrupted(game, edge)) for edge in branches)
    one = f.implies(fires, f.both(f.either(*arrives, *lost), *none_twice))
    yield Conjunct(one, Class.SAFETY, node.origin, text)


def _interrupted(game: Game, edge: TokenEdge) -> Formula:
    """A token that the edge gets in this step is lost at once."""
    return f.either(*game.interruptions(edge.region, {edge.source, edge.target}))


def _branch_update(game: Game, edge: TokenEdge) -> Iterator[Conjunct]:
    after, cleared = f.primed(at(edge)), game.cleared(edge.region, {edge.source, edge.target})
    begins = f.both(game.begins(edge.region), _constant(edge.marked))
    may = f.either(begins, f.both(f.either(game.given(edge), game.kept(edge)), f.negate(cleared)))
    must = f.either(begins, f.both(game.kept(edge), f.negate(cleared)))
    text = _edge_text(game, edge)
    yield Conjunct(f.implies(after, may), Class.SAFETY, edge.origin, text)
    yield Conjunct(f.implies(must, after), Class.SAFETY, edge.origin, text)


def _run_update(game: Game, node: TokenNode) -> Conjunct:
    goes_on = f.either(game.starts(node), f.both(f.var(node.run), f.negate(game.done(node))))
    cleared = game.cleared(node.region, {node.id})
    value = f.both(goes_on, f.negate(cleared))
    until = "for one step" if node.duration is Duration.PULSE else "until it is done"
    text = f"{_capital(node.label)} runs from when all its flows have brought a token {until}."
    return Conjunct(_next(node.run, value), Class.SAFETY, node.origin, text)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _progress(game: Game) -> Iterator[Conjunct]:
    graph = game.graph
    if graph.finishes:
        text = f"{_capital(graph.label)} finishes again and again."
        yield Conjunct(game.complete(ACTIVITY_REGION), Class.LIVENESS, graph.activity, text)
        return
    for entry in endless_entries(graph):
        text = f"{_capital(entry.label)} is reached again and again."
        reached = f.either(*map(at, graph.incoming(entry)))
        yield Conjunct(reached, Class.LIVENESS, entry.origin, text)


def starts(store: Store) -> Iterator[Conjunct]:
    """The value at the start, where the model gives one."""
    if store.first is not None:
        text = f"At the start '{store.variable.name}' is {print_literal(store.first)}."
        value = _equals(store, Const(store.first), is_next=False)
        yield Conjunct(value, Class.INIT, store.variable.origin, text)


def updates(game: Game, store: Store) -> Iterator[Conjunct]:
    """Each write, the start of another run of the activity, and that nothing else changes it."""
    again = game.begins(ACTIVITY_REGION) if store.local and store.first is not None else f.FALSE
    fired = [game.finishes(game.graph.node(write.node)) for write in store.writes]
    for write, fires in zip(store.writes, fired, strict=True):
        yield from _write(game, store, write, fires, _at_once(game, store, write))
    origin, name = store.variable.origin, store.variable.name
    if store.first is not None and again != f.FALSE:
        value = _equals(store, Const(store.first), is_next=True)
        text = f"'{name}' is {print_literal(store.first)} whenever {game.graph.label} starts."
        yield Conjunct(f.implies(again, value), Class.SAFETY, origin, text)
    same = _equals(store, f.var(name), is_next=True)
    frame = f.implies(f.negate(f.either(*fired, again)), same)
    text = f"'{name}' keeps its value until an action writes another."
    yield Conjunct(frame, Class.SAFETY, origin, text)


def _at_once(game: Game, store: Store, write: Write) -> list[Formula]:
    """The other writes that may happen in the same step."""
    others = (other for other in store.writes if other is not write)
    beside = [one for one in others if game.together.are(write.node, one.node)]
    return [way for one in beside for way in _ways(game, store, one)]


def _write(
    game: Game, store: Store, write: Write, fires: Formula, at_once: list[Formula]
) -> Iterator[Conjunct]:
    node, name = game.graph.node(write.node), store.variable.name
    for condition, value in write.values:
        case = f.both(fires, condition)
        given = f.either(_equals(store, value, is_next=True), *at_once)
        text = (
            f"When {node.label} is done{_and(condition)}, '{name}' becomes {_shown(write, value)}."
        )
        yield Conjunct(f.implies(case, given), Class.SAFETY, node.origin, text)


def _and(condition: Formula) -> str:
    return "" if condition == f.TRUE else f" and {print_formula(condition)}"


def _shown(write: Write, value: Formula) -> str:
    return write.text if write.text and len(write.values) == 1 else print_formula(value)


def _ways(game: Game, store: Store, write: Write) -> Iterator[Formula]:
    """The write happens in this step, and gives one of its values."""
    fires = game.finishes(game.graph.node(write.node))
    for condition, value in write.values:
        yield f.both(fires, condition, _equals(store, value, is_next=True))


def _equals(store: Store, value: Formula, *, is_next: bool) -> Formula:
    name = f.var(store.variable.name)
    variable = f.primed(name) if is_next else name
    if not isinstance(store.variable.domain, BooleanDomain):
        return f.eq(variable, value)
    if isinstance(value, Const):
        return variable if value.value else f.negate(variable)
    return f.iff(variable, value)
