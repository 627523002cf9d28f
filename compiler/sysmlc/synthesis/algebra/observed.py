"""Contracts in GR(1): what is outside is said with history bits that observe the run."""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.reduction.history import History
from sysmlc.logic.reduction.reduce import NotReducibleError, as_ltl, is_plain, parts_of
from sysmlc.synthesis.games.game import OutsideGr1Error


class Observed(Struct, frozen=True):
    """Contracts over shared history bits."""

    contracts: tuple[Contract, ...]
    definitions: tuple[Conjunct, ...]
    """What the bits follow: true of every run, and no restriction of any."""


def observed(contracts: Iterable[Contract]) -> Observed:
    """The contracts with history bits where they are needed.

    Raises OutsideGr1Error for a conjunct that no known reduction brings into GR(1).
    """
    given = tuple(contracts)
    history = History(one.name for contract in given for one in contract.variables)
    sides = [
        (tuple(_parts(one.assumptions, history)), tuple(_parts(one.guarantees, history)))
        for one in given
    ]
    made = tuple(
        replace(
            contract,
            variables=(*contract.variables, *history.variables),
            assumptions=assumed,
            guarantees=promised,
        )
        for contract, (assumed, promised) in zip(given, sides, strict=True)
    )
    return Observed(made, tuple(history.conjuncts))


def _parts(conjuncts: Iterable[Conjunct], history: History) -> Iterator[Conjunct]:
    for one in conjuncts:
        if is_plain(one):
            yield one
            continue
        try:
            parts = parts_of(as_ltl(one), history, one.origin)
        except NotReducibleError as problem:
            raise OutsideGr1Error(one, str(problem)) from None
        yield from (replace(one, formula=part, class_=class_) for class_, part in parts)
