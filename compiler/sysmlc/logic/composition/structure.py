"""Structure of a block: its usages, its joined features, and the steps of its operations.

Connectors, bindings and flows join features. A step of an operation ends when the action that
performs it reports that it is executed. A binding names this action, or the value that reports the
end. Without a binding, the action is the only one of the block that is, or specialises, the action
that the step calls.
"""

from collections.abc import Callable, Iterable, Iterator
from itertools import combinations, product

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.query.relations import flow_path
from sysmlc.logic.contract import Contract, Owner

ITSELF = ""
"""Path of the block itself."""
_MAX_COPIES = 16
_STEPS = (Kind.ACTION, Kind.CONTROL, Kind.CONTROL_FLOW, Kind.STRUCTURED)
_ACTIONS = (Kind.OPERATION, Kind.ACTIVITY)


class Usage(Struct, frozen=True):
    """A part or an action of a block, with the path of names from the block."""

    path: str
    element: Element
    type_: Element


class End(Struct, frozen=True):
    """An end of a connection: a usage, and the dotted name of one of its features, or no name."""

    path: str
    feature: str


def iter_usages(graph: Graph, block: Element, path: str = ITSELF) -> Iterator[Usage]:
    """Yield a usage for each copy of each part of a block, and for each action that it performs."""
    visited: set[str] = set()
    for feature in (*query.features(graph, block), *graph.owned(block)):
        is_action = feature.kind is Kind.ACTIVITY
        type_ = (
            _type_of_usage(graph, feature) if is_action or feature.kind in query.FEATURES else None
        )
        if type_ is not None and feature.name and feature.id not in visited:
            visited.add(feature.id)
            for name in _copy_names(feature):
                yield Usage(join_path(path, name), feature, type_)


def _type_of_usage(graph: Graph, feature: Element) -> Element | None:
    if feature.kind is Kind.OPERATION:
        return graph.target(feature, Edge.METHOD)
    if feature.kind is Kind.ACTIVITY:
        return (
            feature
            if (graph.targets(feature, Edge.SPECIALIZES) and not _is_drawn(graph, feature))
            or _is_own_action(graph, feature)
            else None
        )
    is_part = feature.role == "part" and feature.kind in (Kind.PROPERTY, Kind.PORT)
    return query.type_of(graph, feature) if is_part else None


def _is_own_action(graph: Graph, action: Element) -> bool:
    """Whether an action with steps is used by no other element than its owner."""
    edges = (Edge.CLASSIFIER_BEHAVIOR, Edge.METHOD, Edge.CALLS)
    is_used = any(True for edge in edges for _ in graph.sources(action, edge))
    return _is_drawn(graph, action) and not is_used


def find_drawn_activity(graph: Graph, action: Element) -> Element:
    """Return the activity with the steps of an action: itself or its nearest general."""
    family = (action, *query.generals(graph, action))
    return next((relative for relative in family if _is_drawn(graph, relative)), action)


def _is_drawn(graph: Graph, action: Element) -> bool:
    return any(
        member.kind in _STEPS and query.is_performed(graph, member)
        for member in graph.owned(action)
    )


def _copy_names(part: Element) -> Iterator[str]:
    """Yield the names of the copies of a part; a part without an exact multiplicity counts once."""
    limits = query.bounds(part.attrs.get("multiplicity"))
    count = limits[1] if limits is not None and limits[0] == limits[1] else 1
    if count is None or not 1 < count <= _MAX_COPIES:
        yield part.name
        return
    yield from (f"{part.name}[{index}]" for index in range(1, count + 1))


def join_path(path: str, name: str) -> str:
    """Return the path extended by *name*."""
    return f"{path}.{name}" if path and name else path or name


Link = tuple[End, End]
"""The ends of a connection. A connector that leads to copies of a part is several links."""


class Channels:
    """The connectors through which messages pass between ends: paths of objects and their ports.

    A message passes a port of an object only inwards or outwards: of two connectors at one port, it
    takes the second one only if another block has it (a delegation). Two senders that are connected
    with one port do not receive what the other sends.
    """

    def __init__(self) -> None:
        self._links: dict[tuple[str, str], list[tuple[str, tuple[str, str]]]] = {}

    def connect(self, block: str, left: End, right: End) -> None:
        """Add a connector of a block, which has a path."""
        for end, other in ((left, right), (right, left)):
            links = self._links.setdefault((end.path, end.feature), [])
            links.append((block, (other.path, other.feature)))

    def list_reached(self, start: tuple[str, str]) -> set[tuple[str, str]]:
        """Return the ends that a message from an end can reach."""
        visited: set[tuple[str, tuple[str, str]]] = set()
        worklist = list(self._links.get(start, ()))
        while worklist:
            block, end = worklist.pop()
            if (block, end) not in visited:
                visited.add((block, end))
                worklist += [link for link in self._links.get(end, ()) if link[0] != block]
        return {end for _, end in visited}


def iter_links(graph: Graph, block: Element, path: str = ITSELF) -> Iterator[Link]:
    """Yield the pairs of ends that connectors, bindings and flows of a block join."""
    for owner in (block, *query.generals(graph, block)):
        for relation in graph.owned(owner):
            if relation.kind is Kind.CONNECTOR:
                sides = [
                    list(_connector_ends(graph, block, end, path))
                    for end in query.ends(graph, relation)
                ]
                for left, right in combinations(sides, 2):
                    yield from product(left, right)
            elif relation.kind is Kind.ITEM_FLOW and not graph.targets(relation, Edge.REALIZING):
                yield from _flow_link(graph, block, relation, path)


