"""History bits: what was true before, as variables of the system with one rule each.

A bit y tells what held in the step before: initially a constant, then ``y' <-> formula``. The
system can always follow such a rule, in one way, so that it adds no choice (Pnueli's past
temporal testers; Spectra and TuLiP do the same).
"""

from collections.abc import Iterable

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Owner, Variable
from sysmlc.logic.evaluate import has_primes
from sysmlc.logic.formula import Formula, Var
from sysmlc.logic.printing import print_formula


class History:
    """Makes bits; the same past has one bit. ``taken`` are names that they must not have."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)
        self._bits: dict[tuple[str, Formula, Formula], Var] = {}
        self.variables: list[Variable] = []
        self.conjuncts: list[Conjunct] = []

    def copy(self) -> "History":
        """A history that goes on from here, without a change of this one."""
        made = History(self._taken)
        made._bits = dict(self._bits)
        made.variables, made.conjuncts = list(self.variables), list(self.conjuncts)
        return made

    def take(self, other: "History") -> None:
        """Take over everything that a copy has found."""
        self._taken, self._bits = other._taken, other._bits
        self.variables, self.conjuncts = other.variables, other.conjuncts

    def previous(self, formula: Formula, origin: str = "") -> Formula:
        """The formula held one step ago; false in the first step."""
        return self._bit("was", formula, f.FALSE, False, origin)

    def once(self, formula: Formula, origin: str = "") -> Formula:
        """The formula holds now or held at some step before."""
        return self.since(f.TRUE, formula, origin)

    def historically(self, formula: Formula, origin: str = "") -> Formula:
        """The formula holds now and held at all steps before."""
        bit = self._bit("always_was", formula, f.FALSE, True, origin)
        return f.both(formula, bit)

    def since(self, stay: Formula, goal: Formula, origin: str = "") -> Formula:
        """The goal held at some step up to now, and ``stay`` at all steps after it."""
        bit = self._bit("since", stay, goal, False, origin)
        return f.either(goal, f.both(stay, bit))

    def step(self, step: Formula, origin: str = "") -> Formula:
        """The last step was one of which the formula, with primes, is true; at first false."""
        key = ("did", step, f.FALSE)
        if key not in self._bits:
            self._bits[key] = Var(self._fresh("did"))
            self.define(self._bits[key].name, step, False, origin)
        return self._bits[key]

    def _bit(self, stem: str, stay: Formula, goal: Formula, start: bool, origin: str) -> Var:
        """The bit of ``was`` (of stay), ``always_was`` (of stay) or ``since`` (stay, goal)."""
        if has_primes(stay) or has_primes(goal):
            raise ValueError("what was before cannot speak of the next step")
        key = (stem, stay, goal)
        if key not in self._bits:
            bit = Var(self._fresh(stem))
            told = {"was": stay, "always_was": f.both(stay, bit)}
            rule = told.get(stem, f.either(goal, f.both(stay, bit)))
            self._bits[key] = bit
            self.define(bit.name, rule, start, origin)
        return self._bits[key]

    def define(self, name: str, rule: Formula, start: bool, origin: str = "") -> None:
        """Add a bit that starts with a value and has the rule's truth in the next step."""
        bit = Var(name)
        begins = bit if start else f.negate(bit)
        follows = f.iff(Var(name, primed=True), rule)
        about = f"'{name}' remembers {print_formula(rule)}."
        self._taken.add(name)
        self.variables.append(Variable(name, Owner.SYSTEM, BooleanDomain(), origin))
        self.conjuncts.append(Conjunct(begins, Class.INIT, origin, about))
        self.conjuncts.append(Conjunct(follows, Class.SAFETY, origin, about))

    def _fresh(self, stem: str) -> str:
        number = 1
        while f"{stem}_{number}" in self._taken:
            number += 1
        self._taken.add(f"{stem}_{number}")
        return f"{stem}_{number}"
