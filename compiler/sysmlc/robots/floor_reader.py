"""Studies of a model: what specialises the definitions of the library ``Floors``."""

from collections.abc import Iterable, Iterator, Sequence
from math import isqrt
from typing import Protocol

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Rule, Sink
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic.names import Names
from sysmlc.robots import rules
from sysmlc.robots.study import Grid, Order, Robot, Study, Target

LIBRARY = "Floors"
MAX_CELLS = 400
"""Cells of a floor: contracts list them one by one."""
MAX_ROBOT_PAIR_CELLS = 10_000
"""Pairs of robots times cells: contracts say of each pair that it is not in one cell."""


def read_studies(graph: Graph, sink: Sink) -> Iterator[Study]:
    """The floors of a model that robots are on; what is wrong with one is reported."""
    if not any(one.name == LIBRARY for one in graph.of_kind(Kind.PACKAGE)):
        return
    known: set[str] = set()
    for block in graph.of_kind(Kind.CLASS):
        is_drawn = not block.attrs.get("external") and not block.attrs.get("abstract")
        if is_drawn and is_a(graph, block, "Floor"):
            reading = _FloorReader(graph, block, sink)
            yield from reading.study() if reading.is_first(known) else ()


def is_a(graph: Graph, element: Element, name: str) -> bool:
    """Whether a classifier specialises one of the library."""
    return any(_is_ours(graph, one, name) for one in query.generals(graph, element))


def _is_ours(graph: Graph, element: Element, name: str) -> bool:
    if element.name != name:
        return False
    return f"::{graph.qualified_name(element)}".endswith(f"::{LIBRARY}::{name}")


class _PlacedPart(Struct, frozen=True):
    element: Element
    cell: int | None


