"""Sound but incomplete check that a controller satisfies a contract.

The check explores the closed loop projected on its live variables: those whose current value a
transition, an assumption or a guarantee about later steps reads. Inputs and outputs that nothing
reads later are quantified away, and they account for most of the state space. Projection only adds
runs, so the check may reject a correct controller but never accepts a wrong one; ``verification``
runs its exact search only if this check fails.
"""

from collections.abc import Iterable, Iterator

from sysmlc.synthesis.bdd.limits import TooLargeError
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.symbols import is_next
from sysmlc.synthesis.games.relational_product import Product, join_conjuncts
from sysmlc.synthesis.strategies.closed_loop import ClosedLoop

LARGE_FRONTIER = 4_000
"""Nodes of a frontier above which the search tries an inductive invariant instead."""
MAX_STRENGTHENINGS = 5
"""Rounds in which the candidate for an invariant is strengthened."""
MONOLITHIC_PARTS = 2
"""Conjuncts of a monolithic transition relation: the relation and the ranges of the outputs."""
EXTRA_NODES = 100_000
"""The search for an invariant may use this number of nodes, plus twice the current number."""


class QuickCheck:
    """The runs of a closed loop, projected on its live variables."""

    def __init__(
        self,
        closed_loop: ClosedLoop,
        safety_guarantees: Iterable[Node],
        liveness_guarantees: Iterable[Node],
    ) -> None:
        """Compute the reachable states, or an invariant that contains them.

        *safety_guarantees* are diagrams over one step or two, *liveness_guarantees* over one.
        """
        self.closed_loop, self.manager = closed_loop, closed_loop.manager
        self.safety_guarantees, self.liveness_guarantees = (
            tuple(safety_guarantees),
            tuple(liveness_guarantees),
        )
        self.goals = closed_loop.fairness or (self.manager.true,)
        names = tuple(closed_loop.symbols.variables)
        self._current_bits = closed_loop.symbols.all_bits(names)
        self._next_bits = closed_loop.symbols.all_bits(names, primed=True)
        self._all_bits = (*self._current_bits, *self._next_bits)
        live = self._live_variables()
        dead = [name for name in names if name not in live]
        dead_next_bits = closed_loop.symbols.all_bits(dead, primed=True)
        self._forward = Product(
            self.manager,
            (*closed_loop.assumptions, *closed_loop.transitions),
            (*self._current_bits, *dead_next_bits),
        )
        self._dead_bits = closed_loop.symbols.all_bits(dead)
        self.reachable = self._overapproximate_reachable(
            self.manager.exist(self._dead_bits, closed_loop.initial)
        )

    def successors(self, states: Node) -> Node:
        """Return the successors of *states*, projected on the live variables."""
        return self.closed_loop.symbols.unprime(self._forward(states))

    def satisfies_safety(self) -> bool:
        """Whether all safety guarantees hold in all steps, including the first one."""
        state_predicates = [
            node for node in self.safety_guarantees if self._is_state_predicate(node)
        ]
        if not all(self.closed_loop.initial <= node for node in state_predicates):
            return False
        # State predicates have been checked for the first step. For later steps they are checked as
        # predicates of the next state, where dead variables have not been quantified away yet.
        prime = self.closed_loop.symbols.prime
        next_step_guarantees = [
            prime(node) if node in state_predicates else node for node in self.safety_guarantees
        ]
        is_in_parts = len(self.closed_loop.transitions) > MONOLITHIC_PARTS
        conjunctions = (
            self._conjunctions_by_support(next_step_guarantees)
            if is_in_parts
            else join_conjuncts(self.manager, next_step_guarantees)
        )
        return not any(self._can_violate(~node) for node in conjunctions)

    def _can_violate(self, step: Node) -> bool:
        """Whether a transition from a reachable state satisfies *step*."""
        # First test with the few transition parts about the variables of the step. They admit more
        # steps, so the expensive test with all parts is needed only if this one does not exclude
        # it.
        all_parts = (*self.closed_loop.assumptions, *self.closed_loop.transitions)
        return self.can_step(step, self._transitions_about(step)) and self.can_step(step, all_parts)

    def _transitions_about(self, step: Node) -> list[Node]:
        """Return the assumptions, and the transitions that constrain next values read by *step*."""
        support = self.manager.support
        next_bits = frozenset(filter(is_next, support(step)))
        return [
            *self.closed_loop.assumptions,
            *(
                transition
                for transition in self.closed_loop.transitions
                if not next_bits.isdisjoint(support(transition))
            ),
        ]

    def _conjunctions_by_support(self, nodes: Iterable[Node]) -> Iterator[Node]:
        """Yield the conjunctions of diagrams with equal support, in pieces of limited size."""
        groups: dict[frozenset[str], list[Node]] = {}
        for node in nodes:
            groups.setdefault(self.manager.support(node), []).append(node)
        for group in groups.values():
            yield from join_conjuncts(self.manager, group)

    def can_step(self, step: Node, parts: Iterable[Node]) -> bool:
        """Whether a reachable state has a transition that satisfies *step* and *parts*."""
        if step == self.manager.false:
            return False
        product = Product(self.manager, [*parts, step], self._all_bits)
        return product(self.reachable) != self.manager.false

    def _is_state_predicate(self, node: Node) -> bool:
        return not any(map(is_next, self.manager.support(node)))

    def _live_variables(self) -> frozenset[str]:
        """Return the live variables: those whose current value a later step reads."""
        closed_loop = self.closed_loop
        two_step_guarantees = (
            node for node in self.safety_guarantees if not self._is_state_predicate(node)
        )
        readers = (
            *closed_loop.assumptions,
            *closed_loop.transitions,
            *closed_loop.fairness,
            *self.liveness_guarantees,
            *two_step_guarantees,
        )
        return frozenset(name for node in readers for name in closed_loop.symbols.names(node))

    def _overapproximate_reachable(self, initial: Node) -> Node:
        """Return the reachable states, or an inductive invariant if the search becomes large."""
        reachable = frontier = initial
        was_tried = False
        while frontier != self.manager.false:
            if not was_tried and len(frontier) > LARGE_FRONTIER:
                was_tried = True
                invariant = self._find_invariant_within_limits(initial)
                if invariant is not None:
                    return invariant
            frontier = self.successors(frontier) & ~reachable
            reachable = reachable | frontier
            self.manager.check("checking the controller")
        return reachable

    def _find_invariant_within_limits(self, initial: Node) -> Node | None:
        try:
            # The invariant only replaces the search: one that is larger than the frontiers saves
            # nothing.
            with self.manager.limit_nodes(EXTRA_NODES + 2 * self.manager.usage().nodes):
                return self._find_invariant(initial)
        except TooLargeError:
            return None

    def _find_invariant(self, initial: Node) -> Node | None:
        """Return an inductive invariant that contains *initial*, or None if none was found.

        The first candidate is what the contract states about single steps. Each round removes the
        states from which a step may leave the candidate.
        """
        conjuncts = [node for node in self._list_state_predicates() if self._is_live(node)]
        for _ in range(MAX_STRENGTHENINGS):
            candidate = self.manager.conjoin(conjuncts)
            # Strengthening only removes states: no later candidate contains the initial states
            # again.
            if not initial <= candidate:
                return None
            escaping = [self._states_violating_next(candidate, conjunct) for conjunct in conjuncts]
            if all(node == self.manager.false for node in escaping):
                return candidate
            conjuncts += [~node for node in escaping if node != self.manager.false]
        return None

    def _list_state_predicates(self) -> Iterator[Node]:
        """Yield the conjuncts of the contract about single states, as conditions on a state."""
        symbols = self.closed_loop.symbols
        yield from (symbols.domain(name) for name in symbols.variables)
        for node in self._conjunctions_by_support(
            (*self.safety_guarantees, *self.closed_loop.assumptions)
        ):
            if self._is_state_predicate(node):
                yield node
            elif all(map(is_next, self.manager.support(node))):
                yield symbols.unprime(node)

    def _is_live(self, node: Node) -> bool:
        support = self.manager.support(node)
        return bool(support) and support.isdisjoint(self._dead_bits)

    def _states_violating_next(self, states: Node, predicate: Node) -> Node:
        """Return the states from which a step may lead to a violation of *predicate*."""
        # Fewer transitions allow more steps, so the result is a superset, which keeps the check
        # sound.
        violation = self.closed_loop.symbols.prime(~predicate)
        self.manager.check("checking the controller")
        return Product(
            self.manager, [*self._transitions_about(violation), violation], self._next_bits
        )(states)
