"""Checks of requirements as viewpoints: whether each can be kept where only it assumes."""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.synthesis.algebra.viewpoints import conjoin_viewpoints
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decision import Options, Place
from sysmlc.synthesis.games.game import OutsideGr1Error, make_game
from sysmlc.synthesis.unrealizable.core import is_won, unrealizable_core

LEANS = rule(
    "SM599",
    "requirements-lean-on-one-another",
    Severity.WARNING,
    "the requirements of '{component}' can be kept together only where all that any of them "
    "assumes holds",
    help="let each requirement assume what it needs itself",
)


def check_viewpoints(contract: Contract, place: Place, sink: Sink, options: Options) -> bool | None:
    """Whether the conjunction of the requirements can be kept; None when that is not decided.

    ``contract`` is that of all requirements together, which can be kept.
    """
    try:
        game = make_game(
            conjoin_viewpoints(reduced(contract).contract),
            Manager(options.engine, options.limits, options.progress),
        )
        is_kept = is_won(game)
        core = () if is_kept else unrealizable_core(game)
    except (OutsideGr1Error, LimitError):
        return None
    if not is_kept:
        origins = {one.origin for one in core if one.viewpoint}
        notes = dict.fromkeys(
            f"'{one.viewpoint}' demands '{print_formula(one.formula)}'"
            for one in contract.guarantees
            if one.viewpoint and one.origin in origins
        )
        subject = place(contract.origin)
        sink.report(LEANS, subject, notes=tuple(notes), component=contract.component)
    return is_kept
