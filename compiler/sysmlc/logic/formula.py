"""Linear temporal logic over variables with finite domains, as immutable values.

A formula is built by the small functions at the end (``var``, ``eq``, ``both``, ``always`` ...),
never by calling the classes from outside: they keep operands flat and constants folded.
"""

from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from weakref import WeakValueDictionary

Literal = bool | int | str
"""A value of a variable: Boolean, integer, or the name of an enumeration literal."""
_REMEMBERED = 1 << 14
"""Formulas that are kept with what they are made of, and with their variables: machines of one
kind ask for the same again and again."""


class Op(StrEnum):
    """Operators: Boolean, comparison, arithmetic, temporal of the future and of the past."""

    NOT = "!"
    AND = "&"
    OR = "|"
    IMPLIES = "->"
    IFF = "<->"
    EQ = "="
    NE = "!="
    LT = "<"
    LE = "<="
    GT = ">"
    GE = ">="
    ADD = "+"
    SUB = "-"
    MUL = "*"
    DIV = "/"
    MOD = "mod"
    NEXT = "X"
    ALWAYS = "G"
    EVENTUALLY = "F"
    UNTIL = "U"
    RELEASE = "R"
    WEAK_UNTIL = "W"
    PREVIOUS = "Y"
    ONCE = "O"
    HISTORICALLY = "H"
    SINCE = "S"

    # That of Enum is written in Python, and operators are keys of every table here.
    __hash__ = str.__hash__


_NOT, _AND, _OR, _IMPLIES, _IFF, _EQ = Op.NOT, Op.AND, Op.OR, Op.IMPLIES, Op.IFF, Op.EQ
"""Members by names of the module: in Python 3.11 those of a class take twice as long."""


# Formulas that are equal are one object, so that comparing them and looking them up costs nothing,
# however deep they are. A table holds those that somebody still has.


@dataclass(frozen=True, slots=True, eq=False, init=False, weakref_slot=True)
class Const:
    """A literal value. ``Const(True)`` is not ``Const(1)``, though Python calls them equal."""

    value: Literal

    def __new__(cls, value: Literal) -> "Const":
        key = (value.__class__, value)
        found = _CONSTANTS.get(key)
        if found is None:
            found = _CONSTANTS[key] = object.__new__(cls)
            _set(found, "value", value)
        return found

    def __reduce__(self) -> tuple[type["Const"], tuple[Literal]]:
        """Copies and what is read back are the same object again."""
        return Const, (self.value,)


@dataclass(frozen=True, slots=True, eq=False, init=False, weakref_slot=True)
class Var:
    """A variable; ``primed`` means its value in the next step."""

    name: str
    primed: bool = False

    def __new__(cls, name: str, primed: bool = False) -> "Var":
        key = (name, primed)
        found = _VARIABLES.get(key)
        if found is None:
            found = _VARIABLES[key] = object.__new__(cls)
            _set(found, "name", name)
            _set(found, "primed", primed)
        return found

    def __reduce__(self) -> tuple[type["Var"], tuple[str, bool]]:
        return Var, (self.name, self.primed)


@dataclass(frozen=True, slots=True, eq=False, init=False, weakref_slot=True)
class Apply:
    """An operator applied to one or more operands."""

    op: Op
    args: tuple["Formula", ...]

    def __new__(cls, op: Op, args: tuple["Formula", ...]) -> "Apply":
        key = (op, args)
        found = _APPLIED.get(key)
        if found is None:
            found = _APPLIED[key] = object.__new__(cls)
            _set(found, "op", op)
            _set(found, "args", args)
        return found

    def __reduce__(self) -> tuple[type["Apply"], tuple[Op, tuple["Formula", ...]]]:
        return Apply, (self.op, self.args)


_set = object.__setattr__
_CONSTANTS: WeakValueDictionary[tuple[type, Literal], Const] = WeakValueDictionary()
_VARIABLES: WeakValueDictionary[tuple[str, bool], Var] = WeakValueDictionary()
_APPLIED: WeakValueDictionary[tuple[Op, tuple["Formula", ...]], Apply] = WeakValueDictionary()


Formula = Const | Var | Apply

TRUE = Const(True)
FALSE = Const(False)


def const(value: Literal) -> Const:
    """A literal."""
    return Const(value)


@lru_cache(_REMEMBERED)
def var(name: str) -> Var:
    """A variable in the present step."""
    return Var(name)


@lru_cache(_REMEMBERED)
def primed(formula: Formula) -> Formula:
    """The formula about the next step: every variable primed."""
    match formula:
        case Var(name):
            return Var(name, primed=True)
        case Apply(op, args):
            return _applied(op, tuple(primed(arg) for arg in args))
        case _:
            return formula


def negate(formula: Formula) -> Formula:
    """Not; a double negation falls away."""
    if isinstance(formula, Apply):
        return formula.args[0] if formula.op is _NOT else _applied(_NOT, (formula,))
    if isinstance(formula, Const) and isinstance(formula.value, bool):
        return FALSE if formula.value else TRUE
    return _applied(_NOT, (formula,))


def both(*formulas: Formula) -> Formula:
    """Conjunction, flat, without true; true when there is nothing to join."""
    return _flat(_AND, formulas, TRUE, FALSE)


def either(*formulas: Formula) -> Formula:
    """Disjunction, flat, without false; false when there is nothing to join."""
    return _flat(_OR, formulas, FALSE, TRUE)


def implies(left: Formula, right: Formula) -> Formula:
    """Implication."""
    if left == TRUE:
        return right
    if left == FALSE or right == TRUE:
        return TRUE
    return negate(left) if right == FALSE else _applied(_IMPLIES, (left, right))


def iff(left: Formula, right: Formula) -> Formula:
    """Equivalence of two Booleans."""
    return _applied(_IFF, (left, right))


def compare(op: Op, left: Formula, right: Formula) -> Formula:
    """Comparison of two values."""
    return _applied(op, (left, right))


def eq(left: Formula, right: Formula) -> Formula:
    """Equality of two values."""
    return _applied(_EQ, (left, right))


def always(formula: Formula) -> Formula:
    """In every step from now on."""
    return _applied(Op.ALWAYS, (formula,))


def eventually(formula: Formula) -> Formula:
    """In some step from now on."""
    return _applied(Op.EVENTUALLY, (formula,))


@lru_cache(_REMEMBERED)
def _applied(op: Op, args: tuple[Formula, ...]) -> Apply:
    """``Apply``, found again without a call in Python."""
    return Apply(op, args)


@lru_cache(_REMEMBERED)
def variables(formula: Formula) -> tuple[Var, ...]:
    """Every variable of the formula, with repetitions, from left to right."""
    match formula:
        case Var():
            return (formula,)
        case Apply(_, args):
            return tuple(found for arg in args for found in variables(arg))
        case _:
            return ()


@lru_cache(_REMEMBERED)
def _flat(op: Op, formulas: tuple[Formula, ...], unit: Const, zero: Const) -> Formula:
    parts: dict[Formula, None] = {}
    for formula in formulas:
        if isinstance(formula, Apply) and formula.op is op:
            parts.update(dict.fromkeys(formula.args))
        else:
            parts[formula] = None
    parts.pop(unit, None)
    if zero in parts:
        return zero
    if len(parts) <= 1:
        return next(iter(parts), unit)
    return Apply(op, tuple(parts))
