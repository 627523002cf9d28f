"""Members of a composition, the block itself and its parts, and the variables that they share.

Joined features share one variable, with the name and range of all of them.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.composition.structure import (
    EXECUTED,
    ITSELF,
    Channels,
    End,
    Usage,
    iter_joined_names,
    iter_links,
    iter_performed_steps,
    iter_usages,
    join_path,
    list_step_ends,
)
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
from sysmlc.logic.domains import describe, regions_of
from sysmlc.logic.expressions.context import variables_of
from sysmlc.logic.formula import Const, Formula, Op, rename_variables
from sysmlc.logic.machines.reader import find_context_classifier
from sysmlc.logic.region_formulas import split_regions, unite_regions
from sysmlc.support.disjoint_sets import DisjointSets

_ACTIONS = (Kind.OPERATION, Kind.ACTIVITY)
Slot = tuple[str, str]
"""The path of a usage, and the dotted name of one of its features."""


class Member(Struct, frozen=True):
    """A member of a composition: a usage of the block, or the block itself, with its contract.

    ``features`` maps dotted names of features to variables of the contract. ``ports`` has the name
    of the port through which a message passes; a message without one passes through any port.
    """

    path: str
    name: str
    origin: str
    contract: Contract
    features: Mapping[str, str]
    ports: Mapping[str, str] = {}

    def owner(self, variable: str) -> Owner:
        """Return the owner of a variable from the member's point of view."""
        return next(
            candidate.owner for candidate in self.contract.variables if candidate.name == variable
        )

    def slots(self, *owners: Owner) -> Iterator[Slot]:
        """Yield the slots of the member's features whose variables belong to one of *owners*."""
        for name, variable in self.features.items():
            if self.owner(variable) in owners:
                yield self.path, name


@dataclass(slots=True)
class Block:
    """A block with its members; parts without a contract are replaced by their own parts."""

    graph: Graph
    element: Element
    contracts: Mapping[str, Contract]
    """Contracts by the id of the element that has the contract."""
    members: list[Member] = field(default_factory=list)
    usages: dict[str, Usage] = field(default_factory=dict)
    """Usages by path, the block itself included."""
    names: dict[str, list[str]] = field(default_factory=dict)
    """Dotted names of the features of each usage."""
    steps: set[Slot] = field(default_factory=set)
    """The features that report the end of a step of an operation."""
    features: DisjointSets[Slot] = field(default_factory=DisjointSets)
    channels: Channels = field(default_factory=Channels)
    """Ends between which messages pass."""

    def group_slots(self) -> list[list[Slot]]:
        """Return the slots of all features of all usages in groups of joined ones."""
        slots = [(path, name) for path, names in self.names.items() for name in names]
        return self.features.group_items(slots)


def read_block(graph: Graph, element: Element, contracts: Mapping[str, Contract]) -> Block:
    """Return a block with its members and its joined features.

    *contracts* are those of behaviours, by the id of the behaviour, and of requirements, by the id
    of their subject.
    """
    block = Block(graph, element, contracts)
    block.usages[ITSELF] = Usage(ITSELF, element, element)
    block.names[ITSELF] = list(variables_of(graph, element))
    _open_usage(block, element, ITSELF, {element.id})
    return block


def _open_usage(block: Block, element: Element, path: str, enclosing: set[str]) -> None:
    for usage in iter_usages(block.graph, element, path):
        variables = variables_of(block.graph, usage.type_)
        block.usages[usage.path] = usage
        block.names[usage.path] = list(variables)
        contract = find_contract(block, usage)
        if contract is not None:
            member = _make_member(block, usage.path, usage.element, contract, variables)
            block.members.append(_share_block_features(block, element, path, member))
        elif usage.type_.id not in enclosing and usage.element.kind not in _ACTIONS:
            _open_usage(block, usage.type_, usage.path, enclosing | {usage.type_.id})
    for left, right in iter_links(block.graph, element, path):
        block.channels.connect(path, left, right)
        _join_ends(block, left, right)
    # A binding states which action performs a step; otherwise the only suitable action does.
    for step, action in iter_performed_steps(block.graph, element, path):
        if not block.features.has_merged((step.path, step.feature)):
            _join_ends(block, step, action)


def find_contract(block: Block, usage: Usage) -> Contract | None:
    """Return the contract for the requirements of a usage's type, or else for its behaviour."""
    if usage.element.kind in _ACTIONS:
        return block.contracts.get(usage.element.id) or block.contracts.get(usage.type_.id)
    return find_required_contract(block, usage.type_) or find_behaviour_contract(block, usage.type_)


def find_required_contract(block: Block, type_: Element) -> Contract | None:
    """Return the contract for the requirements of a type or of its nearest general with any."""
    family = (type_, *query.generals(block.graph, type_))
    return next(
        (contract for relative in family if (contract := block.contracts.get(relative.id))), None
    )


def find_behaviour_contract(block: Block, type_: Element) -> Contract | None:
    """Return the contract of the behaviour of a type, its own or inherited."""
    activity = query.classifier_behavior(block.graph, type_)
    return None if activity is None else block.contracts.get(activity.id)


def block_as_member(block: Block, contract: Contract) -> Member:
    """Return the block as a member of its own composition, with the given contract."""
    variables = variables_of(block.graph, block.element)
    return _make_member(block, ITSELF, block.element, contract, variables)


