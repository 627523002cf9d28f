"""Encodings of contracts: enumerations as integers, and integers as bits."""

from collections.abc import Iterable, Iterator, Mapping

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
from sysmlc.logic.formats.lowering import (
    Domains,
    flatten_atom,
    index_domains,
    is_boolean,
    rewrite_atoms,
    rewrite_contract_atoms,
)
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.syntax import COMPARISONS

# -- enumerations as integers ----------------------------------------------------------------------


def encode_as_integers(contract: Contract, *, is_flat: bool, from_zero: bool = True) -> Contract:
    """Return the contract over integers: each enumeration literal becomes its index, from 0.

    With *is_flat*, each comparison is between a variable and a value. With *from_zero*, ranges are
    shifted to begin at 0: all ranges with *is_flat*, else only those that begin below 0. Raises
    TooManyValuesError.
    """
    variable_domains = index_domains(contract)
    shifts = {
        variable.name: _compute_shift(variable.domain, is_flat, from_zero)
        for variable in contract.variables
    }
    variables = [
        replace(variable, domain=_encode_domain(variable.domain, shifts[variable.name]))
        for variable in contract.variables
    ]

    def encode(atom: Formula) -> Formula:
        if not is_flat and _compares_indices(atom, variable_domains):
            return _eliminate_subtraction(_encode_atom(atom, variable_domains, shifts))
        return rewrite_atoms(
            flatten_atom(atom, variable_domains),
            lambda inner: _encode_atom(inner, variable_domains, shifts),
        )

    return rewrite_contract_atoms(contract, encode, variables)


def _compute_shift(domain: Domain, is_flat: bool, from_zero: bool) -> int:
    """Return the offset that is subtracted from the values of a variable."""
    if not isinstance(domain, IntegerDomain) or not from_zero:
        return 0
    return domain.low if is_flat else min(domain.low, 0)


def _encode_domain(domain: Domain, shift: int) -> Domain:
    match domain:
        case EnumerationDomain(literals):
            return IntegerDomain(0, len(literals) - 1)
        case IntegerDomain(low, high):
            return IntegerDomain(low - shift, high - shift)
        case BooleanDomain():
            return domain


def _compares_indices(atom: Formula, variable_domains: Domains) -> bool:
    """Whether a comparison of the encoded values has the same meaning.

    Different enumerations can have a literal in common at different indices.
    """
    if isinstance(atom, Apply) and is_boolean(atom.args[0], variable_domains):
        return False
    atom_domains = {variable_domains[name] for name in f.variable_names(atom)}
    return sum(isinstance(domain, EnumerationDomain) for domain in atom_domains) <= 1


def _encode_atom(formula: Formula, variable_domains: Domains, shifts: Mapping[str, int]) -> Formula:
    """Return a comparison of encoded values."""
    match formula:
        case Apply(op, (Var(name) as var, Const(value))) if op in COMPARISONS:
            return Apply(op, (var, Const(_encode(value, variable_domains[name], shifts[name]))))
        case Apply(op, (Const(str(value)), Var(name) as var)):
            return Apply(op, (Const(_encode(value, variable_domains[name], 0)), var))
        case Apply(op, args):
            return Apply(op, tuple(_encode_atom(arg, variable_domains, shifts) for arg in args))
        case Var(name) if shifts[name]:
            return Apply(Op.ADD, (formula, Const(shifts[name])))
        case _:
            return formula


def _encode(value: Literal, domain: Domain, shift: int) -> Literal:
    if isinstance(domain, EnumerationDomain) and isinstance(value, str):
        return domain.literals.index(value)
    return value - shift if isinstance(value, int) and not isinstance(value, bool) else value


# -- comparisons of sums ---------------------------------------------------------------------------


def _eliminate_subtraction(comparison: Formula) -> Formula:
    """Move subtracted terms to the other side of a comparison of sums.

    Structured slugs has no subtraction and no negative numbers.
    """
    if not isinstance(comparison, Apply) or comparison.op not in COMPARISONS:
        return comparison
    left, right = comparison.args
    left_terms, right_terms = _list_terms(left, 1), _list_terms(right, -1)
    if left_terms is None or right_terms is None:
        return comparison
    if not any(_has_subtraction(side) for side in comparison.args):
        return comparison
    terms = [*left_terms, *right_terms]
    constant = sum(sign * term.value for sign, term in terms if isinstance(term, Const))  # type: ignore[misc]
    sides: dict[int, list[Formula]] = {1: [], -1: []}
    for sign, term in terms:
        if isinstance(term, Var):
            sides[sign].append(term)
    if constant:
        sides[1 if constant > 0 else -1].append(Const(abs(constant)))
    return Apply(comparison.op, (_build_sum(sides[1]), _build_sum(sides[-1])))


def _has_subtraction(formula: Formula) -> bool:
    """Whether a sum has a minus sign or a negative number."""
    match formula:
        case Const(value):
            return isinstance(value, int) and value < 0
        case Apply(op, args):
            return op is Op.SUB or any(map(_has_subtraction, args))
        case _:
            return False


