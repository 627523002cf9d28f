"""Tracked variables: the features whose values the contract of an activity follows.

Features that are assigned but not tracked are reported (SM544).
"""

from collections.abc import Iterable, Iterator
from itertools import product

from msgspec.structs import replace

from sysmlc.analyses.activities.assignments import (
    GIVEN_OR_CONSTANT,
    NO_FINITE_DOMAIN,
    NO_RANGE,
    OTHER_OBJECT,
    SEVERAL_VALUES,
    UNKNOWN_VALUE,
    Refusal,
    ResolvedAssignment,
    UntrackedFeature,
    refuse_shared,
)
from sysmlc.analyses.activities.inputs import Scope
from sysmlc.ir import Element, Graph, query
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Store, Write
from sysmlc.logic.contract import Domain, IntegerDomain, Owner, Variable
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.expressions.symbols import ElaborationError
from sysmlc.logic.feature_writes import FeatureWrite, WriterIndex, find_label
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.paths import split_by_range
from sysmlc.logic.simplification import is_satisfiable, remove_redundant, substitute

_Cases = tuple[tuple[Formula, Formula], ...]
"""Pairs of a condition and the value under it; exactly one condition holds."""
_Outcome = tuple[Formula, Formula, bool]
"""A condition, the value under it, and whether the value is a bound that replaces a larger one."""
_MAX_CASES = 64
"""Limit of the cases of a variable after an action: consecutive assignments multiply them."""


def track_stores(
    graph: Graph,
    activity: Element,
    assignments: Iterable[list[ResolvedAssignment]],
    tokens: TokenGraph,
    scope: Scope,
    writers: WriterIndex,
) -> tuple[TokenGraph, list[UntrackedFeature]]:
    """Return the token graph with the variables that its nodes assign, and the untracked features.

    *assignments* holds the assignments of each action.
    """
    tracker = _StoreTracker(graph, activity, tokens, scope, writers)
    for statements in assignments:
        tracker.add_assignments(statements)
    if not tracker.assigned:
        return tokens, []
    return tracker.build_graph(), tracker.list_untracked()


