"""Checks of the contracts of a model: each by itself, and behaviours against requirements."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.basis import Basis
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.contract import Conjunct, Contract, Domain, Owner
from sysmlc.logic.evaluate import find_violation
from sysmlc.logic.quantities import choose_numbers
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.logic.region_formulas import print_worded
from sysmlc.synthesis.algebra.composition import conjoin_viewpoints
from sysmlc.synthesis.algebra.fair_systems import DomainError, Trace
from sysmlc.synthesis.algebra.refinement import Failure, find_refinement_failures
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decision import Options, Place, Verdict, decide
from sysmlc.synthesis.games.game import OutsideGr1Error, make_game
from sysmlc.synthesis.lints import lint
from sysmlc.synthesis.requirement_verdicts import (
    Answer,
    BehaviourCheck,
    BehaviourFindings,
    RequirementVerdict,
    find_place_basis,
    report_unreachable,
)
from sysmlc.synthesis.rules import CONFLICT, VACUOUS
from sysmlc.synthesis.unrealizable import find_unrealizable_core, is_won
from sysmlc.synthesis.witnesses import (
    Party,
    Witness,
    describe_named_run,
    manager_factory,
    mark_violation,
    name_conjunct,
    name_run,
    print_temporal,
    report_failure,
    text_in_parentheses,
)

_MAX_VALUATIONS = 64
"""Combinations of input values that are tried; with more of them an input counts as relevant."""


def find_relevant_inputs(trace: Trace, behaviour: Contract) -> frozenset[str]:
    """Return constant inputs without whose values the run would not be one of the behaviour.

    The inputs are freed in turn. Those that stay free may have any value, all together: the run
    satisfies each conjunct all the same.
    """
    constant_inputs = {
        variable.name: variable.domain
        for variable in behaviour.variables
        if variable.owner is Owner.ENVIRONMENT
        and variable.name in trace.steps[0]
        and len({step.get(variable.name) for step in trace.steps}) == 1
    }
    free: dict[str, Domain] = {}
    for name, domain in constant_inputs.items():
        if _may_vary(trace, behaviour, name, {**free, name: domain}):
            free[name] = domain
    return frozenset(constant_inputs.keys() - free.keys())


def _may_vary(trace: Trace, behaviour: Contract, name: str, free: dict[str, Domain]) -> bool:
    """Whether the run satisfies all conjuncts about an input whatever the free inputs are."""
    known = set(trace.steps[0])
    for conjunct in (*behaviour.guarantees, *behaviour.assumptions):
        read = f.variable_names(conjunct.formula)
        if name not in read or not read <= known:
            continue
        varied = {input: domain for input, domain in free.items() if input in read}
        if domains.count(varied) > _MAX_VALUATIONS:
            return False
        for values in domains.valuations(varied):
            steps = [{**step, **values} for step in trace.steps]
            if find_violation(conjunct, steps, trace.loop) is not None:
                return False
    return True


# -- checks ----------------------------------------------------------------------------------------


SUFFIX = ".requirements"
"""Suffix of the name of a requirements' contract, behind the name of the component."""


BREAKS = rule(
    "SM560",
    "behaviour-breaks-requirement",
    Severity.ERROR,
    "the behaviour of '{component}' violates '{formula}'{context}",
    help="correct the behaviour or the requirement; the run shows a counterexample",
)
ASSUMES = rule(
    "SM561",
    "behaviour-assumes-more",
    Severity.ERROR,
    "the behaviour of '{component}' assumes '{formula}', which its requirements do not{context}",
    help="add it to the assumptions of the requirement, or let the behaviour work without it",
)
NOT_COMPARED = rule(
    "SM562",
    "behaviour-not-compared",
    Severity.WARNING,
    "it is not decided whether the behaviour of '{component}' satisfies '{formula}'{context}: "
    "{reason}",
)


GIVEN_UP = rule(
    "SM563",
    "check-given-up",
    Severity.INFO,
    "the checks of '{component}' are incomplete: {reached}",
    help="give more time (--question-limit), or check the contracts of parts",
)


