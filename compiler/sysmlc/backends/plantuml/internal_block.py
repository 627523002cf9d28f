"""Internal block diagrams: one for each block with connectors or item flows between its parts.

An instance, and a hierarchy of AutomationML whose instances are linked, have one too.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.connections import (
    Connection,
    FreeFlow,
    Path,
    connections,
    free_flows,
    in_order,
)
from sysmlc.backends.plantuml.layout import find_port_sides, iter_port_guides
from sysmlc.backends.plantuml.views import Diagram, InternalView, Line, PartView, PortView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import generals, opposite
from sysmlc.ir.query.units import unit_of
from sysmlc.support.plantuml_text import label, lines, plain, small, stack

FORMS = {"in": "portin", "out": "portout"}
"""How ports are drawn, by direction."""
_CLASSES = (Kind.CLASS, Kind.COMPONENT)
_DRAWN_ROLES = frozenset(["part", "reference"])
_PORT_WIDTH = 24
_TYPE = (Edge.TYPED_BY, Edge.INSTANCE_OF)
"""What leads from a part to its type, and from an instance that is drawn like one."""


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All internal block diagrams, in the order of the model."""
    hierarchies = (p for p in graph.of_kind(Kind.PACKAGE) if p.subkind == "instance-hierarchy")
    flows = free_flows(graph)
    for block in (*graph.of_kind(*_CLASSES, Kind.INSTANCE), *hierarchies):
        yield from _of_block(graph, block, flows.get(block.id, ()))


def _of_block(graph: Graph, block: Element, flows: tuple[FreeFlow, ...]) -> Iterator[Diagram]:
    found = connections(graph, block, flows)
    if not found or block.attrs.get("external"):
        return
    whole = graph.qualified_name(block)
    parts = _divided(graph, block, found)
    for index, (shown, inside) in enumerate(parts):
        drawing = _Drawing(graph, block, shown, inside)
        yield Diagram(
            kind="ibd",
            name=partitioning.numbered(whole, index, len(parts)),
            frame=plain(f"ibd [{_keyword(graph, block)}] {_title(graph, block)}"),
            heading=("Internal block diagram", whole),
            view=drawing.view(),
            about=block.id,
            footer=plain(partitioning.footer(index, len(parts), whole)),
        )


def _keyword(graph: Graph, block: Element) -> str:
    return " ".join(labels.keywords(graph, _classifier(graph, block)))


def _title(graph: Graph, block: Element) -> str:
    """Name of the block; an instance is told with what classifies it."""
    classifier = _classifier(graph, block)
    if classifier is block:
        return labels.name(block)
    return f"{labels.name(block)} : {labels.name(classifier)}"


def _classifier(graph: Graph, block: Element) -> Element:
    """What has the parts and ports inside the frame: of an instance what classifies it."""
    found = graph.target(block, Edge.INSTANCE_OF) if block.kind is Kind.INSTANCE else None
    return block if found is None else found


def _divided(
    graph: Graph, block: Element, found: list[Connection]
) -> list[tuple[list[Element], list[Connection]]]:
    """Parts that are drawn together, and the connections that leave none of them out.

    A connection between two groups is drawn in both; the foreign part is a neighbour there.
    """
    tops = _top_parts(graph, block, found)
    near: dict[str, list[str]] = {part.id: [] for part in tops}
    for connection in found:
        one, other = connection.source.top, connection.target.top
        if one in near and other in near and one != other:
            near[one].append(other)
            near[other].append(one)
    sizes = {part.id: 1 + _nested_count(part.id, found) for part in tops}
    groups = partitioning.chunks([part.id for part in tops], near, sizes=sizes) or [[]]
    if len(groups) == 1:
        return [(tops, found)]
    return [_group(graph, set(group), tops, found, index) for index, group in enumerate(groups)]


def _group(
    graph: Graph, group: set[str], tops: list[Element], found: list[Connection], index: int
) -> tuple[list[Element], list[Connection]]:
    """One group; what connects the frame with itself stands in the first."""
    inside = [c for c in found if c.tops() & group or (not c.tops() and index == 0)]
    near = {top for connection in inside for top in connection.tops()} | group
    return [part for part in tops if part.id in near], inside


def _nested_count(top: str, found: list[Connection]) -> int:
    paths = (end for connection in found for end in (connection.source, connection.target))
    return len({path.parts for path in paths if path.top == top and len(path.parts) > 1})


