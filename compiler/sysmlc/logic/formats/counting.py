"""Contracts with numbers for enumerations, and with bits for numbers (after ``lower``)."""

from collections.abc import Iterable, Mapping

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats.lower import Known, each_conjunct, each_leaf, flat, is_truth, known
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.spelling import COMPARISONS


def counted(contract: Contract, is_flat: bool, from_zero: bool = True) -> Contract:
    """The contract with the numbers of literals, from 0, for enumerations.

    ``is_flat`` leaves no arithmetic, ``from_zero`` no range that begins elsewhere (without
    ``is_flat``: none that begins below 0). Raises TooManyValuesError.
    """
    domains_of = known(contract)
    shifts = {one.name: _least(one.domain, is_flat, from_zero) for one in contract.variables}
    variables = [replace(v, domain=_range(v.domain, shifts[v.name])) for v in contract.variables]

    def leaf(formula: Formula) -> Formula:
        if is_flat or not _can_count(formula, domains_of):
            return each_leaf(flat(formula, domains_of), lambda one: _count(one, domains_of, shifts))
        return _sorted_out(_count(formula, domains_of, shifts))

    return each_conjunct(contract, leaf, variables)


def _least(domain: Domain, is_flat: bool, from_zero: bool) -> int:
    if not isinstance(domain, IntegerDomain) or not from_zero:
        return 0
    return domain.low if is_flat else min(domain.low, 0)


def _range(domain: Domain, shift: int) -> Domain:
    match domain:
        case EnumerationDomain(literals):
            return IntegerDomain(0, len(literals) - 1)
        case IntegerDomain(low, high):
            return IntegerDomain(low - shift, high - shift)
        case BooleanDomain():
            return domain


def _can_count(formula: Formula, domains_of: Known) -> bool:
    """Whether the same comparison says the same of the numbers."""
    if isinstance(formula, Apply) and is_truth(formula.args[0], domains_of):
        return False
    found = {domains_of[variable.name] for variable in f.variables(formula)}
    return len({one for one in found if isinstance(one, EnumerationDomain)}) <= 1


def _count(formula: Formula, domains_of: Known, shifts: Mapping[str, int]) -> Formula:
    """A comparison about the numbers that stand for values."""
    match formula:
        case Apply(op, (Var(name) as var, Const(value))) if op in COMPARISONS:
            return Apply(op, (var, Const(_index(value, domains_of[name], shifts[name]))))
        case Apply(op, (Const(str(value)), Var(name) as var)):
            return Apply(op, (Const(_index(value, domains_of[name], 0)), var))
        case Apply(op, args):
            return Apply(op, tuple(_count(arg, domains_of, shifts) for arg in args))
        case Var(name) if shifts[name]:
            return Apply(Op.ADD, (formula, Const(shifts[name])))
        case _:
            return formula


def _index(value: Literal, domain: Domain, shift: int) -> Literal:
    if isinstance(domain, EnumerationDomain) and isinstance(value, str):
        return domain.literals.index(value)
    return value - shift if isinstance(value, int) and not isinstance(value, bool) else value


def _sorted_out(comparison: Formula) -> Formula:
    """A comparison of sums in which nothing is subtracted, if it is one of sums."""
    if not isinstance(comparison, Apply) or comparison.op not in COMPARISONS:
        return comparison
    left, right = comparison.args
    terms = _terms(left, 1), _terms(right, -1)
    if terms[0] is None or terms[1] is None:
        return comparison
    if not any(_has_minus(side) for side in comparison.args):
        return comparison
    found = [*terms[0], *terms[1]]
    number = sum(sign * one.value for sign, one in found if isinstance(one, Const))  # type: ignore[misc]
    sides: dict[int, list[Formula]] = {1: [], -1: []}
    for sign, one in found:
        if isinstance(one, Var):
            sides[sign].append(one)
    if number:
        sides[1 if number > 0 else -1].append(Const(abs(number)))
    return Apply(comparison.op, (_sum(sides[1]), _sum(sides[-1])))


def _has_minus(formula: Formula) -> bool:
    match formula:
        case Const(value):
            return isinstance(value, int) and value < 0
        case Apply(op, args):
            return op is Op.SUB or any(map(_has_minus, args))
        case _:
            return False


