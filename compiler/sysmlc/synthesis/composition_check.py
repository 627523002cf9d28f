"""Checks of blocks with parts: whether the parts fit together and keep the guarantees of the block.

Parts without a common variable, directly or through other parts, do not affect one another. They
are composed separately, because the composition of a line of forty machines would be too large.
"""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic import formula as f
from sysmlc.logic.basis import Basis, find_basis
from sysmlc.logic.contract import Class, Composite, Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula
from sysmlc.logic.region_formulas import print_worded
from sysmlc.support.disjoint_sets import DisjointSets
from sysmlc.synthesis.algebra.composition import Composition, DriverError, compose_parts
from sysmlc.synthesis.algebra.discharge import OpenAssumption
from sysmlc.synthesis.algebra.fair_systems import DomainError
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.decision import Options, Place
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.rules import DEPENDS
from sysmlc.synthesis.witnesses import (
    Party,
    Witness,
    describe_problem,
    describe_run,
    manager_factory,
    report_failure,
    text_in_parentheses,
)

OPEN = rule(
    "SM595",
    "part-assumption-open",
    Severity.ERROR,
    "part '{part}' of '{component}' assumes '{formula}', which neither the other parts nor "
    "the block's assumptions guarantee{context}",
    help=(
        "let another part guarantee it, let the block assume it, or remove the assumption; the "
        "run shows a counterexample"
    ),
)
CIRCLE = rule(
    "SM596",
    "parts-wait-for-one-another",
    Severity.WARNING,
    "part '{part}' of '{component}' assumes '{formula}', which other parts guarantee "
    "only in response to it{context}",
    help="let one of the parts guarantee its side without that assumption",
)
BREAK = rule(
    "SM597",
    "parts-break-whole",
    Severity.ERROR,
    "the parts of '{component}' together do not guarantee '{formula}'{context}",
    help="let a part guarantee more, or the block less; the run shows a counterexample",
)
CONTRADICT = rule(
    "SM548",
    "parts-contradict",
    Severity.ERROR,
    "no run satisfies the guarantees of all parts of '{component}'{within}",
    help="change one of the guarantees, or the connections of the parts",
)
LOST = rule(
    "SM506",
    "sent-in-one-step",
    Severity.WARNING,
    "in '{component}' two messages are sent in one step, and one of them is lost{context}",
    help="send the second message only after the first was accepted; the run shows an example",
)
NOT_COMPOSED = rule(
    "SM598",
    "parts-not-composed",
    Severity.WARNING,
    "the composition of the parts of '{component}' is not decided: {reason}",
    help="give more time (--question-limit), or use known property patterns",
)


class CompositionVerdict(Struct, frozen=True):
    """The result for one block with parts."""

    component: str
    parts: int
    behaviours: int
    """How many of the parts are behaviours of the block itself."""
    has_whole: bool
    """Whether the block itself guarantees something."""
    has_shared_variables: bool
    """Whether a part shares variables with another part or with the block."""
    is_satisfied: bool | None
    """Whether all assumptions of parts are discharged and the parts guarantee what the block
    guarantees; None if that is not decided."""
    witnesses: tuple[Witness, ...] = ()
    basis: Basis = Basis()
    """The ranges that are assumed in the contracts of the parts and of the block."""
    reason: str = ""
    """Why the composition is not decided, if it is not."""

    def text(self) -> str:
        """Return the verdict on one line."""
        # Parts that share no variables fit whatever the ranges are.
        is_about_values = self.has_shared_variables or not self.is_satisfied
        is_qualified = self.is_satisfied is not None and is_about_values
        within = self.basis.range_text if is_qualified else ""
        return f"{self.component}: {self._verdict()}{within}"

    def _verdict(self) -> str:
        if self.is_satisfied is None:
            return f"the composition of its parts is not decided: {self.reason}"
        if self.has_whole and self.has_shared_variables:
            if self.parts == 1:
                verb = "satisfies" if self.is_satisfied else "violates"
                return f"{self._describe_parts()} {verb} its contract"
            verb = "satisfy" if self.is_satisfied else "violate"
            return f"{self._describe_parts()} together {verb} its contract"
        if self.parts == 1:
            return f"{self._describe_parts()} {'fits' if self.is_satisfied else 'does not fit'}"
        if self.is_satisfied and not self.has_shared_variables:
            return f"{self._describe_parts()} share no variables"
        verb = "fit" if self.is_satisfied else "do not fit"
        return f"{self._describe_parts()} {verb} together"

    def _describe_parts(self) -> str:
        if self.parts == 1:
            return f"its {'behaviour' if self.behaviours else 'part'}"
        if not self.behaviours:
            return f"its {self.parts} parts"
        is_all = self.behaviours == self.parts
        return f"its {self.parts} {'behaviours' if is_all else 'parts and behaviours'}"