class CheckedContract(Struct, frozen=True):
    """The result of checking one contract."""

    verdict: Verdict
    requirements: tuple[RequirementVerdict, ...] = ()
    """The verdicts about the requirements of the component, if the contract is a behaviour's."""
    assumes_more: bool = False
    """Whether the author wrote an assumption on the behaviour that the requirements do not make."""
    findings: BehaviourFindings | None = None
    """Findings about the behaviour that was checked against requirements."""
    is_checked_by_behaviour: bool = False
    """Whether it is the contract of requirements that a behaviour is checked against."""
    witnesses: tuple[Witness, ...] = ()

    @property
    def is_implemented(self) -> bool | None:
        """Whether the behaviour satisfies its requirements; None without a complete answer."""
        answers = [requirement.answer for requirement in self.requirements]
        if self.assumes_more or Answer.BROKEN in answers:
            return False
        return None if not answers or Answer.NOT_DECIDED in answers else True


_NO_BEHAVIOURS: Mapping[str, ComponentBehaviour] = {}


class _Checks(Struct, frozen=True):
    """The setting of the checks of one model."""

    place: Place
    sink: Sink
    options: Options


def check_contracts(
    chosen: Iterable[Contract],
    contracts: Iterable[Contract],
    place: Place,
    sink: Sink,
    options: Options,
    behaviours: Mapping[str, ComponentBehaviour] = _NO_BEHAVIOURS,
) -> Iterator[CheckedContract]:
    """Decide and lint the chosen contracts, and check behaviours against their requirements.

    *contracts* are all contracts of the model, because the contract of the requirements of a chosen
    behaviour need not be chosen itself. *behaviours* are the behaviours by component; without one,
    the contract of a component describes its behaviour completely.
    """
    all_by_component = {contract.component: contract for contract in contracts}
    setting = _Checks(place, sink, options)
    checks: list[tuple[ComponentBehaviour, Contract, BehaviourFindings]] = []
    for contract in chosen:
        component = contract.component
        behaviour = all_by_component.get(component.removesuffix(SUFFIX))
        if component.endswith(SUFFIX) and behaviour is not None:
            checked = behaviours.get(behaviour.component) or ComponentBehaviour(behaviour)
            verdict = _decide_consistency(contract, checked, setting)
            yield CheckedContract(verdict, is_checked_by_behaviour=True)
            continue
        whole = behaviours.get(component)
        if whole is not None and whole.is_of_parts:
            verdict = _decide_consistency(contract, whole, setting)
            result = _check_requirements(verdict, whole, contract, setting)
            if result.findings is not None:
                checks.append((whole, contract, result.findings))
            yield replace(result, is_checked_by_behaviour=True)
            continue
        verdict = decide(contract, place, sink, options)
        # Lints play games and explore runs, so an undecided contract would meet the same obstacle.
        if verdict.is_realizable is not None:
            _lint_within_limits(contract, setting)
        if verdict.is_realizable:
            check_viewpoints(contract, place, sink, options)
        requirements = all_by_component.get(f"{component}{SUFFIX}")
        if requirements is None:
            yield CheckedContract(verdict)
        else:
            checked = behaviours.get(component) or ComponentBehaviour(contract)
            result = _check_requirements(verdict, checked, requirements, setting)
            if result.findings is not None:
                checks.append((checked, requirements, result.findings))
            yield result
    report_unreachable(checks, place, sink)


def _lint_within_limits(
    contract: Contract, setting: _Checks, *, has_behaviour: bool = False
) -> None:
    place, sink, create_manager = setting.place, setting.sink, manager_factory(setting.options)
    reduced = reduce_contract(contract).contract
    try:
        lint(reduced, place, sink, create_manager, has_behaviour=has_behaviour)
    except LimitError as problem:
        reached = str(problem)
        sink.report(GIVEN_UP, place(contract.origin), component=contract.component, reached=reached)


# -- requirements of behaviours --------------------------------------------------------------------


def _decide_consistency(
    requirements: Contract, behaviour: ComponentBehaviour, setting: _Checks
) -> Verdict:
    """Decide whether a system can satisfy all requirements together, and lint them.

    Actions of the behaviour are assumed to end. A feature that other behaviours assign counts as an
    output. Formulas outside GR(1) are not part of the question, because the behaviour is checked
    against each of them anyway.
    """
    irreducible = reduce_contract(requirements).irreducible
    if any(conjunct in irreducible for conjunct in requirements.assumptions):
        return Verdict(requirements.component, None)
    contract = _complete(requirements, behaviour, irreducible)
    verdict = decide(contract, setting.place, setting.sink, setting.options)
    if verdict.is_realizable is not None:
        judged = _without(requirements, irreducible)
        _lint_within_limits(judged, setting, has_behaviour=True)
    if verdict.is_realizable:
        check_viewpoints(contract, setting.place, setting.sink, setting.options)
    return (
        replace(verdict, is_realizable=None) if irreducible and verdict.is_realizable else verdict
    )


