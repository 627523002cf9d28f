"""Lowering of contracts: reserved names, weak until, comparisons and arithmetic.

Each function returns a contract with the same meaning that uses fewer constructs. ``encodings``
goes further and replaces enumerations by integers, and integers by bits.
"""

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from itertools import product, starmap

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
from sysmlc.logic.simplification import rebuild
from sysmlc.logic.syntax import ARITHMETIC, COMPARISONS

MAX_VALUATIONS = 1 << 16
"""Most valuations of its variables over which a comparison is expanded."""
_CACHED_EXPANSIONS = 1 << 12
Domains = Mapping[str, Domain]
"""The domains of variables by name."""
Rewrite = Callable[[Formula], Formula]
_MIRRORED = {Op.LT: Op.GT, Op.GT: Op.LT, Op.LE: Op.GE, Op.GE: Op.LE}
"""The comparison with its sides exchanged."""


class TooManyValuesError(ValueError):
    """A comparison has too many valuations to be expanded; ``conjunct`` contains it."""

    def __init__(self, conjunct: Conjunct | None = None) -> None:
        super().__init__("it compares more values than can be written out")
        self.conjunct = conjunct


# -- traversal -------------------------------------------------------------------------------------


def index_domains(contract: Contract) -> dict[str, Domain]:
    """Return the domains of the contract's variables by name."""
    return {variable.name: variable.domain for variable in contract.variables}


def rewrite_atoms(formula: Formula, rewrite: Rewrite) -> Formula:
    """Replace every atom of the formula: each comparison, Boolean variable and constant."""
    match formula:
        case Apply(op, args) if op not in COMPARISONS:
            return f.apply(op, tuple(rewrite_atoms(arg, rewrite) for arg in args))
        case _:
            return rewrite(formula)


def rewrite_contract_atoms(
    contract: Contract, rewrite: Rewrite, variables: Iterable[Variable] | None = None
) -> Contract:
    """Replace the atoms of every conjunct. Raises TooManyValuesError."""
    return rewrite_conjuncts(contract, lambda formula: rewrite_atoms(formula, rewrite), variables)


def rewrite_conjuncts(
    contract: Contract, rewrite: Rewrite, variables: Iterable[Variable] | None = None
) -> Contract:
    """Replace the formula of every conjunct, and the variables if any are given.
    Raises TooManyValuesError with the conjunct whose rewriting raised it.
    """

    def rewrite_one(conjunct: Conjunct) -> Conjunct:
        try:
            return replace(conjunct, formula=rewrite(conjunct.formula))
        except TooManyValuesError:
            raise TooManyValuesError(conjunct) from None

    return replace(
        contract,
        variables=contract.variables if variables is None else tuple(variables),
        assumptions=tuple(map(rewrite_one, contract.assumptions)),
        guarantees=tuple(map(rewrite_one, contract.guarantees)),
    )


def eliminate_weak_until(formula: Formula) -> Formula:
    """Replace ``a W b`` by ``b R (a | b)``."""
    match formula:
        case Apply(Op.WEAK_UNTIL, (left, right)):
            stay, goal = eliminate_weak_until(left), eliminate_weak_until(right)
            return Apply(Op.RELEASE, (goal, f.either(stay, goal)))
        case Apply(op, args):
            return f.apply(op, tuple(map(eliminate_weak_until, args)))
        case _:
            return formula


# -- names -----------------------------------------------------------------------------------------


def rename_reserved(contract: Contract, reserved: Iterable[str]) -> Contract:
    """Append underscores to variables and literals that are reserved words of a format.

    A literal with the name of a variable is renamed too.
    """
    # A format has one namespace for variables and literals.
    words = frozenset(reserved)
    names = _assign_names([variable.name for variable in contract.variables], words)
    taken = words | {*names, *names.values()}
    literals = _assign_names(list_literals(contract), taken)
    variables = [
        replace(
            variable,
            name=names[variable.name],
            domain=_rename_literals(variable.domain, literals),
        )
        for variable in contract.variables
    ]

    def rename(leaf: Const | Var) -> Formula:
        if isinstance(leaf, Var):
            return Var(names[leaf.name], leaf.primed)
        return Const(literals.get(leaf.value, leaf.value)) if isinstance(leaf.value, str) else leaf

    return rewrite_conjuncts(contract, lambda formula: f.replace_leaves(formula, rename), variables)


