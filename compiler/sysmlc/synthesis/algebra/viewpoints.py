"""Conjunction of viewpoints: a component that keeps several contracts, each where it assumes.

Requirements about one subject are viewpoints. Taken together they assume everything that any of
them assumes; a conjunction owes each viewpoint its promises as long as its own assumptions hold,
whatever becomes of the others' (Benveniste et al. 2018, section 6.3).
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
    """What one viewpoint assumes and promises."""

    name: str
    assumptions: tuple[Conjunct, ...]
    guarantees: tuple[Conjunct, ...]


def viewpoints(contract: Contract) -> tuple[Viewpoint, ...]:
    """The viewpoints of a contract, in the order in which they occur."""
    every = (*contract.assumptions, *contract.guarantees)
    names = dict.fromkeys(one.viewpoint for one in every if one.viewpoint)
    return tuple(
        Viewpoint(
            name,
            tuple(one for one in contract.assumptions if one.viewpoint == name),
            tuple(one for one in contract.guarantees if one.viewpoint == name),
        )
        for name in names
    )


def conjunction(contract: Contract) -> Contract:
    """The contract that owes each viewpoint what it promises where only its assumptions hold.

    The contract is in GR(1). Whether the assumptions of a viewpoint were broken is remembered in a
    variable of the component. Raises OutsideGr1Error where viewpoints that promise something again
    and again assume different things again and again.
    """
    views = viewpoints(contract)
    if len({_words(one.assumptions) for one in views}) < 2:
        return contract
    _check_liveness(views)
    names = Names(*(one.name for one in contract.variables))
    bits = [Var(names.new("broken")) if _can_break(view) else None for view in views]
    common = [one for one in contract.guarantees if not one.viewpoint]
    owed = [one for view, bit in zip(views, bits, strict=True) for one in _owed(view, bit)]
    return replace(
        contract,
        variables=(*contract.variables, *(_remembered(bit) for bit in bits if bit)),
        assumptions=tuple(_common(contract, views)),
        guarantees=(*common, *owed),
    )


def _words(conjuncts: Iterable[Conjunct]) -> frozenset[tuple[Class, Formula]]:
    return frozenset((one.class_, one.formula) for one in conjuncts)


def _check_liveness(views: Sequence[Viewpoint]) -> None:
    """Raise OutsideGr1Error where implications between recurrences differ: that is not GR(1)."""
    found: dict[frozenset[tuple[Class, Formula]], Conjunct] = {}
    for view in views:
        promised = [one for one in view.guarantees if one.class_ is Class.LIVENESS]
        if promised:
            found.setdefault(_words(_recurring(view)), promised[0])
    if len(found) > 1:
        why = "viewpoints that assume different things again and again are more than GR(1)"
        raise OutsideGr1Error(list(found.values())[1], why)


def _recurring(view: Viewpoint) -> Iterator[Conjunct]:
    return (one for one in view.assumptions if one.class_ is Class.LIVENESS)


def _common(contract: Contract, views: Sequence[Viewpoint]) -> Iterator[Conjunct]:
    """What is assumed by all; of what recurs that which promises to recur lean on."""
    yield from (one for one in contract.assumptions if not one.viewpoint)
    for view in views:
        if any(one.class_ is Class.LIVENESS for one in view.guarantees):
            yield from _recurring(view)
            return


def _remembered(bit: Var) -> Variable:
    return Variable(bit.name, Owner.SYSTEM, BooleanDomain())


def _can_break(view: Viewpoint) -> bool:
    return any(one.class_ is not Class.LIVENESS for one in view.assumptions)


def _owed(view: Viewpoint, broken: Var | None) -> Iterator[Conjunct]:
    """What the viewpoint promises, until its assumptions are broken; what remembers that."""
    if broken is None:
        yield from view.guarantees
        return
    after = f.primed(broken)
    first = _all(view.assumptions, Class.INIT)
    each = _all(view.assumptions, Class.SAFETY)
    now_broken = f.either(broken, f.negate(each))
    yield Conjunct(f.iff(broken, f.negate(first)), Class.INIT, "", "", view.name)
    yield Conjunct(f.iff(after, now_broken), Class.SAFETY, "", "", view.name)
    for one in view.guarantees:
        escape = after if one.class_ is Class.SAFETY else broken
        yield replace(one, formula=f.either(escape, one.formula))


def _all(conjuncts: Iterable[Conjunct], class_: Class) -> Formula:
    return f.both(*(one.formula for one in conjuncts if one.class_ is class_))
