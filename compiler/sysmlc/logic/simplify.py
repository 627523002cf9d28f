"""Substitution into formulas, constant folding, and satisfiability over small domains."""

from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import evaluation, value_of
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var

_LIMIT = 4096
"""Valuations tried; beyond them the answer is that a formula may be true and may be false."""
_REMEMBERED = 1 << 16
"""Answers that are kept: machines of one kind ask the same questions."""
_TIDY_LIMIT = 300
"""The same for what only serves the reader."""


def substitute(formula: Formula, values: Mapping[str, Formula]) -> Formula:
    """The formula with unprimed variables replaced, constants folded."""
    match formula:
        case Var(name, False):
            return values.get(name, formula)
        case Apply(op, args):
            return rebuild(op, tuple(substitute(arg, values) for arg in args))
        case _:
            return formula


def rebuild(op: Op, args: tuple[Formula, ...]) -> Formula:
    """An operator applied, with what is constant folded away."""
    if all(isinstance(arg, Const) for arg in args) and op not in _TEMPORAL:
        return Const(value_of(Apply(op, args), {}))
    if op in _CONNECTIVES:
        return _CONNECTIVES[op](*args)
    return _shifted(op, args) if op in _OPPOSITE else Apply(op, args)


def _shifted(op: Op, args: tuple[Formula, ...]) -> Formula:
    """A comparison with the constant moved to the right: ``x + 1 = 3`` is ``x = 2``."""
    match args:
        case (Apply(Op.ADD, (inner, Const(int(by)))), Const(int(limit))):
            return Apply(op, (inner, Const(limit - by)))
        case (Apply(Op.SUB, (inner, Const(int(by)))), Const(int(limit))):
            return Apply(op, (inner, Const(limit + by)))
        case _:
            return Apply(op, args)


def _same(left: Formula, right: Formula) -> Formula:
    for one, other in ((left, right), (right, left)):
        if isinstance(one, Const):
            return other if one.value else f.negate(other)
    return f.iff(left, right)


def is_satisfiable(formula: Formula, known: Mapping[str, Domain], limit: int = _LIMIT) -> bool:
    """Whether some values make the formula true; yes when there are too many to try.

    Primed and unprimed variables are independent of one another.
    """
    if isinstance(formula, Const):
        return bool(formula.value)
    domains_of = {v: known[v.name] for v in f.variables(formula)}
    if _count(domains_of.values(), limit) > limit:
        return True
    return _is_satisfiable(formula, tuple(domains_of.items()))


def _count(found: Iterable[Domain], limit: int) -> int:
    """Number of valuations, or of those of some variables if that is more than the limit."""
    number = 1
    for domain in found:
        number *= domains.size(domain)
        if number > limit:
            break
    return number


@lru_cache(_REMEMBERED)
def _is_satisfiable(formula: Formula, variables: tuple[tuple[Var, Domain], ...]) -> bool:
    """Parts of a disjunction are tried one by one, parts of a conjunction that have nothing to
    do with one another too: that is much less than all values of all variables."""
    branches = _branches(formula)
    if branches:
        return any(_is_possible(one, variables) for one in branches)
    groups = _apart(_joined(formula))
    if len(groups) > 1:
        return all(_is_possible(f.both(*group), variables) for group in groups)
    return _has_model(formula, dict(variables))


def _branches(formula: Formula) -> tuple[Formula, ...]:
    """The parts of a disjunction, however it is written; nothing for what is none."""
    match formula:
        case Apply(Op.OR, args):
            return args
        case Apply(Op.IMPLIES, (left, right)):
            return f.negate(left), right
        case Apply(Op.NOT, (Apply(Op.AND, args),)):
            return tuple(map(f.negate, args))
        case _:
            return ()


def _joined(formula: Formula) -> tuple[Formula, ...]:
    """The parts of a conjunction, however it is written, else the formula alone."""
    match formula:
        case Apply(Op.NOT, (Apply(Op.OR, args),)):
            return tuple(map(f.negate, args))
        case _:
            return _parts(formula)


def _is_possible(formula: Formula, around: tuple[tuple[Var, Domain], ...]) -> bool:
    if isinstance(formula, Const):
        return bool(formula.value)
    used = frozenset(f.variables(formula))
    return _is_satisfiable(formula, tuple(pair for pair in around if pair[0] in used))


def _apart(formulas: tuple[Formula, ...]) -> list[list[Formula]]:
    """The formulas in groups that share no variable."""
    groups: list[tuple[set[Var], list[Formula]]] = []
    for formula in formulas:
        variables, members = set(f.variables(formula)), [formula]
        for group in [one for one in groups if not one[0].isdisjoint(variables)]:
            groups.remove(group)
            variables |= group[0]
            members = [*group[1], *members]
        groups.append((variables, members))
    return [members for _, members in groups]


def _has_model(formula: Formula, found: Mapping[Var, Domain]) -> bool:
    """Whether some of all values make the formula true."""
    if len(found) == 1:
        return any(_solutions(formula, variable, domain) for variable, domain in found.items())
    now = {one.name: domain for one, domain in found.items() if not one.primed}
    then = {one.name: domain for one, domain in found.items() if one.primed}
    truth = evaluation(formula)
    return any(
        truth(before, after)
        for after in domains.valuations(then)
        for before in domains.valuations(now)
    )


