"""Why a contract cannot be kept, in words: what conflicts, and what would help."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.domains import size, values
from sysmlc.logic.formula import Formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.reduce import is_plain
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.games.game import Constraint, Game
from sysmlc.synthesis.unrealizable.core import is_won, unrealizable_core

_PREFIXES = {
    Class.INIT: "at first: ",
    Class.SAFETY: "always: ",
    Class.LIVENESS: "again and again: ",
    Class.OTHER: "",
}


def explain_unrealizability(game: Game, contract: Contract) -> Iterator[str]:
    """The guarantees of a lost game that cannot be kept together, then assumptions that would
    help, a line each; ``contract`` is the one that was written, before it was reduced to GR(1)."""
    try:
        yield from _describe_conflict(game, contract)
    except LimitError as problem:
        yield f"which guarantees cannot be kept together is not known: {problem}"
        return
    try:
        helpful = helpful_assumptions(game)
    except LimitError:
        return
    for one in helpful:
        yield f"it could be kept if this were assumed, {_print_conjunct(one)}"


def _describe_conflict(game: Game, contract: Contract) -> Iterator[str]:
    parts = (*game.init_guarantees, *game.guarantees, *game.goals)
    known = original_conjuncts((part.conjunct for part in parts if part.conjunct), contract)
    core = original_conjuncts(unrealizable_core(game), contract)
    yield (
        f"these {len(core)} of {len(known)} guarantees cannot be kept together; "
        "without any one of them the rest can:"
    )
    for one in core:
        text = f" ({one.text})" if one.text not in ("", print_formula(one.formula)) else ""
        yield f"{_print_conjunct(one)}{text}"


def original_conjuncts(conjuncts: Iterable[Conjunct], contract: Contract) -> list[Conjunct]:
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


def _print_conjunct(conjunct: Conjunct) -> str:
    return f"{_PREFIXES[conjunct.class_]}{print_formula(conjunct.formula)}"


MAX_TRIED = 60
"""Assumptions that are tried, a game or two each; of large games fewer, by the square."""
_SMALL_GAME_BITS = 20
"""Bits up to which a game is small."""
_MAX_VALUES = 6
"""Values of a variable up to which each of them is tried."""


def helpful_assumptions(game: Game, most: int = 3) -> tuple[Conjunct, ...]:
    """Some assumptions each of which makes a lost game a won one; the simplest first.

    Raises LimitError.
    """
    bits = max(_SMALL_GAME_BITS, len(game.inputs) + len(game.outputs))
    tried = islice(_candidate_assumptions(game), MAX_TRIED * _SMALL_GAME_BITS**2 // bits**2)
    with game.manager.guard():
        return tuple(islice((one for one in tried if _makes_realizable(game, one)), most))


def _candidate_assumptions(game: Game) -> Iterator[Conjunct]:
    """What may be asked: that values recur, that inputs stay, then that they stay for a while."""
    inputs = [game.symbols.variables[name] for name in game.names(Owner.ENVIRONMENT)]
    outputs = [game.symbols.variables[name] for name in game.names(Owner.SYSTEM)]
    for one in inputs:
        for now in _value_predicates(one):
            yield Conjunct(now, Class.LIVENESS, one.origin)
    for one in inputs:
        yield Conjunct(_frame_condition(one), Class.SAFETY, one.origin)
    for other in outputs:
        for now in _value_predicates(other):
            for one in inputs:
                yield Conjunct(f.implies(now, _frame_condition(one)), Class.SAFETY, one.origin)


def _value_predicates(variable: Variable) -> Sequence[Formula]:
    """That the variable has a value, for each of few."""
    if size(variable.domain) > _MAX_VALUES:
        return ()
    found = f.var(variable.name)
    return tuple(
        (found if value else f.negate(found))
        if isinstance(value, bool)
        else f.eq(found, f.const(value))
        for value in values(variable.domain)
    )


def _frame_condition(variable: Variable) -> Formula:
    now = f.var(variable.name)
    after = f.primed(now)
    return (f.iff if isinstance(variable.domain, BooleanDomain) else f.eq)(after, now)


def _makes_realizable(game: Game, assumption: Conjunct) -> bool:
    game.manager.check("looking for assumptions that would help")
    part = Constraint(game.symbols.bdd(assumption.formula), assumption)
    if assumption.class_ is Class.LIVENESS:
        tried = replace(game, fairness=(*game.fairness, part))
    else:
        tried = replace(game, assumptions=(*game.assumptions, part))
    return is_won(tried) and not is_won(_game_against_assumptions(tried))


def _game_against_assumptions(game: Game) -> Game:
    """The game that the system wins when it can make the environment break an assumption."""
    false = Constraint(game.manager.false)

    def of(parts: Sequence[Constraint]) -> tuple[Constraint, ...]:
        return tuple(one for one in parts if one.conjunct is None)

    return replace(
        game,
        init_guarantees=of(game.init_guarantees),
        guarantees=of(game.guarantees),
        goals=(false,),
    )
