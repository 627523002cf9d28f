"""What checks of contracts have in common: managers within limits, and how a failure is told."""

from collections.abc import Callable

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.logic.contract import Conjunct
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.algebra.relations import Failure
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decide import Options
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.witness import lines


def new_manager(options: Options) -> Callable[[], Manager]:
    """A manager within the limits for each question."""
    return lambda: Manager(options.engine, options.limits, options.progress)


def why_not(problem: Exception) -> str:
    """Why something was not decided, with the formula that stands in the way."""
    if isinstance(problem, OutsideGr1Error):
        return f"'{print_formula(problem.conjunct.formula)}': {problem}"
    return str(problem)


def said(conjunct: Conjunct) -> str:
    """What a conjunct says in words, in brackets."""
    return f" ({conjunct.text.removesuffix('.')})" if conjunct.text else ""


def report_failure(
    rule: Rule,
    failure: Failure,
    component: str,
    subject: Subject,
    sink: Sink,
    notes: tuple[str, ...] = (),
) -> None:
    """Report a conjunct that is not kept, with the run that shows it, then what else is noted."""
    conjunct = failure.conjunct
    sink.report(
        rule,
        subject,
        notes=(*lines(failure.trace, conjunct), *notes),
        component=component,
        formula=print_formula(conjunct.formula),
        said=said(conjunct),
    )
