"""The environment's winning strategy in a lost game: the dual of the fixpoint in ``solver``.

States in which the environment wins are divided into ranks. In a state of a rank, the environment
satisfies its assumptions and prevents one goal forever, unless the system moves to a state of an
earlier rank (Könighofer, Hofferek, Bloem 2013: counter-strategies of GR(1) games).
"""

from collections.abc import Iterator, Mapping

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.symbols import current_bit, next_bit
from sysmlc.synthesis.games.arena import Arena, PredecessorOperator, build_plain_arena
from sysmlc.synthesis.games.game import Game


class Rank(Struct, frozen=True):
    """States in which the environment wins by preventing one goal or reaching an earlier rank."""

    states: Node
    """The states of this rank and of all earlier ones."""
    goal: int
    """The index of the prevented goal."""
    stay: Node
    """The states in which the play stays while the goal is prevented."""
    fairness_layers: tuple[tuple[Node, ...], ...]
    """For each fairness assumption, its attractor as layers: the states from which the environment
    can satisfy it within 0, 1, 2 ... steps."""


class LostGame(Struct, frozen=True):
    """A game that the environment wins."""

    game: Game
    arena: Arena
    goals: tuple[Node, ...]
    """The liveness guarantees; true if there are none."""
    fairness: tuple[Node, ...]
    """The liveness assumptions; true if there are none."""
    ranks: tuple[Rank, ...]

    @property
    def states(self) -> Node:
        """All states in which the environment wins."""
        return self.ranks[-1].states if self.ranks else self.arena.manager.false


def find_ranks(game: Game) -> LostGame:
    """Return the ranks of the states in which the environment wins. Raises LimitError."""
    arena = build_plain_arena(game)
    true = arena.manager.true
    goals, fairness = arena.goals or (true,), arena.fairness or (true,)
    with arena.manager.guard():
        ranks = tuple(_RankSearch(arena, goals, fairness).iter_ranks())
        return LostGame(game, arena, goals, fairness, ranks)


class _RankSearch:
    def __init__(self, arena: Arena, goals: tuple[Node, ...], fairness: tuple[Node, ...]) -> None:
        self._arena, self._goals, self._fairness = arena, goals, fairness
        self._steps = PredecessorOperator(arena)

    def iter_ranks(self) -> Iterator[Rank]:
        """Compute ranks until no goal can be prevented from more states."""
        # A least fixpoint: cycle through the goals until none of them adds states.
        won = self._arena.manager.false
        unchanged_goals, goal = 0, 0
        while unchanged_goals < len(self._goals):
            rank = self._compute_rank(goal, won)
            unchanged_goals = unchanged_goals + 1 if rank.states == won else 0
            if rank.states != won:
                yield rank
            won, goal = rank.states, (goal + 1) % len(self._goals)

    def _compute_rank(self, goal: int, won: Node) -> Rank:
        """Return the rank of the states in which the goal is prevented or *won* is reached."""
        # A greatest fixpoint: within `stay`, the environment can reach each fairness assumption
        # again and again without satisfying the goal.
        allowed = ~self._goals[goal] | self._steps.environment_predecessors(won)
        stay = self._arena.states
        while True:
            candidates = allowed & self._steps.environment_predecessors(stay) & self._arena.states
            attractors = tuple(self._attractor_layers(fair, candidates) for fair in self._fairness)
            layers = (attractor[-1] for attractor in attractors)
            shrunk = stay & self._arena.manager.conjoin(layers)
            if shrunk == stay:
                return Rank(won | stay, goal, stay, attractors)
            stay = shrunk

    def _attractor_layers(self, fair: Node, within: Node) -> tuple[Node, ...]:
        """Return the attractor of *fair* inside *within*; each layer contains the previous one."""
        layers = [within & fair]
        while True:
            extended = layers[-1] | (within & self._steps.environment_predecessors(layers[-1]))
            if extended == layers[-1]:
                return tuple(layers)
            layers.append(extended)
            self._arena.manager.check("computing how the environment wins")


Bits = Mapping[str, bool]


class NotLostError(ValueError):
    """Reports that the environment does not win: the contract is realizable."""


