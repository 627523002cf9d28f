"""Assume/guarantee contracts: variables with owners and domains, classified conjuncts.

Thesis section 2.2.1; the neutral JSON form is the one of corpus/gr1 (design, section 6).
"""

from sysmlc.logic.formula import Formula
from sysmlc.values import StrEnum, dataclass


class Owner(StrEnum):
    """Who decides the value of a variable."""

    ENVIRONMENT = "env"
    SYSTEM = "sys"


@dataclass(frozen=True, slots=True)
class BooleanDomain:
    """true and false."""


@dataclass(frozen=True, slots=True)
class IntegerDomain:
    """Integers from ``low`` to ``high``, both included."""

    low: int
    high: int


@dataclass(frozen=True, slots=True)
class EnumerationDomain:
    """Names of literals, in declaration order.

    Of a text (String) they stand for ``texts``, in this order, and the last one for any other.
    """

    literals: tuple[str, ...]
    texts: tuple[str, ...] = ()


Domain = BooleanDomain | IntegerDomain | EnumerationDomain


@dataclass(frozen=True, slots=True)
class Variable:
    """One variable of a contract; ``origin`` is the id of the element it stands for."""

    name: str
    owner: Owner
    domain: Domain
    origin: str = ""


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


@dataclass(frozen=True, slots=True)
class Conjunct:
    """One conjunct with the element (id) that it comes from and what it says in words."""

    formula: Formula
    class_: Class
    origin: str
    text: str = ""
    viewpoint: str = ""
    """Name of the requirement whose viewpoint it belongs to; empty for what is common to all."""


@dataclass(frozen=True, slots=True)
class Contract:
    """Contract of one component: the guarantees hold as long as the assumptions do."""

    component: str
    """Qualified name of the component (design, section 6)."""
    origin: str
    variables: tuple[Variable, ...]
    assumptions: tuple[Conjunct, ...]
    guarantees: tuple[Conjunct, ...]
