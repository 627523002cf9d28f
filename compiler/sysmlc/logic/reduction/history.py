"""History bits: facts about the past as Boolean variables of the system.

A bit has a constant initial value and one rule ``y' <-> formula``, so that it stores what held in
the step before. The system can always follow the rule, in exactly one way, so that bits add no
choice (the past temporal testers of Pnueli; Spectra and TuLiP do the same).
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import count

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Owner,
    Source,
    Variable,
)
from sysmlc.logic.formula import Apply, Formula, Op, Var, has_primes, rename_variables, variables
from sysmlc.logic.printing import print_formula


class HistoryBit(Struct, frozen=True):
    """A history bit: its value in the first step, and the formula that it stores for one step."""

    name: str
    start: bool
    rule: Formula


def list_history_bits(contract: Contract) -> tuple[HistoryBit, ...]:
    """Return the history bits of a contract, in an order in which they can be computed.

    They are the auxiliary Booleans whose first value and update rule are derived guarantees.
    """
    starts: dict[str, bool] = {}
    rules: dict[str, Formula] = {}
    for name, conjunct in _iter_definitions(contract):
        match conjunct.formula:
            case Apply(Op.IFF, (_, rule)):
                rules[name] = rule
            case formula:
                starts[name] = isinstance(formula, Var)
    bits: dict[str, HistoryBit] = {}
    for name, rule in rules.items():
        # A rule may read the next value of a bit before it.
        next_names = {variable.name for variable in variables(rule) if variable.primed}
        if name in starts and next_names & rules.keys() <= bits.keys():
            bits[name] = HistoryBit(name, starts[name], rule)
    return tuple(bits.values())


def list_history_conjuncts(contract: Contract) -> tuple[Conjunct, ...]:
    """Return the guarantees that define the history bits of a contract."""
    names = {bit.name for bit in list_history_bits(contract)}
    return tuple(conjunct for name, conjunct in _iter_definitions(contract) if name in names)


def share_history(contracts: Sequence[Contract]) -> tuple[tuple[Contract, ...], Contract]:
    """Return the contracts without history bits, and a contract with the bits of all of them.

    The bits keep their names, except that different bits with the same name get different names.
    """
    taken = {variable.name for contract in contracts for variable in contract.variables}
    shared: dict[str, tuple[HistoryBit, Variable]] = {}
    stripped: list[Contract] = []
    for contract in contracts:
        variables_by_name = {variable.name: variable for variable in contract.variables}
        names: dict[str, str] = {}
        for bit in list_history_bits(contract):
            name = bit.name
            renamed = _rename_bit(bit, names)
            if name in shared and shared[name][0] != renamed:
                name = names[bit.name] = _find_free_name(name.rpartition("_")[0], taken)
                renamed = _rename_bit(bit, names)
            taken.add(name)
            variable = replace(variables_by_name.pop(bit.name), name=name)
            shared.setdefault(name, (renamed, variable))
        definitions = frozenset(list_history_conjuncts(contract))
        guarantees = (item for item in contract.guarantees if item not in definitions)
        stripped.append(
            replace(
                contract,
                variables=tuple(variables_by_name.values()),
                assumptions=_rename_conjuncts(contract.assumptions, names),
                guarantees=_rename_conjuncts(guarantees, names),
            )
        )
    bits = tuple(variable for _, variable in shared.values())
    conjuncts = tuple(
        conjunct
        for bit, variable in shared.values()
        for conjunct in _define_bit(bit, variable.origin)
    )
    return tuple(stripped), Contract("", "", bits, (), conjuncts)


def add_history(contract: Contract, history: Contract) -> Contract:
    """Return the contract with the bits that ``share_history`` removed."""
    return replace(
        contract,
        variables=(*contract.variables, *history.variables),
        guarantees=(*contract.guarantees, *history.guarantees),
    )


def _rename_bit(bit: HistoryBit, names: Mapping[str, str]) -> HistoryBit:
    name = names.get(bit.name, bit.name)
    return HistoryBit(name, bit.start, rename_variables(bit.rule, names))


def _rename_conjuncts(
    conjuncts: Iterable[Conjunct], names: Mapping[str, str]
) -> tuple[Conjunct, ...]:
    return tuple(
        replace(item, formula=rename_variables(item.formula, names)) if names else item
        for item in conjuncts
    )


def _find_free_name(stem: str, taken: Collection[str]) -> str:
    """Return the stem with the least number that makes a name which is not *taken*."""
    return next(name for number in count(1) if (name := f"{stem}_{number}") not in taken)


def _define_bit(bit: HistoryBit, origin: str) -> tuple[Conjunct, Conjunct]:
    """Return the first value and the update rule of a bit."""
    variable = Var(bit.name)
    text = f"'{bit.name}' remembers {print_formula(bit.rule)}."
    first = variable if bit.start else f.negate(variable)
    update = f.iff(Var(bit.name, primed=True), bit.rule)
    return (
        Conjunct(first, Class.INIT, origin, text, source=Source.DERIVED),
        Conjunct(update, Class.SAFETY, origin, text, source=Source.DERIVED),
    )


def _iter_definitions(contract: Contract) -> Iterator[tuple[str, Conjunct]]:
    """Yield the derived guarantees that define an auxiliary variable, and its name."""
    auxiliary = {variable.name for variable in contract.variables if variable.is_auxiliary}
    for conjunct in contract.guarantees:
        name = _find_defined_variable(conjunct) if conjunct.is_derived else None
        if name in auxiliary:
            yield name, conjunct


def _find_defined_variable(conjunct: Conjunct) -> str | None:
    match conjunct.formula:
        case Var(name) | Apply(Op.NOT, (Var(name),)) if conjunct.class_ is Class.INIT:
            return name
        case Apply(Op.IFF, (Var(name, True), _)) if conjunct.class_ is Class.SAFETY:
            return name
        case _:
            return None


class History:
    """Creates history bits and collects their variables and conjuncts.

    Equal facts share one bit. No bit gets one of the names in *taken*.
    """

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)
        self._bits_by_fact: dict[tuple[str, Formula, Formula], Var] = {}
        self.variables: list[Variable] = []
        self.conjuncts: list[Conjunct] = []

    def copy(self) -> "History":
        """Return an independent copy, which can be extended and then adopted or dropped."""
        duplicate = History(self._taken)
        duplicate._bits_by_fact = dict(self._bits_by_fact)
        duplicate.variables, duplicate.conjuncts = list(self.variables), list(self.conjuncts)
        return duplicate

    def adopt(self, extended: "History") -> None:
        """Replace the bits by those of *extended*, a copy to which bits were added."""
        self._taken, self._bits_by_fact = extended._taken, extended._bits_by_fact
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
        bit = HistoryBit(name, start, rule)
        self._taken.add(name)
        self.variables.append(
            Variable(name, Owner.SYSTEM, BooleanDomain(), origin, is_auxiliary=True)
        )
        self.conjuncts += _define_bit(bit, origin)

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
        name = _find_free_name(stem, self._taken)
        self._taken.add(name)
        return name
