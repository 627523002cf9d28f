"""Conditions in words of the contract: formulas for diagrams over registers and inputs.

A condition has to hold for some values, must not hold for others (those of the other moves), and
is free for the rest. From one value all that is true of it is taken, what is special first, and
left out where the rest suffices: ``xpos<xtarget`` rather than the cells for which that is so.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import combinations
from sys import maxsize

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.contract import BooleanDomain, Contract, IntegerDomain, Owner
from sysmlc.logic.formula import (
    Apply,
    Const,
    Formula,
    Literal,
    Op,
    Var,
    both,
    compare,
    either,
    eq,
    negate,
)
from sysmlc.logic.formula import variables as variables_of
from sysmlc.synthesis.bdd.limits import TooLargeError
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.skolem_functions import least
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.controllers.explicit_states import Answer, Draft
from sysmlc.synthesis.controllers.mealy import Machine, Move

MOST_CASES = 5_000
"""Alternatives in all conditions of a machine: more are no explicit machine any more."""


Pair = frozenset[str]
"""Two variables that a contract compares, or one whose values of two steps may be."""


def machine(draft: Draft, contract: Contract, most: int = MOST_CASES) -> Machine:
    """The machine of a draft. Raises TooLargeError when its conditions have too many cases."""
    symbols = draft.strategy.symbols
    writer = _Writer(symbols, frozenset(compared(contract)), most)
    states = tuple(tuple(writer.moves(moves)) for moves in draft.states)
    variables = symbols.variables
    spoken = writer.spoken
    return Machine(
        tuple(variables[name] for name in draft.strategy.inputs),
        tuple(variables[name] for name in draft.strategy.outputs),
        tuple(variables[name] for name in draft.registers if name in spoken),
        states,
    )


def compared(contract: Contract) -> Iterator[Pair]:
    """The variables that some conjunct compares with one another."""
    waiting = [one.formula for one in (*contract.assumptions, *contract.guarantees)]
    while waiting:
        match waiting.pop():
            case Apply(op, (left, right)) if op in _COMPARING:
                for one in variables_of(left):
                    yield from (Pair((one.name, other.name)) for other in variables_of(right))
            case Apply(_, parts):
                waiting += parts
            case _:
                pass


_COMPARING = (Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE)


class _Fact(Struct, frozen=True):
    """Something that is true of some values."""

    formula: Formula
    looser: Sequence[Formula | Literal] = ()
    """The same with other bounds, the furthest one first, or the bounds alone."""
    bounded: Callable[[Literal], Formula] = Const
    """The same with a bound."""

    def loosened(self, at: int) -> Formula:
        """The fact with one of the bounds."""
        found = self.looser[at]
        return found if isinstance(found, Formula) else self.bounded(found)


class _Writer:
    def __init__(self, symbols: Symbols, pairs: frozenset[Pair], most: int) -> None:
        self._symbols, self._manager = symbols, symbols.manager
        self._pairs, self._left, self._most = pairs, most, most
        self.spoken: set[str] = set()
        """Registers that conditions or outputs name."""

    def moves(self, moves: Mapping[Answer, Node]) -> Iterator[Move]:
        """The moves of a state; at most one condition holds for what can happen."""
        everything = self._manager.false
        for node in moves.values():
            everything = everything | node
        variables = self._variables(moves.values())
        for (output, state), node in moves.items():
            forbidden = everything & ~node
            when = either(*self._cases(node, forbidden, variables))
            self.spoken.update(
                one.name
                for formula in (when, *output)
                for one in variables_of(formula)
                if not one.primed
            )
            yield Move(when, output, state)

    def _variables(self, nodes: Iterable[Node]) -> list[Var]:
        """What the conditions of a state may be about."""
        support = frozenset[str]().union(*map(self._manager.support, nodes))
        known = [Var(name, primed) for primed in (False, True) for name in self._symbols.variables]
        return [
            one for one in known if not support.isdisjoint(self._symbols.bits(one.name, one.primed))
        ]

    def _cases(self, node: Node, forbidden: Node, variables: Sequence[Var]) -> Iterator[Formula]:
        bits = [bit for one in variables for bit in self._symbols.bits(one.name, one.primed)]
        while (values := least(self._manager, node, bits)) is not None:
            self._left -= 1
            self._manager.check("writing the conditions of a machine")
            if self._left < 0:
                raise TooLargeError("cases in the conditions of the machine", f"{self._most:,}")
            formula, where = self._case(self._known(values, variables), forbidden)
            yield formula
            node = node & ~where

    def _known(self, values: Mapping[str, bool], variables: Iterable[Var]) -> dict[Var, Literal]:
        now = {primed: self._symbols.decode(values, primed) for primed in (False, True)}
        return {one: now[one.primed][one.name] for one in variables}

    def _case(self, known: Mapping[Var, Literal], forbidden: Node) -> tuple[Formula, Node]:
        """What is true of some values, without what is not needed to tell them apart."""
        facts = list(self._facts(known))
        rest = self._rest([fact.formula for fact in facts])
        kept, where = list[Formula](), self._manager.true
        for fact, later in zip(facts, rest, strict=True):
            without = where & later & forbidden
            if without != self._manager.false:
                formula = self._loosened(fact, without)
                kept.append(formula)
                where = where & self._symbols.bdd(formula)
        return both(*_exact(kept)), where

    def _rest(self, formulas: Sequence[Formula]) -> list[Node]:
        """For each formula the conjunction of those behind it."""
        found = list[Node]()
        after = self._manager.true
        for formula in reversed(formulas):
            found.append(after)
            after = after & self._symbols.bdd(formula)
        return found[::-1]

    def _loosened(self, fact: _Fact, without: Node) -> Formula:
        """The fact, with the bound that is furthest and still keeps out what has to be kept out."""
        found, low, high = fact.formula, 0, len(fact.looser)
        while low < high:
            middle = (low + high) // 2
            bound = fact.loosened(middle)
            if without & self._symbols.bdd(bound) == self._manager.false:
                found, high = bound, middle
            else:
                low = middle + 1
        return found

    def _facts(self, known: Mapping[Var, Literal]) -> Iterator[_Fact]:
        """What is true of some values, what is least general first."""
        numbers = [one for one in known if self._is_number(one)]
        for one in numbers:
            yield from self._bounds(one, known[one])
        yield from self._comparisons(numbers, known)
        for one, value in known.items():
            if isinstance(self._symbols.variables[one.name].domain, BooleanDomain):
                yield _Fact(one if value else negate(one))
            elif one not in numbers:
                yield _Fact(eq(one, Const(value)))

    def _is_number(self, one: Var) -> bool:
        return isinstance(self._symbols.variables[one.name].domain, IntegerDomain)

    def _bounds(self, one: Var, value: Literal) -> Iterator[_Fact]:
        known = domains.values(self._symbols.variables[one.name].domain)
        place = known.index(value)
        for op, looser in ((Op.GE, known[1:place]), (Op.LE, known[-2:place:-1])):
            bounded = partial(_bounded, op, one)
            yield _Fact(bounded(value), looser[:maxsize], bounded)

    def _comparisons(self, numbers: Sequence[Var], known: Mapping[Var, Literal]) -> Iterator[_Fact]:
        """Numbers that are compared, and what registers are when they have counted."""
        of = self._symbols.variables
        pairs = [
            (one, other)
            for one, other in combinations(numbers, 2)
            if one.name == other.name or Pair((one.name, other.name)) in self._pairs
        ]
        for shift in (-1, 1, 0):
            for one, other in pairs:
                if shift and (one.primed or of[one.name].owner is Owner.ENVIRONMENT):
                    continue
                left, right = int(known[one]) + shift, int(known[other])
                op = Op.LT if left < right else Op.GT if left > right else Op.EQ
                looser = () if op is Op.EQ else (compare(Op.NE, _shifted(one, shift), other),)
                yield _Fact(compare(op, _shifted(one, shift), other), looser)


def _bounded(op: Op, one: Var, bound: Literal) -> Formula:
    return compare(op, one, Const(bound))


def _shifted(one: Var, shift: int) -> Formula:
    if not shift:
        return one
    return Apply(Op.ADD if shift > 0 else Op.SUB, (one, Const(1)))


def _exact(facts: Sequence[Formula]) -> Iterator[Formula]:
    """Two bounds that leave one value are an equation."""
    known = set(facts)
    for fact in facts:
        match fact:
            case Apply(Op.GE, (one, bound)) if compare(Op.LE, one, bound) in known:
                yield eq(one, bound)
            case Apply(Op.LE, (one, bound)) if compare(Op.GE, one, bound) in known:
                pass
            case _:
                yield fact
