"""Contracts with fewer words: without enumerations, without arithmetic, without numbers at all.

Each says the same as the contract that it comes from, about variables that stand for its own.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache

from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    Variable,
)
from sysmlc.logic.evaluate import Evaluation, compile_evaluation
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.spelling import COMPARISONS

LIMIT = 1 << 16
"""Most values of its variables for which a comparison is written out."""
Known = Mapping[str, Domain]
Leaf = Callable[[Formula], Formula]


class TooManyValuesError(ValueError):
    """A comparison with too many values to be written out; ``conjunct`` holds it."""

    def __init__(self, conjunct: Conjunct | None = None) -> None:
        super().__init__("it compares more values than can be written out")
        self.conjunct = conjunct


def known(contract: Contract) -> dict[str, Domain]:
    """The domains of the contract's variables by their names."""
    return {variable.name: variable.domain for variable in contract.variables}


def each_leaf(formula: Formula, leaf: Leaf) -> Formula:
    """The formula with ``leaf`` of every comparison and every variable that is a truth itself."""
    match formula:
        case Apply(op, args) if op not in COMPARISONS:
            parts = tuple(each_leaf(arg, leaf) for arg in args)
            return _BUILD[op](*parts) if op in _BUILD else Apply(op, parts)
        case _:
            return leaf(formula)


_BUILD: dict[Op, Callable[..., Formula]] = {
    Op.AND: f.both,
    Op.OR: f.either,
    Op.NOT: f.negate,
    Op.IMPLIES: f.implies,
}


def each_conjunct(
    contract: Contract, leaf: Leaf, variables: Iterable[Variable] | None = None
) -> Contract:
    """The contract with ``leaf`` in every conjunct. Raises TooManyValuesError."""
    return each_formula(contract, lambda formula: each_leaf(formula, leaf), variables)


def each_formula(
    contract: Contract, make: Leaf, variables: Iterable[Variable] | None = None
) -> Contract:
    """The contract with ``make`` of every conjunct's formula. Raises TooManyValuesError."""

    def of(conjuncts: tuple[Conjunct, ...]) -> tuple[Conjunct, ...]:
        return tuple(_replaced(one, make) for one in conjuncts)

    return replace(
        contract,
        variables=contract.variables if variables is None else tuple(variables),
        assumptions=of(contract.assumptions),
        guarantees=of(contract.guarantees),
    )


def _replaced(conjunct: Conjunct, make: Leaf) -> Conjunct:
    try:
        return replace(conjunct, formula=make(conjunct.formula))
    except TooManyValuesError:
        raise TooManyValuesError(conjunct) from None


def without_weak_until(formula: Formula) -> Formula:
    """The formula with ``b R (a | b)`` for ``a W b``."""
    match formula:
        case Apply(Op.WEAK_UNTIL, (left, right)):
            stay, goal = without_weak_until(left), without_weak_until(right)
            return Apply(Op.RELEASE, (goal, f.either(stay, goal)))
        case Apply(op, args):
            parts = tuple(map(without_weak_until, args))
            return _BUILD[op](*parts) if op in _BUILD else Apply(op, parts)
        case _:
            return formula


# -- names ---------------------------------------------------------------------------------------


def renamed(contract: Contract, reserved: Iterable[str]) -> Contract:
    """The contract whose variables and literals are none of a language's words.

    Those that are get an underscore behind, and so do literals that are called like a variable.
    """
    words = frozenset(reserved)
    names = _unlike([one.name for one in contract.variables], words)
    literals = _unlike(_literals(contract), words | {*names, *names.values()})
    variables = [
        replace(one, name=names[one.name], domain=_domain(one.domain, literals))
        for one in contract.variables
    ]
    return each_conjunct(contract, lambda formula: _named(formula, names, literals), variables)


def unambiguous(contract: Contract) -> Contract:
    """The contract without literals that are called like a variable: of ``state=red`` nobody
    could tell whether ``red`` is the value or what the variable ``red`` is."""
    names = {one.name for one in contract.variables}
    return contract if names.isdisjoint(_literals(contract)) else renamed(contract, ())


def _literals(contract: Contract) -> Iterable[str]:
    """Literals of all enumerations: one that two of them have has one name in both."""
    found = [one.domain for one in contract.variables]
    enumerations = [one for one in found if isinstance(one, EnumerationDomain)]
    return dict.fromkeys(literal for one in enumerations for literal in one.literals)


