"""Verification of a controller against its contract, independent of the synthesis.

The formulas of the contract are translated again, the controller becomes a relation over a variable
for its state (``closed_loop``), and the fair runs of both are searched for violations of a
guarantee (``algebra``). Synthesis and verification share only the semantics of formulas and the
decision diagrams.
"""

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner, select_classes
from sysmlc.logic.formula import Literal
from sysmlc.logic.reduction.history import list_history_conjuncts
from sysmlc.support.disjoint_sets import group_related
from sysmlc.synthesis.algebra.fair_systems import (
    FairSystem,
    Runs,
    Universe,
    build_lasso,
    pick_state,
    shortest_path,
)
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.games.dead_ends import find_viable_inputs
from sysmlc.synthesis.games.relational_product import Product
from sysmlc.synthesis.strategies.closed_loop import (
    ClosedLoop,
    Controller,
    state_variable,
    translate_controller,
)
from sysmlc.synthesis.strategies.quick_check import QuickCheck


class Fault(Struct, frozen=True):
    """A violation of the contract by a controller, with the steps that lead to it."""

    conjunct: Conjunct | None
    """The violated guarantee; None if the controller has no answer to allowed inputs."""
    steps: tuple[Mapping[str, Literal], ...] = ()
    loop: int | None = None
    """The step at which a fair run continues after the last step; None for other violations."""


def find_faults(controller: Controller, contract: Contract, manager: Manager) -> Iterator[Fault]:
    """Yield the violations of a contract by a controller; none if it satisfies the contract.

    The manager must be new. In every run in which the environment satisfies its assumptions, the
    controller must have an answer, satisfy initial and safety guarantees, and, if all liveness
    assumptions recur, satisfy the liveness guarantees. Raises OutsideGr1Error, LimitError;
    SymbolError for a machine with values that the contract does not have.
    """
    with manager.guard(), manager.without_reordering():
        yield from _Verification(controller, contract, manager).find_faults()


