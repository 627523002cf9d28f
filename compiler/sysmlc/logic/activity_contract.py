"""Contracts of activities: the token game as assumptions and guarantees (design, section 7).

The system owns the tokens, the environment the ends of actions and the values that guards read.
What the state is in the next step is a function of this step, so the safety guarantees are one
equivalence for each variable; only a decision with several open branches leaves a choice.

A loop whose exit depends on the environment gets the assumption
``GF(!inside | at the decision & exit guard)``. The plain ``GF(exit guard)`` would not do: the guard
could be true only while the token is elsewhere in the loop.
"""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.activity_loops import Loop, endless_entries, loops
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Formula
from sysmlc.logic.tokens import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    Interruptible,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)


def derive(graph: TokenGraph) -> Contract:
    """The contract of an activity: as long as the environment ends what it was asked to do, the
    tokens move as drawn and the activity finishes again and again.
    """
    game = _Game(graph)
    return Contract(
        component=graph.component,
        origin=graph.activity,
        variables=tuple(_variables(graph)),
        assumptions=tuple(_assumptions(game)),
        guarantees=(
            *_starts(graph),
            *(_edge_update(game, edge) for edge in graph.edges if not game.is_chosen(edge)),
            *(part for node in game.choosers() for part in _choice(game, node)),
            *(_run_update(game, node) for node in graph.workers()),
            *_progress(game),
        ),
    )


def _variables(graph: TokenGraph) -> Iterator[Variable]:
    yield from graph.inputs
    for node in graph.workers():
        yield Variable(node.run, Owner.SYSTEM, BooleanDomain(), node.origin)
    for edge in graph.edges:
        yield Variable(edge.variable, Owner.SYSTEM, BooleanDomain(), edge.origin)


class _Game:
    """The parts that the conjuncts are put together from, all about the present step."""

    def __init__(self, graph: TokenGraph) -> None:
        self.graph = graph
        self._complete: dict[str, Formula] = {}

    # -- nodes -----------------------------------------------------------------------------

    def waits(self, node: TokenNode) -> Formula:
        """A token is on every incoming edge."""
        incoming = self.graph.incoming(node)
        return f.both(*map(_at, incoming)) if incoming else f.FALSE

    def done(self, node: TokenNode) -> Formula:
        """A running node is done."""
        if node.kind is NodeKind.STRUCTURED:
            return self.complete(node.id)
        if node.duration is Duration.PULSE or node.done is None:
            return f.TRUE
        return node.done

    def complete(self, region: str) -> Formula:
        """A token is at a final node of the region, or none is left in the region."""
        if region not in self._complete:
            self._complete[region] = self._completion(region)
        return self._complete[region]

    def _completion(self, region: str) -> Formula:
        at_final = [_at(edge) for edge in self.graph.ends(region)]
        if not self.graph.can_empty(region):
            return f.either(*at_final)
        edges, nodes = self.graph.inside(region)
        left = (*map(_at, edges), *(f.var(node.run) for node in nodes))
        return f.either(*at_final, f.both(*map(f.negate, left)))

    def choosers(self) -> list[TokenNode]:
        """Decisions with several branches that may be open at the same time."""
        return [n for n in self.graph.nodes if _may_choose(self.graph.outgoing(n), n)]

    def is_chosen(self, edge: TokenEdge) -> bool:
        """Whether the edge is a branch of such a decision."""
        source = self.graph.node(edge.source)
        return _may_choose(self.graph.outgoing(source), source)

    # -- edges -----------------------------------------------------------------------------

    def opened(self, edge: TokenEdge) -> Formula:
        """The guard of the edge, with else as none of the other guards."""
        guard = edge.guard
        if guard is None:
            return f.TRUE
        if guard.condition is not None:
            return guard.condition
        siblings = self.graph.outgoing(self.graph.node(edge.source))
        return f.both(*(f.negate(self.opened(s)) for s in siblings if not _is_else(s)))

    def given(self, edge: TokenEdge) -> Formula:
        """The source of the edge gives it a token (or may, when the decision has a choice)."""
        source = self.graph.node(edge.source)
        match source.firing:
            case Firing.ANY:
                return f.either(*map(_at, self.graph.incoming(source)))
            case Firing.ALL:
                return self.waits(source)
            case Firing.CHOICE:
                return f.both(self.waits(source), self.opened(edge))
            case Firing.WORK:
                return f.both(f.var(source.run), self.done(source))
            case _:
                return f.FALSE

    def taken(self, edge: TokenEdge) -> Formula:
        """The target of the edge takes a token that is on it."""
        target = self.graph.node(edge.target)
        match target.firing:
            case Firing.ANY | Firing.END:
                return f.TRUE
            case Firing.NEVER:
                return f.FALSE
            case Firing.CHOICE:
                branches = self.graph.outgoing(target)
                opened = f.either(*map(self.opened, branches)) if branches else f.TRUE
                return f.both(self.others(edge), opened)
            case _:
                return self.others(edge)

    def others(self, edge: TokenEdge) -> Formula:
        """A token is on every other edge into the same node."""
        incoming = self.graph.incoming(self.graph.node(edge.target))
        return f.both(*(_at(other) for other in incoming if other is not edge))

    def kept(self, edge: TokenEdge) -> Formula:
        """The edge holds a token that stays on it."""
        return f.both(_at(edge), f.negate(self.taken(edge)))

    # -- ends of regions -------------------------------------------------------------------

    def cleared(self, region: str, members: set[str]) -> Formula:
        """Something ends the region or interrupts what ``members`` (node ids) are in."""
        ends = [
            self.complete(ACTIVITY_REGION),
            *(
                f.both(f.var(around.run), self.complete(around.id))
                for around in self.graph.regions_around(region)
            ),
            *self._interruptions(region, members),
        ]
        return f.either(*ends)

    def _interruptions(self, region: str, members: set[str]) -> Iterator[Formula]:
        around = {node.id for node in self.graph.regions_around(region)}
        for interruptible in self.graph.interruptibles:
            nodes = set(interruptible.nodes)
            if members <= nodes or around & nodes:
                yield self.interrupted(interruptible)

    def interrupted(self, interruptible: Interruptible) -> Formula:
        """A token enters an interrupting edge of the region."""
        entering = [e for e in self.graph.edges if e.interrupts == interruptible.id]
        return f.either(*map(self.arrives, entering))

    def arrives(self, edge: TokenEdge) -> Formula:
        """The edge gets a token; for a branch that is chosen this is seen in the next step."""
        if not self.is_chosen(edge):
            return self.given(edge)
        return f.both(self.given(edge), f.primed(_at(edge)), f.negate(self.kept(edge)))

    def begins(self, region: str) -> Formula:
        """The region starts in the next step."""
        if region == ACTIVITY_REGION:
            return self.complete(region)
        node = self.graph.node(region)
        return f.both(self.waits(node), f.negate(self.cleared(node.region, {node.id})))


