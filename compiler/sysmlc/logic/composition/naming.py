"""Variables of a composite: what is joined is one variable, everything else is its member's own."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.composition.members import Block, Member
from sysmlc.logic.composition.structure import ITSELF, joined
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
from sysmlc.logic.domains import describe
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var


class Wire(Struct, frozen=True):
    """What several members know: one variable, with its name and each member's own variable."""

    name: str
    ends: tuple[tuple[Member, Variable], ...]

    @property
    def drivers(self) -> list[Member]:
        """The members that decide it."""
        return [member for member, one in self.ends if one.owner is Owner.SYSTEM]


def wires(block: Block, members: Iterable[Member]) -> list[Wire]:
    """The features of members that are joined, each set with one name.

    That of the block when a feature of it is among them, else that of who decides it.
    """
    by_path: dict[str, list[Member]] = {}
    for member in members:
        by_path.setdefault(member.path, []).append(member)
    slots = [(path, name) for path, names in block.names.items() for name in names]
    found = []
    for group in block.features.group_items(slots):
        ends = [
            (member, _variable(member, name))
            for path, name in group
            for member in by_path.get(path, ())
            if name in member.features
        ]
        if len(ends) > 1:
            own = next((name for path, name in group if path == ITSELF), "")
            found.append(Wire(_name(own, ends), tuple(ends)))
    return found


def _variable(member: Member, feature: str) -> Variable:
    name = member.features[feature]
    return next(one for one in member.contract.variables if one.name == name)


def _name(own: str, ends: list[tuple[Member, Variable]]) -> str:
    at_block = next((one.name for member, one in ends if member.path == ITSELF), "")
    if own:
        return at_block or own.replace(".", "_")
    driver = next((end for end in ends if end[1].owner is Owner.SYSTEM), ends[0])
    return joined(driver[0].path, driver[1].name)


def is_one_type(wire: Wire) -> bool:
    """Whether all its members have values of one kind in it."""
    known = [one.domain for _, one in wire.ends]
    holds_texts = any(isinstance(one, EnumerationDomain) and one.texts for one in known)
    return len(set(known) if holds_texts else {type(one) for one in known}) == 1


def renamed(member: Member, known: Iterable[Wire]) -> Contract:
    """The contract of a member in the variables of the composite.

    A variable that others have with another range has the range that holds all values: that a
    member stays within its own is then promised by who decides it and assumed by who reads it.
    """
    wide: dict[str, Wire] = {}
    for wire in known:
        for one, variable in wire.ends:
            if one is member:
                wide[variable.name] = wire
    names = {one.name: _named(member, one, wide) for one in member.contract.variables}
    variables = tuple(
        replace(one, name=names[one.name], domain=_domain(one, wide.get(one.name)))
        for one in member.contract.variables
    )
    bounds = [
        (one.owner, conjunct)
        for one in member.contract.variables
        for conjunct in _kept(one, names[one.name], _domain(one, wide.get(one.name)))
    ]
    return replace(
        member.contract,
        variables=tuple(_once(variables)),
        assumptions=(
            *(c for owner, c in bounds if owner is Owner.ENVIRONMENT),
            *_all_renamed(member.contract.assumptions, names),
        ),
        guarantees=(
            *(c for owner, c in bounds if owner is Owner.SYSTEM),
            *_all_renamed(member.contract.guarantees, names),
        ),
    )


def _once(known: Iterable[Variable]) -> Iterable[Variable]:
    """Each variable once; an input that is joined to the same member's output is that output."""
    found: dict[str, Variable] = {}
    for one in known:
        if one.name not in found or one.owner is Owner.SYSTEM:
            found[one.name] = one
    return found.values()


def own_name(member: Member, variable: str, known: Iterable[Wire]) -> str:
    """The name of a member's variable in the composite."""
    for wire in known:
        for one, known_as in wire.ends:
            if one is member and known_as.name == variable:
                return wire.name
    return joined(member.path, variable)


def _named(member: Member, one: Variable, wide: Mapping[str, Wire]) -> str:
    wire = wide.get(one.name)
    return joined(member.path, one.name) if wire is None else wire.name


def _all_renamed(conjuncts: Iterable[Conjunct], names: Mapping[str, str]) -> Iterator[Conjunct]:
    for one in conjuncts:
        yield replace(one, formula=in_names(one.formula, names))


def in_names(formula: Formula, names: Mapping[str, str]) -> Formula:
    """The formula with other names for its variables, in this step and the next."""
    match formula:
        case Var(name, primed):
            return Var(names.get(name, name), primed)
        case Apply(op, args):
            return Apply(op, tuple(in_names(arg, names) for arg in args))
        case _:
            return formula


# -- ranges ------------------------------------------------------------------------------------


def _domain(one: Variable, wire: Wire | None) -> Domain:
    """The domain that holds what all members know of the variable."""
    if wire is None:
        return one.domain
    known = [other.domain for _, other in wire.ends]
    numbers = [domain for domain in known if isinstance(domain, IntegerDomain)]
    if numbers:
        return IntegerDomain(min(d.low for d in numbers), max(d.high for d in numbers))
    enumerations = [domain for domain in known if isinstance(domain, EnumerationDomain)]
    if enumerations:
        literals = dict.fromkeys(name for domain in enumerations for name in domain.literals)
        return replace(enumerations[0], literals=tuple(literals))
    return BooleanDomain()


def _kept(one: Variable, name: str, domain: Domain) -> Iterator[Conjunct]:
    """That a variable stays among the values that the member knows, where it could leave them."""
    inside = f.both(*_bounds(one, f.var(name), domain))
    if inside == f.TRUE:
        return
    text = f"'{one.name}' is one of {describe(one.domain)}."
    yield Conjunct(inside, Class.INIT, one.origin, text)
    yield Conjunct(f.primed(inside), Class.SAFETY, one.origin, text)


def _bounds(one: Variable, value: Formula, domain: Domain) -> Iterator[Formula]:
    if isinstance(one.domain, IntegerDomain) and isinstance(domain, IntegerDomain):
        if domain.low < one.domain.low:
            yield f.compare(Op.GE, value, Const(one.domain.low))
        if domain.high > one.domain.high:
            yield f.compare(Op.LE, value, Const(one.domain.high))
    if isinstance(one.domain, EnumerationDomain) and isinstance(domain, EnumerationDomain):
        known = one.domain.literals
        if set(domain.literals) - set(known):
            yield f.either(*(f.eq(value, Const(name)) for name in known))