def simplified(formula: Formula, known: Mapping[str, Domain]) -> Formula:
    """True or false when the formula is always that, else the formula."""
    if isinstance(formula, Const):
        return formula
    if not is_satisfiable(formula, known):
        return f.FALSE
    return formula if is_satisfiable(f.negate(formula), known) else f.TRUE


@lru_cache(_REMEMBERED)
def _solutions(formula: Formula, variable: Var, domain: Domain) -> frozenset[Literal]:
    """The values of its only variable that make the formula true."""
    match formula:
        case Apply(Op.NOT, (inner,)):
            return frozenset(domains.values(domain)) - _solutions(inner, variable, domain)
        case Apply(Op.AND, args):
            return frozenset.intersection(*(_solutions(one, variable, domain) for one in args))
        case Apply(Op.OR, args):
            return frozenset.union(*(_solutions(one, variable, domain) for one in args))
        case _:
            truth = evaluation(formula)
            rows = ((value, {variable.name: value}) for value in domains.values(domain))
            return frozenset(value for value, row in rows if truth(row, row))


# -- tidying -----------------------------------------------------------------------------------


def tidy(formula: Formula, known: Mapping[str, Domain], facts: tuple[Formula, ...] = ()) -> Formula:
    """An equivalent formula, given the facts, without the parts that the rest implies."""
    return _remembered(formula, tuple(known.items()), facts)


@lru_cache(_REMEMBERED)
def _remembered(
    formula: Formula, known: tuple[tuple[str, Domain], ...], facts: tuple[Formula, ...]
) -> Formula:
    return _tidy(formula, dict(known), facts)


def _tidy(formula: Formula, known: Mapping[str, Domain], facts: tuple[Formula, ...]) -> Formula:
    match formula:
        case Apply(Op.AND, args):
            return _tidy_and(args, known, facts)
        case Apply(Op.OR, args):
            return f.either(*(_tidy(arg, known, facts) for arg in args))
        case Apply(Op.NOT, (inner,)):
            return opposite(_tidy(inner, known, facts))
        case Apply(Op.IMPLIES, (left, right)):
            return f.implies(_tidy(left, known, facts), right)
        case _:
            return _leaf(formula, known, facts)


def opposite(formula: Formula) -> Formula:
    """The negation; a comparison is turned into the opposite one."""
    if isinstance(formula, Apply) and formula.op in _OPPOSITE:
        return Apply(_OPPOSITE[formula.op], formula.args)
    return f.negate(formula)


def _tidy_and(
    args: tuple[Formula, ...], known: Mapping[str, Domain], facts: tuple[Formula, ...]
) -> Formula:
    parts = list(args)
    for index in reversed(range(len(parts))):
        others = (*facts, *parts[:index], *parts[index + 1 :])
        parts[index] = _tidy(parts[index], known, others)
    return f.both(*parts)


def _leaf(formula: Formula, known: Mapping[str, Domain], facts: tuple[Formula, ...]) -> Formula:
    near = _near(formula, known, facts)
    if not is_satisfiable(f.both(near, f.negate(formula)), known, _TIDY_LIMIT):
        return f.TRUE
    if not is_satisfiable(f.both(near, formula), known, _TIDY_LIMIT):
        return f.FALSE
    return formula


def _near(formula: Formula, known: Mapping[str, Domain], facts: tuple[Formula, ...]) -> Formula:
    """Facts about the formula's variables, the simplest first, as many as can be tried."""
    used = set(f.variables(formula))
    parts = [part for fact in facts for part in _parts(fact)]
    about = [(set(f.variables(part)), part) for part in parts]
    chosen: list[Formula] = []
    for variables, part in sorted(about, key=lambda one: len(one[0])):
        if variables.isdisjoint(f.variables(formula)):
            continue
        if _size(used | variables, known) <= _TIDY_LIMIT:
            used |= variables
            chosen.append(part)
    return f.both(*chosen)


def _parts(formula: Formula) -> tuple[Formula, ...]:
    is_and = isinstance(formula, Apply) and formula.op is Op.AND
    return formula.args if is_and and isinstance(formula, Apply) else (formula,)


def _size(variables: set[Var], known: Mapping[str, Domain]) -> int:
    number = 1
    for variable in variables:
        number *= domains.size(known[variable.name])
    return number


_TEMPORAL = frozenset([Op.NEXT, Op.ALWAYS, Op.EVENTUALLY, Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL])
_TEMPORAL |= {Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY, Op.SINCE}
_CONNECTIVES: dict[Op, Callable[..., Formula]] = {
    Op.AND: f.both,
    Op.OR: f.either,
    Op.NOT: f.negate,
    Op.IMPLIES: f.implies,
    Op.IFF: _same,
}
_OPPOSITE = {
    Op.EQ: Op.NE,
    Op.NE: Op.EQ,
    Op.LT: Op.GE,
    Op.GE: Op.LT,
    Op.GT: Op.LE,
    Op.LE: Op.GT,
}