def _without(requirements: Contract, irreducible: Sequence[Conjunct]) -> Contract:
    guarantees = tuple(
        conjunct for conjunct in requirements.guarantees if conjunct not in irreducible
    )
    return replace(requirements, guarantees=guarantees)


def _complete(
    requirements: Contract, behaviour: ComponentBehaviour, irreducible: Sequence[Conjunct]
) -> Contract:
    """Return the requirements with the assumptions that the compiler derives for the behaviour."""
    assumptions = tuple(
        conjunct for conjunct in behaviour.contract.assumptions if conjunct.is_derived
    )
    names = {variable.name for variable in requirements.variables}
    read = f.variable_names(*(item.formula for item in assumptions))
    variables = (
        *requirements.variables,
        *(variable for variable in behaviour.contract.variables if variable.name in read - names),
    )
    features = behaviour.gaps.keys() - behaviour.undescribed
    return replace(
        _without(requirements, irreducible),
        variables=tuple(
            replace(variable, owner=Owner.SYSTEM) if variable.name in features else variable
            for variable in variables
        ),
        assumptions=(
            *(
                conjunct
                for conjunct in requirements.assumptions
                # The initial value of such a feature is no assumption about an input.
                if not conjunct.is_derived
                or features.isdisjoint(f.variable_names(conjunct.formula))
            ),
            *assumptions,
        ),
    )


def _check_requirements(
    verdict: Verdict, behaviour: ComponentBehaviour, requirements: Contract, setting: _Checks
) -> CheckedContract:
    """Check a behaviour against each conjunct of its requirements, and report the failures."""
    contract = behaviour.contract
    failures = _find_undischarged(contract, requirements, setting.options)
    for failure in failures:
        _report_run(ASSUMES, failure, behaviour, setting)
    undischarged = [failure.conjunct for failure in failures]
    check = BehaviourCheck(behaviour, requirements, tuple(undischarged), setting.options)
    verdicts = tuple(
        replace(answer, trace=answer.trace and _trim_run(answer.trace, answer.conjunct, behaviour))
        for answer in check.decide_requirements()
    )
    for requirement in verdicts:
        _report_verdict(behaviour, requirement, setting)
    findings = _find_behaviour_findings(check, behaviour, requirements, setting)
    failures += [
        Failure(requirement.conjunct, False, requirement.trace)
        for requirement in verdicts
        if requirement.trace is not None
    ]
    witnesses = tuple(_build_witness(behaviour, failure) for failure in failures)
    named = tuple(
        replace(answer, trace=answer.trace and name_run(answer.trace, behaviour.atoms))
        for answer in verdicts
    )
    return CheckedContract(verdict, named, bool(undischarged), findings, witnesses=witnesses)


def _trim_run(trace: Trace, broken: Conjunct, described: ComponentBehaviour) -> Trace:
    """Return a run with its violated step and the inputs that matter, without those not read."""
    behaviour, limits = described.contract, described.limits
    if limits:
        numbers = choose_numbers(behaviour.variables, trace.steps, limits=limits)
        trace = replace(trace, numbers=numbers)
    formulas = (*behaviour.guarantees, *behaviour.assumptions, broken)
    read = f.variable_names(*(conjunct.formula for conjunct in formulas))
    unread = {
        variable.name
        for variable in behaviour.variables
        if variable.owner is Owner.ENVIRONMENT and variable.name not in read
    }
    return replace(
        mark_violation(trace, broken),
        auxiliary=trace.auxiliary | unread,
        relevant=find_relevant_inputs(trace, behaviour),
    )


def _find_behaviour_findings(
    check: BehaviourCheck,
    behaviour: ComponentBehaviour,
    requirements: Contract,
    setting: _Checks,
) -> BehaviourFindings | None:
    """Report write conflicts, and return all findings; None if a limit is reached."""
    component, place, sink = behaviour.contract.component, setting.place, setting.sink
    try:
        conflicts = tuple(check.find_conflicts())
        unreachable = tuple(check.find_unreachable())
    except (LimitError, OutsideGr1Error, DomainError) as problem:
        subject = place(requirements.origin)
        sink.report(GIVEN_UP, subject, component=component, reached=str(problem))
        return None
    for conflict in conflicts:
        sink.report(
            CONFLICT,
            place(conflict.conjunct.origin),
            notes=describe_named_run(conflict.trace, conflict.conjunct, behaviour.atoms),
            component=component,
            variable=conflict.variable,
            condition="" if conflict.basis == Basis() else f", perhaps: {conflict.basis.reason}",
        )
    certain = tuple(item.variable for item in conflicts if item.basis == Basis())
    bases = (find_place_basis(item, behaviour, requirements) for item in unreachable)
    ranges = dict.fromkeys(text for basis in bases for text in basis.ranges)
    return BehaviourFindings(certain, unreachable, tuple(ranges))


