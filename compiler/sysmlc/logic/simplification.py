"""Substitution into formulas, constant folding, and satisfiability over small domains."""

from collections.abc import Iterable, Mapping
from functools import lru_cache

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import compile_evaluation, value_of
from sysmlc.logic.formula import FUTURE, PAST, Apply, Const, Formula, Literal, Op, Var

_MAX_VALUATIONS = 4096
"""Most valuations tried; above this number a formula counts as satisfiable."""
_CACHED_ANSWERS = 1 << 16
"""Cache size: similar machines ask the same questions."""
_MAX_VALUATIONS_REDUNDANCY = 300
"""Most valuations tried to decide whether a part of a formula is redundant."""
_OPPOSITE = {
    Op.EQ: Op.NE,
    Op.NE: Op.EQ,
    Op.LT: Op.GE,
    Op.GE: Op.LT,
    Op.GT: Op.LE,
    Op.LE: Op.GT,
}


def substitute(formula: Formula, values: Mapping[str, Formula]) -> Formula:
    """Return the formula with unprimed variables replaced and constants folded."""
    match formula:
        case Var(name, False):
            return values.get(name, formula)
        case Apply(op, args):
            return rebuild(op, tuple(substitute(arg, values) for arg in args))
        case _:
            return formula


def rebuild(op: Op, args: tuple[Formula, ...]) -> Formula:
    """Apply the operator to the operands and fold constants."""
    if all(isinstance(arg, Const) for arg in args) and op not in FUTURE and op not in PAST:
        return Const(value_of(Apply(op, args), {}))
    if op is Op.IFF:
        return f.fold_iff(*args)
    if op is Op.MOD and args[1] == Const(1):
        return Const(0)  # the values are whole numbers
    return _move_constant_right(op, args) if op in _OPPOSITE else f.apply(op, args)


def _move_constant_right(op: Op, args: tuple[Formula, ...]) -> Formula:
    """Move a constant of a comparison to the right: ``x + 1 = 3`` becomes ``x = 2``."""
    match args:
        case (Apply(Op.ADD, (inner, Const(int(by)))), Const(int(limit))):
            return Apply(op, (inner, Const(limit - by)))
        case (Apply(Op.SUB, (inner, Const(int(by)))), Const(int(limit))):
            return Apply(op, (inner, Const(limit + by)))
        case _:
            return Apply(op, args)


def is_satisfiable(
    formula: Formula, domain_by_name: Mapping[str, Domain], limit: int = _MAX_VALUATIONS
) -> bool:
    """Whether some values make the formula true, or there are too many values to try.

    Primed and unprimed variables are independent of one another.
    """
    if isinstance(formula, Const):
        return bool(formula.value)
    domains_of = {v: domain_by_name[v.name] for v in f.variables(formula)}
    if _count(domains_of.values(), limit) > limit:
        return True
    return _is_satisfiable(formula, tuple(domains_of.items()))


def _count(variable_domains: Iterable[Domain], limit: int) -> int:
    """Return the number of valuations; counting stops above the limit."""
    total = 1
    for domain in variable_domains:
        total *= domains.size(domain)
        if total > limit:
            break
    return total


@lru_cache(_CACHED_ANSWERS)
def _is_satisfiable(formula: Formula, variables: tuple[tuple[Var, Domain], ...]) -> bool:
    """Whether some values make the formula true.

    The branches of a disjunction, and parts of a conjunction without common variables, are tried
    separately: that needs far fewer valuations than all variables together.
    """
    branches = _split_disjunction(formula)
    if branches:
        return any(_is_part_satisfiable(branch, variables) for branch in branches)
    groups = _group_by_variables(_split_any_conjunction(formula))
    if len(groups) > 1:
        return all(_is_part_satisfiable(f.both(*group), variables) for group in groups)
    return _has_model(formula, dict(variables))