def rename_ambiguous_literals(contract: Contract) -> Contract:
    """Rename literals with the name of a variable.

    In ``state=red``, ``red`` could otherwise be the literal or the variable.
    """
    names = {variable.name for variable in contract.variables}
    is_ambiguous = not names.isdisjoint(list_literals(contract))
    return rename_reserved(contract, ()) if is_ambiguous else contract


def list_literals(contract: Contract) -> list[str]:
    """Return the literals of all enumerations; a literal of two enumerations occurs once."""
    enumerations = [v.domain for v in contract.variables if isinstance(v.domain, EnumerationDomain)]
    return list(dict.fromkeys(literal for domain in enumerations for literal in domain.literals))


def _assign_names(names: Iterable[str], words: frozenset[str]) -> dict[str, str]:
    """Map each name to itself, or, if it is one of the words, to a new name with underscores."""
    names = list(names)
    taken = set(names) | words
    assigned = {}
    for name in names:
        new_name = name
        while new_name in words or (new_name != name and new_name in taken):
            new_name += "_"
        taken.add(new_name)
        assigned[name] = new_name
    return assigned


def _rename_literals(domain: Domain, literals: Mapping[str, str]) -> Domain:
    if not isinstance(domain, EnumerationDomain):
        return domain
    renamed = tuple(literals[literal] for literal in domain.literals)
    return dataclasses.replace(domain, literals=renamed)


# -- comparisons -----------------------------------------------------------------------------------


def flatten_atom(atom: Formula, variable_domains: Domains) -> Formula:
    """Rewrite an atom into comparisons of variables with values. Raises TooManyValuesError."""
    match atom:
        case Apply(Op.EQ | Op.NE as op, (left, right)) if is_boolean(left, variable_domains):
            equivalence = f.iff(
                *(
                    rewrite_atoms(side, lambda inner: flatten_atom(inner, variable_domains))
                    for side in (left, right)
                )
            )
            return equivalence if op is Op.EQ else f.negate(equivalence)
        case Apply(_, (Var(name), Const(value))) if domains.contains(variable_domains[name], value):
            return atom
        case Apply(op, (Const(value), Var(name) as var)) if domains.contains(
            variable_domains[name], value
        ):
            return Apply(_MIRRORED.get(op, op), (var, Const(value)))
        case Apply():
            return expand_comparison(atom, variable_domains)
        case _:
            return atom


def is_boolean(formula: Formula, variable_domains: Domains) -> bool:
    """Whether the value of a formula is true or false."""
    match formula:
        case Var(name):
            return isinstance(variable_domains[name], BooleanDomain)
        case Const(value):
            return isinstance(value, bool)
        case Apply(op):
            return op not in ARITHMETIC


def expand_comparison(
    comparison: Formula, variable_domains: Domains, limit: int = MAX_VALUATIONS
) -> Formula:
    """Return the valuations that make a comparison true, as a formula over ``x = value``.

    Raises TooManyValuesError.
    """
    variables = tuple(dict.fromkeys(f.variables(comparison)))
    pairs = tuple((variable, variable_domains[variable.name]) for variable in variables)
    return _expand(comparison, pairs, limit)


@lru_cache(_CACHED_EXPANSIONS)
def _expand(comparison: Formula, variables: tuple[tuple[Var, Domain], ...], limit: int) -> Formula:
    if math.prod(domains.size(domain) for _, domain in variables) > limit:
        raise TooManyValuesError
    return _expand_variables(compile_evaluation(comparison), variables, {}, {})


