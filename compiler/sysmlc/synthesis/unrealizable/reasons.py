"""Why a contract cannot be kept, in words: what conflicts, and what would help."""

from collections.abc import Iterable, Iterator

from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.reduce import is_plain
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.unrealizable.core import unrealizable_core
from sysmlc.synthesis.unrealizable.helpful import helpful_assumptions

_WHEN = {
    Class.INIT: "at first: ",
    Class.SAFETY: "always: ",
    Class.LIVENESS: "again and again: ",
    Class.OTHER: "",
}


def reasons_of(game: Game, contract: Contract) -> Iterator[str]:
    """The guarantees of a lost game that cannot be kept together, then assumptions that would
    help, a line each; ``contract`` is the one that was written, before it was reduced to GR(1)."""
    try:
        yield from _conflict(game, contract)
    except LimitError as problem:
        yield f"which guarantees cannot be kept together is not known: {problem}"
        return
    try:
        helpful = helpful_assumptions(game)
    except LimitError:
        return
    for one in helpful:
        yield f"it could be kept if this were assumed, {_said(one)}"


def _conflict(game: Game, contract: Contract) -> Iterator[str]:
    parts = (*game.init_guarantees, *game.guarantees, *game.goals)
    known = as_written((part.conjunct for part in parts if part.conjunct), contract)
    core = as_written(unrealizable_core(game), contract)
    yield (
        f"these {len(core)} of {len(known)} guarantees cannot be kept together; "
        "without any one of them the rest can:"
    )
    for one in core:
        text = f" ({one.text})" if one.text not in ("", print_formula(one.formula)) else ""
        yield f"{_said(one)}{text}"


def as_written(conjuncts: Iterable[Conjunct], contract: Contract) -> list[Conjunct]:
    """The conjuncts, each once; in place of what a guarantee was reduced to, the guarantee."""
    written = {id(one) for one in contract.guarantees}
    formulas: dict[str, list[Conjunct]] = {}
    for one in contract.guarantees:
        if not is_plain(one):
            formulas.setdefault(one.origin, []).append(one)
    found: dict[int, Conjunct] = {}
    for one in conjuncts:
        of = [] if id(one) in written else formulas.get(one.origin, [])
        kept = of[0] if len(of) == 1 else one
        found.setdefault(id(kept), kept)
    return list(found.values())


def _said(conjunct: Conjunct) -> str:
    return f"{_WHEN[conjunct.class_]}{print_formula(conjunct.formula)}"
