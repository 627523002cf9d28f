"""The order of a mission's targets: connectors typed by ``Before`` and ``Carry``."""

from collections.abc import Iterator, Sequence
from typing import Protocol

from sysmlc.diagnostics import Rule, Sink
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.robots import rules
from sysmlc.robots.study import Order


class Reader(Protocol):
    """What reads a floor."""

    graph: Graph
    sink: Sink

    def fail(self, found: Rule, element: Element, **facts: str | int) -> None:
        """Report what is wrong."""

    def is_typed(self, part: Element, kind: str) -> bool:
        """Whether a feature is of that kind."""


def orders_of(
    reader: Reader, missions: Sequence[Element], targets: Sequence[Element]
) -> Iterator[Order]:
    """The orders that missions ask for, by numbers of targets; circles are reported."""
    found = [one for mission in missions for one in _stated(reader, mission, targets)]
    _check_circles(reader, found, targets)
    _check_carrying(reader, found, targets)
    return iter(found)


def _stated(reader: Reader, mission: Element, targets: Sequence[Element]) -> Iterator[Order]:
    graph = reader.graph
    numbers = {one.id: at for at, one in enumerate(targets)}
    block = query.type_of(graph, mission)
    family = () if block is None else (block, *query.generals(graph, block))
    for connector in (one for owner in family for one in graph.owned(owner)):
        if connector.kind is not Kind.CONNECTOR or not reader.is_typed(connector, "Before"):
            continue
        roles = [query.role_of(graph, end) for end in query.ends(graph, connector)]
        ends = [numbers[one.id] for one in roles if one is not None and one.id in numbers]
        if len(ends) == 2:
            is_carried = reader.is_typed(connector, "Carry")
            yield Order(ends[0], ends[1], is_carried, connector.id)


def _check_circles(reader: Reader, orders: Sequence[Order], targets: Sequence[Element]) -> None:
    """Report the first target that waits for itself."""
    for start in range(len(targets)):
        circle = _way(orders, start, start)
        if circle:
            names = " before ".join(f"'{targets[at].name}'" for at in circle)
            name = targets[start].name
            reader.fail(rules.CIRCULAR_ORDER, targets[start], name=name, circle=names)
            return


def _way(orders: Sequence[Order], start: int, end: int) -> list[int]:
    """Targets from one to another, by what is later; empty when none leads there."""
    came: dict[int, int] = {}
    waiting = [start]
    while waiting:
        here = waiting.pop(0)
        for one in orders:
            if one.earlier == here and one.later not in came:
                came[one.later] = here
                waiting.append(one.later)
    if end not in came:
        return []
    way = [end]
    while len(way) == 1 or way[0] != start:
        way.insert(0, came[way[0]])
    return way


def _check_carrying(reader: Reader, orders: Sequence[Order], targets: Sequence[Element]) -> None:
    for side, other, words in (
        ("earlier", "later", ("from", "to")),
        ("later", "earlier", ("to", "from")),
    ):
        known: dict[int, int] = {}
        for one in orders:
            here, there = getattr(one, side), getattr(one, other)
            if one.is_carried and known.setdefault(here, there) != there:
                reader.fail(
                    rules.CARRIED_TWICE,
                    reader.graph[one.origin],
                    way=words[0],
                    there=words[1],
                    name=targets[here].name,
                    one=targets[known[here]].name,
                    other=targets[there].name,
                )