def _split_disjunction(formula: Formula) -> tuple[Formula, ...]:
    """Return the operands of a disjunction, also of ``a -> b`` and ``!(a & b)``; else nothing."""
    match formula:
        case Apply(Op.OR, args):
            return args
        case Apply(Op.IMPLIES, (left, right)):
            return f.negate(left), right
        case Apply(Op.NOT, (Apply(Op.AND, args),)):
            return tuple(map(f.negate, args))
        case _:
            return ()


def _split_any_conjunction(formula: Formula) -> tuple[Formula, ...]:
    """Return the operands of a conjunction, also of ``!(a | b)``; else the formula alone."""
    match formula:
        case Apply(Op.NOT, (Apply(Op.OR, args),)):
            return tuple(map(f.negate, args))
        case _:
            return f.split_conjunction(formula)


def _is_part_satisfiable(
    formula: Formula, variable_domains: tuple[tuple[Var, Domain], ...]
) -> bool:
    if isinstance(formula, Const):
        return bool(formula.value)
    own_variables = frozenset(f.variables(formula))
    return _is_satisfiable(
        formula, tuple(pair for pair in variable_domains if pair[0] in own_variables)
    )


def _group_by_variables(formulas: tuple[Formula, ...]) -> list[list[Formula]]:
    """Group the formulas so that different groups share no variable."""
    groups: list[tuple[set[Var], list[Formula]]] = []
    for formula in formulas:
        variables, members = set(f.variables(formula)), [formula]
        for group in [existing for existing in groups if not existing[0].isdisjoint(variables)]:
            groups.remove(group)
            variables |= group[0]
            members = [*group[1], *members]
        groups.append((variables, members))
    return [members for _, members in groups]


def _has_model(formula: Formula, variable_domains: Mapping[Var, Domain]) -> bool:
    """Whether some valuation makes the formula true, by trying all."""
    if len(variable_domains) == 1:
        return any(
            _solutions(formula, variable, domain) for variable, domain in variable_domains.items()
        )
    current = {
        variable.name: domain
        for variable, domain in variable_domains.items()
        if not variable.primed
    }
    following = {
        variable.name: domain for variable, domain in variable_domains.items() if variable.primed
    }
    truth = compile_evaluation(formula)
    return any(
        truth(before, after)
        for after in domains.valuations(following)
        for before in domains.valuations(current)
    )


def simplify_constant(formula: Formula, domain_by_name: Mapping[str, Domain]) -> Formula:
    """Return true or false if the formula is constant, else the formula."""
    if isinstance(formula, Const):
        return formula
    if not is_satisfiable(formula, domain_by_name):
        return f.FALSE
    return formula if is_satisfiable(f.negate(formula), domain_by_name) else f.TRUE


@lru_cache(_CACHED_ANSWERS)
def _solutions(formula: Formula, variable: Var, domain: Domain) -> frozenset[Literal]:
    """Return the values of its only variable that make the formula true."""
    match formula:
        case Apply(Op.NOT, (inner,)):
            return frozenset(domains.values(domain)) - _solutions(inner, variable, domain)
        case Apply(Op.AND, args):
            return frozenset.intersection(*(_solutions(arg, variable, domain) for arg in args))
        case Apply(Op.OR, args):
            return frozenset.union(*(_solutions(arg, variable, domain) for arg in args))
        case _:
            truth = compile_evaluation(formula)
            rows = ((value, {variable.name: value}) for value in domains.values(domain))
            return frozenset(value for value, row in rows if truth(row, row))


# -- redundant parts --------------------------------------------------------------------------


def remove_redundant(
    formula: Formula, domain_by_name: Mapping[str, Domain], facts: tuple[Formula, ...] = ()
) -> Formula:
    """Return an equivalent formula, given the facts, without parts that the rest implies."""
    return _remove_redundant_cached(formula, tuple(domain_by_name.items()), facts)


@lru_cache(_CACHED_ANSWERS)
def _remove_redundant_cached(
    formula: Formula, domain_by_name: tuple[tuple[str, Domain], ...], facts: tuple[Formula, ...]
) -> Formula:
    return _remove_redundant(formula, dict(domain_by_name), facts)


