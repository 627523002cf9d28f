"""Symbolic tableau of a formula in temporal logic (Clarke, Grumberg and Hamaguchi 1997).

Each temporal operator becomes a Boolean that predicts whether it holds from the present step on. A
step rule expands the operator, and a fairness condition excludes obligations that are postponed for
ever. The fair runs in which the encoding holds in the first step are those that satisfy the
formula. Operators of the past become history bits, which are deterministic.
"""

from collections.abc import Iterable

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Owner, Variable
from sysmlc.logic.formula import FUTURE, Apply, Formula, Op, Var, has_primes
from sysmlc.logic.identifiers import Names
from sysmlc.logic.reduction.contract_reduction import as_ltl, is_gr1
from sysmlc.logic.reduction.formula_reduction import FormulaReduction
from sysmlc.logic.reduction.history import History


class Tableau(Struct, frozen=True):
    """The encoding of a formula, with the variables and conjuncts that give it its meaning."""

    formula: Formula
    variables: tuple[Variable, ...]
    conjuncts: tuple[Conjunct, ...]


def build_tableau(formula: Formula, taken: tuple[str, ...]) -> Tableau:
    """Return the tableau of a formula; no new variable has a name in *taken*.

    Raises NotReducibleError if an operator of the past is applied to the future.
    """
    history = History(taken)
    present_and_future = FormulaReduction(history, "").replace_past(formula)
    encoder = _Encoder((*taken, *(variable.name for variable in history.variables)))
    encoded = encoder.encode(present_and_future)
    return Tableau(
        encoded,
        (*history.variables, *encoder.variables),
        (*history.conjuncts, *encoder.conjuncts),
    )


def encode_conjuncts(
    conjuncts: Iterable[Conjunct], names: Iterable[str]
) -> tuple[tuple[Variable, ...], tuple[Conjunct, ...]]:
    """Return the variables of tableaux, and the conjuncts with tableaux in place of general LTL.

    *names* are the variables of the conjuncts. Raises NotReducibleError like ``build_tableau``.
    """
    taken = tuple(names)
    variables: list[Variable] = []
    encoded: list[Conjunct] = []
    for conjunct in conjuncts:
        if is_gr1(conjunct):
            encoded.append(conjunct)
            continue
        tableau = build_tableau(
            as_ltl(conjunct), (*taken, *(variable.name for variable in variables))
        )
        variables += tableau.variables
        encoded.append(replace(conjunct, formula=tableau.formula, class_=Class.INIT))
        encoded += tableau.conjuncts
    return tuple(variables), tuple(encoded)


class _Encoder:
    """Encodes formulas and collects the variables and conjuncts of the tableau."""

    def __init__(self, taken: tuple[str, ...]) -> None:
        self._names = Names(*taken)
        self._bits: dict[Formula, Var] = {}
        self.variables: list[Variable] = []
        self.conjuncts: list[Conjunct] = []

    def encode(self, formula: Formula) -> Formula:
        """Return a formula without temporal operators and primes that is equivalent from now on."""
        if isinstance(formula, Apply) and formula.op in FUTURE:
            return self._encode_operator(formula.op, tuple(map(self.encode, formula.args)))
        if isinstance(formula, Apply) and formula.op in _CONNECTIVES:
            return Apply(formula.op, tuple(map(self.encode, formula.args)))
        return self._predict(formula) if has_primes(formula) else formula

    def _predict(self, step: Formula) -> Var:
        """Return the bit that is true exactly if *step*, a formula with primes, holds now."""
        if step not in self._bits:
            self._bits[step] = self._add_bit()
            self._restrict(f.iff(self._bits[step], step), Class.SAFETY)
        return self._bits[step]

    def _encode_operator(self, op: Op, args: tuple[Formula, ...]) -> Var:
        key = Apply(op, args)
        if key in self._bits:
            return self._bits[key]
        bit = self._bits[key] = self._add_bit()
        later, last = f.prime(bit), args[-1]
        match op:
            case Op.NEXT:
                self._restrict(f.iff(bit, f.prime(last)), Class.SAFETY)
            case Op.ALWAYS:
                self._restrict(f.iff(bit, f.both(last, later)), Class.SAFETY)
                self._restrict(f.either(bit, f.negate(last)), Class.LIVENESS)
            case Op.EVENTUALLY:
                self._restrict(f.iff(bit, f.either(last, later)), Class.SAFETY)
                self._restrict(f.either(f.negate(bit), last), Class.LIVENESS)
            case Op.UNTIL | Op.WEAK_UNTIL:
                self._restrict(f.iff(bit, f.either(last, f.both(args[0], later))), Class.SAFETY)
                fair = (
                    f.either(f.negate(bit), last)
                    if op is Op.UNTIL
                    else f.either(bit, f.negate(args[0]))
                )
                self._restrict(fair, Class.LIVENESS)
            case _:
                # Release: the last operand holds up to and including the first step of the first.
                self._restrict(f.iff(bit, f.both(last, f.either(args[0], later))), Class.SAFETY)
                self._restrict(f.either(bit, f.negate(last)), Class.LIVENESS)
        return bit

    def _add_bit(self) -> Var:
        bit = Var(self._names.new("foresight"))
        self.variables.append(Variable(bit.name, Owner.SYSTEM, BooleanDomain()))
        return bit

    def _restrict(self, formula: Formula, class_: Class) -> None:
        self.conjuncts.append(Conjunct(formula, class_, ""))


_CONNECTIVES = frozenset((Op.AND, Op.OR, Op.NOT, Op.IMPLIES, Op.IFF))