def _top_parts(graph: Graph, block: Element, found: list[Connection]) -> list[Element]:
    """Parts and references of the block, with inherited and foreign ones that connectors name."""
    own = list(_properties(graph, block))
    named = [end.top for c in found for end in (c.source, c.target) if end.top]
    wanted = [item for item in own if item.role in _DRAWN_ROLES]
    ids = dict.fromkeys([*(item.id for item in wanted), *named])
    return [graph[id] for id in ids]


def _properties(graph: Graph, block: Element) -> Iterator[Element]:
    """Properties of the block; of an instance all that its classifier has, inherited ones too."""
    if block.kind is not Kind.INSTANCE:
        yield from (item for item in graph.owned(block) if item.kind is Kind.PROPERTY)
        return
    classifier = _classifier(graph, block)
    family = (classifier, *generals(graph, classifier))
    found = [p for one in family for p in graph.owned(one) if p.kind is Kind.PROPERTY]
    gone = {old.id for one in found for old in graph.targets(one, Edge.REDEFINES)}
    yield from (item for item in found if item.id not in gone)


@dataclass(slots=True)
class _Drawing:
    """One internal block diagram in the making."""

    graph: Graph
    block: Element
    tops: list[Element]
    connections: list[Connection]
    aliases: Aliases = field(default_factory=Aliases)
    has_ports: bool = False
    sides: dict[tuple[str, ...], str] = field(default_factory=dict)
    instances: dict[tuple[str, ...], Element] = field(default_factory=dict)
    """Instances with the values of parts, by the parts that lead to them."""

    def __post_init__(self) -> None:
        self.sides = find_port_sides(self.connections)
        self.instances |= {(top.id,): top for top in self.tops if top.kind is Kind.INSTANCE}
        waiting: list[tuple[tuple[str, ...], Element]] = [((), self.block)]
        waiting += self.instances.items()
        for path, owner in waiting:
            for inner in self.graph.owned(owner):
                part = self.graph.target(inner, Edge.REPRESENTS)
                if inner.kind is Kind.INSTANCE and part is not None:
                    self.instances[*path, part.id] = inner
                    waiting.append(((*path, part.id), inner))

    def view(self) -> InternalView:
        parts = tuple(self._part((part.id,), part) for part in self.tops)
        slots = _slots(self.graph, self.block)
        frame = PartView(
            self.aliases.make("frame", self.block.name, "block"),
            stack(_rows(self.graph, slots)) or " ",
            "frame",
            tuple(self._ports((), _classifier(self.graph, self.block))),
            parts,
            (self.block.id, *(slot.id for slot in slots)),
        )
        drawn = tuple(self._line(connection) for connection in self.connections)
        hidden = tuple(iter_port_guides(frame, drawn))
        return InternalView(frame, drawn, self.has_ports, hidden, domains_of(self.connections))

    def _part(self, path: tuple[str, ...], part: Element) -> PartView:
        alias = self.aliases.make(_key(path), part.name, "part")
        inner = tuple(self._part((*path, item.id), item) for item in self._inner(path))
        type_ = self.graph.target(part, _TYPE[part.kind is Kind.INSTANCE])
        instance = self.instances.get(path)
        slots = [] if instance is None else _slots(self.graph, instance)
        rows = _rows(self.graph, slots)
        values = () if instance is None else (instance.id, *(slot.id for slot in slots))
        return PartView(
            alias,
            stack([small(plain(self._words(part))), *bold(_named(self.graph, part)), *rows]),
            _style(part),
            tuple(self._ports(path, type_)),
            inner,
            (part.id, *values),
        )

    def _words(self, part: Element) -> str:
        words = labels.applied(self.graph, part)
        kept = [word for word in words if word not in ("partProperty", "referenceProperty")]
        return labels.guillemets(kept)

    def _inner(self, path: tuple[str, ...]) -> list[Element]:
        """Parts inside the part at ``path`` that a connection names, in order of first use."""
        found: dict[str, None] = {}
        for connection in self.connections:
            for end in (connection.source, connection.target):
                if len(end.parts) > len(path) and end.parts[: len(path)] == path:
                    found[end.parts[len(path)]] = None
        for deep, instance in self.instances.items():
            if len(deep) > len(path) and deep[: len(path)] == path and _slots(self.graph, instance):
                found[deep[len(path)]] = None
        return [self.graph[id] for id in found]

    def _ports(self, path: tuple[str, ...], owner: Element | None) -> Iterator[PortView]:
        """All ports of the part's type, inherited ones too, and what connections name there."""
        every = [port.id for port in _ports_of(self.graph, owner)] if owner is not None else []
        ends = [(end.port,) for end in self._ends(path) if end.port]
        keys = dict.fromkeys([*((id,) for id in every), *ends, *self._nested_ports(path)])
        for key in keys:
            yield self._port(path, key)

    def _ends(self, path: tuple[str, ...]) -> Iterator[Path]:
        for connection in self.connections:
            for end in (connection.source, connection.target):
                if end.parts == path and not end.ports:
                    yield end

    def _nested_ports(self, path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
        for connection in self.connections:
            for end in (connection.source, connection.target):
                if end.parts == path and end.ports:
                    yield (*end.ports, end.port)

    def _port(self, path: tuple[str, ...], key: tuple[str, ...]) -> PortView:
        port = self.graph[key[-1]]
        self.has_ports = True
        shown = ".".join(labels.name(self.graph[id]) for id in key)
        alias = self.aliases.make(_key((*path, *key)), port.name, "port")
        text = shown if port.name.strip() else labels.typed(self.graph, port)
        form = FORMS.get(self._direction(key)) or self.sides.get((*path, *key), "port")
        rows = (f"<back:#FFFFFF>{row}</back>" for row in lines(text, _PORT_WIDTH))
        return PortView(alias, stack(rows), form, key)

    def _direction(self, key: tuple[str, ...]) -> str:
        """Direction of the innermost port; conjugated ones around it turn it round."""
        direction = str(self.graph[key[-1]].attrs.get("direction", ""))
        around = [self.graph[id] for id in key[:-1]]
        is_turned = len([one for one in around if one.attrs.get("conjugated")]) % 2 == 1
        return (opposite(direction) or "") if is_turned else direction

    def _line(self, connection: Connection) -> Line:
        return Line(
            self._end(connection.source),
            connection.arrow,
            self._end(connection.target),
            connection.text(),
            label(connection.near),
            label(connection.far),
            connection.shows,
        )

    def _end(self, path: Path) -> str:
        key = (*path.parts, *path.ports, path.port) if path.port else path.parts
        return self.aliases[_key(key) if key else "frame"]


def _named(graph: Graph, part: Element) -> str:
    return _title(graph, part) if part.kind is Kind.INSTANCE else labels.typed(graph, part)


def _slots(graph: Graph, instance: Element) -> list[Element]:
    return [one for one in graph.owned(instance) if one.kind is Kind.SLOT]


def _rows(graph: Graph, slots: list[Element]) -> list[str]:
    """What the slots say; what one says of a port stands in none of its rows."""
    told = [slot for slot in slots if "value" in slot.attrs]
    return [small(plain(f"{one.name} = {one.attrs['value']}{_unit(graph, one)}")) for one in told]


def _unit(graph: Graph, slot: Element) -> str:
    """The unit of what the slot gives a value to, behind the value."""
    feature = graph.target(slot, Edge.INSTANCE_OF)
    unit = None if feature is None else unit_of(graph, feature)
    return "" if unit is None else f" {unit.attrs.get('symbol') or labels.name(unit)}"


def bold(text: str) -> list[str]:
    """The name of a part in escaped lines."""
    return [f"**{row}**" for row in lines(text)]


def domains_of(drawn: list[Connection]) -> tuple[str, ...]:
    """Domains of what flows in the diagram."""
    return in_order(domain for one in drawn for _, domain in one.carried)


def _key(path: tuple[str, ...]) -> str:
    return "\x1f".join(("part", *path))


def _style(part: Element) -> str:
    is_shared = (
        not part.role
        and part.kind is not Kind.INSTANCE
        and part.attrs.get("aggregation") != "composite"
    )
    return "reference" if is_shared or part.role == "reference" else "part"


def _ports_of(graph: Graph, classifier: Element) -> list[Element]:
    """Ports of a classifier and of what it specialises; a redefined port does not count."""
    found: dict[str, Element] = {}
    seen: dict[str, None] = {}
    queue = [classifier]
    for type_ in queue:
        if type_.id not in seen:
            seen[type_.id] = None
            found |= {p.id: p for p in graph.owned(type_) if _is_port(p)}
            queue.extend(graph.targets(type_, Edge.SPECIALIZES))
    gone = {old.id for port in found.values() for old in graph.targets(port, Edge.REDEFINES)}
    return [port for port in found.values() if port.id not in gone]


def _is_port(item: Element) -> bool:
    return item.kind is Kind.PORT