class _StoreTracker:
    """Collects the assignments of one activity. The tables have names of variables as keys."""

    def __init__(
        self,
        graph: Graph,
        activity: Element,
        tokens: TokenGraph,
        scope: Scope,
        writers: WriterIndex,
    ) -> None:
        self.graph, self.activity, self.tokens, self.scope = graph, activity, tokens, scope
        self.writers = writers
        self.nodes = {node.id: node for node in tokens.workers()}
        self.features: dict[str, Feature] = {}
        self.assigned: dict[str, list[FeatureWrite]] = {}
        self.writes: dict[str, list[Write]] = {}
        self.refusals: dict[str, Refusal] = {}
        self.set_by_calls: set[str] = set()
        """Variables that outputs of calls set, too."""
        self.out_of_range_actions: set[str] = set()
        """Ids of actions that assign a value that is always out of range."""
        self.other_writers: dict[str, Element | None] = {}
        self.read_variables: set[str] = set()

    def add_assignments(self, statements: list[ResolvedAssignment]) -> None:
        """Record the assignments of one action and compute the values of variables after them."""
        cases_of: dict[str, _Cases] = {}
        stops: dict[str, list[Formula]] = {}
        for assignment, feature in (
            (resolved.assignment, resolved.feature) for resolved in statements
        ):
            if feature is None:
                continue
            name = feature.variable
            self.features[name] = feature
            self.assigned.setdefault(name, []).append(assignment)
            outcomes = self._evaluate_cases(assignment, feature, cases_of)
            if outcomes:
                cases_of[name] = tuple((when, value) for when, value, _ in outcomes)
                stops.setdefault(name, []).extend(
                    when for when, _, is_bound in outcomes if is_bound
                )
            elif assignment.is_bound:
                self.set_by_calls.add(name)
            else:
                cases_of.pop(name, None)
                reason = f"'{assignment.text}' is unknown, or has too many cases"
                refusal = (
                    replace(UNKNOWN_VALUE, reason=reason) if assignment.text else UNKNOWN_VALUE
                )
                self.refusals.setdefault(name, refusal)
        first_assignment = statements[0].assignment
        node = first_assignment.action.id
        text = (
            first_assignment.text
            if len(statements) == 1 and node not in self.out_of_range_actions
            else ""
        )
        for name, cases in cases_of.items():
            self.writes.setdefault(name, []).append(Write(node, text, cases, tuple(stops[name])))

    def _evaluate_cases(
        self, assignment: FeatureWrite, feature: Feature, cases_of: dict[str, _Cases]
    ) -> list[_Outcome]:
        """Return the values that an assignment gives, each with its condition.

        The flag of an outcome is true if the value is a bound that saturates a larger or smaller
        value. The list is empty if the value is unknown or has too many cases.
        """
        if assignment.value is None or feature.domain is None:
            return []
        try:
            result = self.scope.evaluate(assignment.value, feature.domain)
        except ElaborationError:
            return []
        if _is_outside(feature.domain, result.domain):
            self.out_of_range_actions.add(assignment.action.id)
        substituted = (
            outcome
            for guarded_case in result.cases
            for outcome in _substitute_cases(guarded_case.condition, guarded_case.value, cases_of)
        )
        outcomes: list[_Outcome] = []
        for case, value in substituted:
            for when, assigned, is_bound in _saturate(case, value, feature.domain, result.domain):
                possible = self._simplify_condition(when)
                outcomes += [(possible, assigned, is_bound)] if possible != f.FALSE else []
            if len(outcomes) > _MAX_CASES:
                return []
        return outcomes

    def _simplify_condition(self, when: Formula) -> Formula:
        """Return the condition without redundant parts; false if it cannot be satisfied."""
        domains = {
            variable.name: self.scope.domain_of(variable.name) for variable in f.variables(when)
        }
        return remove_redundant(when, domains) if is_satisfiable(when, domains) else f.FALSE

    # -- selection of tracked variables --------------------------------------------------------

    def build_graph(self) -> TokenGraph:
        """Return the token graph with a store for each tracked variable."""
        tracked = self._select_tracked()
        stores = (
            *(self._make_store(name) for name in self.writes if name in tracked),
            *self.tokens.stores,
        )
        stored = {variable.variable.name for variable in stores}
        self.read_variables = self._read_by_tokens() | self._read_by_values(stored)
        inputs_by_name = {variable.name: variable for variable in self.tokens.inputs}
        new_inputs = (
            self.scope.declare_input(name)
            for name in sorted(self.read_variables - inputs_by_name.keys() - stored)
        )
        inputs = (
            *inputs_by_name.values(),
            *(variable for variable in new_inputs if variable is not None),
        )
        inputs = tuple(variable for variable in inputs if variable.name not in stored)
        shared = tuple(self._make_store(name) for name in self.writes if self._is_only_shared(name))
        names = {variable.name for variable in inputs} | stored
        read = sorted(self._read_by_values(store.variable.name for store in shared) - names)
        shared_inputs = (self.scope.declare_input(name) for name in read)
        return replace(
            self.tokens,
            inputs=inputs,
            stores=stores,
            shared=shared,
            shared_inputs=tuple(variable for variable in shared_inputs if variable is not None),
        )

    def _is_only_shared(self, name: str) -> bool:
        """Whether the variable is not tracked only because it belongs to a part or is shared."""
        return self._find_own_refusal(name) is None and self._find_refusal(name) is not None

    def _select_tracked(self) -> set[str]:
        """Return the variables to track: finite ones that no other behaviour assigns."""
        return {name for name in self.writes if not self._find_refusal(name)}

    def _read_by_values(self, names: Iterable[str]) -> set[str]:
        writes = [write for name in names for write in self.writes.get(name, ())]
        formulas = [part for write in writes for pair in write.values for part in pair]
        return {variable.name for formula in formulas for variable in f.variables(formula)}

    def _read_by_tokens(self) -> set[str]:
        guards = (edge.guard.condition for edge in self.tokens.edges if edge.guard is not None)
        formulas = [*guards, *(node.done for node in self.tokens.nodes)]
        return {v.name for formula in formulas if formula is not None for v in f.variables(formula)}

    def _is_visible(self, name: str) -> bool:
        """Whether the variable is visible outside the activity."""
        feature = self.features[name]
        return feature.direction == "out" or not self._is_local(feature)

    def _is_local(self, feature: Feature) -> bool:
        owner = self.graph.owner(feature.element)
        return owner is not None and owner.kind in query.BEHAVIORS

    def _is_shared(self, name: str) -> bool:
        """Whether the variable could be tracked if no other behaviour assigned it."""
        feature = self.features[name]
        is_able = feature.domain is not None and not feature.is_assumed
        return (
            is_able and not self._is_local(feature) and self._find_other_writer(feature) is not None
        )

    def _find_other_writer(self, feature: Feature) -> Element | None:
        name = feature.variable
        if name not in self.other_writers:
            self.other_writers[name] = self.writers.find_other_writer(
                feature.element, self.activity
            )
        return self.other_writers[name]

    def _find_refusal(self, name: str) -> Refusal | None:
        """Return the reason why the contract cannot track the variable, or None."""
        refusal = self._find_own_refusal(name)
        if refusal is None and name in self.set_by_calls:
            return UNKNOWN_VALUE
        if refusal is None and self.scope.belongs_to_a_part(name):
            return OTHER_OBJECT
        if refusal is not None or self._is_local(self.features[name]):
            return refusal
        writer = self._find_other_writer(self.features[name])
        if writer is None:
            return None
        return refuse_shared(find_label(self.graph, writer, self.activity.name))

    def _find_own_refusal(self, name: str) -> Refusal | None:
        """Return a reason that does not depend on other behaviours, or None."""
        feature = self.features[name]
        limits = query.bounds(feature.element.attrs.get("multiplicity"))
        if limits is not None and limits[1] != 1:
            return SEVERAL_VALUES
        if feature.domain is None:
            return NO_FINITE_DOMAIN
        if feature.is_assumed:
            return NO_RANGE
        if feature.direction in ("in", "inout") or feature.is_constant:
            return GIVEN_OR_CONSTANT
        # The component that has the part follows what is assigned to it.
        if self.scope.belongs_to_another_object(name) and not self.scope.belongs_to_a_part(name):
            return OTHER_OBJECT
        return self.refusals.get(name)

    def _make_store(self, name: str) -> Store:
        feature = self.features[name]
        assert feature.domain is not None
        variable = Variable(name, Owner.SYSTEM, feature.domain, feature.element.id)
        local = self._is_local(feature)
        return Store(variable, tuple(self.writes[name]), feature.default, local)

    def list_untracked(self) -> list[UntrackedFeature]:
        """Return the assigned variables to report because they are not tracked."""
        untracked = []
        for name, writes in self.assigned.items():
            refusal = self._find_refusal(name) if self._needs_report(name) else None
            if refusal is not None:
                actions: dict[str, Element] = {}
                for assignment in writes:
                    label = self.nodes[assignment.action.id].label
                    actions.setdefault(label, assignment.action)
                untracked.append(UntrackedFeature(self.features[name].element, refusal, actions))
        return untracked

    def _needs_report(self, name: str) -> bool:
        """Whether an untracked variable is reported: guards, values or other objects read it."""
        # An output bound to a feature assigns an unknown value, so that the feature is an input
        # anyway if all its assignments are of this kind (docs/decisions/0036).
        if all(assignment.is_bound for assignment in self.assigned[name]) and not self._is_shared(
            name
        ):
            return False
        # Assignments to constants are reported by SM415.
        is_seen = self._is_visible(name) and not self.features[name].is_constant
        return name in self.read_variables or is_seen or self.scope.belongs_to_another_object(name)