def _at(edge: TokenEdge) -> Formula:
    return f.var(edge.variable)


def _is_else(edge: TokenEdge) -> bool:
    return edge.guard is not None and edge.guard.condition is None


def _may_choose(branches: list[TokenEdge], node: TokenNode) -> bool:
    """Whether more than one branch may be open at the same time."""
    if node.firing is not Firing.CHOICE:
        return False
    others = [branch for branch in branches if _is_else(branch)]
    stated = len(branches) - len(others)
    return len(others) > 1 or (stated > 1 and not node.exclusive)


# -- guarantees --------------------------------------------------------------------------------


def _starts(graph: TokenGraph) -> Iterator[Conjunct]:
    for edge in graph.edges:
        is_marked = edge.marked and edge.region == ACTIVITY_REGION
        value = _at(edge) if is_marked else f.negate(_at(edge))
        verb = "starts with a token" if is_marked else "has no token at the start"
        yield Conjunct(value, Class.INIT, edge.origin, f"{_capital(edge.label)} {verb}.")
    for node in graph.workers():
        text = f"At the start {node.label} is not running."
        yield Conjunct(f.negate(f.var(node.run)), Class.INIT, node.origin, text)


def _edge_update(game: _Game, edge: TokenEdge) -> Conjunct:
    moves = f.both(
        f.either(game.given(edge), game.kept(edge)),
        f.negate(game.cleared(edge.region, {edge.source, edge.target})),
    )
    held = f.either(f.both(game.begins(edge.region), _constant(edge.marked)), moves)
    return Conjunct(_next(edge.variable, held), Class.SAFETY, edge.origin, _edge_text(game, edge))


def _constant(value: bool) -> Formula:
    return f.TRUE if value else f.FALSE


def _next(variable: str, value: Formula) -> Formula:
    return f.iff(f.primed(f.var(variable)), value)


def _edge_text(game: _Game, edge: TokenEdge) -> str:
    source, target = game.graph.node(edge.source), game.graph.node(edge.target)
    given = f"{source.label} gives one"
    if edge.marked:
        around = [node.label for node in game.graph.regions_around(edge.region)]
        given = f"{next(iter(around), 'the activity')} starts"
    when = f" and its guard {edge.guard.text} holds" if edge.guard else ""
    return (
        f"{_capital(edge.label)} gets a token when {given}{when}, and keeps it "
        f"until {target.label} takes it."
    )


