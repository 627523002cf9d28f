"""Assumptions that would make a contract one that can be kept: what to ask of the environment.

What an environment does to win is taken from it one simple thing at a time: that an input recurs
with a value, that it stays as it is, always or while an output has a value (after Chatterjee,
Henzinger, Jobstmann 2008; the candidates are ours). An assumption that the component could make
the environment break is no help.
"""

from collections.abc import Iterator, Sequence
from itertools import islice

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Owner, Variable
from sysmlc.logic.domains import size, values
from sysmlc.logic.formula import Formula
from sysmlc.synthesis.games.game import Game, Part
from sysmlc.synthesis.unrealizable.core import is_won

MOST_TRIED = 60
"""Assumptions that are tried, a game or two each; of large games fewer, by the square."""
_SMALL = 20
"""Bits up to which a game is small."""
_MOST_VALUES = 6
"""Values of a variable up to which each of them is tried."""


def helpful_assumptions(game: Game, most: int = 3) -> tuple[Conjunct, ...]:
    """Some assumptions each of which makes a lost game a won one; the simplest first.

    Raises LimitError.
    """
    bits = max(_SMALL, len(game.inputs) + len(game.outputs))
    tried = islice(_candidates(game), MOST_TRIED * _SMALL**2 // bits**2)
    with game.manager.guard():
        return tuple(islice((one for one in tried if _helps(game, one)), most))


def _candidates(game: Game) -> Iterator[Conjunct]:
    """What may be asked: that values recur, that inputs stay, then that they stay for a while."""
    inputs = [game.symbols.variables[name] for name in game.names(Owner.ENVIRONMENT)]
    outputs = [game.symbols.variables[name] for name in game.names(Owner.SYSTEM)]
    for one in inputs:
        for now in _values(one):
            yield Conjunct(now, Class.LIVENESS, one.origin)
    for one in inputs:
        yield Conjunct(_stays(one), Class.SAFETY, one.origin)
    for other in outputs:
        for now in _values(other):
            for one in inputs:
                yield Conjunct(f.implies(now, _stays(one)), Class.SAFETY, one.origin)


def _values(variable: Variable) -> Sequence[Formula]:
    """That the variable has a value, for each of few."""
    if size(variable.domain) > _MOST_VALUES:
        return ()
    found = f.var(variable.name)
    return tuple(
        (found if value else f.negate(found))
        if isinstance(value, bool)
        else f.eq(found, f.const(value))
        for value in values(variable.domain)
    )


def _stays(variable: Variable) -> Formula:
    now = f.var(variable.name)
    after = f.primed(now)
    return (f.iff if isinstance(variable.domain, BooleanDomain) else f.eq)(after, now)


def _helps(game: Game, assumption: Conjunct) -> bool:
    game.manager.check("looking for assumptions that would help")
    part = Part(game.symbols.bdd(assumption.formula), assumption)
    if assumption.class_ is Class.LIVENESS:
        tried = replace(game, fairness=(*game.fairness, part))
    else:
        tried = replace(game, assumptions=(*game.assumptions, part))
    return is_won(tried) and not is_won(_only_assumed(tried))


def _only_assumed(game: Game) -> Game:
    """The game that the system wins when it can make the environment break an assumption."""
    false = Part(game.manager.false)

    def of(parts: Sequence[Part]) -> tuple[Part, ...]:
        return tuple(one for one in parts if one.conjunct is None)

    return replace(
        game,
        init_guarantees=of(game.init_guarantees),
        guarantees=of(game.guarantees),
        goals=(false,),
    )
