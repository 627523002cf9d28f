"""Usages inside a block, and which of their features connectors, bindings and flows join."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.query.relations import flow_path
from sysmlc.logic.contract import Contract, Owner

ITSELF = ""
"""Path of the block whose parts are looked at."""
_MOST_COPIES = 16
_STEPS = (Kind.ACTION, Kind.CONTROL, Kind.CONTROL_FLOW, Kind.STRUCTURED)


class Usage(Struct, frozen=True):
    """A part, or an action that a block has, by the path of names from the block to it."""

    path: str
    element: Element
    type_: Element


class End(Struct, frozen=True):
    """Where something is attached: a usage, and the dotted name of a feature of it (or nothing)."""

    path: str
    feature: str


def usages(graph: Graph, block: Element, path: str = ITSELF) -> Iterator[Usage]:
    """The parts of a block and the actions that it performs, each copy of a part by itself."""
    seen: set[str] = set()
    for one in (*query.features(graph, block), *graph.owned(block)):
        is_action = one.kind is Kind.ACTIVITY
        type_ = _type(graph, one) if is_action or one.kind in query.FEATURES else None
        if type_ is not None and one.name and one.id not in seen:
            seen.add(one.id)
            for name in _copies(one):
                yield Usage(joined(path, name), one, type_)


def _type(graph: Graph, feature: Element) -> Element | None:
    if feature.kind is Kind.OPERATION:
        return graph.target(feature, Edge.METHOD)
    if feature.kind is Kind.ACTIVITY:
        return feature if _is_usage(graph, feature) or _is_own(graph, feature) else None
    is_part = feature.role == "part" and feature.kind in (Kind.PROPERTY, Kind.PORT)
    return query.type_of(graph, feature) if is_part else None


def _is_usage(graph: Graph, action: Element) -> bool:
    """Whether an action says no more than what it specialises: it has no steps of its own."""
    return bool(graph.targets(action, Edge.SPECIALIZES)) and not _is_drawn(graph, action)


def _is_own(graph: Graph, action: Element) -> bool:
    """Whether an action drawn in a block is performed for itself, not as what another one is."""
    taken = (Edge.CLASSIFIER_BEHAVIOR, Edge.METHOD, Edge.CALLS)
    is_taken = any(True for edge in taken for _ in graph.sources(action, edge))
    return _is_drawn(graph, action) and not is_taken


def drawn_of(graph: Graph, action: Element) -> Element:
    """The activity whose steps an action has: its own, else the nearest that it specialises."""
    family = (action, *query.generals(graph, action))
    return next((one for one in family if _is_drawn(graph, one)), action)


def _is_drawn(graph: Graph, action: Element) -> bool:
    return any(one.kind in _STEPS for one in graph.owned(action))


def _copies(part: Element) -> Iterator[str]:
    """Names of the copies of a part; one of which nobody says how many there are counts once."""
    limits = query.bounds(part.attrs.get("multiplicity"))
    number = limits[1] if limits is not None and limits[0] == limits[1] else 1
    if number is None or not 1 < number <= _MOST_COPIES:
        yield part.name
        return
    yield from (f"{part.name}[{at}]" for at in range(1, number + 1))


def joined(path: str, name: str) -> str:
    """A path with one more step."""
    return f"{path}.{name}" if path and name else path or name


Link = tuple[list[End], list[End]]
"""What is joined: the ends on either side, several where a side leads to a part with copies."""


def links(graph: Graph, block: Element, path: str = ITSELF) -> Iterator[Link]:
    """What connectors, bindings and flows of a block join."""
    for owner in (block, *query.generals(graph, block)):
        for one in graph.owned(owner):
            if one.kind is Kind.CONNECTOR:
                sides = [list(_ends(graph, block, end, path)) for end in query.ends(graph, one)]
                for number, side in enumerate(sides):
                    for other in sides[number + 1 :]:
                        yield side, other
            elif one.kind is Kind.ITEM_FLOW and not graph.targets(one, Edge.REALIZING):
                yield from _flow(graph, block, one, path)


def _ends(graph: Graph, block: Element, end: Element, path: str) -> Iterator[End]:
    steps = [*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)]
    yield from _along(graph, block, steps, path)


def _along(graph: Graph, block: Element, steps: list[Element], path: str) -> Iterator[End]:
    """The ends to which features lead, parts first."""
    if steps and _type(graph, steps[0]) is not None:
        for name in _copies(steps[0]):
            yield from _along(graph, block, steps[1:], joined(path, name))
        return
    yield End(path, ".".join(step.name for step in steps))


def _flow(graph: Graph, block: Element, flow: Element, path: str) -> Iterator[Link]:
    """A flow that no connector realises leads between features: of the parts that have them."""
    sides: list[list[End]] = []
    for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
        feature = graph.target(flow, edge)
        parts = flow_path(graph, flow, edge)
        if feature is None:
            sides.append([])
        elif parts:
            sides.append(list(_along(graph, block, [*parts, feature], path)))
        else:
            sides.append(list(_holders(graph, block, feature, path)))
    if all(len(side) == 1 for side in sides):
        yield sides[0], sides[1]


def _holders(graph: Graph, block: Element, feature: Element, path: str) -> Iterator[End]:
    if feature in query.features(graph, block):
        yield End(path, feature.name)
        return
    for usage in usages(graph, block, path):
        known = (*query.features(graph, usage.type_), *query.parameters(graph, usage.type_))
        if feature in known:
            yield End(usage.path, feature.name)


def unclear_flows(graph: Graph, block: Element) -> Iterator[tuple[Element, Element, int]]:
    """Flows of a block of which it is not clear between what they lead: the flow, the feature
    that several usages have, how many.
    """
    for owner in (block, *query.generals(graph, block)):
        for one in graph.owned(owner):
            if one.kind is not Kind.ITEM_FLOW or graph.targets(one, Edge.REALIZING):
                continue
            for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
                feature = graph.target(one, edge)
                if flow_path(graph, one, edge):
                    continue
                count = 0 if feature is None else len(list(_holders(graph, block, feature, "")))
                if feature is not None and count > 1:
                    yield one, feature, count


EXECUTED = "executed"
"""The output by which an action tells that it is executed."""


def ends_of_steps(graph: Graph, contract: Contract) -> dict[str, str]:
    """The inputs of an operation that say that a step is over, as features of its steps."""
    found = {}
    for one in contract.variables:
        step = graph.get(one.origin)
        if one.owner is Owner.ENVIRONMENT and step is not None and tells(graph, step):
            found[joined(step.name, EXECUTED)] = one.name
    return found


def performed(graph: Graph, block: Element, path: str) -> Iterator[tuple[End, End]]:
    """For each step of the operations of a block the end of the one action that performs it."""
    known = [one for one in usages(graph, block, path) if one.element.kind in _ACTIONS]
    for operation in known:
        for step in graph.owned(drawn_of(graph, operation.type_)):
            if tells(graph, step):
                able = [one for one in known if _is_what(graph, one, step)]
                if len(able) == 1:
                    feature = joined(step.name, EXECUTED)
                    yield End(operation.path, feature), End(able[0].path, EXECUTED)


_ACTIONS = (Kind.OPERATION, Kind.ACTIVITY)


def tells(graph: Graph, step: Element) -> bool:
    """Whether the step calls an action that tells that it is executed."""
    called = graph.target(step, Edge.CALLS) if step.kind is Kind.ACTION else None
    if called is None or called.kind is not Kind.ACTIVITY:
        return False
    return any(one.name == EXECUTED for one in _parameters(graph, called))


def _parameters(graph: Graph, action: Element) -> Iterator[Element]:
    for one in (action, *query.generals(graph, action)):
        yield from query.parameters(graph, one)


def _is_what(graph: Graph, usage: Usage, step: Element) -> bool:
    called = graph.target(step, Edge.CALLS)
    return called in (usage.type_, *query.generals(graph, usage.type_))
