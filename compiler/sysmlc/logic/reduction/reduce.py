"""Contracts in GR(1): history bits for what games have no other words for.

The rules are those of ``reductions``.
"""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.logic.evaluate import has_primes
from sysmlc.logic.formula import Formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.history import History
from sysmlc.logic.reduction.rules import (
    NotReducibleError,
    Reduction,
    has_past,
    parts_of,
)

__all__ = [
    "NotReducibleError",
    "Reduced",
    "as_ltl",
    "is_plain",
    "is_reducible",
    "parts_of",
    "reduced",
    "remembering",
]


class Reduced(Struct, frozen=True):
    """A contract whose conjuncts are of GR(1), but for those in ``outside``, as they were."""

    contract: Contract
    outside: tuple[Conjunct, ...]


def reduced(contract: Contract) -> Reduced:
    """The contract in GR(1), with history bits of the system.

    Bits and what they follow stand behind everything else; their origin is the conjunct's. What is
    said otherwise keeps its formula as its text, if it had none.
    """
    history = History(variable.name for variable in contract.variables)
    outside: list[Conjunct] = []
    assumptions = tuple(_side(contract.assumptions, history, outside))
    guarantees = tuple(_side(contract.guarantees, history, outside))
    made = _with_bits(contract, assumptions, guarantees, history)
    return Reduced(made, tuple(outside))


def _side(
    conjuncts: Iterable[Conjunct], history: History, outside: list[Conjunct]
) -> Iterator[Conjunct]:
    for one in conjuncts:
        if one.class_ in (Class.INIT, Class.SAFETY) or is_plain(one):
            yield one
            continue
        try:
            parts = parts_of(as_ltl(one), history, one.origin)
        except NotReducibleError:
            outside.append(one)
            yield one
        else:
            text = one.text or print_formula(as_ltl(one))
            for class_, part in parts:
                yield replace(one, formula=part, class_=class_, text=text)


def is_plain(conjunct: Conjunct) -> bool:
    """Whether the conjunct is of GR(1) as it stands."""
    if conjunct.class_ is Class.LIVENESS:
        return not has_primes(conjunct.formula)
    return conjunct.class_ is not Class.OTHER


def as_ltl(conjunct: Conjunct) -> Formula:
    """The conjunct with the temporal operators that its class stands for."""
    if conjunct.class_ is Class.SAFETY:
        return f.always(conjunct.formula)
    if conjunct.class_ is Class.LIVENESS:
        return f.always(f.eventually(conjunct.formula))
    return conjunct.formula


def remembering(contract: Contract) -> Contract:
    """The contract with history bits for its operators of the past.

    Raises NotReducibleError when the past is one of something that is yet to come.
    """
    history = History(variable.name for variable in contract.variables)

    def of(conjuncts: tuple[Conjunct, ...]) -> tuple[Conjunct, ...]:
        return tuple(
            replace(one, formula=Reduction(history, one.origin).present(one.formula))
            if has_past(one.formula)
            else one
            for one in conjuncts
        )

    assumptions, guarantees = of(contract.assumptions), of(contract.guarantees)
    return _with_bits(contract, assumptions, guarantees, history)


def _with_bits(
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
    """Whether a formula in LTL can be brought into GR(1)."""
    try:
        parts_of(formula, History(()))
    except NotReducibleError:
        return False
    return True
