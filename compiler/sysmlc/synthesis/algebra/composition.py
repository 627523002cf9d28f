"""Parallel composition: what the parts of a block keep together, and whether that is enough.

Parts run in step, each with the values of the others (thesis 2.2.1; Benveniste et al. 2018,
section 6). What a part assumes of the others is discharged by what they promise; what is left is
assumed by the composition.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Composite, Conjunct, Contract, Owner, Part, Variable
from sysmlc.synthesis.algebra.discharge import Open, discharge, outputs
from sysmlc.synthesis.algebra.fair_systems import Universe, observe_histories
from sysmlc.synthesis.algebra.refinement import Entailment, Failure
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.unrealizable.core import minimal_conflict


class Composition(Struct, frozen=True):
    """What became of a composition.

    ``contract`` is that of the parts together; ``open`` are the assumptions of parts that nothing
    discharges, ``failures`` what the whole promises and the parts do not keep, ``losses`` runs in
    which something that is sent is lost. Where there is no
    run in which all parts keep what they promise, ``conflict`` says what cannot be had together.
    """

    contract: Contract
    open: tuple[Open, ...] = ()
    failures: tuple[Failure, ...] = ()
    losses: tuple[Failure, ...] = ()
    conflict: tuple[Conjunct, ...] = ()


class DriverError(Exception):
    """Two parts decide the same variable."""

    def __init__(self, variable: str, parts: tuple[str, ...]) -> None:
        super().__init__(f"'{variable}' is decided by {' and '.join(parts)}")
        self.variable = variable
        self.parts = parts


def composition(composite: Composite, manager: Manager) -> Composition:
    """Compose the parts, in the environment of the whole where that has a contract.

    Without one, what parts assume of things that no part decides is assumed by the composition.
    Raises DriverError, DomainError, OutsideGr1Error, LimitError.
    """
    with manager.guard():
        return _composed(composite, manager)


def _composed(composite: Composite, manager: Manager) -> Composition:
    _one_driver_each(composite.parts)
    whole = composite.whole or _open_to_outside(composite)
    wiring = Contract("", "", (), composite.wiring, ())
    made = observe_histories((*(one.contract for one in composite.parts), wiring, whole))
    *contracts, joined, seen = made.contracts
    parts = tuple(_with(p, c) for p, c in zip(composite.parts, contracts, strict=True))
    universe = Universe(made.contracts, manager)
    inside = replace(composite, parts=parts, wiring=joined.assumptions)
    contract = _together(composite, whole)
    contradiction = _contradiction(inside, seen.assumptions, made.definitions, universe)
    if contradiction:
        return Composition(contract, conflict=contradiction)
    found = discharge(inside, (*seen.assumptions, *made.definitions), universe)
    runs = Entailment(universe, universe.system(found.facts))
    failures = tuple(_broken(seen.guarantees, runs))
    losses = tuple(_broken(composite.crowding, runs))
    return Composition(contract, found.open, failures, losses)


def _contradiction(
    composite: Composite,
    assumed: Sequence[Conjunct],
    definitions: Sequence[Conjunct],
    universe: Universe,
) -> tuple[Conjunct, ...]:
    """What of promises, wiring and assumptions no run keeps; nothing when some run keeps all."""
    promised = (one for part in composite.parts for one in part.contract.guarantees)
    every = tuple(dict.fromkeys((*assumed, *composite.wiring, *promised)))

    def is_impossible(some: Sequence[Conjunct]) -> bool:
        return not Entailment(universe, universe.system((*some, *definitions))).is_possible

    return minimal_conflict(every, is_impossible) if is_impossible(every) else ()


def _open_to_outside(composite: Composite) -> Contract:
    """The contract of a whole that has none: what parts assume of things that no part decides.

    What a part assumes may speak of its own outputs, too: only then has the environment to act.
    """
    inside = {name for part in composite.parts for name in outputs(part)}
    assumed = tuple(
        one
        for part in composite.parts
        for one in part.contract.assumptions
        if _is_of_outside(one, inside, outputs(part))
    )
    return Contract(composite.component, composite.origin, (), assumed, ())


def _is_of_outside(conjunct: Conjunct, inside: set[str], own: set[str]) -> bool:
    used = {one.name for one in f.variables(conjunct.formula)}
    return not used <= inside and not used & (inside - own)


def _with(part: Part, contract: Contract) -> Part:
    """The part with a contract in GR(1); its history bits are nobody's outputs."""
    return replace(part, contract=replace(contract, variables=part.contract.variables))


def _together(composite: Composite, whole: Contract) -> Contract:
    """What the parts promise, where the whole's assumptions hold."""
    promised = tuple(one for part in composite.parts for one in part.contract.guarantees)
    variables = _variables(composite.parts)
    kept = (*promised, *composite.wiring)
    return Contract(composite.component, composite.origin, variables, whole.assumptions, kept)


def _one_driver_each(parts: Sequence[Part]) -> None:
    deciding = Counter(name for part in parts for name in sorted(outputs(part)))
    for name, number in deciding.items():
        if number > 1:
            raise DriverError(name, tuple(one.name for one in parts if name in outputs(one)))


def _broken(wanted: Iterable[Conjunct], runs: Entailment) -> Iterator[Failure]:
    for conjunct in wanted:
        trace = runs.violation(conjunct)
        if trace is not None:
            yield Failure(conjunct, False, trace)


def _variables(parts: Sequence[Part]) -> tuple[Variable, ...]:
    """All variables; one that a part decides is the composition's own."""
    found: dict[str, Variable] = {}
    for one in (one for part in parts for one in part.contract.variables):
        if one.name not in found or one.owner is Owner.SYSTEM:
            found[one.name] = one
    return tuple(found.values())
