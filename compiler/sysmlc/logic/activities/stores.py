"""What becomes of the variables that an activity writes: their start, each write, and their frame.

Of several nodes that write one variable in the same step one is the last, which is left open
(UML 2.5.1, 15.2.3: what flows do not order happens in any order).
"""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.activities.step_formulas import Game
from sysmlc.logic.activities.token_graph import ACTIVITY_REGION, Store, Write
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.printing import print_formula, print_literal


def starts(store: Store) -> Iterator[Conjunct]:
    """The value at the start, where the model gives one."""
    if store.first is not None:
        text = f"At the start '{store.variable.name}' is {print_literal(store.first)}."
        value = _equals(store, Const(store.first), is_next=False)
        yield Conjunct(value, Class.INIT, store.variable.origin, text)


def updates(game: Game, store: Store) -> Iterator[Conjunct]:
    """Each write, the start of another run of the activity, and that nothing else changes it."""
    again = game.begins(ACTIVITY_REGION) if store.local and store.first is not None else f.FALSE
    fired = [game.finishes(game.graph.node(write.node)) for write in store.writes]
    for write, fires in zip(store.writes, fired, strict=True):
        yield from _write(game, store, write, fires, _at_once(game, store, write))
    origin, name = store.variable.origin, store.variable.name
    if store.first is not None and again != f.FALSE:
        value = _equals(store, Const(store.first), is_next=True)
        text = f"'{name}' is {print_literal(store.first)} whenever {game.graph.label} starts."
        yield Conjunct(f.implies(again, value), Class.SAFETY, origin, text)
    same = _equals(store, f.var(name), is_next=True)
    frame = f.implies(f.negate(f.either(*fired, again)), same)
    text = f"'{name}' keeps its value until an action writes another."
    yield Conjunct(frame, Class.SAFETY, origin, text)


def _at_once(game: Game, store: Store, write: Write) -> list[Formula]:
    """The other writes that may happen in the same step."""
    others = (other for other in store.writes if other is not write)
    beside = [one for one in others if game.together.are(write.node, one.node)]
    return [way for one in beside for way in _ways(game, store, one)]


def _write(
    game: Game, store: Store, write: Write, fires: Formula, at_once: list[Formula]
) -> Iterator[Conjunct]:
    node, name = game.graph.node(write.node), store.variable.name
    for condition, value in write.values:
        case = f.both(fires, condition)
        given = f.either(_equals(store, value, is_next=True), *at_once)
        text = (
            f"When {node.label} is done{_and(condition)}, '{name}' becomes {_shown(write, value)}."
        )
        yield Conjunct(f.implies(case, given), Class.SAFETY, node.origin, text)


def _and(condition: Formula) -> str:
    return "" if condition == f.TRUE else f" and {print_formula(condition)}"


def _shown(write: Write, value: Formula) -> str:
    return write.text if write.text and len(write.values) == 1 else print_formula(value)


def _ways(game: Game, store: Store, write: Write) -> Iterator[Formula]:
    """The write happens in this step, and gives one of its values."""
    fires = game.finishes(game.graph.node(write.node))
    for condition, value in write.values:
        yield f.both(fires, condition, _equals(store, value, is_next=True))


def _equals(store: Store, value: Formula, *, is_next: bool) -> Formula:
    name = f.var(store.variable.name)
    variable = f.primed(name) if is_next else name
    if not isinstance(store.variable.domain, BooleanDomain):
        return f.eq(variable, value)
    if isinstance(value, Const):
        return variable if value.value else f.negate(variable)
    return f.iff(variable, value)
