"""Composites: for each block with parts the contracts that make it up, in shared variables.

Design section 7: the direction of ports decides who owns a variable, connectors rename; what
flows from a sender's output is the receiver's input (SysML 1.6 clause 9.3.2).
"""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.composition.members import Block, Member, behaviour, itself, read_block, required
from sysmlc.logic.composition.messages import crowding, wiring
from sysmlc.logic.composition.naming import Wire, is_one_type, renamed, wires
from sysmlc.logic.composition.structure import drawn_of, tells, unclear_flows
from sysmlc.logic.contract import Composite, Contract, Owner, Part
from sysmlc.logic.domains import describe

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
    "'{first}' and '{second}' of '{block}' are joined, and have values of different kinds: "
    "{domains}",
    help="give both ends one type",
)
UNCLEAR_FLOW = rule(
    "SM526",
    "flow-between-unclear-parts",
    Severity.WARNING,
    "the flow from '{source}' to '{target}' joins no parts of '{block}': {count} of them have "
    "'{feature}'",
    help="draw a connector between the parts, and let the flow be realised by it",
)


def compose(graph: Graph, contracts: Iterable[Contract], sink: Sink) -> Iterator[Composite]:
    """A composite for each block that has parts with contracts, and something to compare.

    A block takes part in itself by a contract whose outputs its parts read and none of them
    decides (a controller, a coordinator), and by its behaviour; what its parts decide is what
    they make up together. ``contracts`` are those that the pass of that name derives from the
    graph; composites come in the order of their components.
    """
    known = {one.origin: one for one in contracts}
    waiting: list[OpenStep] = []
    for element in _blocks(graph, known):
        block = read_block(graph, element, known)
        whole = _take_part(block) if block.members else None
        if len(block.members) + (whole is not None) < 2:
            continue
        waiting += open_steps(block)
        composite = _composite(block, whole, sink)
        if composite is not None:
            yield composite
    report_open_steps(graph, waiting, sink)


def _blocks(graph: Graph, known: Mapping[str, Contract]) -> list[Element]:
    """Classifiers with a part, or an action, that has a contract, at whatever depth."""
    types = [graph[id] for id in known]
    waiting = list(types)
    found: dict[str, Element] = {}
    while waiting:
        one = waiting.pop()
        for owner in _owners(graph, one):
            if owner.id not in found:
                found[owner.id] = owner
                waiting.append(owner)
    blocks = [one for one in found.values() if one.kind in (Kind.CLASS, Kind.COMPONENT)]
    shown = (one for one in blocks if not one.attrs.get("external"))
    return sorted(shown, key=lambda one: (graph.qualified_name(one), one.id))


def _owners(graph: Graph, one: Element) -> Iterator[Element]:
    """What has it as a part or an action, what specialises it, whose behaviour it is."""
    yield from graph.sources(one, Edge.SPECIALIZES)
    yield from graph.sources(one, Edge.CLASSIFIER_BEHAVIOR)
    owner = graph.owner(one) if one.kind is Kind.ACTIVITY else None
    if owner is not None:
        yield owner
    usages = [*graph.sources(one, Edge.TYPED_BY), *graph.sources(one, Edge.METHOD)]
    for usage in [one] if one.kind is Kind.OPERATION else usages:
        if usage.kind in (Kind.PROPERTY, Kind.PORT, Kind.OPERATION):
            yield from graph.sources(usage, Edge.FEATURE)


def _composite(block: Block, whole: Member | None, sink: Sink) -> Composite | None:
    known = wires(block, [*block.members, *([whole] if whole else [])])
    _report_flows(block, sink)
    if list(_faults(block, whole, known, sink)):
        return None
    return Composite(
        component=query.component_name(block.graph, block.element),
        origin=block.element.id,
        parts=tuple(Part(one.name, renamed(one, known), one.origin) for one in block.members),
        wiring=tuple(wiring(block, block.members, known)),
        whole=None if whole is None else renamed(whole, known),
        crowding=tuple(crowding(block, block.members, known)),
    )


