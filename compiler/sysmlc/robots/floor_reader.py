"""Reader of floors: elements of a model that specialise definitions of the library ``Floors``."""

from collections.abc import Iterable, Iterator, Sequence
from math import isqrt

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic.identifiers import Names
from sysmlc.robots.study import Grid, Order, Robot, Study, Target

OFF_FLOOR = rule(
    "SM564",
    "place-off-floor",
    Severity.ERROR,
    "'{name}' is in row {row}, column {column}, which the floor '{floor}' does not have",
    help="rows are 0 to {rows}, columns 0 to {columns}",
)
CELL_TAKEN = rule(
    "SM565",
    "cell-taken",
    Severity.ERROR,
    "'{name}' is in the cell of '{other}' (row {row}, column {column})",
    help="give it another row or column",
)
NO_NUMBER = rule(
    "SM566",
    "floor-number",
    Severity.ERROR,
    "'{attribute}' of '{name}' {problem}",
    help="give the attribute a whole number as its value",
)
CIRCULAR_ORDER = rule(
    "SM567",
    "targets-wait-for-one-another",
    Severity.ERROR,
    "target '{name}' would have to be reached before itself: {circle}",
    help="remove one of these connections",
)
CARRIED_TWICE = rule(
    "SM568",
    "carried-twice",
    Severity.ERROR,
    "'Carry' connections send a robot {way} '{name}' {there} both '{one}' and '{other}'",
    help="use 'Before' for one of them",
)
OUT_OF_REACH = rule(
    "SM569",
    "target-out-of-reach",
    Severity.ERROR,
    "no robot can reach target '{name}': obstacles are on every way",
    help="move the target or an obstacle",
)
SAME_FLOOR = rule(
    "SM577",
    "floors-of-one-name",
    Severity.ERROR,
    "there is another floor '{name}': this one is not studied",
    help="give one of the floors another name",
)


# -- reader ----------------------------------------------------------------------------------------


LIBRARY = "Floors"
MAX_CELLS = 400
"""Largest number of cells of a floor: contracts have conjuncts for each cell."""
MAX_ROBOT_PAIR_CELLS = 10_000
"""Largest product of the number of cells and the square of the number of robots: contracts have a
conjunct for each pair of robots and each cell."""


def read_studies(graph: Graph, sink: Sink) -> Iterator[Study]:
    """Yield a study for each floor of a model that has robots; faulty floors are reported."""
    if not any(package.name == LIBRARY for package in graph.of_kind(Kind.PACKAGE)):
        return
    names: set[str] = set()
    for block in graph.of_kind(Kind.CLASS):
        is_drawn = not block.attrs.get("external") and not block.attrs.get("abstract")
        if is_drawn and _specialises_library(graph, block, "Floor"):
            reader = _FloorReader(graph, block, sink)
            yield from reader.read_study() if reader.check_name(names) else ()


def _specialises_library(graph: Graph, element: Element, name: str) -> bool:
    """Return whether a classifier specialises the named definition of the library."""
    return any(
        _is_library_element(graph, general, name) for general in query.generals(graph, element)
    )


def _is_library_element(graph: Graph, element: Element, name: str) -> bool:
    if element.name != name:
        return False
    return f"::{graph.qualified_name(element)}".endswith(f"::{LIBRARY}::{name}")


class _PlacedPart(Struct, frozen=True):
    """A part of a floor with its cell; None for a robot without a start, or after an error."""

    element: Element
    cell: int | None


