"""Parametric diagrams: one for each block or constraint block with constraint properties.

SysML 1.6 clause 10: usages of constraint blocks with their parameters, and what is bound to them.
A feature of a part stands in a box of its own, with the path as its name (clause 8.3.1.2).
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.boxes import format_unit
from sysmlc.backends.plantuml.connections import Path, is_parametric, path_of
from sysmlc.backends.plantuml.views import Diagram, InternalView, Line, PartView, PortView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import features, type_of
from sysmlc.support.plantuml_text import label, lines, plain, small, stack

OWNERS = (Kind.CLASS, Kind.COMPONENT)
_DEEPEST = 4
_WIDEST = 1000
"""Steps from a block to a feature of its parts that a connector without a path can mean, and
the ways that are followed in each."""


class Binding(Struct, frozen=True):
    """One line of a parametric diagram; ``shows`` are the ids that it stands for."""

    source: Path
    target: Path
    shows: tuple[str, ...]

    @property
    def ends(self) -> tuple[Path, Path]:
        """Both ends."""
        return self.source, self.target


def usages(graph: Graph, block: Element) -> list[Element]:
    """Constraint properties that instances of the block have, inherited ones too."""
    return [one for one in features(graph, block) if one.role == "constraint property"]


def bindings(graph: Graph) -> dict[str, list[Binding]]:
    """Bindings at constraint parameters by the block in whose parametric diagram they stand.

    That is the owner of the connector. Papyrus before 1.0 put the connectors of a parametric
    diagram below any classifier, and wrote no paths: what leads to features of another block
    with constraint properties, to each in a single shortest way, stands there.
    """
    found: dict[str, list[Binding]] = {}
    homes = _homes(graph)
    for connector in graph.of_kind(Kind.CONNECTOR):
        if is_parametric(graph, connector):
            for block, paths in _place_connector(graph, connector, homes):
                found.setdefault(block, []).extend(_iter_bindings(graph, connector, paths))
    return found


def _homes(graph: Graph) -> dict[str, list[Element]]:
    """Blocks by the constraint blocks that their constraint properties are typed by."""
    found: dict[str, list[Element]] = {}
    for block in graph.of_kind(*OWNERS):
        types = (type_of(graph, one) for one in usages(graph, block))
        for id in dict.fromkeys(type_.id for type_ in types if type_ is not None):
            found.setdefault(id, []).append(block)
    return found


def _place_connector(
    graph: Graph, connector: Element, homes: dict[str, list[Element]]
) -> list[tuple[str, list[Path]]]:
    ends = graph.targets(connector, Edge.END)
    if _is_stray(graph, connector):
        owners = (role.owner for role in _roles(graph, connector) if role.owner in homes)
        blocks = dict.fromkeys(block for id in owners for block in homes[id or ""])
        ways = [(block.id, [_find_path(graph, block, end) for end in ends]) for block in blocks]
        known = [(id, [way for way in found if way is not None]) for id, found in ways]
        placed = [(id, paths) for id, paths in known if len(paths) == len(ends)]
        if placed:
            return placed
    own = [path for end in ends if (path := path_of(graph, end)) is not None]
    return [(connector.owner, own)] if connector.owner is not None else []


def _roles(graph: Graph, connector: Element) -> list[Element]:
    ends = graph.targets(connector, Edge.END)
    return [role for end in ends for role in graph.targets(end, Edge.ROLE)]


def _iter_bindings(graph: Graph, connector: Element, paths: list[Path]) -> Iterator[Binding]:
    shows = (connector.id, *(end.id for end in graph.targets(connector, Edge.END)))
    for one, other in pairwise(paths):
        yield Binding(one, other, shows)


def _is_stray(graph: Graph, connector: Element) -> bool:
    """Whether it has no paths and leads to what its owner does not have."""
    owner, ends = graph.owner(connector), graph.targets(connector, Edge.END)
    if owner is None or any(graph.targets(end, Edge.PATH) for end in ends):
        return False
    own = features(graph, owner)
    return any(role not in own for role in _roles(graph, connector))


def _find_path(graph: Graph, block: Element, end: Element) -> Path | None:
    """The one shortest way from the block to the role of the end."""
    role = graph.target(end, Edge.ROLE)
    level: list[tuple[Element, ...]] = [(one,) for one in features(graph, block)]
    for _ in range(_DEEPEST):
        ways = [way for way in level if way[-1] is role]
        if ways:
            return _as_path(ways[0]) if len(ways) == 1 else None
        level = [(*way, one) for way in level[:_WIDEST] for one in _list_features_below(graph, way)]
    return None


def _list_features_below(graph: Graph, way: tuple[Element, ...]) -> list[Element]:
    type_ = type_of(graph, way[-1])
    if type_ is None or way[-1].kind is not Kind.PROPERTY:
        return []
    return [one for one in features(graph, type_) if one not in way]


def _as_path(way: tuple[Element, ...]) -> Path:
    ids = tuple(one.id for one in way)
    if way[-1].role == "constraint parameter":
        return Path(ids[:-1], port=ids[-1])
    return Path(ids)


_ROW = 40


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All parametric diagrams, in the order of the model."""
    bound = bindings(graph)
    for block in graph.of_kind(*OWNERS):
        has_usages = any(_is_law(graph, one) for one in graph.owned(block))
        if (has_usages or block.id in bound) and not block.attrs.get("external"):
            yield from _of_block(graph, block, usages(graph, block), bound.get(block.id, []))


