"""Composites: for each block with parts, the contracts of its members in shared variables.

The direction of a port decides which member owns its variable. Connectors make an output of the
sender and the input of the receiver one variable (SysML 1.6 clause 9.3.2).
"""

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Handshake
from sysmlc.logic.cells import state_facts
from sysmlc.logic.composition.free_outputs import add_free_outputs
from sysmlc.logic.composition.members import (
    Block,
    Member,
    Wire,
    block_as_member,
    find_behaviour_contract,
    find_required_contract,
    find_wires,
    has_single_type,
    read_block,
    rename_contract,
)
from sysmlc.logic.composition.messages import derive_exclusions, derive_wiring
from sysmlc.logic.composition.structure import (
    find_drawn_activity,
    find_unclear_flows,
    is_end_observable,
)
from sysmlc.logic.contract import Composite, Conjunct, Contract, Owner, Part, drop_trivial
from sysmlc.logic.domains import describe_kind
from sysmlc.logic.feature_writes import WriterIndex
from sysmlc.logic.simplification import substitute

TWO_DRIVERS = rule(
    "SM524",
    "joined-outputs",
    Severity.ERROR,
    "'{first}' and '{second}' of '{block}' both decide '{variable}'",
    help="give one of the two ends direction 'in', or join another feature",
)
OTHER_VALUES = rule(
    "SM525",
    "joined-values-differ",
    Severity.ERROR,
    "'{first}' and '{second}' of '{block}' are connected, but have values of "
    "different types: {domains}",
    help="give both ends the same type",
)
UNCLEAR_FLOW = rule(
    "SM526",
    "flow-between-unclear-parts",
    Severity.WARNING,
    "the flow from '{source}' to '{target}' connects no parts of '{block}': "
    "{count} of them have '{feature}'",
    help="draw a connector between the parts, and let the flow be realised by it",
)


def list_checked_composites(
    composites: Iterable[Composite], behaviours: Container[str]
) -> list[Composite]:
    """Return the composites as they are checked; *behaviours* are components with a behaviour.

    A block with a behaviour of its own has no demands on its parts: the behaviour answers for the
    requirements of the block.
    """
    return [
        replace(composite, whole=composite.whole and replace(composite.whole, guarantees=()))
        if composite.component in behaviours
        else composite
        for composite in composites
    ]


def compose_blocks(graph: Graph, contracts: Iterable[Contract], sink: Sink) -> Iterator[Composite]:
    """Yield a composite for each block whose parts have contracts that can be compared.

    A block may have contracts of its own. A contract whose outputs the parts only read is a further
    member (a controller, a coordinator). A contract whose outputs the parts decide is the
    specification of the composition. *contracts* are those that the analysis ``contracts`` derives
    from the graph. The composites are in the order of their components.
    """
    handshakes = {game.activity: game.handshake for game in graph.derived(TokenGraph)}
    by_origin = {
        contract.origin: _repeat_service(contract, handshakes.get(contract.origin))
        for contract in contracts
    }
    open_steps: list[OpenStep] = []
    writers = WriterIndex(graph)
    for element in _list_blocks(graph, by_origin):
        block = read_block(graph, element, by_origin)
        whole = _add_own_contracts(block) if block.members else None
        if block.members:
            add_free_outputs(block, writers)
        if len(block.members) + (whole is not None) < 2:
            continue
        open_steps += _find_open_steps(block)
        composite = _make_composite(block, whole, sink)
        if composite is not None:
            yield composite
    _report_open_steps(graph, open_steps, sink)


def _repeat_service(contract: Contract, handshake: Handshake | None) -> Contract:
    """Return the contract of an activity that is started again and again, and never stopped.

    The actions of a block are compared as if its environment used each of them all the time.
    """
    if handshake is None or not handshake.start:
        return contract
    values = {handshake.start: f.TRUE, handshake.stop: f.FALSE}

    def restrict(conjuncts: Iterable[Conjunct]) -> tuple[Conjunct, ...]:
        return drop_trivial(
            replace(conjunct, formula=substitute(conjunct.formula, values))
            for conjunct in conjuncts
        )

    return replace(
        contract,
        variables=tuple(v for v in contract.variables if v.name not in values),
        assumptions=restrict(contract.assumptions),
        guarantees=restrict(contract.guarantees),
    )


