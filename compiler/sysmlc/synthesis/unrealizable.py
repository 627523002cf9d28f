"""Unrealizable contracts: the unrealizable core, and assumptions that make them realizable.

The core is a minimal set of guarantees that cannot be satisfied together under the assumptions. It
is searched with QuickXplain (Junker 2004), which examines halves before single items, so a small
conflict among many items takes few checks.

The candidates for assumptions restrict the environment in one simple way: an input recurs with some
value, or it stays constant, always or while an output has some value (after Chatterjee, Henzinger,
Jobstmann 2008, with other candidates). Assumptions that the component could force the environment
to violate are excluded.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from typing import Generic, TypeVar

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner, Variable, equals
from sysmlc.logic.domains import size, values
from sysmlc.logic.formula import Formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import is_gr1
from sysmlc.logic.region_formulas import print_worded
from sysmlc.support.counts import count
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.game import Constraint, Game
from sysmlc.synthesis.games.solver import solve_arena
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables

T = TypeVar("T")
MAX_CHECKS = 200
"""Checks after which the search ends, although the result may not be minimal."""


def find_minimal_conflict(
    items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], max_checks: int = MAX_CHECKS
) -> tuple[T, ...]:
    """Return a minimal conflicting subset of the conflicting *items*, in their order.

    The subset may not be minimal if the search ends after *max_checks* checks.
    """
    return _QuickXplain(items, is_conflict, max_checks).run()


class _QuickXplain(Generic[T]):
    """The search for a minimal conflict (Junker 2004).

    A recursive closure instead would be a cycle of references to the manager of diagrams, which the
    collector must not free (``bdd.limits``).
    """

    def __init__(
        self, items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], max_checks: int
    ) -> None:
        self._items = items
        self._is_conflict = is_conflict
        self._checks_left = max_checks

    def run(self) -> tuple[T, ...]:
        """Return the minimal conflict, in the order of the items."""
        conflict = set(self._reduce((), range(len(self._items)), is_new=True))
        return tuple(item for index, item in enumerate(self._items) if index in conflict)

    def _reduce(
        self, background: Sequence[int], candidates: Sequence[int], is_new: bool
    ) -> tuple[int, ...]:
        """Return a minimal set of candidates that is in conflict with the background.

        *is_new* tells whether the background has been extended since its last check.
        """
        if is_new and self._check(background):
            return ()
        if len(candidates) == 1 or not self._checks_left:
            return tuple(candidates)
        first, second = candidates[: len(candidates) // 2], candidates[len(candidates) // 2 :]
        second_needed = self._reduce((*background, *first), second, is_new=bool(first))
        return (
            *self._reduce((*background, *second_needed), first, is_new=bool(second_needed)),
            *second_needed,
        )

    def _check(self, indices: Sequence[int]) -> bool:
        """Return whether the items are known to be in conflict; False when no checks are left."""
        if not self._checks_left:
            return False
        self._checks_left -= 1
        return self._is_conflict([self._items[index] for index in indices])


def find_unrealizable_core(game: Game, max_checks: int = MAX_CHECKS) -> tuple[Conjunct, ...]:
    """Return a minimal set of guarantees of a lost game that cannot be satisfied together.

    The set may not be minimal if the search ends after *max_checks* games. It is empty if the
    ranges of variables alone are unrealizable. Raises LimitError.
    """
    parts = (*game.init_guarantees, *game.guarantees, *game.goals)
    guarantees = [part for part in parts if part.conjunct is not None]
    core = find_minimal_conflict(
        guarantees,
        lambda subset: not is_won(_keep_guarantees(game, guarantees, subset)),
        max_checks,
    )
    return tuple(part.conjunct for part in core if part.conjunct is not None)


def _keep_guarantees(
    game: Game, guarantees: Sequence[Constraint], kept_guarantees: Sequence[Constraint]
) -> Game:
    """Return the game with *kept_guarantees* only; ranges of variables stay."""
    removed = {id(part) for part in guarantees} - {id(part) for part in kept_guarantees}

    def filter_parts(parts: Sequence[Constraint]) -> tuple[Constraint, ...]:
        return tuple(part for part in parts if id(part) not in removed)

    return replace(
        game,
        init_guarantees=filter_parts(game.init_guarantees),
        guarantees=filter_parts(game.guarantees),
        goals=filter_parts(game.goals),
    )


def is_won(game: Game) -> bool:
    """Whether the system wins a game. Raises LimitError."""
    with game.manager.guard():
        arena = eliminate_commands(eliminate_determined_variables(game))
    return solve_arena(arena, is_complete=False).is_realizable


# -- explanation -------------------------------------------------------------------------------

_PREFIXES = {
    Class.INIT: "at first: ",
    Class.SAFETY: "always: ",
    Class.LIVENESS: "again and again: ",
    Class.OTHER: "",
}


def explain_unrealizability(game: Game, contract: Contract) -> Iterator[str]:
    """Yield a line for each conflicting guarantee of a lost game, then for each helpful assumption.

    *contract* is the original contract, before its reduction to GR(1).
    """
    try:
        yield from _describe_conflict(game, contract)
    except LimitError as problem:
        yield f"the conflicting guarantees are unknown: {problem}"
        return
    try:
        helpful = find_helpful_assumptions(game)
    except LimitError:
        return
    for assumption in helpful:
        shown = _print_conjunct(assumption, contract)
        yield f"it is realizable under the further assumption {shown}"


def _describe_conflict(game: Game, contract: Contract) -> Iterator[str]:
    parts = (*game.init_guarantees, *game.guarantees, *game.goals)
    guarantees = find_original_conjuncts(
        (part.conjunct for part in parts if part.conjunct), contract
    )
    core = find_original_conjuncts(find_unrealizable_core(game), contract)
    number = count(len(guarantees), "guarantee")
    if len(core) == 1:
        yield f"this one of {number} cannot be satisfied:"
    else:
        yield (
            f"these {len(core)} of {number} cannot be satisfied together; "
            "without any one of them the rest can:"
        )
    for conjunct in core:
        is_new = conjunct.text not in ("", print_formula(conjunct.formula))
        text = f" ({conjunct.text})" if is_new else ""
        yield f"{_print_conjunct(conjunct, contract)}{text}"


def find_original_conjuncts(conjuncts: Iterable[Conjunct], contract: Contract) -> list[Conjunct]:
    """Return the conjuncts of *contract* from which *conjuncts* are derived, without repetition.

    A conjunct that the reduction to GR(1) has made belongs to the guarantee with its origin. If
    several guarantees have the same origin, the reduced conjunct itself is returned.
    """
    guarantee_ids = {id(conjunct) for conjunct in contract.guarantees}
    formulas: dict[str, list[Conjunct]] = {}
    for conjunct in contract.guarantees:
        if not is_gr1(conjunct):
            formulas.setdefault(conjunct.origin, []).append(conjunct)
    result: dict[int, Conjunct] = {}
    for conjunct in conjuncts:
        guarantees = [] if id(conjunct) in guarantee_ids else formulas.get(conjunct.origin, [])
        original = guarantees[0] if len(guarantees) == 1 else conjunct
        result.setdefault(id(original), original)
    return list(result.values())


def _print_conjunct(conjunct: Conjunct, contract: Contract) -> str:
    formula = print_worded(conjunct.formula, contract.variables)
    return f"{_PREFIXES[conjunct.class_]}{formula}"


MAX_CANDIDATES = 60
"""Candidates that are tried in a small game, with one or two games each. In larger games the number
decreases with the square of the number of bits."""
_SMALL_GAME_BITS = 20
"""Bits up to which a game is small."""
_MAX_VALUES = 6
"""Values of a variable up to which there is a candidate for each value."""


def find_helpful_assumptions(game: Game, max_assumptions: int = 3) -> tuple[Conjunct, ...]:
    """Return assumptions each of which makes a lost game realizable, the simplest first.

    Raises LimitError.
    """
    bits = max(_SMALL_GAME_BITS, len(game.inputs) + len(game.outputs))
    candidates = islice(_iter_candidates(game), MAX_CANDIDATES * _SMALL_GAME_BITS**2 // bits**2)
    with game.manager.guard():
        return tuple(
            islice(
                (candidate for candidate in candidates if _makes_realizable(game, candidate)),
                max_assumptions,
            )
        )


def _iter_candidates(game: Game) -> Iterator[Conjunct]:
    """Yield candidates, the simplest first.

    They state that an input recurs with a value, that it is constant, or that it is constant while
    an output has a value.
    """
    inputs = [game.symbols.variables[name] for name in game.names(Owner.ENVIRONMENT)]
    outputs = [game.symbols.variables[name] for name in game.names(Owner.SYSTEM)]
    for input_variable in inputs:
        for predicate in _list_value_predicates(input_variable):
            yield Conjunct(predicate, Class.LIVENESS, input_variable.origin)
    frames = [(equals(v, f.var(v.name), is_next=True), v.origin) for v in inputs]
    for frame, origin in frames:
        yield Conjunct(frame, Class.SAFETY, origin)
    for output in outputs:
        for predicate in _list_value_predicates(output):
            for frame, origin in frames:
                yield Conjunct(f.implies(predicate, frame), Class.SAFETY, origin)


def _list_value_predicates(variable: Variable) -> Sequence[Formula]:
    """Return for each value the predicate that the variable has it; none for many values."""
    if size(variable.domain) > _MAX_VALUES:
        return ()
    return [equals(variable, f.const(value)) for value in values(variable.domain)]


def _makes_realizable(game: Game, assumption: Conjunct) -> bool:
    """Return whether the assumption makes the game won, and not only because it can be violated."""
    game.manager.check("searching for assumptions that would help")
    part = Constraint(game.symbols.bdd(assumption.formula), assumption)
    if assumption.class_ is Class.LIVENESS:
        extended_game = replace(game, fairness=(*game.fairness, part))
    else:
        extended_game = replace(game, assumptions=(*game.assumptions, part))
    return is_won(extended_game) and not is_won(_make_game_against_assumptions(extended_game))


def _make_game_against_assumptions(game: Game) -> Game:
    """Return a game that the system wins only if it can force a violated assumption."""
    false = Constraint(game.manager.false)

    def drop_guarantees(parts: Sequence[Constraint]) -> tuple[Constraint, ...]:
        return tuple(part for part in parts if part.conjunct is None)

    return replace(
        game,
        init_guarantees=drop_guarantees(game.init_guarantees),
        guarantees=drop_guarantees(game.guarantees),
        goals=(false,),
    )
