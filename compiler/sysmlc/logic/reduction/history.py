"""History bits: facts about the past as Boolean variables of the system.

A bit has a constant initial value and one rule ``y' <-> formula``, so that it stores what held in
the step before. The system can always follow the rule, in exactly one way, so that bits add no
choice (the past temporal testers of Pnueli; Spectra and TuLiP do the same).
"""

from collections.abc import Iterable

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Owner, Source, Variable
from sysmlc.logic.formula import Formula, Var, has_primes
from sysmlc.logic.printing import print_formula


class HistoryBit(Struct, frozen=True):
    """A history bit: its value in the first step, and the formula that it stores for one step."""

    name: str
    start: bool
    rule: Formula


class History:
    """Creates history bits and collects their variables and conjuncts.

    Equal facts share one bit. No bit gets one of the names in *taken*.
    """

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)
        self._bits_by_fact: dict[tuple[str, Formula, Formula], Var] = {}
        self.bits: list[HistoryBit] = []
        self.variables: list[Variable] = []
        self.conjuncts: list[Conjunct] = []

    def copy(self) -> "History":
        """Return an independent copy, which can be extended and then adopted or dropped."""
        duplicate = History(self._taken)
        duplicate._bits_by_fact = dict(self._bits_by_fact)
        duplicate.bits = list(self.bits)
        duplicate.variables, duplicate.conjuncts = list(self.variables), list(self.conjuncts)
        return duplicate

    def adopt(self, extended: "History") -> None:
        """Replace the bits by those of *extended*, a copy to which bits were added."""
        self._taken, self._bits_by_fact = extended._taken, extended._bits_by_fact
        self.bits = extended.bits
        self.variables, self.conjuncts = extended.variables, extended.conjuncts

    def previous(self, formula: Formula, origin: str = "") -> Formula:
        """Return the condition that the formula held one step ago; false in the first step."""
        return self._find_bit("was", formula, f.FALSE, False, origin)

    def once(self, formula: Formula, origin: str = "") -> Formula:
        """Return the condition that the formula holds now or held at some step before."""
        return self.since(f.TRUE, formula, origin)

    def historically(self, formula: Formula, origin: str = "") -> Formula:
        """Return the condition that the formula holds now and held at all steps before."""
        bit = self._find_bit("always_was", formula, f.FALSE, True, origin)
        return f.both(formula, bit)

    def since(self, stay: Formula, goal: Formula, origin: str = "") -> Formula:
        """Return the condition that *goal* held at some step up to now, and *stay* since then."""
        bit = self._find_bit("since", stay, goal, False, origin)
        return f.either(goal, f.both(stay, bit))

    def last_step(self, step: Formula, origin: str = "") -> Formula:
        """Return the condition that *step*, a formula with primes, held for the last step and this.

        It is false in the first step, which no step precedes.
        """
        key = ("did", step, f.FALSE)
        if key not in self._bits_by_fact:
            self._bits_by_fact[key] = Var(self._make_name("did"))
            self.define(self._bits_by_fact[key].name, step, False, origin)
        return self._bits_by_fact[key]

    def define(self, name: str, rule: Formula, start: bool, origin: str = "") -> None:
        """Add a bit with an initial value; in each next step it has the present value of *rule*."""
        bit = Var(name)
        initial = bit if start else f.negate(bit)
        update = f.iff(Var(name, primed=True), rule)
        text = f"'{name}' remembers {print_formula(rule)}."
        self._taken.add(name)
        self.bits.append(HistoryBit(name, start, rule))
        variable = Variable(name, Owner.SYSTEM, BooleanDomain(), origin, is_auxiliary=True)
        self.variables.append(variable)
        for formula, class_ in ((initial, Class.INIT), (update, Class.SAFETY)):
            conjunct = Conjunct(formula, class_, origin, text, source=Source.DERIVED)
            self.conjuncts.append(conjunct)

    def _find_bit(self, stem: str, stay: Formula, goal: Formula, start: bool, origin: str) -> Var:
        """Return the bit for an operator and its operands; create it at the first call.

        *stem*, with which the name of the bit begins, selects the operator: ``was`` (*stay* held in
        the last step), ``always_was`` (*stay* has always held) or ``since``.
        """
        if has_primes(stay) or has_primes(goal):
            raise ValueError("a history bit cannot refer to the next step")
        key = (stem, stay, goal)
        if key not in self._bits_by_fact:
            bit = self._bits_by_fact[key] = Var(self._make_name(stem))
            rules = {"was": stay, "always_was": f.both(stay, bit)}
            rule = rules.get(stem, f.either(goal, f.both(stay, bit)))
            self.define(bit.name, rule, start, origin)
        return self._bits_by_fact[key]

    def _make_name(self, stem: str) -> str:
        number = 1
        while f"{stem}_{number}" in self._taken:
            number += 1
        self._taken.add(f"{stem}_{number}")
        return f"{stem}_{number}"
