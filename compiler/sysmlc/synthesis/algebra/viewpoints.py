"""Conjunction of viewpoints: one component satisfies several contracts, each under its own
assumptions.

Requirements about one subject are viewpoints. Merged into one contract they would assume everything
that any of them assumes. Their conjunction owes each viewpoint its guarantees as long as this
viewpoint's assumptions hold (Benveniste et al. 2018, section 6.3).
"""

from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Formula, Var
from sysmlc.logic.names import Names
from sysmlc.synthesis.games.game import OutsideGr1Error


class Viewpoint(Struct, frozen=True):
    """The assumptions and guarantees of one viewpoint."""

    name: str
    assumptions: tuple[Conjunct, ...]
    guarantees: tuple[Conjunct, ...]


def list_viewpoints(contract: Contract) -> tuple[Viewpoint, ...]:
    """Return the viewpoints of a contract, in the order of their first conjuncts."""
    conjuncts = (*contract.assumptions, *contract.guarantees)
    names = dict.fromkeys(conjunct.viewpoint for conjunct in conjuncts if conjunct.viewpoint)
    return tuple(
        Viewpoint(
            name,
            tuple(conjunct for conjunct in contract.assumptions if conjunct.viewpoint == name),
            tuple(conjunct for conjunct in contract.guarantees if conjunct.viewpoint == name),
        )
        for name in names
    )


def conjoin_viewpoints(contract: Contract) -> Contract:
    """Return the contract that owes each viewpoint its guarantees where only its own assumptions
    hold.

    The result is in GR(1); variables of the component record which assumptions were broken. Raises
    OutsideGr1Error if viewpoints with liveness guarantees have different liveness assumptions.
    """
    viewpoints = list_viewpoints(contract)
    if len({_formulas_of(viewpoint.assumptions) for viewpoint in viewpoints}) < 2:
        return contract
    _check_liveness(viewpoints)
    names = Names(*(one.name for one in contract.variables))
    bits = [
        Var(names.new("broken")) if _has_breakable_assumptions(viewpoint) else None
        for viewpoint in viewpoints
    ]
    common_guarantees = [one for one in contract.guarantees if not one.viewpoint]
    weakened = [
        one
        for viewpoint, bit in zip(viewpoints, bits, strict=True)
        for one in _weaken_guarantees(viewpoint, bit)
    ]
    return replace(
        contract,
        variables=(*contract.variables, *(_memory_variable(bit) for bit in bits if bit)),
        assumptions=tuple(_common_assumptions(contract, viewpoints)),
        guarantees=(*common_guarantees, *weakened),
    )


def _formulas_of(conjuncts: Iterable[Conjunct]) -> frozenset[tuple[Class, Formula]]:
    return frozenset((conjunct.class_, conjunct.formula) for conjunct in conjuncts)


def _check_liveness(viewpoints: Sequence[Viewpoint]) -> None:
    """Raise OutsideGr1Error if liveness assumptions differ: several such implications exceed
    GR(1).
    """
    first_guarantees: dict[frozenset[tuple[Class, Formula]], Conjunct] = {}
    for viewpoint in viewpoints:
        liveness_guarantees = [
            conjunct for conjunct in viewpoint.guarantees if conjunct.class_ is Class.LIVENESS
        ]
        if liveness_guarantees:
            first_guarantees.setdefault(
                _formulas_of(_liveness_assumptions(viewpoint)), liveness_guarantees[0]
            )
    if len(first_guarantees) > 1:
        reason = "viewpoints that assume different things again and again are more than GR(1)"
        raise OutsideGr1Error(list(first_guarantees.values())[1], reason)


def _liveness_assumptions(view: Viewpoint) -> Iterator[Conjunct]:
    return (conjunct for conjunct in view.assumptions if conjunct.class_ is Class.LIVENESS)


def _common_assumptions(contract: Contract, views: Sequence[Viewpoint]) -> Iterator[Conjunct]:
    """Yield the assumptions shared by all viewpoints, and the liveness assumptions that guarantees
    need.
    """
    yield from (conjunct for conjunct in contract.assumptions if not conjunct.viewpoint)
    for view in views:
        if any(conjunct.class_ is Class.LIVENESS for conjunct in view.guarantees):
            yield from _liveness_assumptions(view)
            return


def _memory_variable(bit: Var) -> Variable:
    return Variable(bit.name, Owner.SYSTEM, BooleanDomain())


def _has_breakable_assumptions(view: Viewpoint) -> bool:
    return any(conjunct.class_ is not Class.LIVENESS for conjunct in view.assumptions)


def _weaken_guarantees(view: Viewpoint, broken: Var | None) -> Iterator[Conjunct]:
    """Yield the guarantees, weakened by *broken*, and the conjuncts that define *broken*."""
    if broken is None:
        yield from view.guarantees
        return
    next_broken = f.prime(broken)
    first = _conjoin_class(view.assumptions, Class.INIT)
    safety = _conjoin_class(view.assumptions, Class.SAFETY)
    becomes_broken = f.either(broken, f.negate(safety))
    yield Conjunct(f.iff(broken, f.negate(first)), Class.INIT, "", "", view.name)
    yield Conjunct(f.iff(next_broken, becomes_broken), Class.SAFETY, "", "", view.name)
    for guarantee in view.guarantees:
        escape = next_broken if guarantee.class_ is Class.SAFETY else broken
        yield replace(guarantee, formula=f.either(escape, guarantee.formula))


def _conjoin_class(conjuncts: Iterable[Conjunct], class_: Class) -> Formula:
    return f.both(*(conjunct.formula for conjunct in conjuncts if conjunct.class_ is class_))
