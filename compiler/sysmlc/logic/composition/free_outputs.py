"""Outputs that no contract is about, although other members assume something about them.

The contract of a part leaves such an output free. Without a variable that the part decides, the
composition would take the output for an input of the block, and would inherit the assumption.
"""

from collections.abc import Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Element, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.composition.members import Block, Member, Slot
from sysmlc.logic.composition.structure import ITSELF
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    Domain,
    Owner,
    Source,
    Variable,
    equals,
)
from sysmlc.logic.domains import contains
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.feature_writes import WriterIndex
from sysmlc.logic.printing import print_literal


class _Output(Struct, frozen=True):
    """A feature that a usage decides, and the member of the usage; None without a contract."""

    slot: Slot
    feature: Feature
    member: Member | None


def add_free_outputs(block: Block, writers: WriterIndex) -> None:
    """Add a variable to the contract of each part that decides what another member relies on.

    These are the outputs about which another member assumes something and that no contract
    decides. A part without a contract becomes a member that guarantees initial values only.
    """
    for group in block.group_slots():
        members = _find_members(block, group)
        if any(member.owner(member.features[name]) is Owner.SYSTEM for member, name in members):
            continue
        domains = [
            variable.domain
            for member, name in members
            if (variable := _find_assumed_input(member, name)) is not None
        ]
        output = next(_iter_outputs(block, group, writers), None) if domains else None
        if output is not None:
            _add_output(block, output, domains[0], writers)


def _find_members(block: Block, group: Sequence[Slot]) -> list[tuple[Member, str]]:
    """Return the members with a variable for a slot of the group, and the name of the feature."""
    return [
        (member, name)
        for path, name in group
        for member in block.members
        if member.path == path and name in member.features
    ]


def _find_assumed_input(member: Member, name: str) -> Variable | None:
    """Return the variable of a feature about which the author lets the member assume something."""
    contract = member.contract
    stated = (conjunct.formula for conjunct in contract.assumptions if not conjunct.is_derived)
    if member.features[name] not in f.variable_names(*stated):
        return None
    return next(item for item in contract.variables if item.name == member.features[name])


def _iter_outputs(block: Block, group: Sequence[Slot], writers: WriterIndex) -> Iterator[_Output]:
    """Yield the features of the group that a part or the block decides, inner parts first."""
    for path, name in sorted(group, key=lambda slot: slot[0].count("."), reverse=True):
        feature = context_of(block.graph, block.usages[path].type_).features.get(name)
        if feature is None or find_owner(feature) is Owner.ENVIRONMENT:
            continue
        member = next((member for member in block.members if member.path == path), None)
        # A behaviour takes a feature without a direction from its environment if it only reads it,
        # and so does a block.
        is_read = path == ITSELF or (member is not None and name in member.features)
        if (feature.direction or not is_read) and not _is_assigned_outside(
            block, block.usages[path].type_, feature, writers
        ):
            yield _Output((path, name), feature, member)


def find_owner(feature: Feature) -> Owner:
    """Return the environment for inputs, else the system.

    A parameter without a direction is an input, which is the default of UML.
    """
    default_direction = "in" if feature.element.kind is Kind.PARAMETER else "out"
    is_input = (feature.direction or default_direction) == "in"
    return Owner.ENVIRONMENT if is_input else Owner.SYSTEM


def _is_assigned_outside(
    block: Block, type_: Element, feature: Feature, writers: WriterIndex
) -> bool:
    """Whether a behaviour of another object assigns the feature, which no contract describes."""
    family = {type_.id, *(general.id for general in query.generals(block.graph, type_))}
    return any(
        family.isdisjoint(owner.id for owner in block.graph.ancestors(writer))
        for writer in writers.iter_writers(feature.element)
    )


def _add_output(block: Block, output: _Output, domain: Domain, writers: WriterIndex) -> None:
    """Let the usage of an output decide its variable, of *domain* if no values are declared."""
    (path, name), feature = output.slot, output.feature
    member = output.member or _make_member_without_contract(block, path)
    if feature.domain is not None and not feature.is_assumed:
        domain = feature.domain
    variable = Variable(
        member.features.get(name, feature.variable), Owner.SYSTEM, domain, feature.element.id
    )
    contract = member.contract
    others = (item for item in contract.variables if item.name != variable.name)
    guarantees = _iter_guarantees(block, contract, feature, variable, writers)
    contract = replace(
        contract, variables=(*others, variable), guarantees=(*contract.guarantees, *guarantees)
    )
    extended = replace(member, contract=contract, features={**member.features, name: variable.name})
    if output.member is None:
        block.members.append(extended)
    else:
        block.members[block.members.index(member)] = extended


def _make_member_without_contract(block: Block, path: str) -> Member:
    element = block.usages[path].element
    return Member(path, path or element.name, element.id, Contract("", element.id, (), (), ()), {})


def _iter_guarantees(
    block: Block, contract: Contract, feature: Feature, variable: Variable, writers: WriterIndex
) -> Iterator[Conjunct]:
    """Yield what the model says about an output that its contract does not mention.

    A constant has its value, and so has a feature with a bound value (``= true``) that nothing in
    the model assigns; another feature has its initial value. If the contract is that of a
    behaviour, a feature that nothing in the model assigns keeps its value.
    """
    is_assigned = any(writers.iter_writers(feature.element)) or any(
        writers.iter_unclear_writers(feature.element)
    )
    is_bound = feature.element.attrs.get("default_kind") == "bound" and not is_assigned

    def derive(formula: f.Formula, class_: Class, text: str) -> Conjunct:
        return Conjunct(formula, class_, variable.origin, text, source=Source.DERIVED)

    if feature.default is not None and contains(variable.domain, feature.default):
        value, text = f.const(feature.default), print_literal(feature.default)
        if feature.is_constant or is_bound:
            yield derive(equals(variable, value), Class.SAFETY, f"'{variable.name}' is {text}.")
        else:
            text = f"'{variable.name}' starts with {text}."
            yield derive(equals(variable, value), Class.INIT, text)
    is_behaviour = block.graph[contract.origin].kind in query.BEHAVIORS
    if is_behaviour and not is_assigned:
        now = f.var(variable.name)
        text = f"'{variable.name}' keeps its value, because nothing assigns it."
        yield derive(equals(variable, now, is_next=True), Class.SAFETY, text)
