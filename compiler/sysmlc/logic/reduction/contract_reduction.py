"""Reduction of contracts to GR(1); ``formula_reduction`` has the rules for formulas."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.classification import add_temporal_operators, classify
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner, drop_trivial
from sysmlc.logic.formula import Apply, Formula, Op, Var, has_past, has_primes, variable_names
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.formula_reduction import (
    FormulaReduction,
    NotReducibleError,
    reduce_formula,
)
from sysmlc.logic.reduction.history import History, HistoryBit, list_history_bits
from sysmlc.logic.simplification import rebuild, substitute


class ReducedContract(Struct, frozen=True):
    """A contract whose conjuncts are in GR(1), except those in ``irreducible``, unchanged."""

    contract: Contract
    irreducible: tuple[Conjunct, ...]


def reduce_contract(contract: Contract) -> ReducedContract:
    """Return the contract in GR(1), with history bits as variables of the system.

    The bits and their rules follow all other variables and guarantees, with the origin of the
    conjunct that needs them. A conjunct without a text gets its original formula as text.
    """
    history = History(variable.name for variable in contract.variables)
    irreducible: list[Conjunct] = []
    assumptions = tuple(_reduce_conjuncts(contract.assumptions, history, irreducible))
    guarantees = tuple(_reduce_conjuncts(contract.guarantees, history, irreducible))
    extended = _extend(contract, assumptions, guarantees, history)
    if list_history_bits(extended):
        extended = state_assumptions_of_inputs(extended)
    return ReducedContract(extended, tuple(irreducible))


def state_assumptions_of_inputs(contract: Contract) -> Contract:
    """Return the contract in which no safety assumption is about the next value of a history bit.

    The rule of the bit replaces it. An assumption about inputs and history bits of one step is
    stated for the first step and for each next step, so that it is evaluated when the environment
    chooses the inputs. As a condition on the present step, solvers of games evaluate it a step
    late, when the system has already had to answer.
    """
    bits = {bit.name: bit for bit in list_history_bits(contract)}
    starts = {name: f.const(bit.start) for name, bit in bits.items()}
    decided = {item.name for item in contract.variables if item.owner is Owner.ENVIRONMENT}
    decided |= bits.keys()
    assumptions: list[Conjunct] = []
    for conjunct in contract.assumptions:
        if conjunct.class_ is Class.INIT:
            first = substitute(conjunct.formula, starts)
            assumptions.append(replace(conjunct, formula=first))
        elif conjunct.class_ is Class.SAFETY:
            for part in _split_step(conjunct.formula):
                step = part
                if not has_primes(part) and variable_names(part) <= decided:
                    first = substitute(part, starts)
                    assumptions.append(replace(conjunct, formula=first, class_=Class.INIT))
                    step = f.prime(part)
                assumptions.append(replace(conjunct, formula=_replace_next_bits(step, bits)))
        else:
            assumptions.append(conjunct)
    return replace(contract, assumptions=drop_trivial(assumptions))


def _split_step(formula: Formula) -> Iterator[Formula]:
    """Yield the conjuncts of a condition on one step or two."""
    match formula:
        case Apply(Op.AND, args):
            for arg in args:
                yield from _split_step(arg)
        case Apply(Op.NOT, (Apply(Op.OR, args),)):
            for arg in args:
                yield from _split_step(f.negate(arg))
        case Apply(Op.NOT, (Apply(Op.IMPLIES, (left, right)),)):
            yield from _split_step(left)
            yield from _split_step(f.negate(right))
        case Apply(Op.IMPLIES, (left, right)):
            for part in _split_step(right):
                yield f.implies(left, part)
        case _:
            yield formula


def _replace_next_bits(formula: Formula, bits: Mapping[str, HistoryBit]) -> Formula:
    match formula:
        case Var(name, True) if name in bits:
            return _replace_next_bits(bits[name].rule, bits)
        case Apply(op, args):
            return rebuild(op, tuple(_replace_next_bits(arg, bits) for arg in args))
        case _:
            return formula


def _reduce_conjuncts(
    conjuncts: Iterable[Conjunct], history: History, irreducible: list[Conjunct]
) -> Iterator[Conjunct]:
    for conjunct in conjuncts:
        if is_gr1(conjunct):
            yield conjunct
            continue
        try:
            parts = reduce_formula(as_ltl(conjunct), history, conjunct.origin)
        except NotReducibleError:
            irreducible.append(conjunct)
            yield conjunct
        else:
            text = conjunct.text or print_formula(as_ltl(conjunct))
            for class_, part in parts:
                yield replace(conjunct, formula=part, class_=class_, text=text)


def is_gr1(conjunct: Conjunct) -> bool:
    """Whether the conjunct is in GR(1) as it is."""
    if has_past(conjunct.formula):
        return False
    if conjunct.class_ is Class.LIVENESS:
        return not has_primes(conjunct.formula)
    return conjunct.class_ is not Class.OTHER


def as_ltl(conjunct: Conjunct) -> Formula:
    """Return the formula with the temporal operators that its class implies."""
    return add_temporal_operators(conjunct.class_, conjunct.formula)


def add_history_bits(contract: Contract, taken: Iterable[str] = ()) -> Contract:
    """Return the contract with history bits in place of operators of the past.

    No bit has a name in *taken*, or that of a variable. Raises NotReducibleError if an operator of
    the past is applied to the future.
    """
    history = History((*taken, *(variable.name for variable in contract.variables)))
    assumptions = tuple(_replace_past(contract.assumptions, history))
    guarantees = tuple(_replace_past(contract.guarantees, history))
    return _extend(contract, assumptions, guarantees, history)


def _replace_past(conjuncts: Iterable[Conjunct], history: History) -> Iterator[Conjunct]:
    for conjunct in conjuncts:
        if not has_past(conjunct.formula):
            yield conjunct
            continue
        reduction = FormulaReduction(history, conjunct.origin)
        formula = reduction.replace_past(conjunct.formula)
        is_general = conjunct.class_ is Class.OTHER
        for class_, part in classify(formula) if is_general else ((conjunct.class_, formula),):
            wording = conjunct.wording or as_ltl(conjunct)
            yield replace(conjunct, formula=part, class_=class_, wording=wording)


def _extend(
    contract: Contract,
    assumptions: tuple[Conjunct, ...],
    guarantees: tuple[Conjunct, ...],
    history: History,
) -> Contract:
    return replace(
        contract,
        variables=(*contract.variables, *history.variables),
        assumptions=assumptions,
        guarantees=(*guarantees, *history.conjuncts),
    )


def is_reducible(formula: Formula) -> bool:
    """Whether a formula in LTL can be reduced to GR(1)."""
    try:
        reduce_formula(formula, History(()))
    except NotReducibleError:
        return False
    return True