def chosen(
    graph: Graph, block: Element, shown: Iterable[Element], found: list[Binding]
) -> InternalView:
    """The properties in ``shown`` and the bindings, in the frame of the block."""
    own = [(one.id,) for one in shown if one.kind is Kind.PROPERTY]
    boxes = dict.fromkeys([*own, *(end.parts for one in found for end in one.ends)])
    boxes.pop((), None)
    return _Drawing(graph, block, list(boxes), found).view()


def _is_law(graph: Graph, item: Element) -> bool:
    return _is_usage(item) and type_of(graph, item) is not None


def _is_usage(item: Element) -> bool:
    return item.role == "constraint property"


def _of_block(
    graph: Graph, block: Element, held: list[Element], found: list[Binding]
) -> Iterator[Diagram]:
    whole = graph.qualified_name(block)
    parts = _divided([(one.id,) for one in held], found)
    for index, (shown, inside) in enumerate(parts):
        drawing = _Drawing(graph, block, shown, inside)
        yield Diagram(
            kind="par",
            name=partitioning.numbered(whole, index, len(parts)),
            frame=plain(f"par [{' '.join(labels.keywords(graph, block))}] {labels.name(block)}"),
            heading=("Parametric diagram", whole),
            view=drawing.view(),
            about=block.id,
            footer=plain(partitioning.footer(index, len(parts), whole)),
        )


def _divided(
    held: list[tuple[str, ...]], found: list[Binding]
) -> list[tuple[list[tuple[str, ...]], list[Binding]]]:
    """Boxes that are drawn together, with all bindings of each; the other ends come along."""
    boxes = dict.fromkeys([*held, *(end.parts for one in found for end in one.ends)])
    boxes.pop((), None)
    names = {_key(path): path for path in boxes}
    near: dict[str, list[str]] = {key: [] for key in names}
    for one in found:
        first, second = (_key(end.parts) for end in one.ends)
        if first in near and second in near and first != second:
            near[first].append(second)
            near[second].append(first)
    groups = partitioning.chunks(list(names), near) or [[]]
    return [_group(set(group), names, found, at == 0) for at, group in enumerate(groups)]


def _group(
    group: set[str], names: dict[str, tuple[str, ...]], found: list[Binding], is_first: bool
) -> tuple[list[tuple[str, ...]], list[Binding]]:
    inside = [one for one in found if _touches(one, group, is_first)]
    ends = {_key(end.parts) for one in inside for end in one.ends} | group
    return [path for key, path in names.items() if key in ends], inside