def _connector_ends(graph: Graph, block: Element, end: Element, path: str) -> Iterator[End]:
    steps = [*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)]
    yield from _follow_path(graph, block, steps, path)


def _follow_path(graph: Graph, block: Element, features: list[Element], path: str) -> Iterator[End]:
    """Yield the ends to which a path of features leads; parts at its start become the usage."""
    if features and _type_of_usage(graph, features[0]) is not None:
        for name in _copy_names(features[0]):
            yield from _follow_path(graph, block, features[1:], join_path(path, name))
        return
    yield End(path, ".".join(feature.name for feature in features))


def _flow_link(graph: Graph, block: Element, flow: Element, path: str) -> Iterator[Link]:
    """Yield the link of a flow that no connector realises, if both sides are unambiguous."""
    sides: list[list[End]] = []
    for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
        feature = graph.target(flow, edge)
        parts = flow_path(graph, flow, edge)
        if feature is None:
            sides.append([])
        elif parts:
            sides.append(list(_follow_path(graph, block, [*parts, feature], path)))
        else:
            sides.append(list(_find_holders(graph, block, feature, path)))
    if all(len(side) == 1 for side in sides):
        yield sides[0][0], sides[1][0]


def iter_joined_names(
    left: End, right: End, names: Callable[[str], Iterable[str]]
) -> Iterator[tuple[str, str]]:
    """Yield the pairs of dotted names of features that a link joins.

    *names* returns those of the features of the usage with a path. A link of ports joins their
    features of the same names.
    """
    if left.feature and right.feature:
        suffixes = set(_iter_suffixes(right, names))
        for suffix in _iter_suffixes(left, names):
            if suffix in suffixes:
                yield left.feature + suffix, right.feature + suffix


def _iter_suffixes(end: End, names: Callable[[str], Iterable[str]]) -> Iterator[str]:
    """Yield the suffixes that follow the feature of an end in dotted names of its usage."""
    for name in names(end.path):
        if name == end.feature or name.startswith(f"{end.feature}."):
            yield name[len(end.feature) :]


def _find_holders(graph: Graph, block: Element, feature: Element, path: str) -> Iterator[End]:
    """Yield the ends of all usages that have the feature."""
    if feature in query.features(graph, block):
        yield End(path, feature.name)
        return
    for usage in iter_usages(graph, block, path):
        features = (*query.features(graph, usage.type_), *query.parameters(graph, usage.type_))
        if feature in features:
            yield End(usage.path, feature.name)


def find_unclear_flows(graph: Graph, block: Element) -> Iterator[tuple[Element, Element, int]]:
    """Yield each flow whose parts are ambiguous.

    Each has the feature at its end and the number of usages that have the feature.
    """
    for owner in (block, *query.generals(graph, block)):
        for flow in graph.owned(owner):
            if flow.kind is not Kind.ITEM_FLOW or graph.targets(flow, Edge.REALIZING):
                continue
            for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
                feature = graph.target(flow, edge)
                if flow_path(graph, flow, edge):
                    continue
                count = (
                    0 if feature is None else len(list(_find_holders(graph, block, feature, "")))
                )
                if feature is not None and count > 1:
                    yield flow, feature, count


EXECUTED = "executed"
"""Name of the output with which an action reports that it is executed."""


def list_step_ends(graph: Graph, contract: Contract) -> dict[str, str]:
    """Map ``<step>.executed`` to the input of an operation that reports the end of the step."""
    ends = {}
    for variable in contract.variables:
        step = graph.get(variable.origin)
        if (
            variable.owner is Owner.ENVIRONMENT
            and step is not None
            and is_end_observable(graph, step)
        ):
            ends[join_path(step.name, EXECUTED)] = variable.name
    return ends


def iter_performed_steps(graph: Graph, block: Element, path: str) -> Iterator[tuple[End, End]]:
    """Yield each step of the block's operations that exactly one action of the block can perform.

    The result has the feature that reports the end of the step, and that of the action.
    """
    actions = [
        action for action in iter_usages(graph, block, path) if action.element.kind in _ACTIONS
    ]
    for operation in actions:
        for step in graph.owned(find_drawn_activity(graph, operation.type_)):
            if is_end_observable(graph, step):
                performers = [action for action in actions if _performs_step(graph, action, step)]
                if len(performers) == 1:
                    feature = join_path(step.name, EXECUTED)
                    yield End(operation.path, feature), End(performers[0].path, EXECUTED)


def is_end_observable(graph: Graph, step: Element) -> bool:
    """Whether the step calls an action that reports when it is executed."""
    action = graph.target(step, Edge.CALLS) if step.kind is Kind.ACTION else None
    if action is None or action.kind is not Kind.ACTIVITY:
        return False
    return any(parameter.name == EXECUTED for parameter in _parameters(graph, action))


def _parameters(graph: Graph, action: Element) -> Iterator[Element]:
    for relative in (action, *query.generals(graph, action)):
        yield from query.parameters(graph, relative)


def _performs_step(graph: Graph, usage: Usage, step: Element) -> bool:
    """Return whether the usage is, or specialises, the action that the step calls."""
    action = graph.target(step, Edge.CALLS)
    return action in (usage.type_, *query.generals(graph, usage.type_))