def _list_blocks(graph: Graph, by_origin: Mapping[str, Contract]) -> list[Element]:
    """List the classifiers that have a part or an action with a contract, at any depth."""
    # The contracts of a file have no elements.
    types = [element for id in by_origin if (element := graph.get(id)) is not None]
    worklist = list(types)
    owners: dict[str, Element] = {}
    while worklist:
        element = worklist.pop()
        for owner in _iter_owners(graph, element):
            if owner.id not in owners:
                owners[owner.id] = owner
                worklist.append(owner)
    blocks = [
        element for element in owners.values() if element.kind in (Kind.CLASS, Kind.COMPONENT)
    ]
    own_blocks = (element for element in blocks if not element.attrs.get("external"))
    return sorted(own_blocks, key=lambda element: (graph.qualified_name(element), element.id))


def _iter_owners(graph: Graph, element: Element) -> Iterator[Element]:
    """Yield the elements that contain *element* as part, action or behaviour, or specialise it."""
    yield from graph.sources(element, Edge.SPECIALIZES)
    yield from graph.sources(element, Edge.CLASSIFIER_BEHAVIOR)
    owner = graph.owner(element) if element.kind is Kind.ACTIVITY else None
    if owner is not None:
        yield owner
    usages = [*graph.sources(element, Edge.TYPED_BY), *graph.sources(element, Edge.METHOD)]
    for usage in [element] if element.kind is Kind.OPERATION else usages:
        if usage.kind in (Kind.PROPERTY, Kind.PORT, Kind.OPERATION):
            yield from graph.sources(usage, Edge.FEATURE)


def _make_composite(block: Block, whole: Member | None, sink: Sink) -> Composite | None:
    wires = find_wires(block, [*block.members, *([whole] if whole else [])])
    _report_flows(block, sink)
    if list(_report_faults(block, whole, wires, sink)):
        return None
    parts = tuple(
        Part(
            member.name,
            rename_contract(member, wires, block.features),
            member.origin,
            block.graph[member.origin].kind not in (Kind.PROPERTY, Kind.PORT),
            bool(member.contract.component),
        )
        for member in block.members
    )
    return Composite(
        component=query.component_name(block.graph, block.element),
        origin=block.element.id,
        parts=parts,
        wiring=(
            *derive_wiring(block, block.members, wires),
            *dict.fromkeys(_derive_facts(block, parts)),
        ),
        whole=None if whole is None else rename_contract(whole, wires, block.features),
        exclusions=tuple(derive_exclusions(block, block.members, wires)),
    )


def _derive_facts(block: Block, parts: Sequence[Part]) -> Iterator[Conjunct]:
    """Yield what is true of the numbers of all parts, and of those of each part.

    The facts about all parts are omitted if there are too many numbers.
    """
    groups = [part.contract.variables for part in parts]
    together = {variable.name: variable for group in groups for variable in group}
    for group in (*groups, together.values()):
        # Whoever decides the numbers, they do not contradict one another.
        given = [replace(variable, owner=Owner.ENVIRONMENT) for variable in group]
        yield from state_facts(given, (), block.element.id)


def _add_own_contracts(block: Block) -> Member | None:
    """Add the block's own contracts to its members, and return the one that is a specification.

    The result is None if the block has no contract whose outputs the parts decide.
    """
    # docs/decisions/0031: the directions of features tell a controller from a specification.
    requirement, behaviour_member = (
        _as_member(block, find(block, block.element))
        for find in (find_required_contract, find_behaviour_contract)
    )
    parts = tuple(block.members)
    if behaviour_member is not None and (
        requirement is not None or not _has_decided_outputs(block, behaviour_member, parts)
    ):
        block.members.append(behaviour_member)
        behaviour_member = None
    if requirement is None:
        return behaviour_member
    if _shares_outputs(block, requirement, parts, Owner.ENVIRONMENT) and not _has_decided_outputs(
        block, requirement, parts
    ):
        if len(block.members) == len(parts):
            block.members.append(requirement)
        return None
    return requirement


def _as_member(block: Block, contract: Contract | None) -> Member | None:
    return None if contract is None else block_as_member(block, contract)


def _has_decided_outputs(block: Block, member: Member, parts: Iterable[Member]) -> bool:
    """Whether some output of the member is joined to an output of a part."""
    return _shares_outputs(block, member, parts, Owner.SYSTEM)


