"""Parametric diagrams: one for each block or constraint block with constraint properties.

A diagram has the usages of constraint blocks with their parameters, and the bindings to them (SysML
1.6 clause 10). A feature of a part has its own box, with the path as name (clause 8.3.1.2).
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.boxes import format_unit
from sysmlc.backends.plantuml.connections import Path, is_parametric, path_of
from sysmlc.backends.plantuml.views import Aliases, Diagram, InternalView, Line, PartView, PortView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import features, type_of
from sysmlc.support.plantuml_text import escape_line, format_label, join_rows, shrink, wrap_lines

_Ids = tuple[str, ...]
OWNERS = (Kind.CLASS, Kind.COMPONENT)
_MAX_STEPS = 4
"""The longest path from a block to a feature that is searched for a connector without paths."""
_MAX_PATHS = 1000
"""The largest number of paths of one length that the search extends."""


class Binding(Struct, frozen=True):
    """One line of a parametric diagram; ``shows`` are the ids of its elements."""

    source: Path
    target: Path
    shows: tuple[str, ...]

    @property
    def ends(self) -> tuple[Path, Path]:
        """Both ends."""
        return self.source, self.target


def _list_usages(graph: Graph, block: Element) -> list[Element]:
    """Return the constraint properties of a block, inherited ones included."""
    return [feature for feature in features(graph, block) if feature.role == "constraint property"]


def find_bindings(graph: Graph) -> dict[str, list[Binding]]:
    """Return the bindings to constraint parameters, by the block whose diagram shows them.

    This block is the owner of the connector, with one exception: Papyrus before 1.0 stored the
    connectors of a parametric diagram below any classifier, and without paths. A connector that
    leads to features of another block with constraint properties therefore belongs to that block if
    each feature has a single shortest path.
    """
    bindings_by_block: dict[str, list[Binding]] = {}
    users = _find_users(graph)
    for connector in graph.of_kind(Kind.CONNECTOR):
        if is_parametric(graph, connector):
            for block, paths in _place_connector(graph, connector, users):
                bindings_by_block.setdefault(block, []).extend(
                    _iter_bindings(graph, connector, paths)
                )
    return bindings_by_block


def _find_users(graph: Graph) -> dict[str, list[Element]]:
    """Return the blocks that use each constraint block, by its id."""
    users: dict[str, list[Element]] = {}
    for block in graph.of_kind(*OWNERS):
        types = (type_of(graph, usage) for usage in _list_usages(graph, block))
        for id in dict.fromkeys(type_.id for type_ in types if type_ is not None):
            users.setdefault(id, []).append(block)
    return users


def _place_connector(
    graph: Graph, connector: Element, users: dict[str, list[Element]]
) -> list[tuple[str, list[Path]]]:
    ends = graph.targets(connector, Edge.END)
    if _is_stray(graph, connector):
        owners = (role.owner for role in _list_roles(graph, connector) if role.owner in users)
        blocks = dict.fromkeys(block for id in owners for block in users[id or ""])
        candidates = [
            (block.id, [_find_path(graph, block, end) for end in ends]) for block in blocks
        ]
        resolved = [
            (id, [path for path in candidate_paths if path is not None])
            for id, candidate_paths in candidates
        ]
        placed = [(id, paths) for id, paths in resolved if len(paths) == len(ends)]
        if placed:
            return placed
    own_paths = [path for end in ends if (path := path_of(graph, end)) is not None]
    return [(connector.owner, own_paths)] if connector.owner is not None else []


def _list_roles(graph: Graph, connector: Element) -> list[Element]:
    ends = graph.targets(connector, Edge.END)
    return [role for end in ends for role in graph.targets(end, Edge.ROLE)]


def _iter_bindings(graph: Graph, connector: Element, paths: list[Path]) -> Iterator[Binding]:
    shows = (connector.id, *(end.id for end in graph.targets(connector, Edge.END)))
    for source, target in pairwise(paths):
        yield Binding(source, target, shows)


def _is_stray(graph: Graph, connector: Element) -> bool:
    """Whether the connector has no paths and connects features that its owner does not have."""
    owner, ends = graph.owner(connector), graph.targets(connector, Edge.END)
    if owner is None or any(graph.targets(end, Edge.PATH) for end in ends):
        return False
    own_features = features(graph, owner)
    return any(role not in own_features for role in _list_roles(graph, connector))


def _find_path(graph: Graph, block: Element, end: Element) -> Path | None:
    """Return the single shortest path from the block to the role of the end, or None."""
    role = graph.target(end, Edge.ROLE)
    level: list[tuple[Element, ...]] = [(feature,) for feature in features(graph, block)]
    for _ in range(_MAX_STEPS):
        ways = [way for way in level if way[-1] is role]
        if ways:
            return _as_path(ways[0]) if len(ways) == 1 else None
        level = [
            (*way, feature)
            for way in level[:_MAX_PATHS]
            for feature in _list_features_below(graph, way)
        ]
    return None


def _list_features_below(graph: Graph, way: tuple[Element, ...]) -> list[Element]:
    type_ = type_of(graph, way[-1])
    if type_ is None or way[-1].kind is not Kind.PROPERTY:
        return []
    return [feature for feature in features(graph, type_) if feature not in way]


def _as_path(way: tuple[Element, ...]) -> Path:
    ids = tuple(feature.id for feature in way)
    if way[-1].role == "constraint parameter":
        return Path(ids[:-1], port=ids[-1])
    return Path(ids)


_ROW_WIDTH = 40


def draw_parametric_diagrams(graph: Graph) -> Iterator[Diagram]:
    """Yield all parametric diagrams, in the order of the model."""
    bound = find_bindings(graph)
    for block in graph.of_kind(*OWNERS):
        owned_usages = (m for m in graph.owned(block) if m.role == "constraint property")
        has_usages = any(type_of(graph, usage) is not None for usage in owned_usages)
        if (has_usages or block.id in bound) and not block.attrs.get("external"):
            yield from _draw_block(
                graph, block, _list_usages(graph, block), bound.get(block.id, [])
            )


def build_selected_view(
    graph: Graph, block: Element, shown: Iterable[Element], selected: list[Binding]
) -> InternalView:
    """Return the view of the properties in *shown* and the bindings, in the frame of the block."""
    property_paths = [(element.id,) for element in shown if element.kind is Kind.PROPERTY]
    boxes = dict.fromkeys(
        [*property_paths, *(end.parts for element in selected for end in element.ends)]
    )
    boxes.pop((), None)
    return _ParametricDrawing(graph, block, list(boxes), selected).build_view()


def _draw_block(
    graph: Graph, block: Element, properties: list[Element], block_bindings: list[Binding]
) -> Iterator[Diagram]:
    title = graph.qualified_name(block)
    parts = _partition([(property_.id,) for property_ in properties], block_bindings)
    for index, (shown, inside) in enumerate(parts):
        drawing = _ParametricDrawing(graph, block, shown, inside)
        diagram = Diagram(
            kind="par",
            name=title,
            frame=escape_line(
                f"par [{' '.join(labels.keywords(graph, block))}] {labels.name(block)}"
            ),
            heading=("Parametric diagram", title),
            view=drawing.build_view(),
            about=block.id,
        )
        yield partitioning.name_part(diagram, index, len(parts))


def _partition(
    property_paths: list[_Ids], block_bindings: list[Binding]
) -> list[tuple[list[_Ids], list[Binding]]]:
    """Return groups of boxes, each with its bindings and the boxes at both ends of these."""
    boxes = dict.fromkeys(
        [*property_paths, *(end.parts for binding in block_bindings for end in binding.ends)]
    )
    boxes.pop((), None)
    adjacency: dict[_Ids, list[_Ids]] = {path: [] for path in boxes}
    for binding in block_bindings:
        first, second = (end.parts for end in binding.ends)
        if first in adjacency and second in adjacency and first != second:
            adjacency[first].append(second)
            adjacency[second].append(first)
    parts = []
    for index, group in enumerate(partitioning.partition(list(boxes), adjacency) or [[]]):
        inside = []
        for binding in block_bindings:
            ends = {end.parts for end in binding.ends} - {()}
            if not ends.isdisjoint(group) or (index == 0 and not ends):
                inside.append(binding)
        shown = {end.parts for binding in inside for end in binding.ends}.union(group)
        parts.append(([path for path in boxes if path in shown], inside))
    return parts


@dataclass(slots=True)
class _ParametricDrawing:
    """Builder of the view of one parametric diagram; ``boxes`` are paths from the block."""

    graph: Graph
    block: Element
    boxes: list[_Ids]
    bindings: list[Binding]
    aliases: Aliases = field(default_factory=Aliases)
    right_ports: frozenset[_Ids] = frozenset()

    def __post_init__(self) -> None:
        self.bindings = [_orient_towards_parameter(binding) for binding in self.bindings]
        self.right_ports = _find_right_ports(self.bindings)

    def build_view(self) -> InternalView:
        frame = PartView(
            self.aliases.make((), self.block.name, "block"),
            " ",
            "frame",
            tuple(self._iter_ports((), self.block)),
            tuple(self._make_box(path) for path in self.boxes),
            (self.block.id,),
        )
        return InternalView(
            frame,
            tuple(
                Line(
                    self.aliases[binding.source.ids()],
                    "--",
                    self.aliases[binding.target.ids()],
                    shows=binding.shows,
                )
                for binding in self.bindings
            ),
            True,
        )

    def _make_box(self, path: _Ids) -> PartView:
        shown = self.graph[path[-1]]
        type_ = type_of(self.graph, shown)
        is_usage = shown.role == "constraint property"
        return PartView(
            self.aliases.make(path, shown.name, "property"),
            self._format_label(path, shown, type_ if is_usage else None),
            "law" if is_usage else "value",
            tuple(self._iter_ports(path, type_ if is_usage else None)),
            (),
            (
                *path,
                *(condition.id for condition in self._list_conditions(type_ if is_usage else None)),
            ),
        )

    def _format_label(self, path: _Ids, shown: Element, constraint_block: Element | None) -> str:
        steps = ".".join(labels.name(self.graph[id]) for id in path)
        text = labels.format_typed(self.graph, shown, steps)
        rows = [
            wrap_lines(labels.condition(condition), _ROW_WIDTH)
            for condition in self._list_conditions(constraint_block)
        ]
        words = (
            shrink(escape_line(labels.guillemets(["constraint"])))
            if constraint_block is not None
            else ""
        )
        unit = format_unit(self.graph, shown) if constraint_block is None else ""
        return join_rows(
            [
                words,
                format_label(text),
                format_label(unit),
                *(row for condition_rows in rows for row in condition_rows),
            ]
        )

    def _list_conditions(self, constraint_block: Element | None) -> list[Element]:
        members = [] if constraint_block is None else self.graph.owned(constraint_block)
        return [member for member in members if member.kind is Kind.CONSTRAINT]

    def _iter_ports(self, path: _Ids, owner: Element | None) -> Iterator[PortView]:
        """Yield all parameters of a usage, and further ports at which bindings end."""
        features_of_type = [] if owner is None else features(self.graph, owner)
        ids = [item.id for item in features_of_type if item.role == "constraint parameter"]
        bound_ends = [
            end for item in self.bindings for end in item.ends if end.parts == path and end.port
        ]
        keys = dict.fromkeys(
            [*((id,) for id in ids), *((*end.ports, end.port) for end in bound_ends)]
        )
        for key in keys:
            name = ".".join(labels.name(self.graph[id]) for id in key)
            alias = self.aliases.make((*path, *key), self.graph[key[-1]].name, "parameter")
            text = join_rows(f"<back:#FFFFFF>{row}</back>" for row in wrap_lines(name))
            form = "portout" if (*path, *key) in self.right_ports else "port"
            yield PortView(alias, text, form, key)


# -- layout ------------------------------------------------------------------------------------


def _orient_towards_parameter(binding: Binding) -> Binding:
    """Return the binding with the property as its source and the parameter as its target.

    Graphviz then draws all properties on the left.
    """
    if binding.source.port and not binding.target.port:
        return replace(binding, source=binding.target, target=binding.source)
    return binding


def _find_right_ports(lines_drawn: list[Binding]) -> frozenset[_Ids]:
    """Return the paths to parameters that are the source of bindings and never the target."""
    starts = {
        binding.source.ids()
        for binding in lines_drawn
        if binding.source.parts and binding.source.port
    }
    return frozenset(starts - {binding.target.ids() for binding in lines_drawn})