class EnvironmentStrategy:
    """A winning strategy of the environment, evaluated step by step.

    Its memory is the index of the fairness assumption that is satisfied next. Valuations (``Bits``)
    map the names of unprimed bits to values.
    """

    def __init__(self, lost_game: LostGame) -> None:
        """Choose the first inputs. Raises NotLostError if the environment does not win."""
        self.lost_game = lost_game
        self._arena = lost_game.arena
        self.first = self._first_inputs()

    def _first_inputs(self) -> Bits:
        """Return first inputs after which every answer of the system is losing."""
        input_turn, answer_turn = self._arena.start
        manager = self._arena.manager
        escaping_answers = manager.conjoin(answer_turn.parts) & ~self.lost_game.states
        winning_inputs = manager.conjoin(input_turn.parts)
        winning_inputs = winning_inputs & ~manager.exist(answer_turn.bits, escaping_answers)
        inputs = manager.pick(winning_inputs, input_turn.bits)
        if inputs is None:
            raise NotLostError("the environment does not win")
        return inputs

    def iter_answers(self, state: Bits | None, inputs: Bits) -> Iterator[Bits]:
        """Yield the answers that the guarantees allow after *inputs*; none if the system is stuck.

        *state* is the previous step, None in the first step.
        """
        answer_turn, values = self._arena.start[1], inputs
        if state is not None:
            answer_turn = self._arena.turns[1]
            values = {**state, **{next_bit(bit): value for bit, value in inputs.items()}}
        manager = self._arena.manager
        allowed = manager.conjoin(manager.assign(part, values) for part in answer_turn.parts)
        while (answer := manager.pick(allowed, answer_turn.bits)) is not None:
            yield _unprime(answer)
            allowed = allowed & ~manager.cube(answer)

    def rank(self, state: Bits) -> Rank:
        """Return the first rank that contains the state.

        Raises NotLostError if the system wins from the state.
        """
        for rank in self.lost_game.ranks:
            if self._holds(rank.states, state):
                return rank
        raise NotLostError("the system wins from here")

    def next_inputs(self, state: Bits, fair: int) -> tuple[Bits, int]:
        """Return the next inputs, and the index of the fairness assumption to satisfy next.

        *fair* is the current index.
        """
        rank = self.rank(state)
        # A goal state belongs to the rank only because an earlier rank can be forced from it.
        if self._holds(self.lost_game.goals[rank.goal], state):
            earlier = self.lost_game.ranks[: self.lost_game.ranks.index(rank)]
            target = earlier[-1].states if earlier else self._arena.manager.false
            return self._inputs_towards(state, target), 0
        if self._holds(self.lost_game.fairness[fair], state):
            return self._inputs_towards(state, rank.stay), (fair + 1) % len(self.lost_game.fairness)
        attractor = rank.fairness_layers[fair]
        index = next(layer for layer, states in enumerate(attractor) if self._holds(states, state))
        return self._inputs_towards(state, attractor[index - 1]), fair

    def _inputs_towards(self, state: Bits, target: Node) -> Bits:
        """Return inputs after which all answers lead to *target*; unchanged inputs if possible."""
        manager = self._arena.manager
        input_turn, answer_turn = self._arena.turns
        winning_inputs, allowed_answers = (
            manager.conjoin(manager.assign(part, state) for part in turn.parts)
            for turn in (input_turn, answer_turn)
        )
        escaping_answers = allowed_answers & ~self._arena.symbols.prime(target)
        winning_inputs = winning_inputs & ~manager.exist(answer_turn.bits, escaping_answers)
        current_inputs = {next_bit(bit): state[bit] for bit in self.first}
        if self._holds(winning_inputs, current_inputs):
            return {bit: state[bit] for bit in self.first}
        return _unprime(manager.pick(winning_inputs, input_turn.bits) or {})

    def _holds(self, node: Node, values: Bits) -> bool:
        manager = self._arena.manager
        return manager.assign(node, values) == manager.true


def _unprime(next_values: Bits) -> Bits:
    """Return the values with unprimed names of bits."""
    return {current_bit(bit): value for bit, value in next_values.items()}
