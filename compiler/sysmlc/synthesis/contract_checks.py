"""Checks of the contracts of a model: each by itself, and behaviours against requirements."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.contract import Contract
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.synthesis.algebra.fair_systems import DomainError
from sysmlc.synthesis.algebra.refinement import Failure, find_refinement_failures
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.decision import Options, Place, Verdict, decide
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.lints import lint
from sysmlc.synthesis.requirement_check import check_viewpoints
from sysmlc.synthesis.witnesses import (
    Party,
    Witness,
    describe_problem,
    manager_factory,
    report_failure,
)

SUFFIX = ".requirements"
"""What the contract of a component's requirements has behind the name of its behaviour's."""


BREAKS = rule(
    "SM560",
    "behaviour-breaks-requirement",
    Severity.ERROR,
    "the behaviour of '{component}' does not keep '{formula}'{said}",
    help="change the behaviour, or the requirement; the run shows what happens",
)
ASSUMES = rule(
    "SM561",
    "behaviour-assumes-more",
    Severity.ERROR,
    "the behaviour of '{component}' assumes '{formula}', which its requirements do not{said}",
    help="add it to the assumptions of the requirement, or let the behaviour do without it",
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
    "not everything that may be suspicious in '{component}' was looked for: {reached}",
    help="give more time (--question-limit), or check the contracts of parts",
)


class Checked(Struct, frozen=True):
    """What was found out about one contract; the pairs that were compared by name."""

    verdict: Verdict
    is_implemented: bool | None
    """Whether the behaviour keeps its requirements; None when there are none, or no answer."""
    witnesses: tuple[Witness, ...] = ()


def check(
    chosen: Iterable[Contract],
    contracts: Iterable[Contract],
    place: Place,
    sink: Sink,
    options: Options,
) -> Iterator[Checked]:
    """Decide the chosen contracts, tell what is suspicious in them, compare them with requirements.

    ``contracts`` are all that there are: the requirements of a chosen behaviour may not be chosen.
    """
    demanded = {one.component.removesuffix(SUFFIX): one for one in contracts if _is_demand(one)}
    for contract in chosen:
        verdict = decide(contract, place, sink, options)
        if verdict.is_realizable is not None:
            _lint(contract, place, sink, options)
        if verdict.is_realizable:
            check_viewpoints(contract, place, sink, options)
        other = None if _is_demand(contract) else demanded.get(contract.component)
        failures = None if other is None else _failures(contract, other, place, sink, options)
        kept = None if failures is None else not failures
        yield Checked(verdict, kept, tuple(_witness(contract, one) for one in failures or ()))


def _is_demand(contract: Contract) -> bool:
    return contract.component.endswith(SUFFIX)


def _lint(contract: Contract, place: Place, sink: Sink, options: Options) -> None:
    try:
        lint(reduced(contract).contract, place, sink, manager_factory(options))
    except LimitError as problem:
        reached = str(problem)
        sink.report(GIVEN_UP, place(contract.origin), component=contract.component, reached=reached)


def _failures(
    behaviour: Contract, demanded: Contract, place: Place, sink: Sink, options: Options
) -> tuple[Failure, ...] | None:
    """Where the behaviour's contract does not refine that of the requirements; all reported.

    None when that is not decided.
    """
    try:
        failures = tuple(find_refinement_failures(behaviour, demanded, manager_factory(options)()))
    except (OutsideGr1Error, DomainError, LimitError) as problem:
        subject = place(behaviour.origin)
        reason = describe_problem(problem)
        sink.report(NOT_COMPARED, subject, component=behaviour.component, reason=reason)
        return None
    for failure in failures:
        rule = ASSUMES if failure.is_assumption else BREAKS
        report_failure(rule, failure, behaviour.component, place(failure.conjunct.origin), sink)
    return failures


def _witness(behaviour: Contract, failure: Failure) -> Witness:
    parties = (Party(behaviour.component, behaviour),)
    return Witness(behaviour.component, failure.conjunct, failure.trace, parties)