def _find_undischarged(
    behaviour: Contract, requirements: Contract, options: Options
) -> list[Failure]:
    """Return the author's assumptions on a behaviour that some requirement does not entail."""
    stated = tuple(conjunct for conjunct in behaviour.assumptions if not conjunct.is_derived)
    concrete, new_manager = replace(behaviour, assumptions=stated), manager_factory(options)
    viewpoints = dict.fromkeys(item.viewpoint for item in requirements.guarantees)
    failures: dict[Conjunct, Failure] = {}
    try:
        for assumed in dict.fromkeys(map(requirements.list_assumptions, viewpoints)):
            abstract = replace(requirements, assumptions=assumed, guarantees=())
            for failure in find_refinement_failures(concrete, abstract, new_manager):
                failures.setdefault(failure.conjunct, failure)
        return list(failures.values())
    except (OutsideGr1Error, DomainError, LimitError):
        # Each requirement meets the same obstacle and reports it.
        return []


def _report_verdict(
    behaviour: ComponentBehaviour, requirement: RequirementVerdict, setting: _Checks
) -> None:
    conjunct = requirement.conjunct
    if requirement.trace is not None:
        _report_run(BREAKS, Failure(conjunct, False, requirement.trace), behaviour, setting)
    elif requirement.vacuity or requirement.answer is Answer.NOT_DECIDED:
        setting.sink.report(
            VACUOUS if requirement.vacuity else NOT_COMPARED,
            setting.place(conjunct.origin),
            component=behaviour.contract.component,
            formula=print_temporal(conjunct),
            context=text_in_parentheses(conjunct),
            reason=requirement.vacuity or requirement.reason,
        )


def _report_run(
    rule_: Rule, failure: Failure, behaviour: ComponentBehaviour, setting: _Checks
) -> None:
    subject, component = setting.place(failure.conjunct.origin), behaviour.contract.component
    report_failure(rule_, failure, component, subject, setting.sink, atoms=behaviour.atoms)


def _build_witness(behaviour: ComponentBehaviour, failure: Failure) -> Witness:
    contract, atoms = behaviour.contract, behaviour.atoms
    replaced = {atom.replaced for atom in atoms}
    variables = (
        *(atom.variable for atom in atoms),
        *(variable for variable in contract.variables if variable.name not in replaced),
    )
    return Witness(
        contract.component,
        name_conjunct(failure.conjunct, atoms),
        name_run(failure.trace, atoms),
        (Party(contract.component, replace(contract, variables=variables)),),
    )


LEANS = rule(
    "SM599",
    "requirements-lean-on-one-another",
    Severity.WARNING,
    "the requirements of '{component}' can be satisfied together only if the assumptions "
    "of all of them hold",
    help="let each requirement state the assumptions that it needs",
)


def check_viewpoints(contract: Contract, place: Place, sink: Sink, options: Options) -> bool | None:
    """Return whether the conjunction of the requirements is realizable; None if undecided.

    *contract* contains the conjuncts of all requirements and is realizable. A conjunction that is
    not is reported (SM599).
    """
    try:
        game = make_game(
            conjoin_viewpoints(reduce_contract(contract).contract),
            Manager(options.engine, options.limits, options.progress),
        )
        is_realizable = is_won(game)
        core = () if is_realizable else find_unrealizable_core(game)
    except (OutsideGr1Error, LimitError):
        return None
    if not is_realizable:
        origins = {conjunct.origin for conjunct in core if conjunct.viewpoint}
        notes = dict.fromkeys(
            f"'{conjunct.viewpoint}' demands '{print_worded(conjunct.formula, contract.variables)}'"
            for conjunct in contract.guarantees
            if conjunct.viewpoint and conjunct.origin in origins
        )
        subject = place(contract.origin)
        sink.report(LEANS, subject, notes=tuple(notes), component=contract.component)
    return is_realizable