def check_compositions(
    composites: Iterable[Composite], place: Place, sink: Sink, options: Options
) -> Iterator[CompositionVerdict]:
    """Compose the parts of each block, report open assumptions and violations, yield verdicts."""
    for composite in composites:
        decided: list[tuple[Composite, Composition]] = []
        reasons: list[str] = []
        groups = _split_composite(composite)
        for group in groups:
            # A single part of a block without a contract has nothing to fit to.
            if len(group.parts) == 1 and group.whole is None:
                continue
            composition, reason = _compose(group, place, sink, options)
            decided += [] if composition is None else [(group, composition)]
            reasons += [reason] if reason else []
        is_broken = any(
            composition.open or composition.failures or composition.conflict
            for _, composition in decided
        )
        # A violation in one group is a verdict even if another group is undecided.
        is_satisfied = None if reasons and not is_broken else not is_broken
        witnesses = tuple(
            witness
            for group, composition in decided
            for witness in _build_witnesses(group, composition)
        )
        whole, has_shared = composite.whole, any(map(_shares_variables, groups))
        parts = [part for part in composite.parts if part.has_contract]
        has_whole = whole is not None and bool(whole.guarantees)
        yield CompositionVerdict(
            composite.component,
            len(parts),
            sum(part.is_behaviour for part in parts),
            has_whole,
            has_shared,
            is_satisfied,
            witnesses,
            find_basis(_list_contracts(composite)),
            "; ".join(dict.fromkeys(reasons)),
        )


def _compose(
    composite: Composite, place: Place, sink: Sink, options: Options
) -> tuple[Composition | None, str]:
    """Return the composition, if it was computed, and why something about it is not decided."""
    try:
        composition = compose_parts(composite, manager_factory(options)())
    except (OutsideGr1Error, DomainError, DriverError, LimitError) as problem:
        subject, reason = place(composite.origin), describe_problem(problem)
        sink.report(NOT_COMPOSED, subject, component=composite.component, reason=reason)
        return None, reason
    undecided = composition.undecided
    composition = _drop_doubtful(composite, composition, place, sink)
    reasons = list(composition.undecided[len(undecided) :])
    if composition.conflict:
        _report_conflict(composite, composition, place, sink)
    for assumption in _drop_repeated(composition.open):
        _report_open(composite, assumption, place, sink)
    for failure in composition.failures:
        subject = place(failure.conjunct.origin or composite.origin)
        report_failure(
            BREAK, failure, composite.component, subject, sink, _note_open_assumptions(composition)
        )
    for loss in composition.losses:
        report_failure(LOST, loss, composite.component, place(composite.origin), sink)
    if undecided:
        names = ", ".join(f"'{name}'" for name in undecided)
        reason = f"no part decides {names}, which guarantees of the block are about"
        reasons.append(reason)
        sink.report(
            NOT_COMPOSED,
            place(composite.origin),
            component=composite.component,
            reason=reason,
            help="let a part assign the feature, or a behaviour of the block",
        )
    return composition, "; ".join(reasons)


