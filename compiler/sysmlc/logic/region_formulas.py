"""Formulas over regions of numbers: common regions of several contracts, and texts for people.

Two contracts that cut the values of one number at different places have different literals for it.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from fractions import Fraction
from functools import reduce
from itertools import groupby

from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.classification import add_temporal_operators
from sysmlc.logic.contract import (
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Variable,
)
from sysmlc.logic.domains import make_region_domain, regions_of
from sysmlc.logic.expressions.linear import print_term
from sysmlc.logic.formats.lowering import expand_comparison, rewrite_atoms, rewrite_contract_atoms
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.printing import print_formula
from sysmlc.logic.regions import Cut, Regions, split_line

# -- common regions --------------------------------------------------------------------------------


_MAX_RANGE = 64
"""Most Integers of a range that become regions."""


def unite_regions(own_domains: Iterable[Domain]) -> EnumerationDomain | None:
    """Return the domain of a number with the cuts of all domains.

    Beside regions of Integers, each Integer of a range is a region. None if no domain has regions,
    if the units differ, or if other values are among them.
    """
    own_domains = list(own_domains)
    regions = [_find_regions(domain) for domain in own_domains]
    numeric = [item for item in regions if item is not None]
    has_ranges = any(isinstance(domain, IntegerDomain) for domain in own_domains)
    if (
        not any(map(regions_of, own_domains))
        or len(numeric) < len(regions)
        or len({item.unit for item in numeric}) > 1
        or (has_ranges and not all(item.is_integral for item in numeric))
    ):
        return None
    return make_region_domain(reduce(Regions.unite, numeric))


def _find_regions(domain: Domain) -> Regions | None:
    """Return the regions of a domain, or the Integers of a small range as regions."""
    if not isinstance(domain, IntegerDomain) or domains.size(domain) > _MAX_RANGE:
        return regions_of(domain)
    cuts = (Cut(Fraction(number)) for number in range(domain.low, domain.high + 2))
    return Regions(split_line(cuts)[1:-1], is_integral=True)


def split_regions(contract: Contract, new_domains: Mapping[str, Domain]) -> Contract:
    """Return the contract with the finer regions of *new_domains* for its numbers.

    A comparison with a literal becomes one with the regions within it. Two equal values become two
    values in the same one of the former regions, because nothing more is known about them. A
    variable has those literals of its new domain that lie within its former regions. Raises
    TooManyValuesError for arithmetic with many numbers.
    """
    variables: list[Variable] = []
    parts: dict[str, Parts] = {}
    for variable in contract.variables:
        domain = new_domains.get(variable.name, variable.domain)
        old, new = _find_regions(variable.domain), regions_of(domain)
        if domain != variable.domain and old is not None and new is not None:
            assert isinstance(domain, EnumerationDomain)
            finer = dict(zip(domain.literals, new.intervals, strict=True))
            values = domains.values(variable.domain)
            parts[variable.name] = {
                value: tuple(name for name in finer if interval.includes(finer[name]))
                for value, interval in zip(values, old.intervals, strict=True)
            }
            inside = set().union(*parts[variable.name].values())
            own = replace(new, intervals=tuple(finer[name] for name in finer if name in inside))
            literals = tuple(name for name in finer if name in inside)
            variable = replace(
                variable,
                domain=EnumerationDomain(literals, regions=own),
                is_range_assumed=False,
                term=variable.term or ((variable.name, Fraction(1)),),
            )
        variables.append(variable)
    if not parts:
        return contract
    split = _make_splitting({v.name: v for v in contract.variables}, parts)
    return rewrite_contract_atoms(contract, split, variables)


Parts = Mapping[Literal, tuple[str, ...]]
"""For each value of a former domain, the literals of the finer regions."""


def _make_splitting(
    variables: Mapping[str, Variable], parts: Mapping[str, Parts]
) -> Callable[[Formula], Formula]:
    """Return a function that splits the comparisons of variables; *parts* are finer literals."""

    def belongs(operand: Formula, value: Literal) -> Formula:
        if isinstance(operand, Const):
            return Const(operand.value == value)
        assert isinstance(operand, Var)
        names: Iterable[Literal] = parts.get(operand.name, {}).get(value, (value,))
        return f.either(*(f.eq(operand, Const(name)) for name in names))

    def split(atom: Formula) -> Formula:
        match atom:
            case Apply(Op.EQ | Op.NE as op, (left, right)):
                names = [side.name for side in (left, right) if isinstance(side, Var)]
                if parts.keys().isdisjoint(names):
                    return atom
                if len(set(names)) < len(names) and _is_constant(variables[names[0]]):
                    return atom
                is_same = f.either(
                    *(
                        f.both(belongs(left, value), belongs(right, value))
                        for value in domains.values(variables[names[0]].domain)
                    )
                )
                return is_same if op is Op.EQ else f.negate(is_same)
        return atom

    by_name = {name: variable.domain for name, variable in variables.items()}

    def split_arithmetic(atom: Formula) -> Formula:
        """Write arithmetic with ranges as cases before the values are split."""
        names = f.variable_names(atom) & parts.keys()
        if isinstance(atom, Apply) and any(isinstance(by_name[n], IntegerDomain) for n in names):
            return rewrite_atoms(expand_comparison(atom, by_name), split)
        return split(atom)

    return split_arithmetic


def _is_constant(variable: Variable) -> bool:
    """Whether the variable is a sum of numbers that never change."""
    return {name for name, _ in variable.term} <= set(variable.constants)


# -- texts for people ------------------------------------------------------------------------------


def word_regions(formula: Formula, variables: Iterable[Variable]) -> Formula:
    """Return a formula with comparisons in the place of regions: ``temp < low``.

    The result is only for people: a comparison is a variable whose name is its text.
    """
    by_name = {item.name: item for item in variables if regions_of(item.domain) is not None}
    return _Wording(by_name).word(formula) if by_name else formula


def print_worded(formula: Formula, variables: Iterable[Variable]) -> str:
    """Return a formula as text for people, with comparisons in the place of regions."""
    return print_formula(word_regions(formula, variables))


def word_conjunct(conjunct: Conjunct, variables: Iterable[Variable]) -> Conjunct:
    """Return a conjunct with comparisons in the place of regions as its wording, if it has any."""
    worded = word_regions(conjunct.formula, variables)
    if conjunct.wording is not None or worded == conjunct.formula:
        return conjunct
    return replace(conjunct, wording=add_temporal_operators(conjunct.class_, worded))


def word_contract(contract: Contract) -> Contract:
    """Return the contract with the wordings of ``word_conjunct``."""
    assumptions, guarantees = (
        tuple(word_conjunct(conjunct, contract.variables) for conjunct in side)
        for side in (contract.assumptions, contract.guarantees)
    )
    return replace(contract, assumptions=assumptions, guarantees=guarantees)


class _Wording:
    """Writes comparisons of variables whose values are regions."""

    def __init__(self, variables: Mapping[str, Variable]) -> None:
        self._variables = variables

    def word(self, formula: Formula) -> Formula:
        """Return the formula with a comparison for each variable of a connective."""
        selection = self._select(formula)
        if selection is not None:
            return self._describe(*selection)
        match formula:
            case Apply(Op.AND | Op.OR as op, args):
                return f.apply(op, tuple(self._word_operands(op, args)))
            case Apply(op, args):
                return Apply(op, tuple(map(self.word, args)))
        return formula

    def _word_operands(self, op: Op, args: Iterable[Formula]) -> Iterator[Formula]:
        """Yield the operands; those about regions of one variable are one comparison."""
        operands: dict[Formula, Set[int] | None] = {}
        for arg in args:
            variable, indices = self._select(arg) or (arg, None)
            earlier = operands.get(variable)
            if indices is not None and earlier is not None:
                indices = _merge(op, earlier, indices)
            operands[variable] = indices
        for operand, indices in operands.items():
            if indices is not None and isinstance(operand, Var):
                yield self._describe(operand, indices)
            else:
                yield self.word(operand)

    def _select(self, formula: Formula) -> tuple[Var, Set[int]] | None:
        """Return the variable of a formula about one number, and the indices of true regions."""
        match formula:
            case Apply(Op.EQ, (Var(name) as variable, Const(literal))) if name in self._variables:
                literals = domains.values(self._domain(name))
                return variable, {i for i, item in enumerate(literals) if item == literal}
            case Apply(Op.NE, args):
                return self._complement(self._select(Apply(Op.EQ, args)))
            case Apply(Op.NOT, (arg,)):
                return self._complement(self._select(arg))
            case Apply(Op.AND | Op.OR as op, args):
                selection = self._select(args[0])
                for following in map(self._select, args[1:]):
                    if selection is None or following is None or selection[0] != following[0]:
                        return None
                    selection = selection[0], _merge(op, selection[1], following[1])
                return selection
        return None

    def _complement(self, selection: tuple[Var, Set[int]] | None) -> tuple[Var, Set[int]] | None:
        if selection is None:
            return None
        variable, indices = selection
        return variable, set(range(domains.size(self._domain(variable.name)))) - indices

    def _domain(self, name: str) -> Domain:
        return self._variables[name].domain

    def _describe(self, variable: Var, indices: Set[int]) -> Formula:
        """Return the comparisons that are true in the regions with these indices."""
        regions, sides = self.read_regions(variable)
        count = len(regions.intervals)
        if self.is_mirrored(variable.name):
            indices = {count - 1 - index for index in indices}
        rest = set(range(count)) - indices
        runs = [
            [i for _, i in group]
            for _, group in groupby(enumerate(sorted(indices)), lambda pair: pair[1] - pair[0])
        ]
        if not rest:
            return f.TRUE
        excluded = min(rest)
        if len(runs) > 1 and len(rest) == 1 and regions.is_point(excluded):
            return Var(regions.describe(excluded, *sides).replace("==", "!="))
        return f.either(*(Var(regions.describe_span(run[0], run[-1], *sides)) for run in runs))

    def read_regions(self, variable: Var) -> tuple[Regions, tuple[str, str]]:
        """Return the regions, what is compared and, of a difference, what is subtracted."""
        number = self._variables[variable.name]
        regions = regions_of(number.domain)
        assert regions is not None
        prime = "'" * variable.primed
        if len(number.term) < 2:
            return regions, ((number.wording or number.name) + prime, "")
        sign = -1 if self.is_mirrored(variable.name) else 1
        named = [
            (self._name(key) + ("" if key in number.constants else prime), sign * factor)
            for key, factor in number.term
        ]
        left = tuple((name, factor) for name, factor in named if factor > 0)
        right = tuple((name, -factor) for name, factor in named if factor < 0)
        return regions.scale(Fraction(sign)), (print_term(left), print_term(right))

    def is_mirrored(self, name: str) -> bool:
        """Whether the text compares a number with a constant, and the term is the reverse."""
        number = self._variables[name]
        changing = [factor for key, factor in number.term if key not in number.constants]
        return 0 < len(changing) < len(number.term) and all(factor < 0 for factor in changing)

    def _name(self, key: str) -> str:
        variable = self._variables.get(key)
        return variable.wording or key if variable is not None else key


def _merge(op: Op, left: Set[int], right: Set[int]) -> Set[int]:
    return left | right if op is Op.OR else left & right


def describe_literals(variable: Variable) -> tuple[tuple[str, str], ...]:
    """Return the literals of a number with the conditions that they stand for."""
    if regions_of(variable.domain) is None:
        return ()
    worded = _Wording({variable.name: variable})
    regions, sides = worded.read_regions(Var(variable.name))
    conditions = regions.list_conditions(*sides)
    if worded.is_mirrored(variable.name):
        conditions.reverse()
    literals = map(str, domains.values(variable.domain))
    return tuple(zip(literals, conditions, strict=True))
