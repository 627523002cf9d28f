"""Contracts of random activities admit the runs of the drawing, and no others."""

import random

import pytest
from drawn_activities import (
    BODIES,
    GUARDS,
    WORKS,
    Listener,
    Pencil,
    Writer,
    following,
    is_over,
    start,
)
from msgspec.structs import replace

from long_runs import quick_first
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic import domains, evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Class, Contract, Owner
from sysmlc.logic.formula import has_primes
from sysmlc.passes import pipeline
from sysmlc.synthesis.algebra.fair_systems import Universe
from sysmlc.synthesis.bdd.manager import Manager

ROUNDS = 10
EACH = 36
STEPS = 25


def contract_of(drawing):
    """The contract, or None where the compiler says that a second token may come."""
    graph, sink = parse_text(drawing.text()), Sink()
    pipeline.run(graph, sink)
    found = graph.derived(Contract)
    assert found or {diagnostic.rule.code for diagnostic in sink} & {"SM454", "SM455"}
    return found[0] if found else None


class Named:
    """The variables of a contract, by what is drawn."""

    def __init__(self, drawing, contract):
        self.drawing = drawing
        self.contract = contract
        self.own = {one.name: one for one in contract.variables if one.owner is Owner.SYSTEM}
        self.inputs = [one for one in contract.variables if one.owner is Owner.ENVIRONMENT]

    def state(self, tokens):
        """The values of what the component decides."""
        return {name: self._value(one, tokens) for name, one in self.own.items()}

    def _value(self, one, tokens):
        if one.origin in self.drawing.flows:
            return one.origin in tokens.at
        if one.origin in dict(tokens.values):
            return dict(tokens.values)[one.origin]
        unseen = f"at_{one.origin}_to_{one.origin}"
        if one.name == unseen:
            (flow,) = (id for id in self.drawing.unseen if self.drawing.flows[id][0] == one.origin)
            return flow in tokens.at
        if one.origin in self.drawing.nodes:
            assert self.drawing.nodes[one.origin] in WORKS
            return one.origin in tokens.running
        return is_over(self.drawing, tokens)

    def said(self, values):
        """What inputs say in the words of the drawing."""
        return {
            one.name if one.name[0] == "g" else one.origin
            for one in self.inputs
            if values[one.name] is True
        }


class Steps:
    """The steps that the guarantees of a contract admit, counted on decision diagrams."""

    def __init__(self, named):
        self.own = list(named.own)
        self.manager = Manager()
        universe = Universe([named.contract], self.manager)
        self.symbols = universe.symbols
        parts = {class_: [] for class_ in Class}
        for one in named.contract.guarantees:
            parts[one.class_].append((has_primes(one.formula), universe.node(one)))
        always = [node for is_step, node in parts[Class.SAFETY] if not is_step]
        self.starts = [*always, *(node for _, node in parts[Class.INIT])]
        # What is said of one step holds in the next one, too.
        self.steps = [node for is_step, node in parts[Class.SAFETY] if is_step]
        self.steps += map(self.symbols.prime, always)

    def first(self):
        """The only state in which the contract lets the component begin."""
        return self._only(self._all(self.starts, {}), primed=False)

    def after(self, now):
        """All states that may follow."""
        bits = {bit: v for name, value in now.items() for bit, v in self._code(name, value)}
        return self._only(self._all(self.steps, bits), primed=True)

    def _code(self, name, value):
        return self.symbols.code(name, value).items()

    def _all(self, nodes, bits):
        found = self.manager.true
        for node in nodes:
            found = found & self.manager.assign(node, bits)
        return found

    def _only(self, node, primed):
        bits = self.symbols.all_bits(self.own, primed)
        assert self.manager.support(node) <= {*bits}
        found = []
        while (chosen := self.manager.pick(node, bits)) is not None:
            found.append(self.symbols.decode(chosen, primed))
            node = node & ~self.manager.cube(chosen)
        return found


def agreed(seed, pencil=Pencil):
    """Whether the contract of a random activity could be compared; fails where it differs."""
    drawing = pencil(seed).drawn()
    contract = contract_of(drawing)
    if contract is None:
        return False
    named, dice = Named(drawing, contract), random.Random(seed)
    steps, tokens = Steps(named), start(drawing)
    assert steps.first() == [named.state(tokens)]
    for _ in range(STEPS):
        inputs = {one.name: dice.random() < 0.6 for one in named.inputs}
        # What nothing assigns is the environment's, which may leave it as it is.
        inputs |= {name: value for name, value in tokens.values if name in inputs}
        now = {**named.state(tokens), **inputs}
        ways = following(drawing, tokens, named.said(inputs))
        expected = [named.state(one) for one in ways]
        assert in_order(steps.after(now)) == in_order(expected), drawing.text()
        tokens = dice.choice(sorted(ways, key=str))
    return True