def _choice(game: _Game, node: TokenNode) -> Iterator[Conjunct]:
    """Each branch is updated as far as the guards say; one token goes to one open branch."""
    branches = game.graph.outgoing(node)
    for edge in branches:
        yield from _branch_update(game, edge)
    cleared = game.cleared(node.region, {node.id})
    fires = f.both(game.waits(node), f.either(*map(game.opened, branches)), f.negate(cleared))
    arrives = [f.both(f.primed(_at(e)), f.negate(game.kept(e))) for e in branches]
    none_twice = [
        f.negate(f.both(one, other))
        for index, one in enumerate(arrives)
        for other in arrives[index + 1 :]
    ]
    text = f"The token that {node.label} gives goes to exactly one branch whose guard holds."
    one = f.implies(fires, f.both(f.either(*arrives), *none_twice))
    yield Conjunct(one, Class.SAFETY, node.origin, text)


def _branch_update(game: _Game, edge: TokenEdge) -> Iterator[Conjunct]:
    after, cleared = f.primed(_at(edge)), game.cleared(edge.region, {edge.source, edge.target})
    begins = f.both(game.begins(edge.region), _constant(edge.marked))
    may = f.either(begins, f.both(f.either(game.given(edge), game.kept(edge)), f.negate(cleared)))
    must = f.either(begins, f.both(game.kept(edge), f.negate(cleared)))
    text = _edge_text(game, edge)
    yield Conjunct(f.implies(after, may), Class.SAFETY, edge.origin, text)
    yield Conjunct(f.implies(must, after), Class.SAFETY, edge.origin, text)


def _run_update(game: _Game, node: TokenNode) -> Conjunct:
    run = f.var(node.run)
    goes_on = f.either(game.waits(node), f.both(run, f.negate(game.done(node))))
    cleared = game.cleared(node.region, {node.id})
    value = f.both(goes_on, f.negate(cleared))
    until = "for one step" if node.duration is Duration.PULSE else "until it is done"
    text = f"{_capital(node.label)} runs from when all its flows have brought a token {until}."
    return Conjunct(_next(node.run, value), Class.SAFETY, node.origin, text)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _progress(game: _Game) -> Iterator[Conjunct]:
    graph = game.graph
    if graph.finishes:
        text = f"{_capital(graph.label)} finishes again and again."
        yield Conjunct(game.complete(ACTIVITY_REGION), Class.LIVENESS, graph.activity, text)
        return
    for entry in endless_entries(graph):
        text = f"{_capital(entry.label)} is reached again and again."
        reached = f.either(*map(_at, graph.incoming(entry)))
        yield Conjunct(reached, Class.LIVENESS, entry.origin, text)


# -- assumptions -------------------------------------------------------------------------------


def _assumptions(game: _Game) -> Iterator[Conjunct]:
    for node in game.graph.workers():
        if node.kind is NodeKind.ACTION and node.duration is Duration.TIMED and node.done:
            ended = f.either(f.negate(f.var(node.run)), node.done)
            text = f"Whenever {node.label} runs, the environment ends it sooner or later."
            yield Conjunct(ended, Class.LIVENESS, node.origin, text)
    for node in game.graph.nodes:
        yield from _answers(game, node)
    for loop in loops(game.graph):
        yield from _exits(game, loop)


def _answers(game: _Game, node: TokenNode) -> Iterator[Conjunct]:
    """A decision without an open branch keeps its token: one has to open sooner or later."""
    branches = game.graph.outgoing(node)
    if node.firing is not Firing.CHOICE or not branches or node.exhaustive:
        return
    opened = f.either(*map(game.opened, branches))
    answer = f.either(f.negate(game.waits(node)), opened)
    text = f"Whenever a token waits at {node.label}, one of its guards holds sooner or later."
    yield Conjunct(answer, Class.LIVENESS, node.origin, text)


def _exits(game: _Game, loop: Loop) -> Iterator[Conjunct]:
    graph = game.graph
    leaves = f.either(
        *(f.both(game.waits(graph.node(edge.source)), game.opened(edge)) for edge in loop.exits)
    )
    inside = [_at(e) for e in graph.edges if e.source in loop.nodes and e.target in loop.nodes]
    inside += [f.var(n.run) for n in graph.workers() if n.id in loop.nodes]
    nodes = [graph.node(edge.source) for edge in loop.exits]
    names = " or ".join(dict.fromkeys(node.label for node in nodes))
    guards = " or ".join(dict.fromkeys(e.guard.text for e in loop.exits if e.guard))
    text = (
        f"The loop through {names} is left sooner or later: whenever it goes on, "
        f"{guards} holds there at last."
    )
    left = f.either(f.both(*map(f.negate, inside)), leaves)
    yield Conjunct(left, Class.LIVENESS, nodes[0].origin, text)