def _is_outside(domain: Domain, spread: Domain) -> bool:
    if not isinstance(domain, IntegerDomain) or not isinstance(spread, IntegerDomain):
        return False
    return spread.low > domain.high or spread.high < domain.low


def _saturate(case: Formula, value: Formula, domain: Domain, spread: Domain) -> Iterator[_Outcome]:
    if isinstance(domain, IntegerDomain) and isinstance(spread, IntegerDomain):
        # Values that are always outside are reported by SM414.
        is_outside = _is_outside(domain, spread)
        for when, bounded, is_bound in split_by_range(case, value, domain, spread):
            yield when, bounded, is_bound and not is_outside
    else:
        yield case, value, False


def _substitute_cases(
    condition: Formula, value: Formula, cases_of: dict[str, _Cases]
) -> Iterator[tuple[Formula, Formula]]:
    """Yield a condition and a value in terms of the values before the action.

    *cases_of* has the values that earlier assignments of the same action give to variables.
    """
    names = [
        name
        for name in cases_of
        if any(
            name == variable.name for part in (condition, value) for variable in f.variables(part)
        )
    ]
    for combination in product(*(cases_of[name] for name in names)):
        values = {name: case[1] for name, case in zip(names, combination, strict=True)}
        when = f.both(*(case[0] for case in combination), substitute(condition, values))
        if when != f.FALSE:
            yield when, substitute(value, values)