class _FloorReader:
    """One floor; ``is_good`` is false from the first error on."""

    def __init__(self, graph: Graph, block: Element, sink: Sink) -> None:
        self.graph, self.block, self.sink = graph, block, sink
        self.is_good = True

    def is_first(self, known: set[str]) -> bool:
        """Whether no floor before has its name, which is added to them."""
        name = query.component_name(self.graph, self.block)
        if name in known:
            self.fail(rules.SAME_FLOOR, self.block, name=name)
        known.add(name)
        return self.is_good

    def study(self) -> Iterator[Study]:
        """The floor as a value; nothing when it is none, or something is wrong with it."""
        grid = Grid(self._size("columns"), self._size("rows"))
        robots = self._all_robots(grid)
        if robots and self.is_good:
            made = self._mission(self._floor(grid, robots))
            if made is not None:
                self._check_ways(made)
            if made is not None and self.is_good:
                yield made

    def _all_robots(self, grid: Grid) -> list[Element]:
        """The parts that are robots, each as often as it says."""
        found: list[Element] = []
        most = isqrt(MAX_ROBOT_PAIR_CELLS // grid.size)
        for part in self._parts(self.block, "Robot"):
            count = self._count(part)
            if len(found) + count > most:
                problem = f"gives too many robots, more than {most} on {grid.size} cells"
                self._refuse(part, part, "multiplicity", problem)
                return found
            found += [part] * count
        return found

    def _floor(self, grid: Grid, robots: list[Element]) -> Study:
        """Robots and obstacles."""
        starts = [self._placed(grid, one, is_needed=False) for one in robots]
        obstacles = [self._placed(grid, one) for one in self._parts(self.block, "Obstacle")]
        self._check_cells(grid, obstacles, starts)
        blocked = sorted((one.cell or 0, one.element.id) for one in obstacles)
        return Study(
            query.component_name(self.graph, self.block),
            self.block.id,
            Grid(grid.columns, grid.rows, tuple(cell for cell, _ in blocked)),
            tuple(self._robots(starts)),
            within=self._number(self.block, "within"),
            counted=self._number(self.block, "counted") or 0,
            obstacles=tuple(id for _, id in blocked),
        )

    def _mission(self, floor: Study) -> Study | None:
        """The floor with its targets; None when something is wrong with one of them."""
        missions = self._parts(self.block, "Mission")
        wanted = [one for mission in missions for one in self._parts(self._type(mission), "Target")]
        targets = [self._placed(floor.grid, one) for one in wanted]
        cells = zip(floor.grid.blocked, floor.obstacles, strict=True)
        barred = [_PlacedPart(self.graph[id], cell) for cell, id in cells]
        self._check_cells(floor.grid, barred, targets)
        orders = tuple(read_orders(self, missions, wanted))
        deadlines = [self._number(self._type(one), "deadline") for one in missions]
        if not self.is_good:
            return None
        return replace(
            floor,
            targets=tuple(self._targets(targets)),
            orders=orders,
            deadline=max((one for one in deadlines if one is not None), default=None),
        )

    def fail(self, found: Rule, element: Element, **facts: str | int) -> None:
        """Report what is wrong with an element; the floor gives no study."""
        self.is_good = False
        self.sink.report(found, self.graph.subject(element), notes=(), help="", **facts)

    def _parts(self, block: Element | None, kind: str) -> list[Element]:
        if block is None:
            return []
        return [one for one in query.parts(self.graph, block) if self.is_typed(one, kind)]

    def is_typed(self, part: Element, kind: str) -> bool:
        """Whether the type of a feature is, or specialises, a definition of the library."""
        type_ = self._type(part)
        if type_ is None:
            return False
        return _is_ours(self.graph, type_, kind) or is_a(self.graph, type_, kind)

    def _type(self, part: Element) -> Element | None:
        return query.type_of(self.graph, part)

    def _count(self, part: Element) -> int:
        low, high = query.bounds(part.attrs.get("multiplicity")) or (1, 1)
        if high != low:
            problem = "leaves open how many robots there are"
            self._refuse(part, part, "multiplicity", problem)
        return low

    def _size(self, attribute: str) -> int:
        value = self._number(self.block, attribute)
        if value is None or not 1 <= value <= MAX_CELLS // 2:
            problem = "is missing" if value is None else f"is {value}, not 1 to {MAX_CELLS // 2}"
            self._refuse(self.block, self.block, attribute, problem)
        return value or 1

    def _number(self, block: Element | None, attribute: str) -> int | None:
        """The value of an attribute; None when it has none, or no number, which is reported."""
        known = query.features(self.graph, block) if block is not None else []
        found = next((one for one in known if one.name == attribute), None)
        value = None if found is None else found.attrs.get("default")
        if found is None or value is None:
            return None
        number = _parse_whole_number(value)
        if number is None or number < 0:
            problem = "is negative" if number is not None else f"is no whole number but '{value}'"
            self._refuse(found, block or found, attribute, problem)
        return number

    def _refuse(self, place: Element, block: Element, attribute: str, problem: str) -> None:
        self.fail(rules.NO_NUMBER, place, attribute=attribute, name=block.name, problem=problem)

    def _placed(self, grid: Grid, part: Element, is_needed: bool = True) -> _PlacedPart:
        was_good = self.is_good
        row, column = (self._number(self._type(part), name) for name in ("row", "column"))
        if self.is_good != was_good:
            return _PlacedPart(part, None)
        if row is None or column is None:
            if is_needed or (row, column) != (None, None):
                missing = "row" if row is None else "column"
                self._refuse(part, part, missing, "is missing")
            return _PlacedPart(part, None)
        if row >= grid.rows or column >= grid.columns:
            self.fail(
                rules.OFF_FLOOR,
                part,
                name=part.name,
                row=row,
                column=column,
                rows=grid.rows - 1,
                columns=grid.columns - 1,
                floor=self.block.name,
            )
            return _PlacedPart(part, None)
        return _PlacedPart(part, row * grid.columns + column)

    def _check_cells(
        self, grid: Grid, obstacles: list[_PlacedPart], others: list[_PlacedPart]
    ) -> None:
        """No two of them are in one cell."""
        known: dict[int, _PlacedPart] = {}
        for one in (*obstacles, *others):
            if one.cell is None or known.setdefault(one.cell, one) is one:
                continue
            row, column = divmod(one.cell, grid.columns)
            self.fail(
                rules.CELL_TAKEN,
                one.element,
                name=one.element.name,
                other=known[one.cell].element.name,
                row=row,
                column=column,
            )

    def _robots(self, starts: Iterable[_PlacedPart]) -> Iterator[Robot]:
        names = Names()
        for one in starts:
            yield Robot(one.element.name, names.new(one.element.name), one.element.id, one.cell)

    def _targets(self, targets: Iterable[_PlacedPart]) -> Iterator[Target]:
        names = Names("none")
        for one in targets:
            part = one.element
            deadline = self._number(self._type(part), "deadline")
            yield Target(part.name, names.new(part.name), one.cell or 0, part.id, deadline)

    def _check_ways(self, study: Study) -> None:
        starts = {one.start for one in study.robots}
        for target in study.targets:
            reached = study.grid.distances(target.cell)
            if None not in starts and starts.isdisjoint(reached):
                self.fail(rules.OUT_OF_REACH, self.graph[target.origin], name=target.name)


def _parse_whole_number(value: object) -> int | None:
    if isinstance(value, bool):
        return None
    if isinstance(value, str) and value.strip().lstrip("-").isdigit():
        return int(value)
    return value if isinstance(value, int) else None


class Reader(Protocol):
    """What reads a floor."""

    graph: Graph
    sink: Sink

    def fail(self, found: Rule, element: Element, **facts: str | int) -> None:
        """Report what is wrong."""

    def is_typed(self, part: Element, kind: str) -> bool:
        """Whether a feature is of that kind."""


def read_orders(
    reader: Reader, missions: Sequence[Element], targets: Sequence[Element]
) -> Iterator[Order]:
    """The orders that missions ask for, by numbers of targets; circles are reported."""
    found = [one for mission in missions for one in _iter_orders(reader, mission, targets)]
    _check_circles(reader, found, targets)
    _check_carrying(reader, found, targets)
    return iter(found)


def _iter_orders(reader: Reader, mission: Element, targets: Sequence[Element]) -> Iterator[Order]:
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
        circle = _find_order_path(orders, start, start)
        if circle:
            names = " before ".join(f"'{targets[at].name}'" for at in circle)
            name = targets[start].name
            reader.fail(rules.CIRCULAR_ORDER, targets[start], name=name, circle=names)
            return


def _find_order_path(orders: Sequence[Order], start: int, end: int) -> list[int]:
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
