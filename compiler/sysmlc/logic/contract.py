"""Assume/guarantee contracts (thesis, 2.2.1), and composites of them.

A contract has variables with owners and domains, and classified conjuncts.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Place, Subject
from sysmlc.ir import Graph
from sysmlc.logic.formula import FALSE, TRUE, Const, Formula, eq, fold_iff, prime, var
from sysmlc.logic.regions import Regions, Term


class Owner(StrEnum):
    """The side that decides the value of a variable: the environment or the system."""

    ENVIRONMENT = "env"
    SYSTEM = "sys"


class BooleanDomain(Struct, frozen=True):
    """The values true and false."""


class IntegerDomain(Struct, frozen=True):
    """Integers from ``low`` to ``high``, both included."""

    low: int
    high: int


@dataclass(frozen=True, slots=True)
class EnumerationDomain:
    """Names of literals, in declaration order.

    For a String, ``texts`` are the texts behind the literals in this order; the last literal stands
    for any other text. For a number, ``regions`` are the intervals behind the literals.
    ``type_name`` is the qualified name of the enumeration in the model, empty for values that the
    compiler collects. Domains with the same literals and regions are equal.
    """

    literals: tuple[str, ...]
    texts: tuple[str, ...] = ()
    # The literals tell domains apart well enough, and fractions are slow to hash.
    regions: Regions | None = field(default=None, hash=False)
    type_name: str = field(default="", compare=False)

    def is_comparable(self, domain: "EnumerationDomain") -> bool:
        """Whether the literals are the same, and belong to one enumeration as far as known."""
        is_same_type = self.type_name in ("", domain.type_name) or not domain.type_name
        return self == domain and is_same_type


Domain = BooleanDomain | IntegerDomain | EnumerationDomain


class Variable(Struct, frozen=True):
    """One variable of a contract; ``origin`` is the id of the element it stands for.

    An auxiliary variable stores the past or stands for a token on a flow. The author has no name
    for it, so that texts about runs omit it.
    """

    name: str
    owner: Owner
    domain: Domain
    origin: str = ""
    is_auxiliary: bool = False
    is_range_assumed: bool = False
    """Whether the compiler assumes the range, because the model states none (SM410)."""
    condition: str = ""
    """The text of the condition without formula that the input stands for (SM411), if it does."""
    reason: str = ""
    """Why this condition has no formula."""
    wording: str = ""
    """The name in formulas of the author, such as ``running(pick)``, if it is another one."""
    term: Term = ()
    """The sum of numbers whose region the variable is; empty for other variables."""
    constants: tuple[str, ...] = ()
    """The features in the term that never change."""


def equals(variable: Variable, value: Formula, *, is_next: bool = False) -> Formula:
    """Return the formula that a variable has a value, in this step or the next one."""
    name = prime(var(variable.name)) if is_next else var(variable.name)
    return fold_iff(name, value) if isinstance(variable.domain, BooleanDomain) else eq(name, value)


def equal_values(variable: Variable, left: Formula, right: Formula) -> Formula:
    """Return the formula that two values of a variable are equal."""
    if isinstance(variable.domain, BooleanDomain):
        return fold_iff(left, right)
    if isinstance(left, Const) and isinstance(right, Const):
        return TRUE if left == right else FALSE
    return eq(left, right)


class Class(StrEnum):
    """Class of a conjunct.

    ``init`` holds in the first step and has no primes; ``safety`` holds in every step (G) and
    may prime variables; ``liveness`` holds infinitely often (GF), and is plain GR(1) when it
    primes none. The temporal operators of safety and liveness are implied, not written in the
    formula; ``other`` is general LTL, written in full.
    """

    INIT = "init"
    SAFETY = "safety"
    LIVENESS = "liveness"
    OTHER = "other"

    __hash__ = str.__hash__


class Source(StrEnum):
    """Who states a conjunct: the author of the model, or the compiler, which derives it.

    Derived conjuncts are the behaviour that the diagrams draw, the initial values of declarations,
    and the assumptions that actions end and loops are left sooner or later.
    """

    AUTHOR = "author"
    DERIVED = "derived"


class Conjunct(Struct, frozen=True):
    """One conjunct, with the id of the element that it comes from and its meaning in words."""

    formula: Formula
    class_: Class
    origin: str
    text: str = ""
    viewpoint: str = ""
    """Name of the requirement whose viewpoint the conjunct belongs to; empty if common to all."""
    source: Source = Source.AUTHOR
    wording: Formula | None = None
    """The formula in LTL with the names that the author wrote, if they differ from variables."""
    awaited: str = ""
    """What a derived assumption expects sooner or later ("Go comes"); empty if an action ends."""

    @property
    def is_derived(self) -> bool:
        """Whether the compiler derives the conjunct."""
        return self.source is Source.DERIVED


def drop_trivial(conjuncts: Iterable[Conjunct]) -> tuple[Conjunct, ...]:
    """Return the conjuncts without those that are just ``true``."""
    return tuple(conjunct for conjunct in conjuncts if conjunct.formula != TRUE)


def select_classes(conjuncts: Iterable[Conjunct], *classes: Class) -> tuple[Conjunct, ...]:
    """Return the conjuncts of these classes."""
    return tuple(conjunct for conjunct in conjuncts if conjunct.class_ in classes)


class Contract(Struct, frozen=True):
    """Contract of one component: the guarantees hold as long as the assumptions do."""

    component: str
    """Qualified name of the component (design, section 6)."""
    origin: str
    variables: tuple[Variable, ...]
    assumptions: tuple[Conjunct, ...]
    guarantees: tuple[Conjunct, ...]

    @property
    def wordings(self) -> dict[str, str]:
        """The names in formulas of the author, by variable, where they differ."""
        return {variable.name: variable.wording for variable in self.variables if variable.wording}

    def list_assumptions(self, viewpoint: str) -> tuple[Conjunct, ...]:
        """Return the assumptions of a viewpoint: its own and those that are common to all."""
        return tuple(item for item in self.assumptions if item.viewpoint in ("", viewpoint))


class GivenContract(Struct, frozen=True):
    """A contract that replaces the derived contract of the same component."""

    contract: Contract


_POSITION = re.compile(r"(?P<file>.*):(?P<line>\d+):(?P<column>\d+)")


def locate_origin(graph: Graph, origin: str) -> Subject:
    """Return what diagnostics about the origin of a contract or conjunct are about.

    That is the element of the graph with this id, or a position ``file:line:column`` in a file of
    contracts.
    """
    element = graph.get(origin)
    if element is not None:
        return graph.subject(element)
    position = _POSITION.fullmatch(origin)
    if position is None:
        return Subject()
    line, column = int(position["line"]), int(position["column"])
    return Subject(place=Place(position["file"], line=line, column=column))


def mark_derived(contract: Contract) -> Contract:
    """Return the contract with all conjuncts marked as derived."""

    def mark(conjuncts: tuple[Conjunct, ...]) -> tuple[Conjunct, ...]:
        return tuple(replace(conjunct, source=Source.DERIVED) for conjunct in conjuncts)

    return replace(
        contract, assumptions=mark(contract.assumptions), guarantees=mark(contract.guarantees)
    )


def name_variables(contract: Contract, wordings: Mapping[str, str]) -> Contract:
    """Return the contract with the names in formulas of the author, by variable."""
    variables = []
    for variable in contract.variables:
        wording = wordings.get(variable.name, variable.wording)
        wording = "" if wording == variable.name else wording
        variables.append(replace(variable, wording=wording))
    return replace(contract, variables=tuple(variables))


class Part(Struct, frozen=True):
    """A part with the contract of its type, in the variables of the whole.

    A variable that several parts share has one name in all contracts; a variable of one part has
    the name of the part as a prefix (``gate.state``). ``origin`` is the id of the part. Operations,
    actions and state machines of the whole count as parts, too.
    """

    name: str
    contract: Contract
    origin: str
    is_behaviour: bool = False
    has_contract: bool = True
    """False for a part that nothing is known about but the outputs that other parts read."""


class Composite(Struct, frozen=True):
    """A block with parts; ``whole`` is the contract of the block itself, in the same variables.

    ``wiring`` states what connectors imply beyond shared names, such as that an event of the
    receiver occurs when the sender sends it; it restricts no part. ``exclusions`` states which
    messages must not be sent in the same step, because one would be lost; no part guarantees it.
    """

    component: str
    origin: str
    parts: tuple[Part, ...]
    wiring: tuple[Conjunct, ...] = ()
    whole: Contract | None = None
    exclusions: tuple[Conjunct, ...] = ()