def _touches(binding: Binding, group: set[str], is_first: bool) -> bool:
    keys = {_key(end.parts) for end in binding.ends if end.parts}
    return bool(keys & group) or (is_first and not keys)


def _key(path: tuple[str, ...]) -> str:
    return "\x1f".join(path)


@dataclass(slots=True)
class _Drawing:
    """One parametric diagram in the making; ``boxes`` are paths from the block."""

    graph: Graph
    block: Element
    boxes: list[tuple[str, ...]]
    found: list[Binding]
    aliases: Aliases = field(default_factory=Aliases)
    right: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        self.found = [_towards_parameter(one) for one in self.found]
        self.right = _on_the_right(self.found)

    def view(self) -> InternalView:
        frame = PartView(
            self.aliases.make("frame", self.block.name, "block"),
            " ",
            "frame",
            tuple(self._ports((), self.block)),
            tuple(self._box(path) for path in self.boxes),
            (self.block.id,),
        )
        return InternalView(frame, tuple(self._line(one) for one in self.found), True)

    def _box(self, path: tuple[str, ...]) -> PartView:
        shown = self.graph[path[-1]]
        type_ = type_of(self.graph, shown)
        is_law = _is_usage(shown)
        return PartView(
            self.aliases.make(_key(path), shown.name, "property"),
            self._label(path, shown, type_ if is_law else None),
            "law" if is_law else "value",
            tuple(self._ports(path, type_ if is_law else None)),
            (),
            (*path, *(one.id for one in self._conditions(type_ if is_law else None))),
        )

    def _label(self, path: tuple[str, ...], shown: Element, law: Element | None) -> str:
        steps = ".".join(labels.name(self.graph[id]) for id in path)
        text = labels.typed(self.graph, shown, steps)
        rows = [lines(labels.condition(one), _ROW) for one in self._conditions(law)]
        words = small(plain(labels.guillemets(["constraint"]))) if law is not None else ""
        unit = format_unit(self.graph, shown) if law is None else ""
        return stack([words, label(text), label(unit), *(row for some in rows for row in some)])

    def _conditions(self, law: Element | None) -> list[Element]:
        held = [] if law is None else self.graph.owned(law)
        return [one for one in held if one.kind is Kind.CONSTRAINT]

    def _ports(self, path: tuple[str, ...], owner: Element | None) -> Iterator[PortView]:
        """All parameters of a usage, and what bindings name besides."""
        known = [] if owner is None else features(self.graph, owner)
        ids = [one.id for one in known if one.role == "constraint parameter"]
        named = [end for one in self.found for end in one.ends if end.parts == path and end.port]
        keys = dict.fromkeys([*((id,) for id in ids), *((*end.ports, end.port) for end in named)])
        for key in keys:
            name = ".".join(labels.name(self.graph[id]) for id in key)
            alias = self.aliases.make(_key((*path, *key)), self.graph[key[-1]].name, "parameter")
            text = stack(f"<back:#FFFFFF>{row}</back>" for row in lines(name))
            form = "portout" if _key((*path, *key)) in self.right else "port"
            yield PortView(alias, text, form, key)

    def _line(self, binding: Binding) -> Line:
        one, other = (self._end(end) for end in binding.ends)
        return Line(one, "--", other, shows=binding.shows)

    def _end(self, end: Path) -> str:
        key = (*end.parts, *end.ports, end.port) if end.port else end.parts
        return self.aliases[_key(key) if key else "frame"]


# -- layout ------------------------------------------------------------------------------------


def _towards_parameter(binding: Binding) -> Binding:
    """A line from a property to a parameter: so properties stand on the left, none between."""
    if binding.source.port and not binding.target.port:
        return replace(binding, source=binding.target, target=binding.source)
    return binding


def _on_the_right(found: list[Binding]) -> frozenset[str]:
    """Parameters that are bound to those of other usages only, and start the lines to them."""
    starts = {_place(one.source) for one in found if one.source.parts and one.source.port}
    return frozenset(starts - {_place(one.target) for one in found})


def _place(end: Path) -> str:
    return _key((*end.parts, *end.ports, end.port))
