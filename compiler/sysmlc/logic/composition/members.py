"""Who takes part in a block: its parts, and the block itself, each with a contract."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic.composition.structure import (
    EXECUTED,
    ITSELF,
    End,
    Usage,
    ends_of_steps,
    joined,
    links,
    performed,
    usages,
)
from sysmlc.logic.contract import Contract, Owner
from sysmlc.logic.expressions.context import variables_of
from sysmlc.logic.machines.reader import find_context_classifier
from sysmlc.logic.requirements.statements import definition_of
from sysmlc.support.disjoint_sets import DisjointSets

_ACTIONS = (Kind.OPERATION, Kind.ACTIVITY)
Slot = tuple[str, str]
"""A feature (dotted name) of a usage (path)."""


class Member(Struct, frozen=True):
    """A contract that takes part, with the variables that its features are, by dotted name."""

    path: str
    name: str
    origin: str
    contract: Contract
    features: Mapping[str, str]

    def owner(self, variable: str) -> Owner:
        """Who decides the variable, as the member sees it."""
        return next(one.owner for one in self.contract.variables if one.name == variable)

    def slots(self, *owners: Owner) -> Iterator[Slot]:
        """The features that its contract speaks of and that one of the owners decides."""
        for name, variable in self.features.items():
            if self.owner(variable) in owners:
                yield self.path, name


@dataclass(slots=True)
class Block:
    """A block with what is in it; parts that have no contract are opened."""

    graph: Graph
    element: Element
    contracts: Mapping[str, Contract]
    """Contracts by the id of what they are contracts of."""
    members: list[Member] = field(default_factory=list)
    names: dict[str, list[str]] = field(default_factory=dict)
    """Dotted names of the features of each usage."""
    steps: set[Slot] = field(default_factory=set)
    """What tells of each step of an operation that it is over."""
    features: DisjointSets[Slot] = field(default_factory=DisjointSets)
    channels: DisjointSets[Slot] = field(default_factory=DisjointSets)
    """Ends between which messages pass."""


def read_block(graph: Graph, element: Element, contracts: Mapping[str, Contract]) -> Block:
    """A block with its members and what of them is joined.

    ``contracts`` are those of behaviours and of requirements, by the id of the behaviour and of
    the requirements' subject.
    """
    block = Block(graph, element, contracts)
    block.names[ITSELF] = list(variables_of(graph, element))
    _open(block, element, ITSELF, {element.id})
    return block


def _open(block: Block, element: Element, path: str, around: set[str]) -> None:
    for usage in usages(block.graph, element, path):
        variables = variables_of(block.graph, usage.type_)
        block.names[usage.path] = list(variables)
        contract = contract_of(block, usage)
        if contract is not None:
            made = _member(block, usage.path, usage.element, contract, variables)
            block.members.append(_with_shared(block, element, path, made))
        elif usage.type_.id not in around and usage.element.kind not in _ACTIONS:
            _open(block, usage.type_, usage.path, around | {usage.type_.id})
    for side, other in links(block.graph, element, path):
        for one in side:
            for two in other:
                _join(block, one, two)
    for step, action in performed(block.graph, element, path):
        if not block.features.has_merged((step.path, step.feature)):
            _join(block, step, action)


def contract_of(block: Block, usage: Usage) -> Contract | None:
    """What a usage promises: what requirements demand of its type, else what its behaviour is."""
    if usage.element.kind in _ACTIONS:
        return block.contracts.get(usage.element.id) or block.contracts.get(usage.type_.id)
    return required(block, usage.type_) or behaviour(block, usage.type_)


def required(block: Block, type_: Element) -> Contract | None:
    """The contract that requirements make with a type, or with what it specialises."""
    family = (type_, *query.generals(block.graph, type_))
    return next((found for one in family if (found := block.contracts.get(one.id))), None)


def behaviour(block: Block, type_: Element) -> Contract | None:
    """The contract of the behaviour of a type, its own or inherited."""
    found = query.classifier_behavior(block.graph, type_)
    return None if found is None else block.contracts.get(found.id)


def itself(block: Block, contract: Contract) -> Member:
    """The block as one that takes part, by its behaviour or by what is demanded of it."""
    variables = variables_of(block.graph, block.element)
    return _member(block, ITSELF, block.element, contract, variables)


def _member(
    block: Block, path: str, element: Element, contract: Contract, variables: Mapping[str, str]
) -> Member:
    origin = block.graph[contract.origin]
    if origin.kind in query.BEHAVIORS and origin is not element:
        around = find_context_classifier(block.graph, origin)
        variables = variables_of(block.graph, around, origin)
    elif origin.kind is Kind.OPERATION:
        variables = variables_of(block.graph, definition_of(block.graph, origin))
    known = {one.name for one in contract.variables}
    found = {name: variable for name, variable in variables.items() if variable in known}
    if origin.kind in _ACTIONS:
        steps = ends_of_steps(block.graph, contract)
        block.steps.update((path, name) for name in steps)
        block.names[path] = list(dict.fromkeys((*block.names[path], *steps)))
        found |= steps
    return Member(path, path or element.name, element.id, contract, found)


def _with_shared(block: Block, around: Element, path: str, member: Member) -> Member:
    """An action that is drawn in its block reads the block's own features: they are one."""
    graph = block.graph
    drawn = definition_of(graph, graph[member.contract.origin])
    if drawn.kind is not Kind.ACTIVITY:
        return member
    family = (around, *query.generals(graph, around))
    context = find_context_classifier(graph, drawn)
    known = {one.name for one in member.contract.variables} - set(member.features.values())
    names = variables_of(graph, context) if context in family else {}
    found = {name: variable for name, variable in names.items() if variable in known}
    for name in found:
        block.features.union((path, name), (member.path, name))
    block.names[member.path] = list(dict.fromkeys((*block.names[member.path], *found)))
    return replace(member, features={**member.features, **found})


def _join(block: Block, one: End, other: End) -> None:
    block.channels.union((one.path, one.feature), (other.path, other.feature))
    one, other = (_end_of(block, this, that) for this, that in ((one, other), (other, one)))
    if not (one.feature and other.feature):
        return
    theirs = set(_behind(block, other))
    for rest in _behind(block, one):
        if rest in theirs:
            block.features.union((one.path, one.feature + rest), (other.path, other.feature + rest))


def _end_of(block: Block, one: End, other: End) -> End:
    """Of a step that is an action of the block, and of that action: what tells that it is over."""
    for step in (one, other):
        told = End(step.path, joined(step.feature, EXECUTED))
        if step.feature and (step.path, told.feature) in block.steps:
            return told if step is one else End(one.path, one.feature or EXECUTED)
    return one


def _behind(block: Block, end: End) -> Iterator[str]:
    """What of dotted names follows the feature of an end."""
    for name in block.names.get(end.path, ()):
        if name == end.feature or name.startswith(f"{end.feature}."):
            yield name[len(end.feature) :]
