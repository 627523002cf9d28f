"""Lints of one contract: assumptions and guarantees that are impossible, vacuous or misplaced.

Lints of the text come first, then those that explore runs and solve games.
"""

from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.basis import find_basis
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import rules
from sysmlc.synthesis.algebra.refinement import has_environment
from sysmlc.synthesis.bdd.manager import ManagerFactory
from sysmlc.synthesis.lints.checks import LintFinding, check_games, check_ownership, check_runs

Place = Callable[[str], Subject]
"""Maps the origin of a contract or conjunct to the subject of diagnostics."""


_LEFT_OPEN = (rules.NO_FRAME, rules.IDLE)
"""Findings about what a contract leaves open, which a behaviour may decide."""


def lint(
    contract: Contract,
    place: Place,
    sink: Sink,
    create_manager: ManagerFactory,
    *,
    has_behaviour: bool = False,
) -> None:
    """Report suspicious properties of a contract; *create_manager* is called for each lint.

    *has_behaviour*: the contract states requirements on a component with a behaviour, which decides
    what they leave open. Raises OutsideGr1Error for a contract that GR(1) cannot express,
    LimitError.
    """
    within = find_basis((contract,)).reservation
    for finding in _find_all(contract, create_manager):
        if has_behaviour and finding.rule in _LEFT_OPEN:
            continue
        origin = contract.origin if finding.conjunct is None else finding.conjunct.origin
        formula = "" if finding.conjunct is None else print_formula(finding.conjunct.formula)
        sink.report(
            finding.rule,
            place(origin),
            component=contract.component,
            formula=formula,
            name=finding.name,
            detail=finding.detail,
            within=within,
        )


def _find_all(contract: Contract, create_manager: ManagerFactory) -> Iterator[LintFinding]:
    findings = list(check_ownership(contract))
    yield from findings
    # A liveness conjunct about two steps is outside GR(1), so no game can be built.
    if any(finding.rule is rules.NEXT_IN_LIVENESS for finding in findings):
        return
    # Without any environment, every further lint would only show a consequence of that.
    if not has_environment(contract, create_manager()):
        yield LintFinding(rules.NO_ENVIRONMENT)
        return
    yield from check_runs(contract, create_manager())
    yield from check_games(contract, create_manager)


__all__ = ["lint"]
