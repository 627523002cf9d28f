"""Verdicts about requirements: each conjunct of a requirement is one question to a behaviour.

The runs of the behaviour that satisfy the assumptions of the requirement either all satisfy the
conjunct, or they do if each action ends, or a run violates it. The assumptions that actions end and
loops are left are derived by the compiler: they may prove a requirement, and never refute one.
"""

from collections.abc import Iterable, Iterator, Sequence
from enum import StrEnum
from itertools import chain, combinations

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic import formula as f
from sysmlc.logic.basis import Basis, describe_basis, find_basis, is_doubtful
from sysmlc.logic.classification import is_safety
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.components.places import PlaceInBehaviour, PlaceKind
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
    equal_values,
)
from sysmlc.logic.domains import regions_of
from sysmlc.logic.formula import Apply, Formula, Op
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import as_ltl
from sysmlc.logic.reduction.formula_reduction import NotReducibleError
from sysmlc.logic.regions import LINE
from sysmlc.synthesis import rules
from sysmlc.synthesis.algebra.fair_systems import DomainError, Trace
from sysmlc.synthesis.algebra.refinement import RunSearch
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.certain_runs import AUXILIARY, CertainRuns, find_certain_runs
from sysmlc.synthesis.decision import Options, Place
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.witnesses import describe_problem, manager_factory


class Answer(StrEnum):
    """The answer to the question whether a behaviour satisfies a conjunct."""

    HOLDS = "holds"
    HOLDS_WITHIN_RANGES = "holds-within-assumed-ranges"
    HOLDS_IF_ACTIONS_END = "holds-if-actions-end"
    BROKEN = "broken"
    NOT_DECIDED = "not-decided"


class RequirementVerdict(Struct, frozen=True):
    """The answer for one conjunct, with its reason, and the run that violates a broken one.

    ``needed`` are the derived assumptions without which a conjunct that holds would not.
    ``vacuity`` is the reason why a conjunct that holds says nothing about the behaviour; it is
    empty for other conjuncts. ``basis`` are the assumed ranges within which a conjunct holds, or
    the assumed ranges and the conditions without formula because of which it is not decided.
    """

    conjunct: Conjunct
    answer: Answer
    reason: str = ""
    trace: Trace | None = None
    needed: tuple[Conjunct, ...] = ()
    vacuity: str = ""
    basis: Basis = Basis()

    @property
    def condition(self) -> str:
        """What the environment has to do so that the conjunct holds; empty without such a need."""
        return describe_needs(self.needed)


def describe_needs(needed: Iterable[Conjunct]) -> str:
    """Return derived assumptions in words: "its actions end and Go comes sooner or later"."""
    awaited = dict.fromkeys(ending.awaited for ending in needed)
    events = [event for event in awaited if event]
    parts = [*(["its actions end"] if "" in awaited else []), *events]
    text = " and ".join(filter(None, (", ".join(parts[:-1]), *parts[-1:])))
    return f"{text} sooner or later" if events else text


def _explain_needs(needed: Sequence[Conjunct]) -> str:
    """Return the assumptions that a proof uses, with a summary if actions that end are not all."""
    texts = " ".join(ending.text for ending in needed)
    has_more_than_endings = any(ending.awaited for ending in needed)
    return f"holds if {describe_needs(needed)}: {texts}" if has_more_than_endings else texts


class WriteConflict(Struct, frozen=True):
    """A feature to which two writers give different values in one step, and a run that shows it.

    Whether the run is one of the model depends on the ``basis``, if it is not empty.
    """

    variable: str
    conjunct: Conjunct
    trace: Trace
    basis: Basis = Basis()