def _unlike(names: Iterable[str], words: frozenset[str]) -> dict[str, str]:
    found = list(names)
    taken = set(found) | words
    made = {}
    for name in found:
        other = name
        while other in words or (other != name and other in taken):
            other += "_"
        taken.add(other)
        made[name] = other
    return made


def _domain(domain: Domain, named: Mapping[str, str]) -> Domain:
    if not isinstance(domain, EnumerationDomain):
        return domain
    return replace(domain, literals=tuple(named[one] for one in domain.literals))


def _named(formula: Formula, names: Mapping[str, str], literals: Mapping[str, str]) -> Formula:
    match formula:
        case Var(name, primed):
            return Var(names[name], primed)
        case Const(str(value)):
            return Const(literals.get(value, value))
        case Apply(op, args):
            return Apply(op, tuple(_named(arg, names, literals) for arg in args))
        case _:
            return formula


# -- comparisons ---------------------------------------------------------------------------------


def without_arithmetic(contract: Contract) -> Contract:
    """The contract whose comparisons are all between a variable and one of its values.

    Raises TooManyValuesError.
    """
    domains_of = known(contract)
    return each_conjunct(contract, lambda leaf: flat(leaf, domains_of))


def flat(leaf: Formula, domains_of: Known) -> Formula:
    """A comparison as comparisons between variables and their values.

    Raises TooManyValuesError.
    """
    match leaf:
        case Apply(Op.EQ | Op.NE as op, (left, right)) if is_truth(left, domains_of):
            same = f.iff(each_leaf(left, _flat(domains_of)), each_leaf(right, _flat(domains_of)))
            return same if op is Op.EQ else f.negate(same)
        case Apply(_, (Var(name), Const(value))) if domains.contains(domains_of[name], value):
            return leaf
        case Apply(op, (Const(value), Var(name) as var)) if domains.contains(
            domains_of[name], value
        ):
            return Apply(_TURNED.get(op, op), (var, Const(value)))
        case Apply():
            return written_out(leaf, domains_of)
        case _:
            return leaf


def _flat(domains_of: Known) -> Leaf:
    return lambda leaf: flat(leaf, domains_of)


_TURNED = {Op.LT: Op.GT, Op.GT: Op.LT, Op.LE: Op.GE, Op.GE: Op.LE}


def is_truth(formula: Formula, domains_of: Known) -> bool:
    """Whether what is compared is true or false."""
    match formula:
        case Var(name):
            return isinstance(domains_of[name], BooleanDomain)
        case Const(value):
            return isinstance(value, bool)
        case Apply(op):
            return op not in (Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD)


def written_out(formula: Formula, domains_of: Known, limit: int = LIMIT) -> Formula:
    """A comparison as the values of its variables that make it true.

    Raises TooManyValuesError.
    """
    variables = tuple(dict.fromkeys(f.variables(formula)))
    return _written_out(formula, tuple((one, domains_of[one.name]) for one in variables), limit)


@lru_cache(1 << 12)
def _written_out(formula: Formula, found: tuple[tuple[Var, Domain], ...], limit: int) -> Formula:
    number = 1
    for _, domain in found:
        number *= domains.size(domain)
    if number > limit:
        raise TooManyValuesError
    return _cases(compile_evaluation(formula), found, {}, {})


def _cases(
    truth: Evaluation,
    variables: tuple[tuple[Var, Domain], ...],
    now: dict[str, Literal],
    then: dict[str, Literal],
) -> Formula:
    if not variables:
        return Const(bool(truth(now, then)))
    (first, domain), rest = variables[0], variables[1:]
    parts = []
    for value in domains.values(domain):
        chosen = {first.name: value}
        before, after = (now, then | chosen) if first.primed else (now | chosen, then)
        parts.append((value, _cases(truth, rest, before, after)))
    if len({part for _, part in parts}) == 1:
        return parts[0][1]
    return f.either(*(f.both(equals(first, value), part) for value, part in parts))


def equals(variable: Var, value: Literal) -> Formula:
    """That a variable has a value."""
    if isinstance(value, bool):
        return variable if value else f.negate(variable)
    return f.eq(variable, Const(value))