def _expand_variables(
    evaluation: Evaluation,
    variables: tuple[tuple[Var, Domain], ...],
    current: dict[str, Literal],
    following: dict[str, Literal],
) -> Formula:
    """Return a case distinction over the variables; the first variable is the outermost."""
    if not variables:
        return Const(bool(evaluation(current, following)))
    (variable, domain), rest = variables[0], variables[1:]
    cases = []
    for value in domains.values(domain):
        extended = {variable.name: value}
        if variable.primed:
            case = _expand_variables(evaluation, rest, current, following | extended)
        else:
            case = _expand_variables(evaluation, rest, current | extended, following)
        cases.append((value, case))
    if len({case for _, case in cases}) == 1:
        return cases[0][1]
    return f.either(*(f.both(f.has_value(variable, value), case) for value, case in cases))


def separate_steps(
    comparison: Formula, variable_domains: Domains, limit: int = MAX_VALUATIONS
) -> Formula:
    """Return a comparison as a formula whose comparisons are each about one step.

    A comparison of current with next values becomes cases over the values of the step that has
    fewer of them; arithmetic over the other step remains. ``x' = y + z`` becomes
    ``x'=0 & y + z=0 | x'=1 & y + z=1``. Raises TooManyValuesError.
    """
    match comparison:
        case Apply(Op.EQ | Op.NE as op, (left, right)) if is_boolean(left, variable_domains):
            equivalence = f.fold_iff(
                *(
                    rewrite_atoms(side, lambda atom: separate_steps(atom, variable_domains, limit))
                    for side in (left, right)
                )
            )
            return equivalence if op is Op.EQ else f.negate(equivalence)
        case Var() | Const():
            return comparison
    variables = tuple(dict.fromkeys(f.variables(comparison)))
    if not variables:
        return Const(bool(compile_evaluation(comparison)({}, {})))
    steps = [
        tuple(
            (variable, variable_domains[variable.name])
            for variable in variables
            if variable.primed is is_primed
        )
        for is_primed in (False, True)
    ]
    if not all(steps):
        return _fold_unreachable(comparison, variable_domains)
    listed = min(steps, key=lambda step: math.prod(domains.size(domain) for _, domain in step))
    if math.prod(domains.size(domain) for _, domain in listed) > limit:
        raise TooManyValuesError
    cases = []
    for values in product(*(domains.values(domain) for _, domain in listed)):
        valuation = dict(zip((variable for variable, _ in listed), values, strict=True))
        rest = _fold_unreachable(_assign(comparison, valuation), variable_domains)
        cases.append(f.both(*starmap(f.has_value, valuation.items()), rest))
    return f.either(*cases)


def _assign(formula: Formula, valuation: Mapping[Var, Literal]) -> Formula:
    """Return the formula with values for some variables and with folded constants."""
    match formula:
        case Var() if formula in valuation:
            return Const(valuation[formula])
        case Apply(op, args):
            return rebuild(op, tuple(_assign(arg, valuation) for arg in args))
        case _:
            return formula


def _fold_unreachable(comparison: Formula, variable_domains: Domains) -> Formula:
    """Return true or false if a comparison with a value is constant, else the comparison.

    ``x=9`` is false and ``x<9`` is true for a variable ``x`` from 0 to 3.
    """
    match comparison:
        case Apply(_, (Var(name), Const(value))):
            values = domains.values(variable_domains[name])
            # One of these three values differs from the others if any value of a range does.
            samples = {values[0], values[-1], value if value in values else values[0]}
            truth = compile_evaluation(comparison)
            truths = {truth(row, row) for row in ({name: sample} for sample in samples)}
            return comparison if len(truths) > 1 else Const(bool(truths.pop()))
        case Apply(op, (Const() as value, (Var() | Apply()) as term)):
            mirrored = rebuild(_MIRRORED.get(op, op), (term, value))
            return _fold_unreachable(mirrored, variable_domains)
        case _:
            return comparison


def has_partial_division(formula: Formula) -> bool:
    """Whether it divides by something that can be 0, for which other languages have no value."""
    match formula:
        case Apply(Op.DIV | Op.MOD, (_, divisor)) if (
            not isinstance(divisor, Const) or divisor.value == 0
        ):
            return True
        case Apply(_, args):
            return any(map(has_partial_division, args))
        case _:
            return False
