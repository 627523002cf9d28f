"""All checks of one contract, those of its text first; what needs a decision comes after."""

from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.algebra.relations import environment
from sysmlc.synthesis.lints import rules
from sysmlc.synthesis.lints.games import NewManager, of_games
from sysmlc.synthesis.lints.runs import of_runs
from sysmlc.synthesis.lints.words import Remark, of_words, timely

Place = Callable[[str], Subject]
"""From the origin of a contract or of a conjunct to what findings are about."""


def lint(contract: Contract, place: Place, sink: Sink, new: NewManager) -> None:
    """Report what is suspicious in a contract; ``new`` makes a manager for each question.

    Raises OutsideGr1Error for a contract that GR(1) cannot say, LimitError.
    """
    for remark in _remarks(contract, new):
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


def _remarks(contract: Contract, new: NewManager) -> Iterator[Remark]:
    said = list(of_words(contract))
    yield from said
    if any(one.rule is rules.NEXT_IN_LIVENESS for one in said):
        return
    if environment(contract, new()) is None:
        yield Remark(rules.NO_ENVIRONMENT)
        return
    yield from of_runs(timely(contract), new())
    yield from of_games(contract, new)