def _list_terms(formula: Formula, sign: int) -> list[tuple[int, Formula]] | None:
    """Return the variables and numbers of a sum with their signs; None for a product."""
    match formula:
        case Apply(Op.ADD | Op.SUB as op, (left, right)):
            left_terms = _list_terms(left, sign)
            right_terms = _list_terms(right, -sign if op is Op.SUB else sign)
            if left_terms is None or right_terms is None:
                return None
            return [*left_terms, *right_terms]
        case Apply():
            return None
        case _:
            return [(sign, formula)]


def _build_sum(terms: list[Formula]) -> Formula:
    if not terms:
        return Const(0)
    total = terms[0]
    for term in terms[1:]:
        total = Apply(Op.ADD, (total, term))
    return total


# -- integers as bits ------------------------------------------------------------------------------


def encode_as_bits(contract: Contract) -> Contract:
    """Return the contract over Booleans; ``x_0`` is the lowest bit of the value of ``x``.

    The owner of a variable promises that its bits encode a value of it. Raises TooManyValuesError.
    """
    integers = encode_as_integers(contract, is_flat=True)
    taken = {variable.name for variable in integers.variables}
    bits = {variable.name: _name_bits(variable, taken) for variable in integers.variables}
    variables = [
        Variable(bit, variable.owner, BooleanDomain(), variable.origin)
        for variable in integers.variables
        for bit in bits[variable.name]
    ]
    encoded = rewrite_contract_atoms(integers, lambda atom: _encode_bits(atom, bits), variables)
    ranges = {owner: tuple(_iter_ranges(integers, owner, bits)) for owner in Owner}
    return replace(
        encoded,
        assumptions=sort_by_class((*ranges[Owner.ENVIRONMENT], *encoded.assumptions)),
        guarantees=sort_by_class((*ranges[Owner.SYSTEM], *encoded.guarantees)),
    )


def sort_by_class(conjuncts: Iterable[Conjunct]) -> tuple[Conjunct, ...]:
    """Return the conjuncts in the order of their classes."""
    order = list(Class)
    return tuple(sorted(conjuncts, key=lambda conjunct: order.index(conjunct.class_)))


def _name_bits(variable: Variable, taken: set[str]) -> tuple[str, ...]:
    """Return free names for the bits of a variable, lowest first, and add them to *taken*."""
    if not isinstance(variable.domain, IntegerDomain):
        return (variable.name,)
    stem, width = variable.name, max(variable.domain.high.bit_length(), 1)
    while any(f"{stem}_{bit}" in taken for bit in range(width)):
        stem += "_"
    names = tuple(f"{stem}_{bit}" for bit in range(width))
    taken.update(names)
    return names


def _iter_ranges(
    contract: Contract, owner: Owner, bits: Mapping[str, tuple[str, ...]]
) -> Iterator[Conjunct]:
    """Yield conjuncts that the initial and next values of the bits are within the range."""
    for variable in contract.variables:
        if variable.owner is not owner or not isinstance(variable.domain, IntegerDomain):
            continue
        high, names = variable.domain.high, bits[variable.name]
        if high + 1 == 1 << len(names):
            continue  # Every pattern of the bits is a value.
        for class_, primed in ((Class.INIT, False), (Class.SAFETY, True)):
            formula = _build_at_most([Var(name, primed) for name in names], high)
            text = f"'{variable.name}' is at most {high}."
            yield Conjunct(formula, class_, variable.origin, text)


def _encode_bits(atom: Formula, bits: Mapping[str, tuple[str, ...]]) -> Formula:
    match atom:
        case Apply(op, (Var(name, primed), Const(int(value)))):
            return _compare_bits(op, [Var(bit, primed) for bit in bits[name]], value)
        case _:
            return atom


def _compare_bits(op: Op, bits: list[Var], value: int) -> Formula:
    match op:
        case Op.EQ:
            return _build_equality(bits, value)
        case Op.NE:
            return f.negate(_build_equality(bits, value))
        case Op.LE:
            return _build_at_most(bits, value)
        case Op.LT:
            return _build_at_most(bits, value - 1)
        case Op.GT:
            return f.negate(_build_at_most(bits, value))
        case _:
            return f.negate(_build_at_most(bits, value - 1))


def _build_equality(bits: list[Var], value: int) -> Formula:
    literals = [bit if value >> index & 1 else f.negate(bit) for index, bit in enumerate(bits)]
    return f.both(*literals)


def _build_at_most(bits: list[Var], value: int) -> Formula:
    """Return the formula that a number is at most *value*, built from the lowest bit upwards."""
    if value < 0:
        return f.FALSE
    at_most: Formula = f.TRUE
    for index, bit in enumerate(bits):
        is_off = f.negate(bit)
        at_most = f.either(is_off, at_most) if value >> index & 1 else f.both(is_off, at_most)
    return at_most


# -- sizes of numbers ------------------------------------------------------------------------------


def measure_numbers(formula: Formula, variable_domains: Domains) -> int:
    """Return a bound for the absolute values of all numbers in a formula."""
    match formula:
        case Const(int(value)) if not isinstance(value, bool):
            return abs(value)
        case Var(name):
            domain = variable_domains[name]
            return max(-domain.low, domain.high) if isinstance(domain, IntegerDomain) else 0
        case Apply(op, args):
            bounds = [measure_numbers(arg, variable_domains) for arg in args]
            if op is Op.MUL:
                return max(*bounds, bounds[0] * bounds[1])
            return sum(bounds) if op in (Op.ADD, Op.SUB) else max(bounds)
        case _:
            return 0
