"""Internal block diagrams: one for each block with connectors or item flows between its parts.

Inherited parts and connections are drawn, too, with ``^`` before their names (UML 2.5.1, 9.2.4).
There is also a diagram for each instance, and for each instance hierarchy of AutomationML, that has
connections between its instances.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.connections import (
    Connection,
    FreeFlow,
    find_classifier,
    find_free_flows,
    inherit_connections,
    list_bases,
    list_connections,
    sort_domains,
)
from sysmlc.backends.plantuml.layout import find_port_sides, iter_port_guides
from sysmlc.backends.plantuml.views import Aliases, Diagram, InternalView, Line, PartView, PortView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import generals, opposite
from sysmlc.ir.query.classifiers import name_value_unit, unit_of
from sysmlc.support.plantuml_text import escape_line, format_label, join_rows, shrink, wrap_lines

FORMS = {"in": "portin", "out": "portout"}
"""PlantUML's keyword for a port, by direction: ``portin`` stands on the left."""
_CLASSES = (Kind.CLASS, Kind.COMPONENT)
_DRAWN_ROLES = frozenset(["part", "reference"])
_PORT_WIDTH = 24
_TYPE = (Edge.TYPED_BY, Edge.INSTANCE_OF)
"""The edge to the type: of a part, and of an instance that is drawn as a part."""


def draw_internal_blocks(graph: Graph) -> Iterator[Diagram]:
    """Yield all internal block diagrams, in the order of the model."""
    hierarchies = (p for p in graph.of_kind(Kind.PACKAGE) if p.subkind == "instance-hierarchy")
    flows = find_free_flows(graph)
    with_connections = _find_blocks_with_connections(graph, flows)
    for block in (*graph.of_kind(*_CLASSES, Kind.INSTANCE), *hierarchies):
        if block.id in with_connections:
            yield from _draw_block(graph, block, flows)


def _find_blocks_with_connections(graph: Graph, flows: Iterable[str]) -> set[str]:
    """Return the ids of the elements that may own or inherit lines of a diagram.

    *flows* are the owners of item flows without a connector. The generals of every block need not
    be listed, which takes quadratic time in a long chain of specialisations.
    """
    allocations = (item for item in graph.of_kind(Kind.DEPENDENCY) if item.role == "allocate")
    clients = (client for item in allocations for client in graph.targets(item, Edge.CLIENT))
    owned_lines = (*graph.of_kind(Kind.CONNECTOR), *clients)
    worklist = [*flows, *(item.owner for item in owned_lines if item.owner is not None)]
    reached = set(worklist)
    while worklist:
        owner = graph[worklist.pop()]
        for edge in (Edge.SPECIALIZES, Edge.INSTANCE_OF):
            heirs = {heir.id for heir in graph.sources(owner, edge)} - reached
            reached |= heirs
            worklist += heirs
    return reached


def _draw_block(
    graph: Graph, block: Element, flows: dict[str, tuple[FreeFlow, ...]]
) -> Iterator[Diagram]:
    block_connections = list_connections(graph, block, flows.get(block.id, ()))
    block_connections += inherit_connections(graph, block, list_bases(graph, block), flows)
    if not block_connections or block.attrs.get("external"):
        return
    title = graph.qualified_name(block)
    parts = _partition(graph, block, block_connections)
    keywords = " ".join(labels.keywords(graph, find_classifier(graph, block)))
    for index, (shown, inside) in enumerate(parts):
        drawing = _InternalBlockDrawing(graph, block, shown, inside)
        diagram = Diagram(
            kind="ibd",
            name=title,
            frame=escape_line(f"ibd [{keywords}] {_format_title(graph, block)}"),
            heading=("Internal block diagram", title),
            view=drawing.build_view(),
            about=block.id,
        )
        yield partitioning.name_part(diagram, index, len(parts))