def _remove_redundant(
    formula: Formula, domain_by_name: Mapping[str, Domain], facts: tuple[Formula, ...]
) -> Formula:
    match formula:
        case Apply(Op.AND, args):
            return _remove_redundant_conjuncts(args, domain_by_name, facts)
        case Apply(Op.OR, args):
            return f.either(*(_remove_redundant(arg, domain_by_name, facts) for arg in args))
        case Apply(Op.NOT, (inner,)):
            return opposite(_remove_redundant(inner, domain_by_name, facts))
        case Apply(Op.IMPLIES, (left, right)):
            return f.implies(_remove_redundant(left, domain_by_name, facts), right)
        case _:
            return _decide_atom(formula, domain_by_name, facts)


def opposite(formula: Formula) -> Formula:
    """Return the negation; a comparison becomes the opposite comparison."""
    if isinstance(formula, Apply) and formula.op in _OPPOSITE:
        return Apply(_OPPOSITE[formula.op], formula.args)
    return f.negate(formula)


def merge_terms(terms: Iterable[Formula]) -> list[Formula]:
    """Return fewer conjunctions with the same disjunction: ``a & b`` and ``a & !b`` become ``a``.

    Terms of which a single condition is a part are dropped.
    """
    merged = {frozenset(parts): parts for parts in map(f.split_conjunction, terms)}
    worklist = list(merged.values())
    for parts in worklist:
        for part in parts:
            rest = tuple(other for other in parts if other != part)
            partner = frozenset((*rest, opposite(part)))
            if rest and frozenset(parts) in merged and partner in merged:
                del merged[frozenset(parts)], merged[partner]
                merged[frozenset(rest)] = rest
                worklist.append(rest)
    single = {parts[0] for parts in merged.values() if len(parts) == 1}
    kept = (parts for parts in merged.values() if len(parts) == 1 or not single & {*parts})
    return [f.both(*parts) for parts in kept]


def _remove_redundant_conjuncts(
    args: tuple[Formula, ...], domain_by_name: Mapping[str, Domain], facts: tuple[Formula, ...]
) -> Formula:
    parts = list(args)
    # From the end, so that of two equivalent conjuncts the first one is retained.
    for index in reversed(range(len(parts))):
        rest = (*facts, *parts[:index], *parts[index + 1 :])
        parts[index] = _remove_redundant(parts[index], domain_by_name, rest)
    return f.both(*parts)


def _decide_atom(
    formula: Formula, domain_by_name: Mapping[str, Domain], facts: tuple[Formula, ...]
) -> Formula:
    """Return true or false if the facts decide the formula, else the formula."""
    relevant = _select_facts(formula, domain_by_name, facts)
    if not is_satisfiable(
        f.both(relevant, f.negate(formula)), domain_by_name, _MAX_VALUATIONS_REDUNDANCY
    ):
        return f.TRUE
    if not is_satisfiable(f.both(relevant, formula), domain_by_name, _MAX_VALUATIONS_REDUNDANCY):
        return f.FALSE
    return formula


def _select_facts(
    formula: Formula, domain_by_name: Mapping[str, Domain], facts: tuple[Formula, ...]
) -> Formula:
    """Return the conjunction of the facts that may decide the formula.

    These share a variable with it. Facts with fewer variables are preferred, and facts with which
    there would be too many valuations to try are omitted.
    """
    selected_variables = set(f.variables(formula))
    parts = [part for fact in facts for part in f.split_conjunction(fact)]
    candidates = [(set(f.variables(part)), part) for part in parts]
    chosen: list[Formula] = []
    for variables, part in sorted(candidates, key=lambda candidate: len(candidate[0])):
        if variables.isdisjoint(f.variables(formula)):
            continue
        variable_domains = (
            domain_by_name[variable.name] for variable in selected_variables | variables
        )
        if _count(variable_domains, _MAX_VALUATIONS_REDUNDANCY) <= _MAX_VALUATIONS_REDUNDANCY:
            selected_variables |= variables
            chosen.append(part)
    return f.both(*chosen)