class _FloorReader:
    """Reads one floor; ``is_good`` becomes false at the first error."""

    def __init__(self, graph: Graph, block: Element, sink: Sink) -> None:
        self.graph, self.block, self.sink = graph, block, sink
        self.is_good = True

    def check_name(self, names: set[str]) -> bool:
        """Return whether the floor's name is new, and add it to *names*."""
        name = query.component_name(self.graph, self.block)
        if name in names:
            self.fail(SAME_FLOOR, self.block, name=name)
        names.add(name)
        return self.is_good

    def read_study(self) -> Iterator[Study]:
        """Yield the study of the floor, or nothing if it has no robots or an error."""
        grid = Grid(self._read_size("columns"), self._read_size("rows"))
        robots = self._list_robots(grid)
        if robots and self.is_good:
            study = self._read_mission(self._read_floor(grid, robots))
            if study is not None:
                self._check_reachability(study)
            if study is not None and self.is_good:
                yield study

    def _list_robots(self, grid: Grid) -> list[Element]:
        """Return the parts that are robots, each as often as its multiplicity requires."""
        robots: list[Element] = []
        max_robots = isqrt(MAX_ROBOT_PAIR_CELLS // grid.size)
        for part in self._parts_of_kind(self.block, "Robot"):
            count = self._read_count(part)
            if len(robots) + count > max_robots:
                problem = f"gives too many robots, more than {max_robots} on {grid.size} cells"
                self._report_attribute(part, part, "multiplicity", problem)
                return robots
            robots += [part] * count
        return robots

    def _read_floor(self, grid: Grid, robots: list[Element]) -> Study:
        """Return the floor with robots and obstacles."""
        starts = [self._read_place(grid, part, is_needed=False) for part in robots]
        obstacles = [
            self._read_place(grid, part) for part in self._parts_of_kind(self.block, "Obstacle")
        ]
        self._check_cells(grid, obstacles, starts)
        blocked = sorted((part.cell or 0, part.element.id) for part in obstacles)
        return Study(
            query.component_name(self.graph, self.block),
            self.block.id,
            Grid(grid.columns, grid.rows, tuple(cell for cell, _ in blocked)),
            tuple(self._build_robots(starts)),
            within=self._read_number(self.block, "within"),
            counter_size=self._read_number(self.block, "counted") or 0,
            obstacles=tuple(id for _, id in blocked),
        )

    def _read_mission(self, floor: Study) -> Study | None:
        """Return the floor with its targets, or None if there is an error."""
        missions = self._parts_of_kind(self.block, "Mission")
        target_parts = [
            part
            for mission in missions
            for part in self._parts_of_kind(self._type_of(mission), "Target")
        ]
        targets = [self._read_place(floor.grid, part) for part in target_parts]
        cells = zip(floor.grid.blocked, floor.obstacles, strict=True)
        placed_obstacles = [_PlacedPart(self.graph[id], cell) for cell, id in cells]
        self._check_cells(floor.grid, placed_obstacles, targets)
        orders = tuple(_read_orders(self, missions, target_parts))
        deadlines = [self._read_number(self._type_of(part), "deadline") for part in missions]
        if not self.is_good:
            return None
        return replace(
            floor,
            targets=tuple(self._build_targets(targets)),
            orders=orders,
            deadline=max((number for number in deadlines if number is not None), default=None),
        )

    def fail(self, rule: Rule, element: Element, **facts: str | int) -> None:
        """Report an error of an element; the floor then yields no study."""
        self.is_good = False
        self.sink.report(rule, self.graph.subject(element), notes=(), help="", cause="", **facts)

    def _parts_of_kind(self, block: Element | None, kind: str) -> list[Element]:
        if block is None:
            return []
        return [part for part in query.parts(self.graph, block) if self.is_typed(part, kind)]

    def is_typed(self, part: Element, kind: str) -> bool:
        """Whether a part is typed by the library's definition *kind* or a specialisation."""
        type_ = self._type_of(part)
        if type_ is None:
            return False
        return _is_library_element(self.graph, type_, kind) or _specialises_library(
            self.graph, type_, kind
        )

    def _type_of(self, part: Element) -> Element | None:
        return query.type_of(self.graph, part)

    def _read_count(self, part: Element) -> int:
        low, high = query.bounds(part.attrs.get("multiplicity")) or (1, 1)
        if high != low:
            problem = "leaves open how many robots there are"
            self._report_attribute(part, part, "multiplicity", problem)
        return low

    def _read_size(self, attribute: str) -> int:
        value = self._read_number(self.block, attribute)
        if value is None or not 1 <= value <= MAX_CELLS // 2:
            problem = "is missing" if value is None else f"is {value}, not 1 to {MAX_CELLS // 2}"
            self._report_attribute(self.block, self.block, attribute, problem)
        return value or 1

    def _read_number(self, block: Element | None, attribute: str) -> int | None:
        """Return the value of an attribute, or None if it has none.

        A value that is not a natural number is reported.
        """
        features = query.features(self.graph, block) if block is not None else []
        feature = next((candidate for candidate in features if candidate.name == attribute), None)
        value = None if feature is None else feature.attrs.get("default")
        if feature is None or value is None:
            return None
        number = _parse_whole_number(value)
        if number is None or number < 0:
            problem = (
                "is negative" if number is not None else f"is not a whole number but '{value}'"
            )
            self._report_attribute(feature, block or feature, attribute, problem)
        return number

    def _report_attribute(
        self, place: Element, block: Element, attribute: str, problem: str
    ) -> None:
        self.fail(NO_NUMBER, place, attribute=attribute, name=block.name, problem=problem)

    def _read_place(self, grid: Grid, part: Element, is_needed: bool = True) -> _PlacedPart:
        """Return a part with its cell; a missing or invalid cell is reported.

        Unless *is_needed*, row and column may both be missing.
        """
        was_good = self.is_good
        row, column = (self._read_number(self._type_of(part), name) for name in ("row", "column"))
        if self.is_good != was_good:
            return _PlacedPart(part, None)
        if row is None or column is None:
            if is_needed or (row, column) != (None, None):
                missing = "row" if row is None else "column"
                self._report_attribute(part, part, missing, "is missing")
            return _PlacedPart(part, None)
        if row >= grid.rows or column >= grid.columns:
            self.fail(
                OFF_FLOOR,
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
        self, grid: Grid, obstacles: list[_PlacedPart], other_parts: list[_PlacedPart]
    ) -> None:
        """Report parts that share a cell."""
        parts_by_cell: dict[int, _PlacedPart] = {}
        for part in (*obstacles, *other_parts):
            if part.cell is None or parts_by_cell.setdefault(part.cell, part) is part:
                continue
            row, column = divmod(part.cell, grid.columns)
            self.fail(
                CELL_TAKEN,
                part.element,
                name=part.element.name,
                other=parts_by_cell[part.cell].element.name,
                row=row,
                column=column,
            )

    def _build_robots(self, starts: Iterable[_PlacedPart]) -> Iterator[Robot]:
        names = Names()
        for placed in starts:
            yield Robot(
                placed.element.name, names.new(placed.element.name), placed.element.id, placed.cell
            )

    def _build_targets(self, targets: Iterable[_PlacedPart]) -> Iterator[Target]:
        names = Names("none")
        for placed in targets:
            part = placed.element
            deadline = self._read_number(self._type_of(part), "deadline")
            yield Target(part.name, names.new(part.name), placed.cell or 0, part.id, deadline)

    def _check_reachability(self, study: Study) -> None:
        start_cells = {robot.start for robot in study.robots}
        for target in study.targets:
            reachable = study.grid.distances(target.cell)
            if None not in start_cells and start_cells.isdisjoint(reachable):
                self.fail(OUT_OF_REACH, self.graph[target.origin], name=target.name)


def _parse_whole_number(value: object) -> int | None:
    if isinstance(value, bool):
        return None
    if isinstance(value, str) and value.strip().lstrip("-").isdigit():
        return int(value)
    return value if isinstance(value, int) else None


def _read_orders(
    reader: _FloorReader, missions: Sequence[Element], targets: Sequence[Element]
) -> Iterator[Order]:
    """Return the orders between targets of the missions.

    Cycles are reported, and targets that are carried from or to several targets.
    """
    orders = [order for mission in missions for order in _iter_orders(reader, mission, targets)]
    _check_circles(reader, orders, targets)
    _check_carrying(reader, orders, targets)
    return iter(orders)


def _iter_orders(
    reader: _FloorReader, mission: Element, targets: Sequence[Element]
) -> Iterator[Order]:
    graph = reader.graph
    numbers = {target.id: number for number, target in enumerate(targets)}
    block = query.type_of(graph, mission)
    owners = () if block is None else (block, *query.generals(graph, block))
    for connector in (element for owner in owners for element in graph.owned(owner)):
        if connector.kind is not Kind.CONNECTOR or not reader.is_typed(connector, "Before"):
            continue
        roles = [query.role_of(graph, end) for end in query.ends(graph, connector)]
        ends = [numbers[role.id] for role in roles if role is not None and role.id in numbers]
        if len(ends) == 2:
            is_carried = reader.is_typed(connector, "Carry")
            yield Order(ends[0], ends[1], is_carried, connector.id)


def _check_circles(
    reader: _FloorReader, orders: Sequence[Order], targets: Sequence[Element]
) -> None:
    """Report the first target that has to be reached before itself."""
    for start in range(len(targets)):
        circle = _find_order_path(orders, start, start)
        if circle:
            names = " before ".join(f"'{targets[number].name}'" for number in circle)
            name = targets[start].name
            reader.fail(CIRCULAR_ORDER, targets[start], name=name, circle=names)
            return


def _find_order_path(orders: Sequence[Order], start: int, end: int) -> list[int]:
    """Return the targets on a shortest path of orders, or an empty list if there is no path."""
    predecessors: dict[int, int] = {}
    worklist = [start]
    while worklist:
        target = worklist.pop(0)
        for order in orders:
            if order.earlier == target and order.later not in predecessors:
                predecessors[order.later] = target
                worklist.append(order.later)
    if end not in predecessors:
        return []
    # Start and end may be equal: a cycle has at least one order.
    path = [end]
    while len(path) == 1 or path[0] != start:
        path.insert(0, predecessors[path[0]])
    return path


def _check_carrying(
    reader: _FloorReader, orders: Sequence[Order], targets: Sequence[Element]
) -> None:
    """Report targets that are carried to, or from, several others."""
    for side, other, prepositions in (
        ("earlier", "later", ("from", "to")),
        ("later", "earlier", ("to", "from")),
    ):
        targets_by_end: dict[int, int] = {}
        for order in orders:
            end, opposite_end = getattr(order, side), getattr(order, other)
            if order.is_carried and targets_by_end.setdefault(end, opposite_end) != opposite_end:
                reader.fail(
                    CARRIED_TWICE,
                    reader.graph[order.origin],
                    way=prepositions[0],
                    there=prepositions[1],
                    name=targets[end].name,
                    one=targets[targets_by_end[end]].name,
                    other=targets[opposite_end].name,
                )
