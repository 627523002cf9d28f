"""The basis of answers about contracts: ranges that are assumed, and conditions without formula.

A variable without a range has an assumed one, so that an answer about all runs is about the runs
within this range. A condition without formula is a free input, so that a run may have values of it
that the model excludes.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence, Set

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, Variable
from sysmlc.logic.domains import describe

_SHOWN = 3
"""Ranges or conditions that a text lists."""


class Basis(Struct, frozen=True):
    """The basis of an answer: ``ranges`` such as ``level in 0..15``, and texts of conditions."""

    ranges: tuple[str, ...] = ()
    conditions: tuple[str, ...] = ()

    @property
    def range_text(self) -> str:
        """The phrase behind an answer about all runs; empty if no range is assumed."""
        return f" within {_enumerate(self.ranges)} (assumed)" if self.ranges else ""

    @property
    def reason(self) -> str:
        """Why a run decides nothing."""
        ranges = (f"{_enumerate(self.ranges)} (assumed)",) if self.ranges else ()
        conditions = tuple(f"'{text}'" for text in self.conditions)
        return f"it depends on {_enumerate((*conditions[:_SHOWN], *ranges), len(conditions))}"

    @property
    def reservation(self) -> str:
        """The phrase behind a finding that may rest on both; empty without them."""
        reason = Basis(conditions=self.conditions).reason if self.conditions else ""
        return f"{self.range_text}{reason and f'; {reason}'}"


def _enumerate(texts: Sequence[str], count: int = 0) -> str:
    shown, hidden = texts[:_SHOWN], max(count, len(texts)) - _SHOWN
    return " and ".join(shown) + (f" and {hidden} more" if hidden > 0 else "")


Reads = tuple[frozenset[str], frozenset[str]]
"""Variables, and variables on which they depend, although no conjunct need name both."""
_NO_NAMES: Mapping[str, str] = {}


def find_basis(
    contracts: Iterable[Contract],
    names: Collection[str] | None = None,
    shown_names: Mapping[str, str] = _NO_NAMES,
    reads: Iterable[Reads] = (),
) -> Basis:
    """Return the basis of an answer about the runs of contracts and the variables *names*.

    Without *names* the answer is about all variables. *shown_names* are the author's names of
    variables.
    """
    contracts = tuple(contracts)
    if not any(is_doubtful(variable) for c in contracts for variable in c.variables):
        return Basis()
    if names is None:
        names = {variable.name for contract in contracts for variable in contract.variables}
    return describe_basis(contracts, find_cone(names, contracts, reads), shown_names)


def is_doubtful(variable: Variable) -> bool:
    """Whether a variable has an assumed range, or stands for a condition without formula."""
    return variable.is_range_assumed or bool(variable.condition)


def describe_basis(
    contracts: Iterable[Contract],
    names: Collection[str],
    shown_names: Mapping[str, str] = _NO_NAMES,
) -> Basis:
    """Return the basis that consists of those variables with *names* that are doubtful."""
    ranges: dict[str, None] = {}
    conditions: dict[str, None] = {}
    for variable in (variable for contract in contracts for variable in contract.variables):
        if variable.name in names and variable.condition:
            conditions[variable.condition] = None
        elif variable.name in names and variable.is_range_assumed:
            name = shown_names.get(variable.name, variable.name)
            ranges[f"{name} in {describe(variable.domain)}"] = None
    return Basis(tuple(ranges), tuple(conditions))


def find_cone(
    names: Iterable[str], contracts: Iterable[Contract], reads: Iterable[Reads] = ()
) -> set[str]:
    """Return the variables that may affect those with *names* (cone of influence)."""
    sources: dict[str, list[Set[str]]] = {}
    for decided, read in reads:
        for name in decided:
            sources.setdefault(name, []).append(read)
    for contract in contracts:
        origins = {variable.name: variable.origin for variable in contract.variables}
        for conjunct in (*contract.assumptions, *contract.guarantees):
            named = f.variable_names(conjunct.formula)
            for name in _find_decided(conjunct, origins) or named:
                sources.setdefault(name, []).append(named)
    cone: set[str] = set()
    worklist = list(names)
    while worklist:
        name = worklist.pop()
        if name not in cone:
            cone.add(name)
            worklist += (source for named in sources.get(name, ()) for source in named)
    return cone


def _find_decided(conjunct: Conjunct, origins: Mapping[str, str]) -> set[str]:
    """Return the variables that a derived conjunct about two steps decides; empty for others.

    It decides those that it names the next value of, or only those of its own element: the next
    value of a feature may depend on the transition that is chosen, but not the other way round.
    """
    if not (conjunct.is_derived and conjunct.class_ is Class.SAFETY):
        return set()
    primed = {variable.name for variable in f.variables(conjunct.formula) if variable.primed}
    return {name for name in primed if origins.get(name) == conjunct.origin} or primed