def _list_contracts(composite: Composite) -> tuple[Contract, ...]:
    wiring = Contract("", "", (), (), composite.wiring)
    whole = () if composite.whole is None else (composite.whole,)
    return (*(part.contract for part in composite.parts), *whole, wiring)


def _drop_doubtful(
    composite: Composite, composition: Composition, place: Place, sink: Sink
) -> Composition:
    """Return the composition without runs that depend on conditions without formula; report them.

    Such a run need not be a run of the parts.
    """
    contracts = _list_contracts(composite)
    doubtful: dict[Conjunct, Basis] = {}
    open_conjuncts = (item.conjunct for item in composition.open if item.trace is not None)
    failures = (item.conjunct for item in (*composition.failures, *composition.losses))
    for conjunct in (*open_conjuncts, *failures):
        basis = find_basis(contracts, f.variable_names(conjunct.formula))
        if basis.conditions:
            doubtful[conjunct] = Basis(conditions=basis.conditions)
    for conjunct, basis in doubtful.items():
        formula = _print_formula(composite, conjunct)
        sink.report(
            DEPENDS,
            place(conjunct.origin or composite.origin),
            question=f"the parts of '{composite.component}' guarantee '{formula}'",
            reason=basis.reason,
        )
    return replace(
        composition,
        open=tuple(item for item in composition.open if item.conjunct not in doubtful),
        failures=tuple(item for item in composition.failures if item.conjunct not in doubtful),
        losses=tuple(item for item in composition.losses if item.conjunct not in doubtful),
        undecided=composition.undecided + tuple(b.reason for b in doubtful.values()),
    )


def _note_open_assumptions(composition: Composition) -> tuple[str, ...]:
    """Return a note that the guarantees of parts with open assumptions were not used."""
    names = " and ".join(
        dict.fromkeys(f"'{assumption.part.name}'" for assumption in composition.open)
    )
    if not names:
        return ()
    return (f"the guarantees of {names} were not used, because they depend on open assumptions",)


def _report_conflict(
    composite: Composite, composition: Composition, place: Place, sink: Sink
) -> None:
    names = {
        guarantee: part.name for part in composite.parts for guarantee in part.contract.guarantees
    }
    notes = (
        f"{names.get(conjunct, composite.component)}: "
        f"'{_print_formula(composite, conjunct)}'{text_in_parentheses(conjunct)}"
        for conjunct in composition.conflict
    )
    subject = place(composite.origin)
    within = find_basis(_list_contracts(composite)).range_text
    component = composite.component
    sink.report(CONTRADICT, subject, notes=tuple(notes), component=component, within=within)


def _drop_repeated(assumptions: Iterable[OpenAssumption]) -> Iterator[OpenAssumption]:
    """Yield the assumptions without those that repeat one about the first step for all others."""
    repeated: set[tuple[str, str, Formula]] = set()
    for assumption in assumptions:
        part, conjunct = assumption.part, assumption.conjunct
        if (part.name, conjunct.origin, conjunct.formula) not in repeated:
            yield assumption
        if conjunct.class_ is Class.INIT:
            repeated.add((part.name, conjunct.origin, f.prime(conjunct.formula)))


def _report_open(
    composite: Composite, assumption: OpenAssumption, place: Place, sink: Sink
) -> None:
    sink.report(
        CIRCLE if assumption.is_circular else OPEN,
        place(assumption.conjunct.origin or assumption.part.origin),
        notes=(
            *_note_free_outputs(composite, assumption.conjunct),
            *(
                ()
                if assumption.trace is None
                else describe_run(assumption.trace, assumption.conjunct)
            ),
        ),
        part=assumption.part.name,
        component=composite.component,
        formula=_print_formula(composite, assumption.conjunct),
        context=text_in_parentheses(assumption.conjunct),
    )


