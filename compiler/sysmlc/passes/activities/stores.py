"""The variables that an activity writes and its contract follows; the others are told (SM544)."""

from collections.abc import Iterable, Iterator
from itertools import product

from msgspec.structs import replace

from sysmlc.ir import Element, Graph, query
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import Store, TokenGraph, Write
from sysmlc.logic.contract import Domain, IntegerDomain, Owner, Variable
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.elaborate import ElaborationError
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.paths import split_by_range
from sysmlc.logic.simplify import is_satisfiable, substitute, tidy
from sysmlc.logic.writers import Writers, called
from sysmlc.logic.written import Assigned
from sysmlc.passes.activities.assignments import Written
from sysmlc.passes.activities.refusals import (
    DECIDED,
    ELSEWHERE,
    ENDLESS,
    UNKNOWN,
    WIDE,
    Refusal,
    Unfollowed,
    shared,
)
from sysmlc.passes.activities.scope import Scope

_Cases = tuple[tuple[Formula, Formula], ...]
_Way = tuple[Formula, Formula, bool]
_MOST_CASES = 64
"""Most cases of what an action leaves in a variable: assignments in a row multiply them."""


def follow(
    graph: Graph,
    activity: Element,
    written: Iterable[list[Written]],
    tokens: TokenGraph,
    scope: Scope,
    writers: Writers,
) -> tuple[TokenGraph, list[Unfollowed]]:
    """The token graph with the variables that its nodes write; and what it reads but cannot
    follow. ``written`` is what each action assigns.
    """
    found = _Following(graph, activity, tokens, scope, writers)
    for statements in written:
        found.note(statements)
    if not found.assigned:
        return tokens, []
    return found.followed(), found.unfollowed()


