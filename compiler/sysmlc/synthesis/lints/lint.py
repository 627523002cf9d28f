"""All checks of one contract, those of its text first; what needs a decision comes after."""

from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.algebra.refinement import find_environment_run
from sysmlc.synthesis.lints import rules
from sysmlc.synthesis.lints.game_checks import ManagerFactory, check_games, check_runs
from sysmlc.synthesis.lints.text_checks import (
    LintFinding,
    check_ownership,
    state_assumptions_of_next_step,
)

Place = Callable[[str], Subject]
"""From the origin of a contract or of a conjunct to what findings are about."""


def lint(contract: Contract, place: Place, sink: Sink, new: ManagerFactory) -> None:
    """Report what is suspicious in a contract; ``new`` makes a manager for each question.

    Raises OutsideGr1Error for a contract that GR(1) cannot say, LimitError.
    """
    for remark in _find_all(contract, new):
        origin = contract.origin if remark.conjunct is None else remark.conjunct.origin
        formula = "" if remark.conjunct is None else print_formula(remark.conjunct.formula)
        sink.report(
            remark.rule,
            place(origin),
            component=contract.component,
            formula=formula,
            name=remark.name,
            said=remark.said,
        )


def _find_all(contract: Contract, new: ManagerFactory) -> Iterator[LintFinding]:
    said = list(check_ownership(contract))
    yield from said
    if any(one.rule is rules.NEXT_IN_LIVENESS for one in said):
        return
    if find_environment_run(contract, new()) is None:
        yield LintFinding(rules.NO_ENVIRONMENT)
        return
    yield from check_runs(state_assumptions_of_next_step(contract), new())
    yield from check_games(contract, new)