def _make_member(
    block: Block, path: str, element: Element, contract: Contract, variables: Mapping[str, str]
) -> Member:
    origin = block.graph[contract.origin]
    if origin.kind in query.BEHAVIORS and origin is not element:
        classifier = find_context_classifier(block.graph, origin)
        variables = variables_of(block.graph, classifier, origin)
    elif origin.kind is Kind.OPERATION:
        variables = variables_of(block.graph, query.definition_of(block.graph, origin))
    variable_names = {variable.name for variable in contract.variables}
    features = {
        name: variable for name, variable in variables.items() if variable in variable_names
    }
    if origin.kind in _ACTIONS:
        steps = list_step_ends(block.graph, contract)
        block.steps.update((path, name) for name in steps)
        block.names[path] = list(dict.fromkeys((*block.names[path], *steps)))
        features |= steps
    return Member(path, path or element.name, element.id, contract, features)


def _share_block_features(block: Block, owner: Element, path: str, member: Member) -> Member:
    """Return an action of *owner* as a member that reads features of *owner*, joined with these."""
    graph = block.graph
    activity = query.definition_of(graph, graph[member.contract.origin])
    if activity.kind is not Kind.ACTIVITY:
        return member
    family = (owner, *query.generals(graph, owner))
    context = find_context_classifier(graph, activity)
    unbound = {variable.name for variable in member.contract.variables} - set(
        member.features.values()
    )
    names = variables_of(graph, context) if context in family else {}
    shared = {name: variable for name, variable in names.items() if variable in unbound}
    for name in shared:
        block.features.union((path, name), (member.path, name))
    block.names[member.path] = list(dict.fromkeys((*block.names[member.path], *shared)))
    return replace(member, features={**member.features, **shared})


def _join_ends(block: Block, left: End, right: End) -> None:
    left, right = (
        _resolve_step_end(block, end, opposite) for end, opposite in ((left, right), (right, left))
    )
    for left_name, right_name in iter_joined_names(
        left, right, lambda path: block.names.get(path, ())
    ):
        block.features.union((left.path, left_name), (right.path, right_name))


def _resolve_step_end(block: Block, end: End, opposite: End) -> End:
    """Return the end to join with *opposite*.

    If one of the two is a step and the other the action that performs it, this is the feature
    ``executed`` of the end. Otherwise it is *end*.
    """
    for step in (end, opposite):
        step_end = End(step.path, join_path(step.feature, EXECUTED))
        if step.feature and (step.path, step_end.feature) in block.steps:
            return step_end if step is end else End(end.path, end.feature or EXECUTED)
    return end


# -- shared variables ------------------------------------------------------------------------------


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
    """Whether the domains of all ends have the same type.

    Texts are equal, and numbers have the same unit.
    """
    domains = [variable.domain for _, variable in wire.ends]
    if any(map(regions_of, domains)):
        return all(map(regions_of, domains)) and unite_regions(domains) is not None
    has_texts = any(isinstance(domain, EnumerationDomain) and domain.texts for domain in domains)
    return len(set(domains) if has_texts else set(map(type, domains))) == 1


def rename_contract(
    member: Member, wires: Iterable[Wire], features: DisjointSets[Slot]
) -> Contract:
    """Return the contract of a member in the variables of the composite; *features* are joined.

    If the ends of a wire have different ranges, its variable has the range that contains all of
    them. A member that decides the variable then guarantees its own range, and a member that reads
    the variable assumes its own range. The regions of a number are cut where any end cuts them.
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
    domains = {name: _find_common_domain(wire) for name, wire in wire_by_variable.items()}
    contract = split_regions(member.contract, domains)
    for variable in contract.variables:
        wire = wire_by_variable.get(variable.name)
        name = join_path(member.path, variable.name) if wire is None else wire.name
        domain = domains.get(variable.name, variable.domain)
        names[variable.name] = name
        variables.append(replace(variable, name=name, domain=domain, wording=""))
        bounds[variable.owner] += _iter_range_conjuncts(variable, name, domain)
    variables = [_rename_term(member, variable, features) for variable in variables]
    assumptions = _rename_conjuncts(contract.assumptions, names)
    guarantees = _rename_conjuncts(contract.guarantees, names)
    return replace(
        contract,
        variables=tuple(_drop_duplicates(variables)),
        assumptions=(*bounds[Owner.ENVIRONMENT], *assumptions),
        guarantees=(*bounds[Owner.SYSTEM], *guarantees),
    )


def _rename_term(member: Member, variable: Variable, features: DisjointSets[Slot]) -> Variable:
    """Return a number as a sum of slots, of which joined ones have one name."""
    names = {own_variable: name for name, own_variable in member.features.items()}
    keys = {*variable.constants, *(key for key, _ in variable.term)}
    slots = {key: join_path(*features.find((member.path, names.get(key, key)))) for key in keys}
    return replace(
        variable,
        term=tuple((slots[key], factor) for key, factor in variable.term),
        constants=tuple(slots[key] for key in variable.constants),
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
    united = unite_regions(domains)
    if united is not None:
        return united
    numbers = [domain for domain in domains if isinstance(domain, IntegerDomain)]
    if numbers:
        return IntegerDomain(min(d.low for d in numbers), max(d.high for d in numbers))
    enumerations = [domain for domain in domains if isinstance(domain, EnumerationDomain)]
    if enumerations:
        literals = dict.fromkeys(name for domain in enumerations for name in domain.literals)
        return EnumerationDomain(tuple(literals), enumerations[0].texts)
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