def _shares_outputs(block: Block, member: Member, parts: Iterable[Member], owner: Owner) -> bool:
    outputs = {block.features.find(slot) for slot in member.slots(Owner.SYSTEM)}
    return any(block.features.find(slot) in outputs for part in parts for slot in part.slots(owner))


# -- faults --------------------------------------------------------------------------------------


def _report_faults(
    block: Block, whole: Member | None, wires: Iterable[Wire], sink: Sink
) -> Iterator[str]:
    """Report wires between different types or with several drivers, and yield their names."""
    subject, name = block.graph.subject(block.element), block.element.name
    for wire in wires:
        drivers = [left_member.name for left_member in wire.drivers if left_member is not whole]
        if not has_single_type(wire):
            (left_member, left_variable), *_ = wire.ends
            right_member, right_variable = next(
                end
                for end in wire.ends
                if not has_single_type(Wire(wire.name, (wire.ends[0], end)))
            )
            ends = left_variable, right_variable
            domains = " and ".join(describe_kind(variable.domain) for variable in ends)
            left, right = (
                _full_name(left_member, left_variable.name),
                _full_name(right_member, right_variable.name),
            )
            sink.report(
                OTHER_VALUES, subject, block=name, domains=domains, first=left, second=right
            )
            yield wire.name
        elif len(drivers) > 1:
            sink.report(
                TWO_DRIVERS,
                subject,
                block=name,
                first=drivers[0],
                second=drivers[1],
                variable=wire.name,
            )
            yield wire.name


def _full_name(member: Member, variable: str) -> str:
    return f"{member.path}.{variable}" if member.path else variable


def _report_flows(block: Block, sink: Sink) -> None:
    graph = block.graph
    for flow, feature, count in find_unclear_flows(graph, block.element):
        ends = [graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
        source, target = (end.name if end is not None else "" for end in ends)
        sink.report(
            UNCLEAR_FLOW,
            graph.subject(flow),
            block=block.element.name,
            source=source,
            target=target,
            feature=feature.name,
            count=count,
        )


OPEN_STEP = rule(
    "SM508",
    "nested-operation-without-end",
    Severity.INFO,
    "no behaviour of '{block}' determines when step '{step}' of '{operation}' ends; "
    "the environment of the block decides it",
    help=(
        "give '{called}' an output 'executed' that is true when its steps are done, or "
        "model its steps in '{operation}'"
    ),
)


class OpenStep(Struct, frozen=True):
    """A step of an operation that calls an action whose end is not observable.

    ``operation`` is the path of the operation from the block.
    """

    block: Element
    operation: str
    step: Element
    called: Element


def _find_open_steps(block: Block) -> Iterator[OpenStep]:
    """Yield the steps of operations in a block whose end is not observable."""
    for member in block.members:
        for step, called in _iter_open_steps(block, member):
            yield OpenStep(block.element, member.name, step, called)


def _report_open_steps(graph: Graph, open_steps: Iterable[OpenStep], sink: Sink) -> None:
    """Report each step once, at the innermost block that contains its operation."""
    nearest: dict[str, OpenStep] = {}
    for open_step in open_steps:
        nearest_step = nearest.setdefault(open_step.step.id, open_step)
        if open_step.operation.count(".") < nearest_step.operation.count("."):
            nearest[open_step.step.id] = open_step
    for open_step in nearest.values():
        sink.report(
            OPEN_STEP,
            graph.subject(open_step.step),
            block=open_step.block.name,
            step=open_step.step.name,
            operation=open_step.operation,
            called=open_step.called.name,
        )


def _iter_open_steps(block: Block, member: Member) -> Iterator[tuple[Element, Element]]:
    graph = block.graph
    if not member.path or graph[member.origin].kind not in (Kind.OPERATION, Kind.ACTIVITY):
        return
    for variable in member.contract.variables:
        step = graph.get(variable.origin)
        if variable.owner is not Owner.ENVIRONMENT or step is None or step.kind is not Kind.ACTION:
            continue
        called = graph.target(step, Edge.CALLS)
        if called is None or called.kind is not Kind.ACTIVITY or is_end_observable(graph, step):
            continue
        if any(
            node.kind is Kind.ACTION for node in graph.owned(find_drawn_activity(graph, called))
        ):
            yield step, called
