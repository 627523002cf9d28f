"""Which transitions can be enabled at once: by what occurs, and by their guards."""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import evaluation
from sysmlc.logic.expressions.elaborate import Scope, condition
from sysmlc.logic.expressions.expression import Expression, name_of
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.actions import walk
from sysmlc.logic.machines.machine import AfterTicks, OnEvent, Transition, Vertex

_LIMIT = 4096
"""Valuations tried to see whether two guards exclude one another; more count as possible."""


def may_compete(outgoing: tuple[Transition, ...], vertex: Vertex, scope: Scope) -> bool:
    """Whether two transitions that leave the vertex can be enabled at once."""
    if vertex.kind == "initial":
        return False
    is_state = vertex.kind == "state"
    return any(
        (not is_state or coincide(one, other)) and compatible(one, other, scope)
        for one, other in combinations(outgoing, 2)
    )


def have_common_cause(outgoing: tuple[Transition, ...], vertex: Vertex, scope: Scope) -> bool:
    """Whether two of them can be enabled by one and the same occurrence."""
    return any(
        (vertex.kind != "state" or _have_same_trigger(one, other)) and compatible(one, other, scope)
        for one, other in combinations(outgoing, 2)
    )


def _have_same_trigger(one: Transition, other: Transition) -> bool:
    if not one.occurrences or not other.occurrences:
        return not one.occurrences and not other.occurrences
    pairs = [(left, right) for left in one.occurrences for right in other.occurrences]
    return any(type(a) is type(b) and _same_step(a, b) for a, b in pairs)


def coincide(one: Transition, other: Transition) -> bool:
    """Whether both can have an occurrence in one step; completion goes before the rest."""
    if not one.occurrences or not other.occurrences:
        return not one.occurrences and not other.occurrences
    return any(_same_step(left, right) for left in one.occurrences for right in other.occurrences)


def _same_step(left: object, right: object) -> bool:
    if isinstance(left, OnEvent) and isinstance(right, OnEvent):
        return left.literal is None or right.literal is None or left.literal == right.literal
    if isinstance(left, AfterTicks) and isinstance(right, AfterTicks):
        return left.count == right.count
    return True


def simultaneous(one: Transition, other: Transition) -> bool:
    """As ``coincide``, for sources that can be active at the same time."""
    if not one.occurrences or not other.occurrences:
        return True
    events = [
        occurrence
        for occurrence in (*one.occurrences, *other.occurrences)
        if not isinstance(occurrence, OnEvent)
    ]
    return bool(events) or coincide(one, other)


def compatible(one: Transition, other: Transition, scope: Scope) -> bool:
    """Whether some values of the variables satisfy both guards."""
    guards = [guard for guard in (one.guard, other.guard) if guard is not None]
    return is_satisfiable(f.both(*(condition(guard, scope) for guard in guards)), guards, scope)


def is_satisfiable(formula: Formula, sources: list[Expression], scope: Scope) -> bool:
    """Whether some values make it true; beyond the limit of valuations the answer is yes."""
    if formula == f.FALSE:
        return False
    found = dict(_domains(sources, scope))
    if domains.count(found) > _LIMIT:
        return True
    truth = evaluation(formula)
    return any(truth(values, None) for values in domains.valuations(found))


def _domains(sources: list[Expression], scope: Scope) -> Iterator[tuple[str, Domain]]:
    for source in sources:
        for part in walk(source):
            name = name_of(part)
            symbol = None if name is None else scope(name)
            if symbol is not None and symbol.domain is not None:
                yield from ((v.name, symbol.domain) for v in f.variables(symbol.formula))
