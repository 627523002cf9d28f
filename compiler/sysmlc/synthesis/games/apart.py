"""Games that are several games: variables of which nothing is said together are played apart.

Who wins each of them wins them all at once. (Not the other way round: where the environment cannot
go on in one game, it has lost the others.)
"""

from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from sysmlc.synthesis.bdd.groups import tied
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.game import Game, Part


def independent(game: Game) -> tuple[Game, ...]:
    """The games that a game consists of; often it is one."""
    together = [_names(game, node) for node in _nodes(game)]
    for name, bits in game.definitions.items():
        together += [frozenset([name, *_names(game, node)]) for node in bits.values()]
    groups = tied(game.symbols.variables, together)
    return (game,) if len(groups) == 1 else tuple(_only(game, group) for group in groups)


def _nodes(game: Game) -> Iterator[Node]:
    for parts in (
        game.init_assumptions,
        game.init_guarantees,
        game.assumptions,
        game.guarantees,
        game.fairness,
        game.goals,
    ):
        yield from (part.node for part in parts)


def _names(game: Game, node: Node) -> frozenset[str]:
    return frozenset((*game.symbols.names(node), *game.symbols.names(node, primed=True)))


def _only(game: Game, names: frozenset[str]) -> Game:
    """What is said of some variables; what is said of none (true, false) is said in each game."""

    def of(parts: Iterable[Part]) -> tuple[Part, ...]:
        return tuple(part for part in parts if _names(game, part.node) <= names)

    return replace(
        game,
        symbols=game.symbols.only(names),
        init_assumptions=of(game.init_assumptions),
        init_guarantees=of(game.init_guarantees),
        assumptions=of(game.assumptions),
        guarantees=of(game.guarantees),
        fairness=of(game.fairness),
        goals=of(game.goals),
        definitions={name: bits for name, bits in game.definitions.items() if name in names},
    )