class _Verification:
    def __init__(self, controller: Controller, contract: Contract, manager: Manager) -> None:
        self.manager, self.contract = manager, contract
        self.state_variable = state_variable(controller, contract)
        extended = replace(contract, variables=(*contract.variables, self.state_variable))
        self.universe = Universe((extended,), manager)
        self.symbols = self.universe.symbols
        relation = translate_controller(controller, self.symbols, self.state_variable)
        self.first_relation, self.transitions = relation.first, relation.step
        # An assumption that the next answer violates does not excuse that answer.
        assumption_system = self.universe.system(contract.assumptions, looks_ahead=False)
        self.assumptions, self.fairness = assumption_system.parts, assumption_system.fairness
        self.initial_inputs = assumption_system.init
        self._exclude_dead_ends()
        self.initial = Product(manager, self.first_relation, ())(self.initial_inputs)

    def _exclude_dead_ends(self) -> None:
        history = self.universe.system(list_history_conjuncts(self.contract), looks_ahead=False)
        viable = find_viable_inputs(self.symbols, self.assumptions, (history.init,), history.parts)
        if viable is not None:
            self.initial_inputs = self.initial_inputs & viable.first
            self.assumptions = (*self.assumptions, viable.later)

    @cached_property
    def runs(self) -> Runs:
        """The runs of the closed loop that satisfy the initial and safety assumptions."""
        return Runs(self._system(()))

    @cached_property
    def fair_runs(self) -> Runs:
        """The runs of the closed loop that satisfy all assumptions."""
        return Runs(self._system(self.fairness))

    def _system(self, fairness: tuple[Node, ...]) -> FairSystem:
        return FairSystem(
            self.symbols, self.initial, (*self.assumptions, *self.transitions), fairness
        )

    def find_faults(self) -> Iterator[Fault]:
        """Yield at most one fault for each conjunct."""
        # Nearly every controller passes; only a fault needs the runs over all variables.
        if self._passes_quick_check():
            return
        yield from self._find_unanswered_inputs()
        for conjunct in self.contract.guarantees:
            violation = ~self.universe.node(conjunct)
            if violation != self.manager.false:
                yield from _FAULT_SEARCHES[conjunct.class_](self, conjunct, violation)

    def _passes_quick_check(self) -> bool:
        """Whether the quick check proves that there is no fault.

        Groups of independent variables are checked separately.
        """
        initial_guarantees, safety_guarantees, liveness_guarantees = (
            list(map(self.universe.node, select_classes(self.contract.guarantees, class_)))
            for class_ in (Class.INIT, Class.SAFETY, Class.LIVENESS)
        )
        if not self._answers_first_inputs() or not all(
            self.initial <= node for node in initial_guarantees
        ):
            return False
        closed_loop = ClosedLoop(
            self.symbols, self.initial, self.assumptions, self.transitions, self.fairness
        )
        return all(
            self._passes_quick_check_of(
                closed_loop.project_on(names),
                closed_loop.select_about(safety_guarantees, names),
                closed_loop.select_about(liveness_guarantees, names),
            )
            for names in self._independent_groups(
                closed_loop, (*safety_guarantees, *liveness_guarantees)
            )
        )

    def _independent_groups(
        self, closed_loop: ClosedLoop, guarantees: Iterable[Node]
    ) -> list[frozenset[str]]:
        """Return the groups of variables that diagrams relate and that must be checked together."""
        # The state of a controller occurs in all its transitions. A single state relates nothing,
        # so it does not count as a relation and is added to every group.
        diagrams = (
            *closed_loop.assumptions,
            *closed_loop.transitions,
            *closed_loop.fairness,
            *guarantees,
        )
        has_single_state = domains.size(self.state_variable.domain) == 1
        single_state = frozenset([self.state_variable.name] if has_single_state else [])
        related_names = [closed_loop.variables_of(node) - single_state for node in diagrams]
        return [
            names | single_state for names in group_related(self.symbols.variables, related_names)
        ]

    def _passes_quick_check_of(
        self,
        closed_loop: ClosedLoop,
        safety_guarantees: list[Node],
        liveness_guarantees: list[Node],
    ) -> bool:
        quick_check = QuickCheck(closed_loop, safety_guarantees, liveness_guarantees)
        unanswered = self._states_without_answer(closed_loop.transitions)
        if (
            quick_check.can_step(unanswered, closed_loop.assumptions)
            or not quick_check.satisfies_safety()
        ):
            return False
        return not any(
            _has_fair_run(quick_check, quick_check.reachable & ~node)
            for node in liveness_guarantees
        )

    def _can_step(self, step: Node, parts: Iterable[Node]) -> bool:
        """Whether a reachable state has a transition that satisfies *step* and *parts*."""
        if step == self.manager.false:
            return False
        product = Product(self.manager, [*parts, step], self.runs.bits)
        return product(self.runs.reachable) != self.manager.false

    def _find_unanswered_inputs(self) -> Iterator[Fault]:
        if not self._answers_first_inputs():
            yield Fault(None)
        yield from self._find_faulty_step(
            None, self._states_without_answer(self.transitions), self.assumptions
        )

    def _answers_first_inputs(self) -> bool:
        """Return whether the controller has an answer to all first inputs."""
        output_bits = self.symbols.bits_of_owner(Owner.SYSTEM)
        product = Product(self.manager, self.first_relation, output_bits)
        return self.initial_inputs <= product(self.manager.true)

    def _states_without_answer(self, moves: Iterable[Node]) -> Node:
        """Return the steps with next inputs to which the controller has no answer."""
        next_outputs = self.symbols.bits_of_owner(Owner.SYSTEM, primed=True)
        return ~Product(self.manager, moves, next_outputs)(self.manager.true)

    def find_initial_fault(self, conjunct: Conjunct, violation: Node) -> Iterator[Fault]:
        """Yield the violation of an initial guarantee, if there is one."""
        states = self.runs.system.init & violation
        if states != self.manager.false:
            yield self._build_fault(conjunct, [pick_state(self.runs, states)])

    def find_step_fault(self, conjunct: Conjunct, violation: Node) -> Iterator[Fault]:
        """Yield a violation of a safety guarantee in a reachable step, if there is one."""
        return self._find_faulty_step(conjunct, violation, self.runs.system.parts)

    def _find_faulty_step(
        self, conjunct: Conjunct | None, violation: Node, parts: Iterable[Node]
    ) -> Iterator[Fault]:
        parts = tuple(parts)
        # This product quantifies all bits and stays small; the states are needed for a
        # counterexample.
        if not self._can_step(violation, parts):
            return
        states = Product(self.manager, parts, self.runs.next_bits)(self.runs.reachable & violation)
        if states != self.manager.false:
            yield self._build_fault(conjunct, shortest_path(self.runs, states))

    def find_fair_fault(self, conjunct: Conjunct, violation: Node) -> Iterator[Fault]:
        """Yield a fair run in which a liveness guarantee never holds again, if there is one."""
        fair_runs, candidates = self.fair_runs, self.runs.reachable & violation
        # Successors decide; predecessors, which take longer, are needed for the lasso only.
        if not _has_fair_run(fair_runs, candidates):
            return
        states = fair_runs.fair_within(candidates)
        if states != self.manager.false:
            trace = build_lasso(fair_runs, shortest_path(fair_runs, states), states)
            yield Fault(conjunct, tuple(map(self._without_memory, trace.steps)), trace.loop)

    def _build_fault(self, conjunct: Conjunct | None, path: Iterable[Node]) -> Fault:
        assignments = (self.manager.pick(state, self.runs.bits) or {} for state in path)
        steps = tuple(self._without_memory(self.symbols.decode(bits)) for bits in assignments)
        return Fault(conjunct, steps)

    def _without_memory(self, values: Mapping[str, Literal]) -> dict[str, Literal]:
        return {name: value for name, value in values.items() if name != self.state_variable.name}


def _has_fair_run(runs: Runs | QuickCheck, within: Node) -> bool:
    """Whether some fair run stays inside *within* forever.

    The fixpoint of Emerson and Lei, computed with successors instead of predecessors, which for
    controllers is faster.
    """
    # The remaining states have an infinite past inside the set. In a finite system such a past
    # contains a cycle, and the fixpoint makes it visit all goals.
    states = within
    while states != runs.manager.false:
        shrunk = states
        for goal in runs.goals:
            shrunk = shrunk & _states_after(runs, shrunk, shrunk & goal)
        if shrunk == states:
            return True
        states = shrunk
        runs.manager.check("searching for runs that never reach a goal")
    return False


def _states_after(runs: Runs | QuickCheck, within: Node, start: Node) -> Node:
    """Return the states that one or more steps from *start* reach.

    All steps but the last one stay inside *within*.
    """
    visited, frontier, result = start, start, runs.manager.false
    while frontier != runs.manager.false:
        result = result | runs.successors(frontier)
        frontier = within & result & ~visited
        visited = visited | frontier
    return result


_FAULT_SEARCHES = {
    Class.INIT: _Verification.find_initial_fault,
    Class.SAFETY: _Verification.find_step_fault,
    Class.LIVENESS: _Verification.find_fair_fault,
}