def _format_title(graph: Graph, block: Element) -> str:
    """Return the name of the block, or ``name : Classifier`` of an instance."""
    classifier = find_classifier(graph, block)
    if classifier is block:
        return labels.name(block)
    return f"{labels.name(block)} : {labels.name(classifier)}"


def _partition(
    graph: Graph, block: Element, block_connections: list[Connection]
) -> list[tuple[list[Element], list[Connection]]]:
    """Return groups of parts, each with all connections of its parts.

    A connection between two groups is drawn in both diagrams, and each shows the part of the other
    group at the end of the line.
    """
    tops = _list_top_parts(graph, block, block_connections)
    adjacency: dict[str, list[str]] = {part.id: [] for part in tops}
    for connection in block_connections:
        source, target = connection.source.top, connection.target.top
        if source in adjacency and target in adjacency and source != target:
            adjacency[source].append(target)
            adjacency[target].append(source)
    # A part fills the diagram with its nested parts, so they count, too.
    sizes = {part.id: 1 + _count_nested_parts(part.id, block_connections) for part in tops}
    groups = partitioning.partition([part.id for part in tops], adjacency, sizes=sizes) or [[]]
    if len(groups) == 1:
        return [(tops, block_connections)]
    parts = []
    for index, group in enumerate(groups):
        inside = []
        for connection in block_connections:
            ends = connection.find_top_parts()
            # The first group also has the connections that lead from the frame to the frame.
            if not ends.isdisjoint(group) or (index == 0 and not ends):
                inside.append(connection)
        connected = {top for connection in inside for top in connection.find_top_parts()}
        connected.update(group)
        parts.append(([part for part in tops if part.id in connected], inside))
    return parts


def _count_nested_parts(top: str, block_connections: list[Connection]) -> int:
    paths = (
        end for connection in block_connections for end in (connection.source, connection.target)
    )
    return len({path.parts for path in paths if path.top == top and len(path.parts) > 1})


def _list_top_parts(
    graph: Graph, block: Element, block_connections: list[Connection]
) -> list[Element]:
    """Return the parts and references of the block.

    Inherited parts, and parts of other blocks, are included if a connection leads to them.
    """
    properties = list(_iter_properties(graph, block))
    connected = [end.top for c in block_connections for end in (c.source, c.target) if end.top]
    drawn = [item for item in properties if item.role in _DRAWN_ROLES]
    ids = dict.fromkeys([*(item.id for item in drawn), *connected])
    return [graph[id] for id in ids]


def _iter_properties(graph: Graph, block: Element) -> Iterator[Element]:
    """Yield the own and inherited properties of the block, or of the classifier of an instance."""
    classifier = find_classifier(graph, block)
    family = (classifier, *generals(graph, classifier))
    properties = [p for item in family for p in graph.owned(item) if p.kind is Kind.PROPERTY]
    redefined = {old.id for new in properties for old in graph.targets(new, Edge.REDEFINES)}
    yield from (item for item in properties if item.id not in redefined)


