"""Whether a controller keeps a contract: an independent check of it and the assumptions together.

Nothing is shared with what made it: the contract's formulas are translated anew, the controller is
a relation over a variable for its state (``closed``), and fair runs are looked for (``algebra``).
"""

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Literal
from sysmlc.synthesis.algebra.fair_systems import FairSystem, Runs, Universe
from sysmlc.synthesis.algebra.traces import lasso, one, shortest
from sysmlc.synthesis.bdd.groups import tied
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.controllers.closed_loop import Closed, Controller, memory, relation
from sysmlc.synthesis.controllers.quick_check import Glance
from sysmlc.synthesis.games.relational_product import Product


class Fault(Struct, frozen=True):
    """What a machine does wrong, with the steps that lead there."""

    conjunct: Conjunct | None
    """The guarantee that it breaks; None when it has no answer to inputs that are allowed."""
    steps: tuple[Mapping[str, Literal], ...] = ()
    loop: int | None = None
    """After the last step it goes on at this one; None when the steps alone show it."""


def faults(controller: Controller, contract: Contract, manager: Manager) -> Iterator[Fault]:
    """Why a controller does not keep a contract; nothing when it does. The manager must be new.

    In every run in which the environment keeps its assumptions the controller has an answer, keeps
    the initial guarantees and those for every step, and, if all that should recur of the
    environment does, what should recur of the system does. Raises OutsideGr1Error, LimitError;
    SymbolError for a machine with other values than the contract's.
    """
    with manager.guard(), manager.calm():
        yield from _Check(controller, contract, manager).faults()


