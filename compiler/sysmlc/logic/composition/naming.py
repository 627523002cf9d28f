"""Names and ranges of the variables of a composite: joined features share one variable."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.composition.members import Block, Member
from sysmlc.logic.composition.structure import ITSELF, join_path
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
from sysmlc.logic.formula import Const, Formula, Op, rename_variables


class Wire(Struct, frozen=True):
    """A shared variable of the composite, and the variables of members that it replaces."""

    name: str
    ends: tuple[tuple[Member, Variable], ...]

    @property
    def drivers(self) -> list[Member]:
        """The members that decide the variable."""
        return [member for member, variable in self.ends if variable.owner is Owner.SYSTEM]


def find_wires(block: Block, members: Iterable[Member]) -> list[Wire]:
    """Return a wire for each set of joined features that occur in several contracts.

    A wire is named after the feature of the block in the set, or else after the variable of the
    member that decides it.
    """
    by_path: dict[str, list[Member]] = {}
    for member in members:
        by_path.setdefault(member.path, []).append(member)
    wires = []
    for group in block.group_slots():
        ends = [
            (member, _find_variable(member, name))
            for path, name in group
            for member in by_path.get(path, ())
            if name in member.features
        ]
        if len(ends) > 1:
            block_feature = next((name for path, name in group if path == ITSELF), "")
            wires.append(Wire(_name_wire(block_feature, ends), tuple(ends)))
    return wires


def _find_variable(member: Member, feature: str) -> Variable:
    name = member.features[feature]
    return next(variable for variable in member.contract.variables if variable.name == name)


def _name_wire(block_feature: str, ends: list[tuple[Member, Variable]]) -> str:
    if block_feature:
        of_block = next((variable.name for member, variable in ends if member.path == ITSELF), "")
        return of_block or block_feature.replace(".", "_")
    drivers = (end for end in ends if end[1].owner is Owner.SYSTEM)
    member, variable = next(drivers, ends[0])
    return join_path(member.path, variable.name)


def has_single_type(wire: Wire) -> bool:
    """Whether the domains of all ends have the same type and, for texts, are equal."""
    domains = [variable.domain for _, variable in wire.ends]
    has_texts = any(isinstance(domain, EnumerationDomain) and domain.texts for domain in domains)
    return len(set(domains) if has_texts else set(map(type, domains))) == 1


def rename_contract(member: Member, wires: Iterable[Wire]) -> Contract:
    """Return the contract of a member in the variables of the composite.

    If the ends of a wire have different ranges, its variable has the range that contains all of
    them. A member that decides the variable then guarantees its own range, and a member that reads
    the variable assumes its own range.
    """
    wire_by_variable = {
        end_variable.name: wire
        for wire in wires
        for end_member, end_variable in wire.ends
        if end_member is member
    }
    names: dict[str, str] = {}
    variables: list[Variable] = []
    bounds: dict[Owner, list[Conjunct]] = {owner: [] for owner in Owner}
    for variable in member.contract.variables:
        wire = wire_by_variable.get(variable.name)
        name = join_path(member.path, variable.name) if wire is None else wire.name
        domain = variable.domain if wire is None else _find_common_domain(wire)
        names[variable.name] = name
        variables.append(replace(variable, name=name, domain=domain, wording=""))
        bounds[variable.owner] += _iter_range_conjuncts(variable, name, domain)
    contract = member.contract
    assumptions = _rename_conjuncts(contract.assumptions, names)
    guarantees = _rename_conjuncts(contract.guarantees, names)
    return replace(
        contract,
        variables=tuple(_drop_duplicates(variables)),
        assumptions=(*bounds[Owner.ENVIRONMENT], *assumptions),
        guarantees=(*bounds[Owner.SYSTEM], *guarantees),
    )


def _drop_duplicates(variables: Iterable[Variable]) -> Iterable[Variable]:
    """Return each variable once; of an input and an output with the same name, the output."""
    by_name: dict[str, Variable] = {}
    for variable in variables:
        if variable.name not in by_name or variable.owner is Owner.SYSTEM:
            by_name[variable.name] = variable
    return by_name.values()


def name_in_composite(member: Member, variable: str, wires: Iterable[Wire]) -> str:
    """Return the name of a member's variable in the composite."""
    for wire in wires:
        for end_member, end_variable in wire.ends:
            if end_member is member and end_variable.name == variable:
                return wire.name
    return join_path(member.path, variable)


def _rename_conjuncts(
    conjuncts: Iterable[Conjunct], names: Mapping[str, str]
) -> Iterator[Conjunct]:
    for conjunct in conjuncts:
        yield replace(conjunct, formula=rename_variables(conjunct.formula, names))


# -- ranges ------------------------------------------------------------------------------------


def _find_common_domain(wire: Wire) -> Domain:
    """Return the domain that contains the values of all ends of the wire."""
    domains = [variable.domain for _, variable in wire.ends]
    numbers = [domain for domain in domains if isinstance(domain, IntegerDomain)]
    if numbers:
        return IntegerDomain(min(d.low for d in numbers), max(d.high for d in numbers))
    enumerations = [domain for domain in domains if isinstance(domain, EnumerationDomain)]
    if enumerations:
        literals = dict.fromkeys(name for domain in enumerations for name in domain.literals)
        return replace(enumerations[0], literals=tuple(literals))
    return BooleanDomain()


def _iter_range_conjuncts(variable: Variable, name: str, domain: Domain) -> Iterator[Conjunct]:
    """Yield the conjuncts that a variable stays in the member's range if the wire's is wider."""
    in_range = f.both(*_iter_range_bounds(variable, f.var(name), domain))
    if in_range == f.TRUE:
        return
    text = f"'{variable.name}' is one of {describe(variable.domain)}."
    yield Conjunct(in_range, Class.INIT, variable.origin, text)
    yield Conjunct(f.prime(in_range), Class.SAFETY, variable.origin, text)


def _iter_range_bounds(variable: Variable, value: Formula, domain: Domain) -> Iterator[Formula]:
    if isinstance(variable.domain, IntegerDomain) and isinstance(domain, IntegerDomain):
        if domain.low < variable.domain.low:
            yield f.compare(Op.GE, value, Const(variable.domain.low))
        if domain.high > variable.domain.high:
            yield f.compare(Op.LE, value, Const(variable.domain.high))
    if isinstance(variable.domain, EnumerationDomain) and isinstance(domain, EnumerationDomain):
        literals = variable.domain.literals
        if set(domain.literals) - set(literals):
            yield f.either(*(f.eq(value, Const(name)) for name in literals))
