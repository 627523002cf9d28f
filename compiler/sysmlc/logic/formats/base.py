"""What readers and writers of all forms share: sections, and what is reduced to be said."""

from collections.abc import Callable, Iterator

from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formats.file import NotExpressibleError
from sysmlc.logic.formats.lower import TooManyValuesError
from sysmlc.logic.formats.spelt import Spelling
from sysmlc.logic.formula import Formula, variables
from sysmlc.logic.reduction.contract_reduction import is_gr1, reduce_contract

SECTIONS = {
    (side, class_): side if class_ is Class.OTHER else f"{class_} {side}"
    for side in ("assumptions", "guarantees")
    for class_ in Class
}
"""What messages call the conjuncts of one side and class."""


def of_class(contract: Contract, side: str, class_: Class) -> Iterator[Conjunct]:
    """The conjuncts of one side (``assumptions``, ``guarantees``) and class."""
    found = contract.assumptions if side == "assumptions" else contract.guarantees
    return (one for one in found if one.class_ is class_)


def conjuncts_of(contract: Contract, owner: Owner, class_: Class) -> Iterator[Conjunct]:
    """The conjuncts that one side promises: the environment assumptions, the system guarantees."""
    side = "assumptions" if owner is Owner.ENVIRONMENT else "guarantees"
    return of_class(contract, side, class_)


def game(
    contract: Contract, form: str, *, primed_liveness: bool = False, apart: bool = False
) -> Contract:
    """The contract in GR(1) as games know it, with history bits for what needs them.

    ``primed_liveness`` says that the form's goals may speak of the next step, ``apart`` that each
    side's initial conditions speak of its own variables alone. Raises NotExpressibleError for
    the first conjunct that cannot be said.
    """
    conjuncts = (*contract.assumptions, *contract.guarantees)
    is_game = all(_is_game(one, primed_liveness) for one in conjuncts)
    made = contract if is_game else reduce_contract(contract).contract
    for one in (*made.assumptions, *made.guarantees):
        if not _is_game(one, primed_liveness):
            raise NotExpressibleError(form, "no reduction to GR(1) is known for it", one)
    _check_owners(made, form, apart)
    return made


def _is_game(conjunct: Conjunct, primed_liveness: bool) -> bool:
    return is_gr1(conjunct) or (primed_liveness and conjunct.class_ is Class.LIVENESS)


def _check_owners(contract: Contract, form: str, apart: bool) -> None:
    owners = {variable.name: variable.owner for variable in contract.variables}
    for owner in Owner if apart else ():
        for one in conjuncts_of(contract, owner, Class.INIT):
            if any(owners[variable.name] is not owner for variable in variables(one.formula)):
                raise NotExpressibleError(form, "at the start each side speaks of its own", one)
    for one in contract.assumptions:
        ahead = [v.name for v in variables(one.formula) if v.primed]
        if one.class_ is Class.SAFETY and any(owners[name] is Owner.SYSTEM for name in ahead):
            raise NotExpressibleError(form, "it assumes what the system does next", one)


def said(form: str, text: Callable[[Formula], str], conjunct: Conjunct) -> str:
    """The conjunct's formula as text. Raises NotExpressibleError."""
    try:
        return text(conjunct.formula)
    except KeyError as error:
        raise NotExpressibleError(form, f"there is no word for {error}", conjunct) from None


def said_ltl(form: str, spelling: Spelling, conjunct: Conjunct) -> str:
    """The conjunct with the temporal operators of its class. Raises NotExpressibleError."""
    return said(form, lambda formula: spelling.ltl(formula, conjunct.class_), conjunct)


def lowered(contract: Contract, form: str, steps: Callable[[Contract], Contract]) -> Contract:
    """The contract with fewer words (``logic.lower``). Raises NotExpressibleError."""
    try:
        return steps(contract)
    except TooManyValuesError as error:
        raise NotExpressibleError(form, str(error), error.conjunct) from None


OWNERS = {"env": Owner.ENVIRONMENT, "sys": Owner.SYSTEM}