@pytest.mark.parametrize("part", quick_first(range(4)))
def test_the_reference_interpreter_does_what_these_contracts_admit(part):
    for seed in range(part * EACH, (part + 1) * EACH):
        graph = parse_text(Writer(seed).drawn().text())
        pipeline.run(graph, Sink())
        for tokens in graph.derived(TokenGraph):
            (contract,) = graph.derived(Contract)
            played(tokens, contract, random.Random(seed))


def played(tokens, contract, dice):
    state, inputs = token_game.initial_state(tokens), [v for v in contract.variables if is_input(v)]
    for _ in range(STEPS):
        now = {one.name: dice.choice(domains.values(one.domain)) for one in inputs}
        now |= token_game.values_of(tokens, state)
        state = token_game.next_state(
            tokens, state, now, evaluate.is_true, lambda _, ways: dice.choice(ways)
        )
        then = {**now, **token_game.values_of(tokens, state)}
        for one in contract.guarantees:
            if one.class_ is Class.SAFETY:
                assert evaluate.is_true(one.formula, now, then), one.text


def is_input(variable):
    return variable.owner is Owner.ENVIRONMENT


def in_order(states):
    """States once each: what no guard reads may differ in more than the contract speaks of."""
    return sorted({tuple(sorted(one.items())) for one in states})


@pytest.mark.parametrize("part", quick_first(range(ROUNDS)))
def test_contracts_of_activities_admit_what_the_drawing_does_and_nothing_else(part):
    compared = [agreed(seed) for seed in range(part * EACH, (part + 1) * EACH)]
    assert compared.count(True) > EACH * 0.85


@pytest.mark.parametrize("part", quick_first(range(ROUNDS)))
def test_contracts_follow_what_actions_assign_as_the_drawing_says(part):
    compared = [agreed(seed, Writer) for seed in range(part * EACH, (part + 1) * EACH)]
    assert compared.count(True) > EACH * 0.85


@pytest.mark.parametrize("part", quick_first(range(ROUNDS)))
def test_accept_actions_listen_from_when_a_token_enters_their_region(part):
    compared = [agreed(seed, Listener) for seed in range(part * EACH, (part + 1) * EACH)]
    assert compared.count(True) > EACH * 0.6


def test_regions_are_entered_again_and_within_one_another():
    drawings = [Listener(seed).drawn() for seed in range(ROUNDS * EACH)]
    assert sum(len(one.regions) > 0 for one in drawings) > 100
    nested = [
        one
        for one in drawings
        if any(a < b for a in one.regions.values() for b in one.regions.values())
    ]
    assert len(nested) > 10


def test_all_that_may_be_assigned_and_read_is_compared():
    drawings = [Writer(seed).drawn() for seed in range(ROUNDS * EACH)]
    bodies = [body for one in drawings for body in one.bodies.values()]
    assert min(bodies.count(body) for body in BODIES) > 20
    guards = [guard for one in drawings for _, _, guard in one.flows.values()]
    assert min(guards.count(guard) for guard in GUARDS) > 20


def test_more_than_three_hundred_activities_of_all_kinds_are_compared():
    kinds = [kind for seed in range(ROUNDS * EACH) for kind in Pencil(seed).drawn().nodes.values()]
    assert ROUNDS * EACH * 0.85 > 300
    for kind in (*WORKS, "value", "fork", "join", "decision", "merge", "object", "flow-final"):
        assert kinds.count(kind) > 20, kind


@pytest.mark.parametrize("hurt", ["drop", "weaken"])
def test_a_contract_that_says_something_else_is_noticed(hurt, monkeypatch):
    whole = contract_of

    def hurt_contract(drawing):
        found = whole(drawing)
        return None if found is None else HURTS[hurt](found)

    monkeypatch.setitem(globals(), "contract_of", hurt_contract)
    noticed = 0
    for seed in range(20):
        try:
            agreed(seed)
        except AssertionError:
            noticed += 1
    assert noticed > 15


def without_last(contract):
    """A contract that forgets one of its rules for steps."""
    steps = [one for one in contract.guarantees if one.class_ is Class.SAFETY]
    kept = tuple(one for one in contract.guarantees if one is not steps[-1])
    return replace(contract, guarantees=kept)


def with_weaker(contract):
    """A contract in which an equivalence is an implication only."""

    def weaker(one):
        match one.formula:
            case f.Apply(f.Op.IFF, (left, right)):
                return replace(one, formula=f.implies(left, right))
        return one

    return replace(contract, guarantees=tuple(map(weaker, contract.guarantees)))


HURTS = {"drop": without_last, "weaken": with_weaker}
