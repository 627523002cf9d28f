"""What games about a contract show: winning by waiting, by force, and for want of fairness."""

from collections.abc import Callable, Iterable, Iterator

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Formula, Var
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.algebra.fair import Runs
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.games.game import make_game
from sysmlc.synthesis.games.solve import solve
from sysmlc.synthesis.lints import rules
from sysmlc.synthesis.lints.runs import all_steps
from sysmlc.synthesis.lints.words import Remark, timely

NewManager = Callable[[], Manager]
_TRIED = 40
"""Assumptions that are tried one by one to say which is to blame."""


def of_games(contract: Contract, new: NewManager) -> Iterator[Remark]:
    """Remarks about how a contract is won or lost; every game has a manager of its own."""
    if not is_won(contract, new):
        yield from _fairness(contract, new)
    elif _recurs((*contract.assumptions, *contract.guarantees)) and is_won(_idle(contract), new):
        yield Remark(rules.IDLE)
    elif _recurs(contract.assumptions) and _recurs(contract.guarantees):
        yield from _needless(contract, new)
    if is_forced(contract, new):
        yield Remark(rules.NOT_SEPARATED, said=_culprits(contract, new))


def is_won(contract: Contract, new: NewManager) -> bool:
    """Whether some component keeps the contract."""
    return solve(make_game(contract, new()), is_complete=False).is_realizable


def _needless(contract: Contract, new: NewManager) -> Iterator[Remark]:
    """That what recurs is brought about although nothing that is assumed recurs."""
    left = tuple(one for one in contract.assumptions if one.class_ is not Class.LIVENESS)
    if is_won(replace(contract, assumptions=left), new):
        yield Remark(rules.NEEDLESS)


def _recurs(conjuncts: Iterable[Conjunct]) -> bool:
    return any(one.class_ is Class.LIVENESS for one in conjuncts)


def _idle(contract: Contract) -> Contract:
    """The same, with all outputs as they are."""
    outputs = [one.name for one in contract.variables if one.owner is Owner.SYSTEM]
    frames = (f.eq(Var(name, primed=True), Var(name)) for name in outputs)
    same = tuple(Conjunct(one, Class.SAFETY, contract.origin) for one in frames)
    return replace(contract, guarantees=(*contract.guarantees, *same))


# -- fairness ----------------------------------------------------------------------------------


def _fairness(contract: Contract, new: NewManager) -> Iterator[Remark]:
    """An assumption that would make a lost contract one that is kept."""
    safe = tuple(one for one in contract.guarantees if one.class_ is not Class.LIVENESS)
    if len(safe) == len(contract.guarantees) or not is_won(replace(contract, guarantees=safe), new):
        return
    for wanted in _recurring(contract):
        more = Conjunct(wanted, Class.LIVENESS, contract.origin)
        helped = replace(contract, assumptions=(*contract.assumptions, more))
        if is_won(helped, new) and not is_forced(helped, new):
            text = f", for instance if '{print_formula(wanted)}' recurred"
            yield Remark(rules.NO_FAIRNESS, said=text)
            return


def _recurring(contract: Contract) -> Iterator[Formula]:
    for variable in contract.variables:
        if variable.owner is Owner.ENVIRONMENT:
            yield from _states(variable)


def _states(variable: Variable) -> Iterator[Formula]:
    match variable.domain:
        case BooleanDomain():
            yield f.var(variable.name)
            yield f.negate(f.var(variable.name))
        case IntegerDomain():
            return
        case domain:
            for value in values(domain):
                yield f.eq(f.var(variable.name), f.const(value))


# -- separation --------------------------------------------------------------------------------


def is_forced(contract: Contract, new: NewManager) -> bool:
    """Whether the component, keeping its safety, can make the assumptions fail from somewhere.

    Klein and Pnueli (2010), Maoz and Ringert (2016): it wins although what it owes is impossible.
    They let it break its own safety too, which a component that wins may not.
    """
    never = Conjunct(f.FALSE, Class.LIVENESS, contract.origin)
    safe = tuple(one for one in contract.guarantees if one.class_ is not Class.LIVENESS)
    game = make_game(timely(replace(contract, guarantees=(*safe, never))), new())
    reachable = Runs(all_steps(game)).reachable
    return reachable & solve(game).winning != game.manager.false


def _culprits(contract: Contract, new: NewManager) -> str:
    """Assumptions without which the others cannot be broken by force, in words."""
    if len(contract.assumptions) > _TRIED:
        return ""
    found = [one for one in contract.assumptions if not is_forced(_without(contract, one), new)]
    texts = ", ".join(f"'{print_formula(one.formula)}'" for one in found)
    return f"; not without {texts}" if texts else ""


def _without(contract: Contract, conjunct: Conjunct) -> Contract:
    left = tuple(one for one in contract.assumptions if one is not conjunct)
    return replace(contract, assumptions=left)
