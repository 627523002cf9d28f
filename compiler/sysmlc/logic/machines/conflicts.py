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
MAX_VALUATIONS = 2_000_000
"""Valuations tried for all guards of a machine, about 2 s of work: every transition may have to be
compared with every other."""


class TooManyValuationsError(Exception):
    """The guards of a machine have too many combinations of values to be compared."""


class GuardComparison:
    """Compares guards of the transitions of one machine, with a bound on the work in all."""

    def __init__(self, scope: Scope) -> None:
        self._scope = scope
        self._remaining = MAX_VALUATIONS
        self._guards: dict[str, tuple[Formula, dict[str, Domain]]] = {}
        """The guard of each transition, by its id, and the domains of the variables in it."""

    def are_compatible(self, left: Transition, right: Transition) -> bool:
        """Return whether some values of the variables satisfy both guards.

        If one comparison has more than ``_LIMIT`` valuations, the answer is yes. Raises
        TooManyValuationsError beyond the bound for the machine.
        """
        left_guard, left_domains = self._read_guard(left)
        right_guard, right_domains = self._read_guard(right)
        formula = f.both(left_guard, right_guard)
        if formula == f.FALSE:
            return False
        variables = left_domains | right_domains
        count = domains.count(variables)
        if count > _LIMIT:
            return True
        self._remaining -= count
        if self._remaining < 0:
            raise TooManyValuationsError
        is_true = evaluation(formula)
        return any(is_true(values, None) for values in domains.valuations(variables))

    def _read_guard(self, transition: Transition) -> tuple[Formula, dict[str, Domain]]:
        guard = transition.guard
        if guard is None:
            return f.TRUE, {}
        if transition.id not in self._guards:
            variables = dict(_find_domains(guard, self._scope))
            self._guards[transition.id] = condition(guard, self._scope), variables
        return self._guards[transition.id]


def may_compete(
    outgoing: tuple[Transition, ...], vertex: Vertex, comparison: GuardComparison
) -> bool:
    """Return whether two transitions that leave the vertex can be enabled at once."""
    if vertex.kind == "initial":
        return False
    is_state = vertex.kind == "state"
    return any(
        (not is_state or coincide(one, other)) and comparison.are_compatible(one, other)
        for one, other in combinations(outgoing, 2)
    )


def have_common_cause(
    outgoing: tuple[Transition, ...], vertex: Vertex, comparison: GuardComparison
) -> bool:
    """Return whether two of the transitions can be enabled by one and the same occurrence."""
    return any(
        (vertex.kind != "state" or _have_same_trigger(one, other))
        and comparison.are_compatible(one, other)
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


def _find_domains(source: Expression, scope: Scope) -> Iterator[tuple[str, Domain]]:
    for part in walk(source):
        name = name_of(part)
        symbol = None if name is None else scope(name)
        if symbol is not None and symbol.domain is not None:
            yield from ((v.name, symbol.domain) for v in f.variables(symbol.formula))