class BehaviourFindings(Struct, frozen=True):
    """Faults of a behaviour that are found without a requirement.

    ``conflicts`` are the features to which two writers may give different values in one step,
    ``unreachable`` the places that no run within the ``assumed_ranges`` reaches.
    """

    conflicts: tuple[str, ...] = ()
    unreachable: tuple[PlaceInBehaviour, ...] = ()
    assumed_ranges: tuple[str, ...] = ()

    def list_unreachable(self, kind: PlaceKind) -> list[str]:
        """Return the names of the places of a kind that no run reaches."""
        return [place.name for place in self.unreachable if place.kind is kind]


UNREACHABLE_RULES = {
    PlaceKind.ACTIVITY: rules.UNREACHABLE,
    PlaceKind.TRANSITION: rules.NEVER_TAKEN,
    PlaceKind.EVENT: rules.NEVER_ACCEPTED,
    PlaceKind.GUARD: rules.GUARD_NEVER_HOLDS,
    PlaceKind.FEATURE: rules.NEVER_CHANGED,
}
_OTHER_NUMBERS = "numbers in no region"
_UNDECIDED_PROBLEMS = (OutsideGr1Error, DomainError, LimitError, NotReducibleError)


class BehaviourCheck:
    """Questions about the runs of a behaviour that satisfy the assumptions of a requirement.

    *undischarged* are the assumptions that the author wrote on the behaviour and that the
    requirements do not entail: the author's guarantees of the behaviour then prove nothing.
    """

    def __init__(
        self,
        behaviour: ComponentBehaviour,
        requirements: Contract,
        undischarged: tuple[Conjunct, ...],
        options: Options,
    ) -> None:
        self._behaviour = behaviour
        self._requirements = requirements
        self._options = options
        contract = behaviour.contract
        self._assumed = tuple(
            conjunct
            for conjunct in requirements.assumptions
            if not (conjunct.is_derived and _names_of((conjunct,)) & behaviour.gaps.keys())
        )
        definitions = tuple(conjunct for conjunct in requirements.guarantees if conjunct.is_derived)
        stated = tuple(conjunct for conjunct in contract.guarantees if not conjunct.is_derived)
        self._facts = (*definitions, *(() if undischarged else stated))
        self._unproven = (*undischarged, *stated) if undischarged else ()
        # An action whose steps are not described may go on for ever.
        derived = [conjunct for conjunct in contract.assumptions if conjunct.is_derived]
        is_described = behaviour.undescribed.isdisjoint
        self._endings = tuple(c for c in derived if is_described(_names_of((c,))))
        self._contracts = (contract, requirements)
        self._shown_names = {atom.replaced: atom.variable.name for atom in behaviour.atoms}
        variables = (*contract.variables, *requirements.variables)
        self._has_doubts = any(is_doubtful(variable) for variable in variables)
        auxiliary = (AUXILIARY,) if self._has_doubts else ()
        self._search = RunSearch((*self._contracts, *auxiliary), manager_factory(options))

    def decide_requirements(self) -> Iterator[RequirementVerdict]:
        """Yield the verdict about each conjunct that the author requires."""
        for conjunct in self._requirements.guarantees:
            if not conjunct.is_derived:
                try:
                    yield self.decide(conjunct)
                except _UNDECIDED_PROBLEMS as problem:
                    reason = describe_problem(problem)
                    yield RequirementVerdict(conjunct, Answer.NOT_DECIDED, reason)

    def find_conflicts(self) -> Iterator[WriteConflict]:
        """Yield each feature to which two writers give different values in a reachable step.

        Raises LimitError.
        """
        self._search.restart_clocks()
        domains = {variable.name: variable for variable in self._behaviour.contract.variables}
        for name, writers in self._behaviour.writers.items():
            for first, second in combinations(writers, 2):
                differ = f.negate(equal_values(domains[name], first.value, second.value))
                coincide = f.both(first.condition, second.condition, differ)
                conjunct = Conjunct(f.negate(coincide), Class.SAFETY, second.origin)
                if coincide == f.FALSE or self._entails((), conjunct):
                    continue
                trace, basis = self._find_violation((), conjunct)
                if trace is None and basis != Basis():
                    facts = self._list_facts((), conjunct)
                    trace = self._find_run(CertainRuns(), facts, conjunct)
                if trace is not None:
                    yield WriteConflict(name, conjunct, trace, basis)
                    break

    def find_unreachable(self) -> Iterator[PlaceInBehaviour]:
        """Yield the places that no run reaches, although runs come near. Raises LimitError."""
        self._search.restart_clocks()
        for place in self._behaviour.places:
            if self._is_never(place, place.is_active) and (
                place.within == f.TRUE or not self._is_never(place, place.within)
            ):
                yield place

    def _is_never(self, place: PlaceInBehaviour, condition: Formula) -> bool:
        conjunct = Conjunct(f.negate(condition), Class.SAFETY, place.origin)
        return self._entails((), conjunct)

    def decide(self, conjunct: Conjunct) -> RequirementVerdict:
        """Return the verdict about a conjunct.

        The answer, the needed assumptions and the vacuity are questions with a time limit each.
        """
        self._search.restart_clocks()
        if not self._search.has_runs(self._list_facts((), conjunct)):
            reason = "no run of the behaviour satisfies the assumptions of the requirement"
            return RequirementVerdict(conjunct, Answer.NOT_DECIDED, reason)
        if self._entails((), conjunct):
            return self._confirm(conjunct, ())
        endings = () if is_safety(as_ltl(conjunct)) else self._select_possible(conjunct)
        if endings and self._entails(endings, conjunct):
            return self._confirm(conjunct, endings)
        verdict = self._refute(conjunct, endings)
        excluded = _names_of(ending for ending in self._endings if ending not in endings)
        basis = Basis(describe_basis(self._contracts, excluded, self._shown_names).ranges)
        if verdict.answer is Answer.BROKEN and basis.ranges and not is_safety(as_ltl(conjunct)):
            # The environment may do beyond an assumed range what it cannot do within it.
            return RequirementVerdict(conjunct, Answer.NOT_DECIDED, basis.reason, basis=basis)
        return verdict

    def _select_possible(self, conjunct: Conjunct) -> tuple[Conjunct, ...]:
        """Return the derived assumptions that are possible, those of the requirement given.

        An author who assumes that an event never comes does not ask what happens if it comes. Nor
        does a guard open that is true for no values of its inputs.
        """
        if self._search.has_runs(self._list_facts(self._endings, conjunct)):
            return self._endings
        possible: tuple[Conjunct, ...] = ()
        for ending in self._endings:
            if self._search.has_runs(self._list_facts((*possible, ending), conjunct)):
                possible = (*possible, ending)
        return possible

    def _confirm(self, conjunct: Conjunct, endings: tuple[Conjunct, ...]) -> RequirementVerdict:
        """Return the verdict about a conjunct that all runs with some derived assumptions satisfy.

        Conditions without formula are free inputs, so that it holds whatever their values are.
        """
        basis = Basis(self.find_basis((conjunct,)).ranges)
        if not self._has_runs_in_ranges(conjunct, endings):
            return RequirementVerdict(conjunct, Answer.NOT_DECIDED, basis.reason, basis=basis)
        needed = self._minimise(endings, conjunct) if endings else ()
        vacuity = self._explain_vacuity(conjunct, endings)
        answer = Answer.HOLDS_WITHIN_RANGES if basis.ranges else Answer.HOLDS
        return RequirementVerdict(
            conjunct,
            Answer.HOLDS_IF_ACTIONS_END if endings else answer,
            _explain_needs(needed),
            needed=needed,
            vacuity=vacuity and vacuity + basis.range_text,
            basis=basis,
        )

    def _has_runs_in_ranges(self, conjunct: Conjunct, endings: tuple[Conjunct, ...]) -> bool:
        """Whether some run never stops a value at a bound of an assumed range.

        A safety conjunct is about the beginnings of runs, which stay in the ranges.
        """
        if not self._has_doubts or is_safety(as_ltl(conjunct)):
            return True
        runs = find_certain_runs(self._behaviour, self._requirements, (conjunct,))
        unclamped = (f.negate(clamp) for _, clamp in runs.clamps)
        facts = tuple(Conjunct(formula, Class.SAFETY, "") for formula in unclamped)
        return not facts or self._search.has_runs((*self._list_facts(endings, conjunct), *facts))

    def _minimise(self, endings: tuple[Conjunct, ...], conjunct: Conjunct) -> tuple[Conjunct, ...]:
        """Return a subset of the derived assumptions that still proves the conjunct.

        It is minimal, unless the limits of one question are reached first.
        """
        self._search.restart_clocks()
        needed = endings
        for ending in endings:
            without_ending = tuple(candidate for candidate in needed if candidate != ending)
            try:
                if self._entails(without_ending, conjunct):
                    needed = without_ending
            except LimitError:
                break
        return needed

    def _explain_vacuity(self, conjunct: Conjunct, endings: tuple[Conjunct, ...]) -> str:
        """Return why a conjunct that holds says nothing about the behaviour, or an empty text.

        It is valid, or the right-hand side of an implication could be false (Beer, Ben-David,
        Eisner and Rodeh 1997).
        """
        self._search.restart_clocks()
        if self._is_valid(conjunct):
            return "it holds whatever the behaviour does"
        strengthened = list(iter_strengthened(conjunct.formula))
        worded = list(iter_strengthened(conjunct.wording or conjunct.formula))
        for position, (condition, stronger) in enumerate(strengthened):
            if self._entails(endings, replace(conjunct, formula=stronger)):
                if len(worded) == len(strengthened):
                    condition, _ = worded[position]
                return f"its condition '{print_formula(condition)}' is never true"
        return ""

    def _is_valid(self, conjunct: Conjunct) -> bool:
        """Whether all runs satisfy the conjunct, those that are no runs of the behaviour too.

        The ranges of Integers are facts of the model: the numbers next to them count, too. Numbers
        keep to arithmetic.
        """
        declared = (*self._behaviour.contract.variables, *self._requirements.variables)
        by_name = {variable.name: variable for variable in declared}
        if conjunct.wording is not None:
            # The end of an action with steps, for which a long condition stands, is free here, too.
            words = f.variable_names(conjunct.wording)
            actions = (name for name in words if name.endswith(")"))
            shown = by_name | {atom.variable.name: atom.variable for atom in self._behaviour.atoms}
            shown |= {name: Variable(name, Owner.SYSTEM, BooleanDomain(), "") for name in actions}
            if shown.keys() >= words:
                by_name, conjunct = shown, Conjunct(conjunct.wording, Class.OTHER, conjunct.origin)
        facts = self._behaviour.facts
        names = _names_of((conjunct, *facts))
        read = tuple(_widen(variable) for name, variable in by_name.items() if name in names)
        free = Contract("", "", read, (), ())
        new_manager = manager_factory(self._options)
        return RunSearch((free,), new_manager).entails(facts, conjunct)

    # -- refutation ------------------------------------------------------------------------------

    def _refute(self, conjunct: Conjunct, endings: tuple[Conjunct, ...]) -> RequirementVerdict:
        gap = self._find_gap(conjunct)
        waits: tuple[Conjunct, ...] = ()
        if gap is not None:
            if gap not in self._behaviour.undescribed:
                return RequirementVerdict(conjunct, Answer.NOT_DECIDED, self._explain_gap(gap))
            # A run in which no such action ever runs is a run of the model.
            waits = tuple(
                Conjunct(f.negate(f.var(name)), Class.SAFETY, "")
                for name in sorted(self._behaviour.gaps)
            )
        facts = (*self._unproven, *endings, *waits)
        trace, basis = self._find_violation(facts, conjunct)
        if trace is not None:
            return RequirementVerdict(conjunct, Answer.BROKEN, trace=trace)
        if basis != Basis():
            return RequirementVerdict(conjunct, Answer.NOT_DECIDED, basis.reason, basis=basis)
        reason = self._explain_gap(gap) if gap else self._explain_unproven()
        return RequirementVerdict(conjunct, Answer.NOT_DECIDED, reason)

    def _find_gap(self, conjunct: Conjunct) -> str | None:
        """Return a variable that the model restricts more than the behaviour does, if any.

        Actions that are not described come last, because other gaps prevent any refutation.
        """
        own_names = {variable.name for variable in self._behaviour.contract.variables}
        free_names = {
            variable.name
            for variable in self._requirements.variables
            # Inputs are free in the model, too, and conjuncts define history bits.
            if variable.owner is Owner.ENVIRONMENT or self._is_history_bit(variable)
        }
        unknown = sorted(_names_of((conjunct,)) - own_names - free_names)
        gaps = self._behaviour.gaps
        features = [name for name in gaps if name not in self._behaviour.undescribed]
        return next(iter((*unknown, *features, *gaps)), None)

    def _is_history_bit(self, variable: Variable) -> bool:
        derived = (conjunct for conjunct in self._requirements.guarantees if conjunct.is_derived)
        return variable.name in _names_of(derived)

    def _explain_gap(self, name: str) -> str:
        default = f"the behaviour does not determine '{name}'"
        return self._behaviour.gaps.get(name, default)

    def _explain_unproven(self) -> str:
        return "the behaviour assumes more than the requirement does"

    # -- runs ------------------------------------------------------------------------------------

    def _entails(self, endings: tuple[Conjunct, ...], conjunct: Conjunct) -> bool:
        return self._search.entails(self._list_facts(endings, conjunct), conjunct)

    def _find_violation(
        self, facts: tuple[Conjunct, ...], conjunct: Conjunct
    ) -> tuple[Trace | None, Basis]:
        """Return a certain run of the behaviour with additional facts that violates the conjunct.

        If there is none, the basis tells because of what the runs that violate it are not certain.
        """
        all_facts = self._list_facts(facts, conjunct)
        if not self._has_doubts:
            return self._search.find_violation(all_facts, conjunct), Basis()
        runs = find_certain_runs(self._behaviour, self._requirements, (conjunct, *facts))
        trace = self._find_run(runs, all_facts, conjunct)
        if trace is not None:
            return trace, Basis()
        for name in reversed(runs.doubts):
            fewer = runs.ignore(name)
            try:
                if self._find_run(fewer, all_facts, conjunct) is None:
                    runs = fewer
            except LimitError:
                break
        return None, describe_basis(self._contracts, runs.doubts, self._shown_names)

    def _find_run(
        self, runs: CertainRuns, facts: tuple[Conjunct, ...], conjunct: Conjunct
    ) -> Trace | None:
        restriction = runs.restrict(facts, conjunct)
        if restriction is None:
            return None
        trace = self._search.find_violation((*facts, *restriction), conjunct)
        return trace and runs.drop_values(trace)

    def find_basis(self, conjuncts: Iterable[Conjunct]) -> Basis:
        """Return the assumed ranges and conditions without formula that affect conjuncts."""
        reads = self._behaviour.list_reads()
        return find_basis(self._contracts, _names_of(conjuncts), self._shown_names, reads)

    def _list_facts(self, facts: tuple[Conjunct, ...], about: Conjunct) -> tuple[Conjunct, ...]:
        """Return what all runs satisfy that a question is *about*, with further *facts*.

        These runs satisfy the assumptions of the requirement that is asked, not those of others.
        """
        assumed = (item for item in self._assumed if item.viewpoint in ("", about.viewpoint))
        steps = (
            conjunct
            for conjunct in self._behaviour.contract.guarantees
            # That an activity goes on for ever follows from the assumption that actions end.
            if conjunct.is_derived and conjunct.class_ is not Class.LIVENESS
        )
        return (*assumed, *self._facts, *steps, *facts)


