"""Conditions of moves: formulas in the terms of the contract for diagrams of moves.

The condition of a move must hold for the move's own values and must not hold for those of the other
moves; for impossible values it may do either. It is a disjunction of cases. A case generalises one
assignment: starting with all facts that are true of it, facts are dropped or weakened, the least
general first, as long as the remaining ones exclude the other moves. So the condition is
``xpos<xtarget`` instead of a list of cells.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import combinations
from sys import maxsize

from msgspec import Struct

from sysmlc.controllers.machine import Machine, Move
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
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.strategies.explicit_states import Answer, DraftMachine

MAX_CASES = 5_000
"""Cases in all conditions of a machine together; a machine with more of them is unreadable."""


Pair = frozenset[str]
"""Two compared variables, or one variable whose values in two steps are compared."""
_COMPARISONS = (Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE)


def build_machine(draft: DraftMachine, contract: Contract, max_cases: int = MAX_CASES) -> Machine:
    """Return the machine of a draft. Raises TooLargeError if its conditions have too many cases."""
    symbols = draft.strategy.symbols
    writer = _ConditionWriter(symbols, frozenset(_compared_pairs(contract)), max_cases)
    states = tuple(tuple(writer.moves(moves)) for moves in draft.states)
    variables = symbols.variables
    read_registers = writer.read_registers
    return Machine(
        tuple(variables[name] for name in draft.strategy.inputs),
        tuple(variables[name] for name in draft.strategy.outputs),
        tuple(variables[name] for name in draft.registers if name in read_registers),
        states,
    )


def _compared_pairs(contract: Contract) -> Iterator[Pair]:
    """Yield the pairs of variables that some conjunct compares."""
    stack = [conjunct.formula for conjunct in (*contract.assumptions, *contract.guarantees)]
    while stack:
        match stack.pop():
            case Apply(op, (left, right)) if op in _COMPARISONS:
                for left_variable in variables_of(left):
                    yield from (
                        Pair((left_variable.name, right_variable.name))
                        for right_variable in variables_of(right)
                    )
            case Apply(_, parts):
                stack += parts
            case _:
                pass


class _Fact(Struct, frozen=True):
    """A formula that is true of an assignment, with weaker alternatives."""

    formula: Formula
    alternatives: Sequence[Formula | Literal] = ()
    """Weaker formulas, the weakest first. Only the bound is stored of a formula ``x <= bound`` or
    ``x >= bound``, because wide integers have very many of them."""
    make_bound: Callable[[Literal], Formula] = Const
    """Creates the formula for a stored bound."""

    def weaker_formula(self, index: int) -> Formula:
        """Return the alternative at *index*."""
        alternative = self.alternatives[index]
        return alternative if isinstance(alternative, Formula) else self.make_bound(alternative)


class _ConditionWriter:
    """Writes the conditions of all moves of a machine."""

    def __init__(self, symbols: Symbols, pairs: frozenset[Pair], max_cases: int) -> None:
        self._symbols, self._manager = symbols, symbols.manager
        self._pairs, self._cases_left, self._max_cases = pairs, max_cases, max_cases
        self.read_registers: set[str] = set()
        """Registers that conditions or outputs read."""

    def moves(self, moves: Mapping[Answer, Node]) -> Iterator[Move]:
        """Yield the moves of a state with their conditions, which exclude one another.

        The conditions may overlap for values that are impossible in the state.
        """
        possible = self._manager.disjoin(moves.values())
        variables = self._variables_of(moves.values())
        for (output, state), condition in moves.items():
            forbidden = possible & ~condition
            when = either(*self._cover(condition, forbidden, variables))
            self.read_registers.update(
                variable.name
                for formula in (when, *output)
                for variable in variables_of(formula)
                if not variable.primed
            )
            yield Move(when, output, state)

    def _variables_of(self, nodes: Iterable[Node]) -> list[Var]:
        """Return the variables that the conditions of a state may read."""
        support = frozenset[str]().union(*map(self._manager.support, nodes))
        candidates = [
            Var(name, primed) for primed in (False, True) for name in self._symbols.variables
        ]
        return [
            variable
            for variable in candidates
            if not support.isdisjoint(self._symbols.bits(variable.name, variable.primed))
        ]

    def _cover(
        self, remaining: Node, forbidden: Node, variables: Sequence[Var]
    ) -> Iterator[Formula]:
        """Yield cases that together cover *remaining* and exclude *forbidden*."""
        bits = [
            bit
            for variable in variables
            for bit in self._symbols.bits(variable.name, variable.primed)
        ]
        while (values := self._manager.pick(remaining, bits)) is not None:
            self._cases_left -= 1
            self._manager.check("computing the conditions of the machine")
            if self._cases_left < 0:
                raise TooLargeError.of_number(
                    self._max_cases, "case", "in the conditions of the machine"
                )
            formula, case_node = self._generalise(self._decode(values, variables), forbidden)
            yield formula
            remaining = remaining & ~case_node

    def _decode(self, values: Mapping[str, bool], variables: Iterable[Var]) -> dict[Var, Literal]:
        values_by_step = {primed: self._symbols.decode(values, primed) for primed in (False, True)}
        return {variable: values_by_step[variable.primed][variable.name] for variable in variables}

    def _generalise(self, values: Mapping[Var, Literal], forbidden: Node) -> tuple[Formula, Node]:
        """Return a formula that is true of *values* and excludes *forbidden*, and its diagram.

        A fact is kept only if the facts kept so far, together with all facts after it, would admit
        forbidden values without it.
        """
        facts = list(self._facts(values))
        suffixes = self._suffix_conjunctions([fact.formula for fact in facts])
        formulas, condition = list[Formula](), self._manager.true
        for fact, later in zip(facts, suffixes, strict=True):
            excluded_now = condition & later & forbidden
            if excluded_now != self._manager.false:
                formula = self._weaken(fact, excluded_now)
                formulas.append(formula)
                condition = condition & self._symbols.bdd(formula)
        return both(*_merge_bounds(formulas)), condition

    def _suffix_conjunctions(self, formulas: Sequence[Formula]) -> list[Node]:
        """Return for each formula the conjunction of the formulas after it."""
        conjunctions = list[Node]()
        conjunction = self._manager.true
        for formula in reversed(formulas):
            conjunctions.append(conjunction)
            conjunction = conjunction & self._symbols.bdd(formula)
        return conjunctions[::-1]

    def _weaken(self, fact: _Fact, excluded: Node) -> Formula:
        """Return the weakest alternative of a fact that excludes all of *excluded*."""
        # Binary search: each alternative implies the ones before it.
        weakest, low, high = fact.formula, 0, len(fact.alternatives)
        while low < high:
            middle = (low + high) // 2
            candidate = fact.weaker_formula(middle)
            if excluded & self._symbols.bdd(candidate) == self._manager.false:
                weakest, high = candidate, middle
            else:
                low = middle + 1
        return weakest

    def _facts(self, values: Mapping[Var, Literal]) -> Iterator[_Fact]:
        """Yield the facts that are true of the assignment, the least general first."""
        integers = [variable for variable in values if self._is_number(variable)]
        for variable in integers:
            yield from self._bound_facts(variable, values[variable])
        yield from self._comparison_facts(integers, values)
        for variable, value in values.items():
            if isinstance(self._symbols.variables[variable.name].domain, BooleanDomain):
                yield _Fact(variable if value else negate(variable))
            elif variable not in integers:
                yield _Fact(eq(variable, Const(value)))

    def _is_number(self, variable: Var) -> bool:
        return isinstance(self._symbols.variables[variable.name].domain, IntegerDomain)

    def _bound_facts(self, variable: Var, value: Literal) -> Iterator[_Fact]:
        domain_values = domains.values(self._symbols.variables[variable.name].domain)
        index = domain_values.index(value)
        for op, weaker_bounds in (
            (Op.GE, domain_values[1:index]),
            (Op.LE, domain_values[-2:index:-1]),
        ):
            make_bound = partial(_bound, op, variable)
            # A domain's values may be a range of more than sys.maxsize elements, whose length
            # Python cannot compute.
            yield _Fact(make_bound(value), weaker_bounds[:maxsize], make_bound)

    def _comparison_facts(
        self, integers: Sequence[Var], values: Mapping[Var, Literal]
    ) -> Iterator[_Fact]:
        """Yield comparisons of integers, also of registers plus or minus one (counters)."""
        variables = self._symbols.variables
        pairs = [
            (left_variable, right_variable)
            for left_variable, right_variable in combinations(integers, 2)
            if left_variable.name == right_variable.name
            or Pair((left_variable.name, right_variable.name)) in self._pairs
        ]
        for shift in (-1, 1, 0):
            for left_variable, right_variable in pairs:
                if shift and (
                    left_variable.primed or variables[left_variable.name].owner is Owner.ENVIRONMENT
                ):
                    continue
                left, right = int(values[left_variable]) + shift, int(values[right_variable])
                op = Op.LT if left < right else Op.GT if left > right else Op.EQ
                weaker = (
                    ()
                    if op is Op.EQ
                    else (compare(Op.NE, _shift(left_variable, shift), right_variable),)
                )
                yield _Fact(compare(op, _shift(left_variable, shift), right_variable), weaker)


def _bound(op: Op, variable: Var, bound: Literal) -> Formula:
    return compare(op, variable, Const(bound))


def _shift(variable: Var, shift: int) -> Formula:
    if not shift:
        return variable
    return Apply(Op.ADD if shift > 0 else Op.SUB, (variable, Const(1)))


def _merge_bounds(facts: Sequence[Formula]) -> Iterator[Formula]:
    """Replace a lower and an upper bound that leave a single value by an equation."""
    all_facts = set(facts)
    for fact in facts:
        match fact:
            case Apply(Op.GE, (term, bound)) if compare(Op.LE, term, bound) in all_facts:
                yield eq(term, bound)
            case Apply(Op.LE, (term, bound)) if compare(Op.GE, term, bound) in all_facts:
                pass
            case _:
                yield fact