class _Check:
    def __init__(self, controller: Controller, contract: Contract, manager: Manager) -> None:
        self.manager, self.contract = manager, contract
        self.memory = memory(controller, contract)
        extended = replace(contract, variables=(*contract.variables, self.memory))
        self.universe = Universe((extended,), manager)
        self.symbols = self.universe.symbols
        done = relation(controller, self.symbols, self.memory)
        self.first, self.moves = done.first, done.later
        assumed = self.universe.system(contract.assumptions)
        self.allowed, self.fairness = assumed.parts, assumed.fairness
        self.inputs = assumed.init
        self.starts = Product(manager, self.first, ())(self.inputs)

    @cached_property
    def runs(self) -> Runs:
        """All runs in which the assumptions about steps are kept."""
        return Runs(self._system(()))

    @cached_property
    def fair(self) -> Runs:
        """Those of them in which all recurs that should."""
        return Runs(self._system(self.fairness))

    def _system(self, fairness: tuple[Node, ...]) -> FairSystem:
        return FairSystem(self.symbols, self.starts, (*self.allowed, *self.moves), fairness)

    def faults(self) -> Iterator[Fault]:
        """All of them, one for each conjunct at most."""
        if self._is_plain():
            return
        yield from self._unanswered()
        for conjunct in self.contract.guarantees:
            broken = ~self.universe.node(conjunct)
            if broken != self.manager.false:
                yield from _SEARCHES[conjunct.class_](self, conjunct, broken)

    def _is_plain(self) -> bool:
        """Whether it is seen without a look at each fault that there is none."""
        first, safe, recurring = (
            [self.universe.node(one) for one in self.contract.guarantees if one.class_ is class_]
            for class_ in (Class.INIT, Class.SAFETY, Class.LIVENESS)
        )
        if not self._answers_first() or not all(self.starts <= node for node in first):
            return False
        closed = Closed(self.symbols, self.starts, self.allowed, self.moves, self.fairness)
        return all(
            self._is_plain_of(
                closed.about(names),
                closed.speaking(safe, names),
                closed.speaking(recurring, names),
            )
            for names in self._groups(closed, (*safe, *recurring))
        )

    def _groups(self, closed: Closed, promised: Iterable[Node]) -> list[frozenset[str]]:
        """Variables that have to be looked at together; a state that is the only one ties none."""
        said = (*closed.allowed, *closed.moves, *closed.fairness, *promised)
        is_only = domains.size(self.memory.domain) == 1
        lone = frozenset([self.memory.name] if is_only else [])
        together = [closed.spoken(node) - lone for node in said]
        return [names | lone for names in tied(self.symbols.variables, together)]

    def _is_plain_of(self, closed: Closed, safe: list[Node], recurring: list[Node]) -> bool:
        seen = Glance(closed, safe, recurring)
        stuck = self._stuck(closed.moves)
        if seen.is_possible(stuck, closed.allowed) or not seen.keeps_each_step():
            return False
        return not any(has_fair_run(seen, seen.reachable & ~node) for node in recurring)

    def _is_possible(self, step: Node, parts: Iterable[Node]) -> bool:
        """Whether a step by all parts from what is reached is one of these."""
        if step == self.manager.false:
            return False
        found = Product(self.manager, [*parts, step], self.runs.bits)
        return found(self.runs.reachable) != self.manager.false

    def _unanswered(self) -> Iterator[Fault]:
        if not self._answers_first():
            yield Fault(None)
        yield from self._stepping(None, self._stuck(self.moves), self.allowed)

    def _answers_first(self) -> bool:
        """Whether there is an answer to all first inputs."""
        answered = Product(self.manager, self.first, self.symbols.all_bits(self._own()))
        return self.inputs <= answered(self.manager.true)

    def _stuck(self, moves: Iterable[Node]) -> Node:
        """Steps and next inputs to which there is no answer."""
        after = self.symbols.all_bits(self._own(), primed=True)
        return ~Product(self.manager, moves, after)(self.manager.true)

    def _own(self) -> tuple[str, ...]:
        variables = self.symbols.variables.values()
        return tuple(one.name for one in variables if one.owner is Owner.SYSTEM)

    def at_first(self, conjunct: Conjunct, broken: Node) -> Iterator[Fault]:
        """A first step that breaks it."""
        found = self.runs.system.init & broken
        if found != self.manager.false:
            yield self._fault(conjunct, [one(self.runs, found)])

    def in_a_step(self, conjunct: Conjunct, broken: Node) -> Iterator[Fault]:
        """A step from a state that is reached."""
        return self._stepping(conjunct, broken, self.runs.system.parts)

    def _stepping(
        self, conjunct: Conjunct | None, broken: Node, parts: Iterable[Node]
    ) -> Iterator[Fault]:
        parts = tuple(parts)
        if not self._is_possible(broken, parts):
            return
        found = Product(self.manager, parts, self.runs.next_bits)(self.runs.reachable & broken)
        if found != self.manager.false:
            yield self._fault(conjunct, shortest(self.runs, found))

    def for_ever(self, conjunct: Conjunct, broken: Node) -> Iterator[Fault]:
        """A fair run that from some step on breaks it for ever."""
        fair, within = self.fair, self.runs.reachable & broken
        if not has_fair_run(fair, within):
            return
        found = fair.fair_within(within)
        if found != self.manager.false:
            trace = lasso(fair, shortest(fair, found), found)
            yield Fault(conjunct, tuple(map(self._shown, trace.steps)), trace.loop)

    def _fault(self, conjunct: Conjunct | None, way: Iterable[Node]) -> Fault:
        picked = (self.manager.pick(state, self.runs.bits) or {} for state in way)
        steps = tuple(self._shown(self.symbols.decode(bits)) for bits in picked)
        return Fault(conjunct, steps)

    def _shown(self, values: Mapping[str, Literal]) -> dict[str, Literal]:
        return {name: value for name, value in values.items() if name != self.memory.name}


def has_fair_run(runs: Runs | Glance, within: Node) -> bool:
    """Whether some fair run goes on for ever without leaving states.

    Emerson and Lei's fixpoint, backwards: what is left has a past of its own without end, which in
    a finite system is a cycle. What a controller does next is computed faster than what led there.
    """
    found = within
    while found != runs.manager.false:
        fewer = found
        for goal in runs.goals:
            fewer = fewer & _later(runs, fewer, fewer & goal)
        if fewer == found:
            return True
        found = fewer
        runs.manager.check("looking for runs that never come to a goal")
    return False


def _later(runs: Runs | Glance, within: Node, start: Node) -> Node:
    """The states that one step leads to, or more that do not leave others before the last one."""
    found, front, after = start, start, runs.manager.false
    while front != runs.manager.false:
        after = after | runs.after(front)
        front = within & after & ~found
        found = found | front
    return after


_SEARCHES = {
    Class.INIT: _Check.at_first,
    Class.SAFETY: _Check.in_a_step,
    Class.LIVENESS: _Check.for_ever,
}