@dataclass(slots=True)
class _InternalBlockDrawing:
    """Builder of the view of one internal block diagram."""

    graph: Graph
    block: Element
    tops: list[Element]
    connections: list[Connection]
    aliases: Aliases = field(default_factory=Aliases)
    has_ports: bool = False
    sides: dict[tuple[str, ...], str] = field(default_factory=dict)
    instances: dict[tuple[str, ...], Element] = field(default_factory=dict)
    """Instances whose slots have the values of a part, by the path to the part."""

    def __post_init__(self) -> None:
        self.sides = find_port_sides(self.connections)
        self.instances |= {(top.id,): top for top in self.tops if top.kind is Kind.INSTANCE}
        worklist: list[tuple[tuple[str, ...], Element]] = [((), self.block)]
        worklist += self.instances.items()
        # The loop also visits the entries that its body appends.
        for path, owner in worklist:
            for inner in self.graph.owned(owner):
                part = self.graph.target(inner, Edge.REPRESENTS)
                if inner.kind is Kind.INSTANCE and part is not None:
                    self.instances[*path, part.id] = inner
                    worklist.append(((*path, part.id), inner))

    def build_view(self) -> InternalView:
        parts = tuple(self._make_part((part.id,), part) for part in self.tops)
        slots = _list_slots(self.graph, self.block)
        frame = PartView(
            self.aliases.make((), self.block.name, "block"),
            join_rows(_format_slots(self.graph, slots)) or " ",
            "frame",
            tuple(self._iter_ports((), find_classifier(self.graph, self.block))),
            parts,
            (self.block.id, *(slot.id for slot in slots)),
        )
        lines = tuple(
            make_line(self.aliases[c.source.ids()], self.aliases[c.target.ids()], c)
            for c in self.connections
        )
        hidden = tuple(iter_port_guides(frame, lines))
        return InternalView(frame, lines, self.has_ports, hidden, domains_of(self.connections))

    def _make_part(self, path: tuple[str, ...], part: Element) -> PartView:
        alias = self.aliases.make(path, part.name, "part")
        inner = tuple(
            self._make_part((*path, item.id), item) for item in self._list_inner_parts(path)
        )
        type_ = self.graph.target(part, _TYPE[part.kind is Kind.INSTANCE])
        instance = self.instances.get(path)
        slots = [] if instance is None else _list_slots(self.graph, instance)
        rows = _format_slots(self.graph, slots)
        values = () if instance is None else (instance.id, *(slot.id for slot in slots))
        return PartView(
            alias,
            join_rows(
                [
                    shrink(escape_line(self._format_stereotypes(part))),
                    *embolden(self._format_part(path, part)),
                    *rows,
                ]
            ),
            _choose_style(part),
            tuple(self._iter_ports(path, type_)),
            inner,
            (part.id, *values),
        )

    def _format_part(self, path: tuple[str, ...], part: Element) -> str:
        if part.kind is Kind.INSTANCE:
            return _format_title(self.graph, part)
        bases = list_bases(self.graph, self.block)
        is_inherited = len(path) == 1 and self.graph.owner(part) in bases
        return "^" * is_inherited + labels.format_typed(self.graph, part)

    def _format_stereotypes(self, part: Element) -> str:
        words = labels.list_stereotypes(self.graph, part)
        # Tools apply these stereotypes to every part: solid and dashed borders show the difference.
        shown = [word for word in words if word not in ("partProperty", "referenceProperty")]
        return labels.guillemets(shown)

    def _list_inner_parts(self, path: tuple[str, ...]) -> list[Element]:
        """Return the parts inside the part at *path* to show: those with connections or values.

        The order is that of their first use.
        """
        ids: dict[str, None] = {}
        for connection in self.connections:
            for end in (connection.source, connection.target):
                if len(end.parts) > len(path) and end.parts[: len(path)] == path:
                    ids[end.parts[len(path)]] = None
        for instance_path, instance in self.instances.items():
            if (
                len(instance_path) > len(path)
                and instance_path[: len(path)] == path
                and _list_slots(self.graph, instance)
            ):
                ids[instance_path[len(path)]] = None
        return [self.graph[id] for id in ids]

    def _iter_ports(self, path: tuple[str, ...], owner: Element | None) -> Iterator[PortView]:
        """Yield the ports of *owner*, the type of the part at *path*.

        Inherited ports are included, and further ports at which connections end.
        """
        type_ports = (
            [port.id for port in _list_ports(self.graph, owner)] if owner is not None else []
        )
        ends = [
            (*end.ports, end.port)
            for connection in self.connections
            for end in (connection.source, connection.target)
            if end.parts == path and (end.ports or end.port)
        ]
        # Ports inside other ports come last.
        keys = dict.fromkeys(
            [*((id,) for id in type_ports), *sorted(ends, key=lambda key: len(key) > 1)]
        )
        for key in keys:
            yield self._make_port(path, key)

    def _make_port(self, path: tuple[str, ...], key: tuple[str, ...]) -> PortView:
        port = self.graph[key[-1]]
        self.has_ports = True
        dotted_name = ".".join(labels.name(self.graph[id]) for id in key)
        alias = self.aliases.make((*path, *key), port.name, "port")
        text = dotted_name if port.name.strip() else labels.format_typed(self.graph, port)
        form = FORMS.get(self._find_direction(key)) or self.sides.get((*path, *key), "port")
        # The name lies on the border of the part; white hides the border behind it (decision 10).
        rows = (f"<back:#FFFFFF>{row}</back>" for row in wrap_lines(text, _PORT_WIDTH))
        return PortView(alias, join_rows(rows), form, key)

    def _find_direction(self, key: tuple[str, ...]) -> str:
        """Return the direction of the innermost port; each outer conjugated port reverses it."""
        direction = str(self.graph[key[-1]].attrs.get("direction", ""))
        outer_ports = [self.graph[id] for id in key[:-1]]
        is_turned = len([port for port in outer_ports if port.attrs.get("conjugated")]) % 2 == 1
        return (opposite(direction) or "") if is_turned else direction