class _Following:
    """Features that actions of one activity assign, by the names of their variables."""

    def __init__(
        self,
        graph: Graph,
        activity: Element,
        tokens: TokenGraph,
        scope: Scope,
        writers: Writers,
    ) -> None:
        self.graph, self.activity, self.tokens, self.scope = graph, activity, tokens, scope
        self.writers = writers
        self.nodes = {node.id: node for node in tokens.workers()}
        self.features: dict[str, Feature] = {}
        self.assigned: dict[str, list[Assigned]] = {}
        self.writes: dict[str, list[Write]] = {}
        self.refused: dict[str, Refusal] = {}
        self.outside: set[str] = set()
        """Actions that assign what no value of a range is."""
        self.others: dict[str, Element | None] = {}
        self.read: set[str] = set()

    def note(self, statements: list[Written]) -> None:
        """Remember what an action assigns, and the value that it leaves in each variable."""
        left: dict[str, _Cases] = {}
        stops: dict[str, list[Formula]] = {}
        for one, feature in ((each.said, each.feature) for each in statements):
            if feature is None:
                continue
            name = feature.variable
            self.features[name] = feature
            self.assigned.setdefault(name, []).append(one)
            ways = self._cases(one, feature, left)
            if ways:
                left[name] = tuple((when, value) for when, value, _ in ways)
                stops.setdefault(name, []).extend(when for when, _, is_bound in ways if is_bound)
            else:
                left.pop(name, None)
                said = f"'{one.text}' is not known, or has too many cases"
                why = replace(UNKNOWN, reason=said) if one.text else UNKNOWN
                self.refused.setdefault(name, why)
        first = statements[0].said
        node = first.action.id
        text = first.text if len(statements) == 1 and node not in self.outside else ""
        for name, cases in left.items():
            self.writes.setdefault(name, []).append(Write(node, text, cases, tuple(stops[name])))

    def _cases(self, one: Assigned, feature: Feature, left: dict[str, _Cases]) -> list[_Way]:
        """The values that an assignment gives, each with its condition and whether it is a bound
        that it would pass; none when the value is unknown.
        """
        if one.value is None or feature.domain is None:
            return []
        try:
            found = self.scope.value(one.value, feature.domain)
        except ElaborationError:
            return []
        if _is_outside(feature.domain, found.domain):
            self.outside.add(one.action.id)
        after = (way for t in found.terms for way in _after(t.condition, t.value, left))
        ways: list[_Way] = []
        for case, value in after:
            for when, given, is_bound in _within(case, value, feature.domain, found.domain):
                possible = self._possible(when)
                ways += [(possible, given, is_bound)] if possible != f.FALSE else []
            if len(ways) > _MOST_CASES:
                return []
        return ways

    def _possible(self, when: Formula) -> Formula:
        """The condition in few words; false when no values make it true."""
        known = {one.name: self.scope.domain(one.name) for one in f.variables(when)}
        return tidy(when, known) if is_satisfiable(when, known) else f.FALSE

    # -- which of them are followed ------------------------------------------------------------

    def followed(self) -> TokenGraph:
        """The token graph with a store for each that is followed."""
        names = self._wanted()
        stores = tuple(self._store(name) for name in self.writes if name in names)
        own = {one.variable.name for one in stores}
        self.read = self._read_by_tokens() | self._read_by_values(own)
        known = {one.name: one for one in self.tokens.inputs}
        more = (self.scope.variable(name) for name in sorted(self.read - known.keys() - own))
        inputs = (*known.values(), *(one for one in more if one is not None))
        inputs = tuple(one for one in inputs if one.name not in own)
        return replace(self.tokens, inputs=inputs, stores=stores)

    def _wanted(self) -> set[str]:
        """What guards and other values read, and what belongs to the block: others see it."""
        wanted = {name for name in self.writes if self._is_seen(name)} | self._read_by_tokens()
        while True:
            able = {name for name in self.writes if name in wanted and not self._refusal(name)}
            more = self._read_by_values(able)
            if more <= wanted:
                return able
            wanted |= more

    def _read_by_values(self, names: Iterable[str]) -> set[str]:
        writes = [write for name in names for write in self.writes[name]]
        formulas = [part for write in writes for pair in write.values for part in pair]
        return {variable.name for one in formulas for variable in f.variables(one)}

    def _read_by_tokens(self) -> set[str]:
        guards = (edge.guard.condition for edge in self.tokens.edges if edge.guard is not None)
        formulas = [*guards, *(node.done for node in self.tokens.nodes)]
        return {v.name for one in formulas if one is not None for v in f.variables(one)}

    def _is_seen(self, name: str) -> bool:
        """Whether others than the activity see it."""
        feature = self.features[name]
        return feature.direction == "out" or not self._is_local(feature)

    def _is_local(self, feature: Feature) -> bool:
        owner = self.graph.owner(feature.element)
        return owner is not None and owner.kind in query.BEHAVIORS

    def _is_shared(self, name: str) -> bool:
        """Whether another behaviour of the block writes what the contract could follow else."""
        feature = self.features[name]
        is_able = feature.domain is not None and not feature.is_assumed
        return is_able and not self._is_local(feature) and self._other_writer(feature) is not None

    def _other_writer(self, feature: Feature) -> Element | None:
        name = feature.variable
        if name not in self.others:
            self.others[name] = self.writers.beside(feature.element, self.activity)
        return self.others[name]

    def _refusal(self, name: str) -> Refusal | None:
        """Why the contract cannot follow the variable; None when it can."""
        feature = self.features[name]
        if feature.domain is None:
            return ENDLESS
        if feature.is_assumed:
            return WIDE
        if feature.direction in ("in", "inout") or feature.constant:
            return DECIDED
        if self.scope.is_of_another(name):
            return ELSEWHERE
        if name in self.refused:
            return self.refused[name]
        other = None if self._is_local(feature) else self._other_writer(feature)
        return None if other is None else shared(called(self.graph, other))

    def _store(self, name: str) -> Store:
        feature = self.features[name]
        assert feature.domain is not None
        variable = Variable(name, Owner.SYSTEM, feature.domain, feature.element.id)
        local = self._is_local(feature)
        return Store(variable, tuple(self.writes[name]), feature.default, local)

    def unfollowed(self) -> list[Unfollowed]:
        """What is read and written and not followed, with the reason."""
        found = []
        for name, writes in self.assigned.items():
            why = self._refusal(name) if self._matters(name) else None
            if why is not None:
                labels = dict.fromkeys(self.nodes[one.action.id].label for one in writes)
                found.append(Unfollowed(self.features[name].element, why, tuple(labels)))
        return found

    def _matters(self, name: str) -> bool:
        """Whether someone misses it; what calls give alone is the environment's anyway."""
        if all(one.is_bound for one in self.assigned[name]) and not self._is_shared(name):
            return False
        # That a constant is assigned to is told by a rule of its own.
        is_seen = self._is_seen(name) and not self.features[name].constant
        return name in self.read or is_seen or self.scope.is_of_another(name)


def _is_outside(domain: Domain, spread: Domain) -> bool:
    if not isinstance(domain, IntegerDomain) or not isinstance(spread, IntegerDomain):
        return False
    return spread.low > domain.high or spread.high < domain.low


def _within(case: Formula, value: Formula, domain: Domain, spread: Domain) -> Iterator[_Way]:
    if isinstance(domain, IntegerDomain) and isinstance(spread, IntegerDomain):
        # What is always outside is an error of its own.
        is_outside = _is_outside(domain, spread)
        for when, given, is_bound in split_by_range(case, value, domain, spread):
            yield when, given, is_bound and not is_outside
    else:
        yield case, value, False


def _after(
    condition: Formula, value: Formula, left: dict[str, _Cases]
) -> Iterator[tuple[Formula, Formula]]:
    """A value behind earlier assignments of the same action, over what held before them."""
    names = [
        name
        for name in left
        if any(name == one.name for part in (condition, value) for one in f.variables(part))
    ]
    for combination in product(*(left[name] for name in names)):
        given = {name: case[1] for name, case in zip(names, combination, strict=True)}
        when = f.both(*(case[0] for case in combination), substitute(condition, given))
        if when != f.FALSE:
            yield when, substitute(value, given)
