"""Linear temporal logic over variables with finite domains, as immutable values.

The functions ``var``, ``eq``, ``both``, ``always`` and others build formulas; they flatten chains
and fold constants. The classes build exactly the formula that is given.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from weakref import WeakValueDictionary

Literal = bool | int | str
"""A value of a variable: Boolean, integer, or the name of an enumeration literal."""
_CACHED_FORMULAS = 1 << 14
"""Cache size: state machines of one kind build the same formulas."""


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

    # Enum.__hash__ is written in Python, and operators are keys of every table here.
    __hash__ = str.__hash__


FUTURE = frozenset([Op.NEXT, Op.ALWAYS, Op.EVENTUALLY, Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL])
PAST = frozenset([Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY, Op.SINCE])
"""Temporal operators."""


# In Python 3.11, looking up a member of an enumeration takes twice as long as a global name.
_NOT, _AND, _OR, _IMPLIES, _IFF, _EQ = Op.NOT, Op.AND, Op.OR, Op.IMPLIES, Op.IFF, Op.EQ


# Equal formulas are one object (interning), so that comparing them and looking them up takes
# constant time at any depth. The tables hold weak references.


@dataclass(frozen=True, slots=True, eq=False, init=False, weakref_slot=True)
class Const:
    """A literal value. ``Const(True)`` is not ``Const(1)``, though Python calls them equal."""

    value: Literal

    def __new__(cls, value: Literal) -> "Const":
        key = (value.__class__, value)
        instance = _CONSTANTS.get(key)
        if instance is None:
            instance = _CONSTANTS[key] = object.__new__(cls)
            _set(instance, "value", value)
        return instance

    def __reduce__(self) -> tuple[type["Const"], tuple[Literal]]:
        """Interned objects stay unique when they are copied or unpickled."""
        return Const, (self.value,)


@dataclass(frozen=True, slots=True, eq=False, init=False, weakref_slot=True)
class Var:
    """A variable; ``primed`` means its value in the next step."""

    name: str
    primed: bool = False

    def __new__(cls, name: str, primed: bool = False) -> "Var":
        key = (name, primed)
        instance = _VARIABLES.get(key)
        if instance is None:
            instance = _VARIABLES[key] = object.__new__(cls)
            _set(instance, "name", name)
            _set(instance, "primed", primed)
        return instance

    def __reduce__(self) -> tuple[type["Var"], tuple[str, bool]]:
        return Var, (self.name, self.primed)


@dataclass(frozen=True, slots=True, eq=False, init=False, weakref_slot=True)
class Apply:
    """An operator applied to one or more operands."""

    op: Op
    args: tuple["Formula", ...]

    def __new__(cls, op: Op, args: tuple["Formula", ...]) -> "Apply":
        key = (op, args)
        instance = _APPLIED.get(key)
        if instance is None:
            instance = _APPLIED[key] = object.__new__(cls)
            _set(instance, "op", op)
            _set(instance, "args", args)
        return instance

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
    """Return a constant."""
    return Const(value)


@lru_cache(_CACHED_FORMULAS)
def var(name: str) -> Var:
    """Return a variable in the current step."""
    return Var(name)


@lru_cache(_CACHED_FORMULAS)
def prime(formula: Formula) -> Formula:
    """Return the formula about the next step: every variable is primed."""
    match formula:
        case Var(name):
            return Var(name, primed=True)
        case Apply(op, args):
            return _apply(op, tuple(prime(arg) for arg in args))
        case _:
            return formula


def negate(formula: Formula) -> Formula:
    """Return the negation; a double negation is removed."""
    if isinstance(formula, Apply):
        return formula.args[0] if formula.op is _NOT else _apply(_NOT, (formula,))
    if isinstance(formula, Const) and isinstance(formula.value, bool):
        return FALSE if formula.value else TRUE
    return _apply(_NOT, (formula,))


def both(*formulas: Formula) -> Formula:
    """Return the flat conjunction without ``true``; ``true`` for no operands."""
    return _flatten(_AND, formulas, TRUE, FALSE)


def either(*formulas: Formula) -> Formula:
    """Return the flat disjunction without ``false``; ``false`` for no operands."""
    return _flatten(_OR, formulas, FALSE, TRUE)


def implies(left: Formula, right: Formula) -> Formula:
    """Return the implication with folded constants."""
    if left == TRUE:
        return right
    if left == FALSE or right == TRUE:
        return TRUE
    return negate(left) if right == FALSE else _apply(_IMPLIES, (left, right))


def iff(left: Formula, right: Formula) -> Formula:
    """Return the equivalence of two Boolean formulas."""
    return _apply(_IFF, (left, right))


def fold_iff(left: Formula, right: Formula) -> Formula:
    """Return the equivalence of two Boolean formulas with folded constants."""
    for constant, operand in ((left, right), (right, left)):
        if isinstance(constant, Const):
            return operand if constant.value else negate(operand)
    return iff(left, right)


def compare(op: Op, left: Formula, right: Formula) -> Formula:
    """Return *op*, a comparison or an arithmetic operation, applied to two values."""
    return _apply(op, (left, right))


def eq(left: Formula, right: Formula) -> Formula:
    """Return the equality of two values."""
    return _apply(_EQ, (left, right))


def has_value(variable: Var, value: Literal) -> Formula:
    """Return the formula that a variable has a value."""
    if isinstance(value, bool):
        return variable if value else negate(variable)
    return eq(variable, Const(value))


def always(formula: Formula) -> Formula:
    """Return ``G formula``: it holds in the current step and in every later step."""
    return _apply(Op.ALWAYS, (formula,))


def eventually(formula: Formula) -> Formula:
    """Return ``F formula``: it holds in the current step or in a later step."""
    return _apply(Op.EVENTUALLY, (formula,))


def apply(op: Op, args: tuple[Formula, ...]) -> Formula:
    """Apply an operator; the connectives but ``iff`` are flattened and fold constants."""
    match op:
        case Op.AND:
            return both(*args)
        case Op.OR:
            return either(*args)
        case Op.NOT:
            return negate(args[0])
        case Op.IMPLIES:
            return implies(*args)
        case _:
            return _apply(op, args)


def previous(formula: Formula) -> Formula:
    """Return ``Y formula``: it held one step ago; false in the first step."""
    return _apply(Op.PREVIOUS, (formula,))


@lru_cache(_CACHED_FORMULAS)
def _apply(op: Op, args: tuple[Formula, ...]) -> Apply:
    """Return ``Apply(op, args)``; the cache also keeps recent formulas alive."""
    return Apply(op, args)


@lru_cache(_CACHED_FORMULAS)
def _flatten(op: Op, formulas: tuple[Formula, ...], unit: Const, zero: Const) -> Formula:
    """Return the chain of *op* with each operand once; *unit* is neutral, *zero* absorbs."""
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


# -- properties of formulas ------------------------------------------------------------------------


@lru_cache(_CACHED_FORMULAS)
def variables(formula: Formula) -> tuple[Var, ...]:
    """Return every variable of the formula from left to right, with repetitions."""
    match formula:
        case Var():
            return (formula,)
        case Apply(_, args):
            return tuple(variable for arg in args for variable in variables(arg))
        case _:
            return ()


def variable_names(*formulas: Formula) -> set[str]:
    """Return the names of all variables of the formulas, primed or not."""
    return {variable.name for formula in formulas for variable in variables(formula)}


def replace_leaves(formula: Formula, replace: Callable[[Const | Var], Formula]) -> Formula:
    """Return the formula with *replace* applied to its constants and variables, unfolded."""
    if isinstance(formula, Apply):
        return Apply(formula.op, tuple(replace_leaves(arg, replace) for arg in formula.args))
    return replace(formula)


def rename_variables(formula: Formula, names: Mapping[str, str]) -> Formula:
    """Return the formula with renamed variables, primed ones included."""

    def rename(leaf: Const | Var) -> Formula:
        return Var(names.get(leaf.name, leaf.name), leaf.primed) if isinstance(leaf, Var) else leaf

    return replace_leaves(formula, rename)


def split_conjunction(formula: Formula) -> tuple[Formula, ...]:
    """Return the operands of a conjunction, or a tuple of any other formula alone."""
    return formula.args if isinstance(formula, Apply) and formula.op is _AND else (formula,)


def has_primes(formula: Formula) -> bool:
    """Whether the formula has primed variables, which have their values in the next step."""
    match formula:
        case Var(_, primed):
            return primed
        case Apply(_, args):
            return any(map(has_primes, args))
        case _:
            return False


@lru_cache(_CACHED_FORMULAS)
def has_future(formula: Formula) -> bool:
    """Whether the formula has temporal operators of the future; primes do not count."""
    if not isinstance(formula, Apply):
        return False
    return formula.op in FUTURE or any(map(has_future, formula.args))


def has_past(formula: Formula) -> bool:
    """Whether the formula has temporal operators of the past."""
    if not isinstance(formula, Apply):
        return False
    return formula.op in PAST or any(map(has_past, formula.args))