def report_unreachable(
    checks: Sequence[tuple[ComponentBehaviour, Contract, BehaviourFindings]],
    place: Place,
    sink: Sink,
) -> None:
    """Report the places that no run reaches, from the behaviours with requirements and findings.

    A state that the author requires to be never reached is not reported, nor a transition to it.
    Nor does a component report what the check of a part, or of an activity that it performs, finds.
    """
    places_by_component = {
        behaviour.contract.origin: {(item.kind, item.origin) for item in findings.unreachable}
        for behaviour, _, findings in checks
    }
    for behaviour, requirements, findings in checks:
        required = {conjunct.formula for conjunct in requirements.guarantees}
        inner = set[tuple[PlaceKind, str]]().union(
            *(places_by_component.get(id, ()) for id in behaviour.constituents)
        )
        for unreached in findings.unreachable:
            negations = iter_negations(unreached.is_active), iter_negations(unreached.leads_to)
            if (unreached.kind, unreached.origin) not in inner and required.isdisjoint(
                chain(*negations)
            ):
                component = behaviour.contract.component
                sink.report(
                    UNREACHABLE_RULES[unreached.kind],
                    place(unreached.origin),
                    component=component,
                    name=unreached.name,
                    within=find_place_basis(unreached, behaviour, requirements).range_text,
                )