def _take_part(block: Block) -> Member | None:
    """Let the block's own contracts take part, and return what the parts make up together."""
    demanded, own = (_own(block, of(block, block.element)) for of in (required, behaviour))
    inner = tuple(block.members)
    if own is not None and (demanded is not None or not _is_made(block, own, inner)):
        block.members.append(own)
        own = None
    if demanded is None:
        return own
    if _is_read(block, demanded, inner) and not _is_made(block, demanded, inner):
        if len(block.members) == len(inner):
            block.members.append(demanded)
        return None
    return demanded


def _own(block: Block, contract: Contract | None) -> Member | None:
    return None if contract is None else itself(block, contract)


def _is_made(block: Block, one: Member, inner: Iterable[Member]) -> bool:
    """Whether parts decide some of its outputs."""
    return _meets(block, one, inner, Owner.SYSTEM)


def _is_read(block: Block, one: Member, inner: Iterable[Member]) -> bool:
    """Whether parts have some of its outputs as inputs."""
    return _meets(block, one, inner, Owner.ENVIRONMENT)


def _meets(block: Block, one: Member, inner: Iterable[Member], owner: Owner) -> bool:
    outputs = {block.features.find(slot) for slot in one.slots(Owner.SYSTEM)}
    return any(
        block.features.find(slot) in outputs for member in inner for slot in member.slots(owner)
    )


# -- what stands against it ----------------------------------------------------------------------


def _faults(block: Block, whole: Member | None, known: Iterable[Wire], sink: Sink) -> Iterator[str]:
    subject, name = block.graph.subject(block.element), block.element.name
    for wire in known:
        drivers = [one.name for one in wire.drivers if one is not whole]
        if not is_one_type(wire):
            (one, first), *_ = wire.ends
            other, second = next(end for end in wire.ends if end[1].domain != first.domain)
            shown = f"{describe(first.domain)} and {describe(second.domain)}"
            left, right = _full(one, first.name), _full(other, second.name)
            sink.report(OTHER_VALUES, subject, block=name, domains=shown, first=left, second=right)
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


def _full(member: Member, variable: str) -> str:
    return f"{member.path}.{variable}" if member.path else variable


def _report_flows(block: Block, sink: Sink) -> None:
    graph = block.graph
    for flow, feature, count in unclear_flows(graph, block.element):
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
    "nothing in '{block}' says when step '{step}' of '{operation}' is over; whoever is around "
    "the block decides it",
    help=(
        "give '{called}' an output 'executed' that says when its steps are done, or put its steps "
        "into '{operation}'"
    ),
)


class OpenStep(Struct, frozen=True):
    """A step of an operation (path from a block) that is an operation without an end to see."""

    block: Element
    operation: str
    step: Element
    called: Element


def open_steps(block: Block) -> Iterator[OpenStep]:
    """The steps of the operations in a block that are operations without an end to see."""
    for member in block.members:
        for step, called in _open(block, member):
            yield OpenStep(block.element, member.name, step, called)


def report_open_steps(graph: Graph, found: Iterable[OpenStep], sink: Sink) -> None:
    """Tell of each step once: at the block that has its operation, not at those around it."""
    nearest: dict[str, OpenStep] = {}
    for one in found:
        known = nearest.setdefault(one.step.id, one)
        if one.operation.count(".") < known.operation.count("."):
            nearest[one.step.id] = one
    for one in nearest.values():
        sink.report(
            OPEN_STEP,
            graph.subject(one.step),
            block=one.block.name,
            step=one.step.name,
            operation=one.operation,
            called=one.called.name,
        )


def _open(block: Block, member: Member) -> Iterator[tuple[Element, Element]]:
    graph = block.graph
    if not member.path or graph[member.origin].kind not in (Kind.OPERATION, Kind.ACTIVITY):
        return
    for one in member.contract.variables:
        step = graph.get(one.origin)
        if one.owner is not Owner.ENVIRONMENT or step is None or step.kind is not Kind.ACTION:
            continue
        called = graph.target(step, Edge.CALLS)
        if called is None or called.kind is not Kind.ACTIVITY or tells(graph, step):
            continue
        if any(each.kind is Kind.ACTION for each in graph.owned(drawn_of(graph, called))):
            yield step, called
