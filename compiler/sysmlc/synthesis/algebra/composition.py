"""Combination of contracts: parallel composition of parts, and conjunction of viewpoints.

Parts run in step and read each other's values (thesis 2.2.1; Benveniste et al. 2018, section 6).
Guarantees of the other parts discharge the assumptions of a part; the composition assumes the rest.

Requirements about one subject are viewpoints. One contract with all their conjuncts would guarantee
something only where the assumptions of all viewpoints hold. Their conjunction guarantees more: each
viewpoint's guarantees wherever the assumptions of this viewpoint hold (Benveniste et al. 2018,
section 6.3).
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Composite,
    Conjunct,
    Contract,
    Owner,
    Part,
    Variable,
    select_classes,
)
from sysmlc.logic.formula import Formula, Var
from sysmlc.logic.identifiers import Names
from sysmlc.synthesis.algebra.discharge import OpenAssumption, discharge, outputs_of
from sysmlc.synthesis.algebra.fair_systems import Universe, observe_histories
from sysmlc.synthesis.algebra.refinement import Entailment, Failure
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.unrealizable import find_minimal_conflict


class Composition(Struct, frozen=True):
    """The result of a composition.

    ``open`` contains the assumptions of parts that neither other parts nor the whole entail,
    ``failures`` the guarantees of the whole that the parts violate, ``losses`` the runs in which a
    sent event is lost. If no run satisfies the guarantees of all parts, ``conflict`` is a minimal
    set of contradicting conjuncts. ``undecided`` has the variables that guarantees of the whole are
    about although no part decides them; these guarantees are not checked.
    """

    open: tuple[OpenAssumption, ...] = ()
    failures: tuple[Failure, ...] = ()
    losses: tuple[Failure, ...] = ()
    conflict: tuple[Conjunct, ...] = ()
    undecided: tuple[str, ...] = ()


class DriverError(Exception):
    """Reports that two parts assign the same variable."""

    def __init__(self, variable: str, parts: tuple[str, ...]) -> None:
        super().__init__(f"'{variable}' is decided by {' and '.join(parts)}")
        self.variable = variable
        self.parts = parts


def compose_parts(composite: Composite, manager: Manager) -> Composition:
    """Compose the parts in the environment that the contract of the whole assumes.

    If the whole has no contract, the composition assumes what its parts assume about variables that
    no part assigns. Raises DriverError, DomainError, OutsideGr1Error, LimitError.
    """
    with manager.guard():
        return _compose(composite, manager)


def _compose(composite: Composite, manager: Manager) -> Composition:
    _check_drivers(composite.parts)
    whole = composite.whole or _contract_with_environment(composite)
    wiring = Contract("", "", (), composite.wiring, ())
    # One call for all contracts, so that equal formulas outside GR(1) share their history bits.
    observed = observe_histories((*(part.contract for part in composite.parts), wiring, whole))
    *contracts, wiring_contract, whole_contract = observed.contracts
    # The variables stay, because history bits are outputs of no part.
    parts = tuple(
        replace(part, contract=replace(reduced, variables=part.contract.variables))
        for part, reduced in zip(composite.parts, contracts, strict=True)
    )
    universe = Universe(observed.contracts, manager)
    reduced_composite = replace(composite, parts=parts, wiring=wiring_contract.assumptions)
    # A contradiction entails everything, so no assumption would stay open (decision 31).
    contradiction = _find_contradiction(
        reduced_composite, whole_contract.assumptions, observed.definitions, universe
    )
    if contradiction:
        return Composition(conflict=contradiction)
    assumed = (*whole_contract.assumptions, *observed.definitions)
    endings = _find_possible_endings(reduced_composite, assumed, universe)
    discharge_result = discharge(reduced_composite, (*assumed, *endings), universe)
    runs = Entailment(universe, universe.system(discharge_result.facts))
    undecided = _find_undecided(composite, whole_contract)
    demands = [
        conjunct
        for conjunct in _list_demands(whole_contract)
        if undecided.isdisjoint(f.variable_names(conjunct.formula))
    ]
    failures = tuple(_find_violations(demands, runs))
    losses = tuple(_find_violations(composite.exclusions, runs))
    # The environment ends what no part ends: such an assumption of the compiler is no demand on
    # those who wrote the model. Where another part decides the end, it has to come.
    decided = {name for part in parts for name in outputs_of(part)}
    open_assumptions = tuple(
        assumption
        for assumption in discharge_result.open
        if not assumption.conjunct.is_derived
        or not _list_inputs(assumption.part, assumption.conjunct).isdisjoint(decided)
    )
    guaranteed = f.variable_names(*(conjunct.formula for conjunct in whole_contract.guarantees))
    return Composition(
        open_assumptions,
        failures,
        losses,
        undecided=tuple(sorted(guaranteed & undecided)),
    )


def _find_possible_endings(
    composite: Composite, assumed: Sequence[Conjunct], universe: Universe
) -> tuple[Conjunct, ...]:
    """Return the derived assumptions of the parts: actions end, and loops are left.

    Ends that another part decides are left out, because that part has to bring them about. The
    result is empty if no run of the parts satisfies all of them.
    """
    decided = {name for part in composite.parts for name in outputs_of(part)}
    endings = tuple(
        conjunct
        for part in composite.parts
        for conjunct in part.contract.assumptions
        if conjunct.is_derived and _list_inputs(part, conjunct).isdisjoint(decided)
    )
    guarantees = (conjunct for part in composite.parts for conjunct in part.contract.guarantees)
    conjuncts = (*assumed, *composite.wiring, *guarantees, *endings)
    return endings if Entailment(universe, universe.system(conjuncts)).is_possible else ()


def _list_demands(whole: Contract) -> list[Conjunct]:
    """List the guarantees of the whole without the initial values of declarations."""
    is_required = any(not conjunct.is_derived for conjunct in whole.guarantees)
    return [
        conjunct
        for conjunct in whole.guarantees
        if not (is_required and conjunct.is_derived and conjunct.class_ is Class.INIT)
    ]


def _find_undecided(composite: Composite, whole: Contract) -> set[str]:
    """Return the variables of the whole that no part decides: nothing restricts them here."""
    variables = () if composite.whole is None else composite.whole.variables
    decided = {name for part in composite.parts for name in outputs_of(part)}
    outputs = {variable.name for variable in variables if variable.owner is Owner.SYSTEM}
    return outputs - decided - _list_defined_names(whole)


def _list_inputs(part: Part, conjunct: Conjunct) -> set[str]:
    """Return the variables of an assumption that the part itself does not decide."""
    return f.variable_names(conjunct.formula) - outputs_of(part)


def _list_defined_names(whole: Contract) -> set[str]:
    """Return the variables that derived conjuncts define, such as history bits."""
    return {
        variable.name
        for conjunct in whole.guarantees
        if conjunct.is_derived and conjunct.class_ is Class.SAFETY
        for variable in f.variables(conjunct.formula)
        if variable.primed
    }


def _find_contradiction(
    composite: Composite,
    assumptions: Sequence[Conjunct],
    definitions: Sequence[Conjunct],
    universe: Universe,
) -> tuple[Conjunct, ...]:
    """Return a minimal set of guarantees, wiring and assumptions that no run satisfies together.

    The result is empty if some run satisfies all of them.
    """
    guarantees = (conjunct for part in composite.parts for conjunct in part.contract.guarantees)
    conjuncts = tuple(dict.fromkeys((*assumptions, *composite.wiring, *guarantees)))

    def is_impossible(subset: Sequence[Conjunct]) -> bool:
        return not Entailment(universe, universe.system((*subset, *definitions))).is_possible

    return find_minimal_conflict(conjuncts, is_impossible) if is_impossible(conjuncts) else ()


def _contract_with_environment(composite: Composite) -> Contract:
    """Return a contract for a whole that has none: the parts' assumptions about the environment.

    These assumptions read a variable that no part assigns, and besides it only outputs of their own
    part: an environment may be assumed to react to a part.
    """
    inner_names = {name for part in composite.parts for name in outputs_of(part)}
    assumptions = tuple(
        conjunct
        for part in composite.parts
        for conjunct in part.contract.assumptions
        if _is_about_outside(conjunct, inner_names, outputs_of(part))
    )
    return Contract(composite.component, composite.origin, (), assumptions, ())


def _is_about_outside(conjunct: Conjunct, inner_names: set[str], own_names: set[str]) -> bool:
    names = f.variable_names(conjunct.formula)
    return not names <= inner_names and not names & (inner_names - own_names)


def _check_drivers(parts: Sequence[Part]) -> None:
    driver_counts = Counter(name for part in parts for name in sorted(outputs_of(part)))
    for name, count in driver_counts.items():
        if count > 1:
            raise DriverError(name, tuple(part.name for part in parts if name in outputs_of(part)))


def _find_violations(conjuncts: Iterable[Conjunct], runs: Entailment) -> Iterator[Failure]:
    for conjunct in conjuncts:
        trace = runs.find_violation(conjunct)
        if trace is not None:
            yield Failure(conjunct, False, trace)


# -- conjunction of viewpoints -----------------------------------------------------------------


class Viewpoint(Struct, frozen=True):
    """The assumptions and guarantees of one viewpoint."""

    name: str
    assumptions: tuple[Conjunct, ...]
    guarantees: tuple[Conjunct, ...]


def _list_viewpoints(contract: Contract) -> tuple[Viewpoint, ...]:
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
    """Return the contract whose guarantees of each viewpoint depend on its own assumptions only.

    The result is in GR(1); additional outputs record which viewpoints' assumptions were broken.
    Raises OutsideGr1Error if viewpoints with liveness guarantees have different liveness
    assumptions.
    """
    viewpoints = _list_viewpoints(contract)
    if len({_formulas_of(viewpoint.assumptions) for viewpoint in viewpoints}) < 2:
        return contract
    _check_liveness(viewpoints)
    names = Names(*(variable.name for variable in contract.variables))
    bits = [
        Var(names.new("broken"))
        if len(select_classes(viewpoint.assumptions, Class.LIVENESS)) < len(viewpoint.assumptions)
        else None
        for viewpoint in viewpoints
    ]
    memory = (Variable(bit.name, Owner.SYSTEM, BooleanDomain()) for bit in bits if bit)
    common_guarantees = [conjunct for conjunct in contract.guarantees if not conjunct.viewpoint]
    weakened = [
        conjunct
        for viewpoint, bit in zip(viewpoints, bits, strict=True)
        for conjunct in _weaken_guarantees(viewpoint, bit)
    ]
    return replace(
        contract,
        variables=(*contract.variables, *memory),
        assumptions=tuple(_common_assumptions(contract, viewpoints)),
        guarantees=(*common_guarantees, *weakened),
    )


def _formulas_of(conjuncts: Iterable[Conjunct]) -> frozenset[tuple[Class, Formula]]:
    return frozenset((conjunct.class_, conjunct.formula) for conjunct in conjuncts)


def _check_liveness(viewpoints: Sequence[Viewpoint]) -> None:
    """Raise OutsideGr1Error if viewpoints with liveness guarantees assume different liveness.

    GR(1) is a single implication between liveness conditions, so it cannot express one for each
    viewpoint.
    """
    first_guarantees: dict[frozenset[tuple[Class, Formula]], Conjunct] = {}
    for viewpoint in viewpoints:
        liveness_guarantees = select_classes(viewpoint.guarantees, Class.LIVENESS)
        if liveness_guarantees:
            assumed = _formulas_of(select_classes(viewpoint.assumptions, Class.LIVENESS))
            first_guarantees.setdefault(assumed, liveness_guarantees[0])
    if len(first_guarantees) > 1:
        reason = "viewpoints that assume different things again and again are more than GR(1)"
        raise OutsideGr1Error(list(first_guarantees.values())[1], reason)


def _common_assumptions(contract: Contract, views: Sequence[Viewpoint]) -> Iterator[Conjunct]:
    """Yield the assumptions of no viewpoint, and the liveness assumptions of the viewpoints."""
    yield from (conjunct for conjunct in contract.assumptions if not conjunct.viewpoint)
    # `_check_liveness` has made sure that all viewpoints with liveness guarantees have the same
    # liveness assumptions, so those of the first one are enough.
    for view in views:
        if select_classes(view.guarantees, Class.LIVENESS):
            yield from select_classes(view.assumptions, Class.LIVENESS)
            return


def _weaken_guarantees(view: Viewpoint, broken: Var | None) -> Iterator[Conjunct]:
    """Yield the viewpoint's guarantees, each required only while the bit *broken* is false.

    The conjuncts that define *broken* come first: it is set by the first violation of an initial
    or safety assumption of the viewpoint, and stays set.
    """
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
        # A safety guarantee is about a step and the next one. The violation of an assumption in the
        # same step already releases from it, as in a game (docs/synthesis.md, strict implication).
        escape = next_broken if guarantee.class_ is Class.SAFETY else broken
        yield replace(guarantee, formula=f.either(escape, guarantee.formula))


def _conjoin_class(conjuncts: Iterable[Conjunct], class_: Class) -> Formula:
    return f.both(*(conjunct.formula for conjunct in select_classes(conjuncts, class_)))