def find_place_basis(
    place: PlaceInBehaviour, behaviour: ComponentBehaviour, requirements: Contract
) -> Basis:
    """Return the assumed ranges within which no run reaches a place."""
    names = f.variable_names(place.is_active, place.within)
    shown_names = {atom.replaced: atom.variable.name for atom in behaviour.atoms}
    contracts = (behaviour.contract, requirements)
    return Basis(find_basis(contracts, names, shown_names, behaviour.list_reads()).ranges)


def _names_of(conjuncts: Iterable[Conjunct]) -> set[str]:
    return f.variable_names(*(conjunct.formula for conjunct in conjuncts))


def _widen(variable: Variable) -> Variable:
    """Return the variable with one more number below and above its range.

    Regions that a behaviour never reaches are missing: they are one more value together.
    """
    domain: Domain = variable.domain
    if isinstance(domain, IntegerDomain):
        domain = IntegerDomain(domain.low - 1, domain.high + 1)
    regions = regions_of(domain)
    if regions is not None and variable.owner is Owner.SYSTEM:
        assert isinstance(domain, EnumerationDomain)
        if regions.join_neighbours().intervals != (LINE,):
            domain = EnumerationDomain((*domain.literals, _OTHER_NUMBERS))
    return replace(variable, domain=domain)


def iter_strengthened(
    formula: Formula, is_positive: bool = True
) -> Iterator[tuple[Formula, Formula]]:
    """Yield, for each implication in positive position, its left-hand side and a stronger formula.

    In the stronger formula the right-hand side of the implication is false.
    """
    if not isinstance(formula, Apply) or formula.op is Op.IFF:
        return
    if formula.op is Op.IMPLIES and is_positive:
        yield formula.args[0], f.negate(formula.args[0])
    for position, arg in enumerate(formula.args):
        is_negated = formula.op is Op.NOT or (formula.op is Op.IMPLIES and position == 0)
        for condition, stronger in iter_strengthened(arg, is_positive is not is_negated):
            args = (*formula.args[:position], stronger, *formula.args[position + 1 :])
            yield condition, Apply(formula.op, args)


def iter_negations(formula: Formula) -> Iterator[Formula]:
    """Yield the spellings of the negation of a formula."""
    yield f.negate(formula)
    if isinstance(formula, Apply) and formula.op is Op.EQ:
        yield f.compare(Op.NE, *formula.args)
