"""Checks of the contracts of a model: each by itself, and behaviours against requirements."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.synthesis.algebra.composition import conjoin_viewpoints
from sysmlc.synthesis.algebra.fair_systems import DomainError
from sysmlc.synthesis.algebra.refinement import Failure, find_refinement_failures
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decision import Options, Place, Verdict, decide
from sysmlc.synthesis.games.game import OutsideGr1Error, make_game
from sysmlc.synthesis.lints import lint
from sysmlc.synthesis.unrealizable import find_unrealizable_core, is_won
from sysmlc.synthesis.witnesses import (
    Party,
    Witness,
    describe_problem,
    manager_factory,
    report_failure,
)

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
    "the behaviour of '{component}' is not compared with its requirements: {reason}",
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
    is_implemented: bool | None
    """Whether the behaviour refines its requirements; None without requirements or verdict."""
    witnesses: tuple[Witness, ...] = ()


def check_contracts(
    chosen: Iterable[Contract],
    contracts: Iterable[Contract],
    place: Place,
    sink: Sink,
    options: Options,
) -> Iterator[CheckedContract]:
    """Decide and lint the chosen contracts, and compare behaviours with their requirements.

    *contracts* are all contracts of the model, because the contract of the requirements of a chosen
    behaviour need not be chosen itself.
    """
    requirement_contracts = {
        contract.component.removesuffix(SUFFIX): contract
        for contract in contracts
        if _is_requirement_contract(contract)
    }
    for contract in chosen:
        verdict = decide(contract, place, sink, options)
        # Lints play games and explore runs, so an undecided contract would meet the same obstacle.
        if verdict.is_realizable is not None:
            _lint_within_limits(contract, place, sink, options)
        if verdict.is_realizable:
            check_viewpoints(contract, place, sink, options)
        requirements = (
            None
            if _is_requirement_contract(contract)
            else requirement_contracts.get(contract.component)
        )
        failures = (
            None
            if requirements is None
            else _find_requirement_failures(contract, requirements, place, sink, options)
        )
        is_implemented = None if failures is None else not failures
        witnesses = tuple(_build_witness(contract, failure) for failure in failures or ())
        yield CheckedContract(verdict, is_implemented, witnesses)


def _is_requirement_contract(contract: Contract) -> bool:
    return contract.component.endswith(SUFFIX)


def _lint_within_limits(contract: Contract, place: Place, sink: Sink, options: Options) -> None:
    try:
        lint(reduce_contract(contract).contract, place, sink, manager_factory(options))
    except LimitError as problem:
        reached = str(problem)
        sink.report(GIVEN_UP, place(contract.origin), component=contract.component, reached=reached)


def _find_requirement_failures(
    behaviour: Contract, requirements: Contract, place: Place, sink: Sink, options: Options
) -> tuple[Failure, ...] | None:
    """Report and return the failures of refinement; None if that is not decided."""
    try:
        failures = tuple(
            find_refinement_failures(behaviour, requirements, manager_factory(options)())
        )
    except (OutsideGr1Error, DomainError, LimitError) as problem:
        subject = place(behaviour.origin)
        reason = describe_problem(problem)
        sink.report(NOT_COMPARED, subject, component=behaviour.component, reason=reason)
        return None
    for failure in failures:
        rule = ASSUMES if failure.is_assumption else BREAKS
        report_failure(rule, failure, behaviour.component, place(failure.conjunct.origin), sink)
    return failures


def _build_witness(behaviour: Contract, failure: Failure) -> Witness:
    parties = (Party(behaviour.component, behaviour),)
    return Witness(behaviour.component, failure.conjunct, failure.trace, parties)


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
            f"'{conjunct.viewpoint}' demands '{print_formula(conjunct.formula)}'"
            for conjunct in contract.guarantees
            if conjunct.viewpoint and conjunct.origin in origins
        )
        subject = place(contract.origin)
        sink.report(LEANS, subject, notes=tuple(notes), component=contract.component)
    return is_realizable