def _terms(formula: Formula, sign: int) -> list[tuple[int, Formula]] | None:
    match formula:
        case Apply(Op.ADD | Op.SUB as op, (left, right)):
            first = _terms(left, sign)
            second = _terms(right, -sign if op is Op.SUB else sign)
            return None if first is None or second is None else [*first, *second]
        case Apply():
            return None
        case _:
            return [(sign, formula)]


def _sum(terms: list[Formula]) -> Formula:
    if not terms:
        return Const(0)
    made = terms[0]
    for term in terms[1:]:
        made = Apply(Op.ADD, (made, term))
    return made


# -- numbers as bits -----------------------------------------------------------------------------


def in_bits(contract: Contract) -> Contract:
    """The contract over Booleans alone: ``x_0`` is the lowest bit of the number of x's value.

    What a variable cannot be is a condition of its owner. Raises TooManyValuesError.
    """
    plain = counted(contract, is_flat=True)
    taken = {one.name for one in plain.variables}
    bits = {one.name: _bits(one, taken) for one in plain.variables}
    variables = [
        Variable(bit, one.owner, BooleanDomain(), one.origin)
        for one in plain.variables
        for bit in bits[one.name]
    ]
    made = each_conjunct(plain, lambda leaf: _in_bits(leaf, bits), variables)
    ranges = {owner: tuple(_ranges(plain, owner, bits)) for owner in Owner}
    return replace(
        made,
        assumptions=in_order((*ranges[Owner.ENVIRONMENT], *made.assumptions)),
        guarantees=in_order((*ranges[Owner.SYSTEM], *made.guarantees)),
    )


def in_order(conjuncts: Iterable[Conjunct]) -> tuple[Conjunct, ...]:
    """The conjuncts in the order of their classes."""
    order = list(Class)
    return tuple(sorted(conjuncts, key=lambda one: order.index(one.class_)))


def _bits(variable: Variable, taken: set[str]) -> tuple[str, ...]:
    if not isinstance(variable.domain, IntegerDomain):
        return (variable.name,)
    stem, width = variable.name, max(variable.domain.high.bit_length(), 1)
    while any(f"{stem}_{bit}" in taken for bit in range(width)):
        stem += "_"
    names = tuple(f"{stem}_{bit}" for bit in range(width))
    taken.update(names)
    return names


def _ranges(
    contract: Contract, owner: Owner, bits: Mapping[str, tuple[str, ...]]
) -> Iterable[Conjunct]:
    for one in contract.variables:
        if one.owner is not owner or not isinstance(one.domain, IntegerDomain):
            continue
        high, names = one.domain.high, bits[one.name]
        if high + 1 == 1 << len(names):
            continue
        for class_, primed in ((Class.INIT, False), (Class.SAFETY, True)):
            formula = _at_most([Var(name, primed) for name in names], high)
            yield Conjunct(formula, class_, one.origin, f"'{one.name}' is at most {high}.")


def _in_bits(leaf: Formula, bits: Mapping[str, tuple[str, ...]]) -> Formula:
    match leaf:
        case Apply(op, (Var(name, primed), Const(int(value)))):
            return _compared(op, [Var(bit, primed) for bit in bits[name]], value)
        case _:
            return leaf


def _compared(op: Op, bits: list[Var], value: int) -> Formula:
    match op:
        case Op.EQ:
            return _equal(bits, value)
        case Op.NE:
            return f.negate(_equal(bits, value))
        case Op.LE:
            return _at_most(bits, value)
        case Op.LT:
            return _at_most(bits, value - 1)
        case Op.GT:
            return f.negate(_at_most(bits, value))
        case _:
            return f.negate(_at_most(bits, value - 1))


def _equal(bits: list[Var], value: int) -> Formula:
    parts = [bit if value >> index & 1 else f.negate(bit) for index, bit in enumerate(bits)]
    return f.both(*parts)


def _at_most(bits: list[Var], value: int) -> Formula:
    if value < 0:
        return f.FALSE
    made: Formula = f.TRUE
    for index, bit in enumerate(bits):
        off = f.negate(bit)
        made = f.either(off, made) if value >> index & 1 else f.both(off, made)
    return made
