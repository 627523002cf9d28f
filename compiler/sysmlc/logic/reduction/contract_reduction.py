"""Reduction of contracts to GR(1); ``formula_reduction`` has the rules for formulas."""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.logic.formula import Formula, has_past, has_primes
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.formula_reduction import (
    FormulaReduction,
    NotReducibleError,
    reduce_formula,
)
from sysmlc.logic.reduction.history import History, HistoryBit


class ReducedContract(Struct, frozen=True):
    """A contract whose conjuncts are in GR(1), except those in ``irreducible``, unchanged.

    ``bits`` are the history bits whose rules are the last guarantees.
    """

    contract: Contract
    irreducible: tuple[Conjunct, ...]
    bits: tuple[HistoryBit, ...] = ()


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
    return ReducedContract(extended, tuple(irreducible), tuple(history.bits))


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
    if conjunct.class_ is Class.LIVENESS:
        return not has_primes(conjunct.formula)
    return conjunct.class_ is not Class.OTHER


def as_ltl(conjunct: Conjunct) -> Formula:
    """Return the formula with the temporal operators that its class implies."""
    if conjunct.class_ is Class.SAFETY:
        return f.always(conjunct.formula)
    if conjunct.class_ is Class.LIVENESS:
        return f.always(f.eventually(conjunct.formula))
    return conjunct.formula


def add_history_bits(contract: Contract) -> Contract:
    """Return the contract with history bits in place of operators of the past.

    Raises NotReducibleError if an operator of the past is applied to the future.
    """
    history = History(variable.name for variable in contract.variables)
    assumptions = _replace_past(contract.assumptions, history)
    guarantees = _replace_past(contract.guarantees, history)
    return _extend(contract, assumptions, guarantees, history)


def _replace_past(conjuncts: Iterable[Conjunct], history: History) -> tuple[Conjunct, ...]:
    return tuple(
        replace(
            conjunct,
            formula=FormulaReduction(history, conjunct.origin).replace_past(conjunct.formula),
            wording=conjunct.wording or as_ltl(conjunct),
        )
        if has_past(conjunct.formula)
        else conjunct
        for conjunct in conjuncts
    )


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
