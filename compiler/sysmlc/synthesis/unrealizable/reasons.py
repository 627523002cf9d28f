"""Why a contract cannot be kept, in words: what conflicts, and what would help."""

from collections.abc import Iterator

from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.bdd.manager import LimitError
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.unrealizable.core import unrealizable_core
from sysmlc.synthesis.unrealizable.helpful import helpful_assumptions

_WHEN = {Class.INIT: "at first", Class.SAFETY: "always", Class.LIVENESS: "again and again"}


def reasons_of(game: Game) -> Iterator[str]:
    """The guarantees of a lost game that cannot be kept together, then assumptions that would
    help, a line each."""
    try:
        yield from _conflict(game)
    except LimitError as problem:
        yield f"which guarantees cannot be kept together is not known: {problem}"
        return
    try:
        helpful = helpful_assumptions(game)
    except LimitError:
        return
    for one in helpful:
        yield f"it could be kept if this were assumed, {_WHEN[one.class_]}: {_said(one)}"


def _conflict(game: Game) -> Iterator[str]:
    core = unrealizable_core(game)
    known = {id(part.conjunct) for part in (*game.init_guarantees, *game.guarantees, *game.goals)}
    whole = len(known - {id(None)})
    yield (
        f"these {len(core)} of {whole} guarantees cannot be kept together; "
        "without any one of them the rest can:"
    )
    for one in core:
        text = f" ({one.text})" if one.text not in ("", _said(one)) else ""
        yield f"{_WHEN[one.class_]}: {_said(one)}{text}"


def _said(conjunct: Conjunct) -> str:
    return print_formula(conjunct.formula)