def _print_formula(composite: Composite, conjunct: Conjunct) -> str:
    variables = (item for contract in _list_contracts(composite) for item in contract.variables)
    return print_worded(conjunct.formula, variables)


def _note_free_outputs(composite: Composite, assumption: Conjunct) -> Iterator[str]:
    """Yield a note for each variable of an assumption that no contract restricts."""
    names = _variable_names(assumption)
    for part in composite.parts:
        contract = part.contract
        restricted = {name for item in contract.guarantees for name in _variable_names(item)}
        for variable in contract.variables:
            is_output = variable.owner is Owner.SYSTEM and variable.name in names
            if is_output and variable.name not in restricted:
                yield f"'{part.name}' decides '{variable.name}' and guarantees nothing about it"


def _build_witnesses(composite: Composite, composition: Composition) -> Iterator[Witness]:
    parties = tuple(Party(part.name, part.contract) for part in composite.parts)
    for assumption in composition.open:
        if assumption.trace is not None:
            yield Witness(composite.component, assumption.conjunct, assumption.trace, parties)
    for failure in (*composition.failures, *composition.losses):
        yield Witness(composite.component, failure.conjunct, failure.trace, parties)


def _split_composite(composite: Composite) -> list[Composite]:
    """Return the groups of parts that share variables, in the order of their first parts.

    The contract of the whole belongs to the group with its variables; the other groups have one
    without conjuncts.
    """
    # All 39 parts of the ICE laboratory's line turned out to be independent of one another.
    variable_sets: DisjointSets[str] = DisjointSets()
    for names in _shared_variable_groups(composite):
        for name in names[1:]:
            variable_sets.union(names[0], name)
    part_numbers: dict[str, list[int]] = {}
    for number, part in enumerate(composite.parts):
        # A part without variables gets a key of its own, which no variable can equal.
        key_variable = next((variable.name for variable in part.contract.variables), f"#{number}")
        part_numbers.setdefault(variable_sets.find(key_variable), []).append(number)
    if composite.whole is not None and composite.whole.variables:
        part_numbers.setdefault(variable_sets.find(composite.whole.variables[0].name), [])
    return [
        _restrict_composite(composite, group, variable_sets, key)
        for key, group in part_numbers.items()
    ]


def _shares_variables(group: Composite) -> bool:
    """Whether two parts of a group, or a part and the whole, share variables."""
    return len(group.parts) > 1 or (group.whole is not None and bool(group.whole.variables))


def _shared_variable_groups(composite: Composite) -> Iterator[list[str]]:
    """Yield for each contract and each wire the names of its variables."""
    for part in composite.parts:
        yield [variable.name for variable in part.contract.variables]
    for wire in composite.wiring:
        yield _variable_names(wire)
    if composite.whole is not None:
        yield [variable.name for variable in composite.whole.variables]


def _variable_names(conjunct: Conjunct) -> list[str]:
    return list(dict.fromkeys(variable.name for variable in f.variables(conjunct.formula)))


def _restrict_composite(
    composite: Composite, group: list[int], variable_sets: DisjointSets[str], key: str
) -> Composite:
    def select_conjuncts(conjuncts: tuple[Conjunct, ...]) -> tuple[Conjunct, ...]:
        return tuple(
            conjunct
            for conjunct in conjuncts
            if variable_sets.find(_variable_names(conjunct)[0]) == key
        )

    return replace(
        composite,
        parts=tuple(composite.parts[number] for number in group),
        wiring=select_conjuncts(composite.wiring),
        exclusions=select_conjuncts(composite.exclusions),
        whole=_restrict_whole(composite.whole, variable_sets, key),
    )


def _restrict_whole(
    whole: Contract | None, variable_sets: DisjointSets[str], key: str
) -> Contract | None:
    if whole is None or not whole.variables:
        return whole
    if variable_sets.find(whole.variables[0].name) == key:
        return whole
    return replace(whole, variables=(), assumptions=(), guarantees=())