def make_line(source: str, target: str, connection: Connection) -> Line:
    """Return the line of a connection between two aliases."""
    near, far = format_label(connection.near), format_label(connection.far)
    return Line(
        source, connection.arrow, target, connection.format_label(), near, far, connection.shows
    )


def _list_slots(graph: Graph, instance: Element) -> list[Element]:
    return [member for member in graph.owned(instance) if member.kind is Kind.SLOT]


def _format_slots(graph: Graph, slots: list[Element]) -> list[str]:
    """Return the rows of the slots that have a value."""
    slots_with_value = [slot for slot in slots if "value" in slot.attrs]
    return [
        shrink(escape_line(f"{slot.name} = {slot.attrs['value']}{_format_unit(graph, slot)}"))
        for slot in slots_with_value
    ]


def _format_unit(graph: Graph, slot: Element) -> str:
    """Return the unit of the slot's value, else of its feature, with a leading blank."""
    own_unit = name_value_unit(graph, slot, "value")
    if own_unit:
        return f" {own_unit}"
    feature = graph.target(slot, Edge.INSTANCE_OF)
    unit = None if feature is None else unit_of(graph, feature)
    return "" if unit is None else f" {unit.attrs.get('symbol') or labels.name(unit)}"


def embolden(text: str) -> list[str]:
    """Return escaped lines in bold type."""
    return [f"**{row}**" for row in wrap_lines(text)]


def domains_of(lines: list[Connection]) -> tuple[str, ...]:
    """Return the domains of the items that flow in the diagram."""
    return sort_domains(domain for connection in lines for _, domain in connection.carried)


def _choose_style(part: Element) -> str:
    is_shared = (
        not part.role
        and part.kind is not Kind.INSTANCE
        and part.attrs.get("aggregation") != "composite"
    )
    return "reference" if is_shared or part.role == "reference" else "part"


def _list_ports(graph: Graph, classifier: Element) -> list[Element]:
    """Return the ports of a classifier and of its generalizations, without redefined ports."""
    ports: dict[str, Element] = {}
    visited: dict[str, None] = {}
    # The loop visits the types that its body appends: breadth first, each once, also in a cycle.
    queue = [classifier]
    for type_ in queue:
        if type_.id not in visited:
            visited[type_.id] = None
            ports |= {p.id: p for p in graph.owned(type_) if p.kind is Kind.PORT}
            queue.extend(graph.targets(type_, Edge.SPECIALIZES))
    redefined = {old.id for port in ports.values() for old in graph.targets(port, Edge.REDEFINES)}
    return [port for port in ports.values() if port.id not in redefined]
