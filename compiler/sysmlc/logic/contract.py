"""Assume/guarantee contracts: variables with owners and domains, classified conjuncts.

Thesis section 2.2.1; the neutral JSON form is the one of corpus/gr1 (design, section 6).
"""

from enum import StrEnum

from msgspec import Struct

from sysmlc.logic.formula import Formula


class Owner(StrEnum):
    """Who decides the value of a variable."""

    ENVIRONMENT = "env"
    SYSTEM = "sys"


class BooleanDomain(Struct, frozen=True):
    """true and false."""


class IntegerDomain(Struct, frozen=True):
    """Integers from ``low`` to ``high``, both included."""

    low: int
    high: int


class EnumerationDomain(Struct, frozen=True):
    """Names of literals, in declaration order.

    Of a text (String) they stand for ``texts``, in this order, and the last one for any other.
    """

    literals: tuple[str, ...]
    texts: tuple[str, ...] = ()


Domain = BooleanDomain | IntegerDomain | EnumerationDomain


class Variable(Struct, frozen=True):
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


class Conjunct(Struct, frozen=True):
    """One conjunct with the element (id) that it comes from and what it says in words."""

    formula: Formula
    class_: Class
    origin: str
    text: str = ""
    viewpoint: str = ""
    """Name of the requirement whose viewpoint it belongs to; empty for what is common to all."""


class Contract(Struct, frozen=True):
    """Contract of one component: the guarantees hold as long as the assumptions do."""

    component: str
    """Qualified name of the component (design, section 6)."""
    origin: str
    variables: tuple[Variable, ...]
    assumptions: tuple[Conjunct, ...]
    guarantees: tuple[Conjunct, ...]


class Part(Struct, frozen=True):
    """A part with the contract of its type, in the variables of the whole.

    What two parts share has one name in both contracts; what only one knows is named behind the
    part (``gate.state``). ``origin`` is the id of the part.
    """

    name: str
    contract: Contract
    origin: str


class Composite(Struct, frozen=True):
    """A block with parts. ``whole`` is what it promises itself, in the same variables.

    ``wiring`` is what connectors make true and no renaming says, as that an event of the receiver
    occurs when the sender sends it; it restricts no part. ``crowding`` is what has to hold for
    nothing to be lost on the way, which nobody owes.
    """

    component: str
    origin: str
    parts: tuple[Part, ...]
    wiring: tuple[Conjunct, ...] = ()
    whole: Contract | None = None
    crowding: tuple[Conjunct, ...] = ()
