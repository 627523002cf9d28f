"""Connections inside a block: connectors with their item flows, and item flows between parts.

Physical items and information have different arrows and colours (thesis 3.4.1).
"""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.relations import format_conveyed, iter_feature_allocations
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import DOMAINS, generals, runs_both_ways
from sysmlc.support.plantuml_text import format_keyword_label, format_label, join_rows


class Path(Struct, frozen=True):
    """The path from the frame to the end of a connection, as ids, outermost first.

    It leads through ``parts``, then through the outer ``ports`` of a nested port, to ``port``. A
    path without ``port`` ends at the last part; a port without ``parts`` is on the frame.
    """

    parts: tuple[str, ...] = ()
    ports: tuple[str, ...] = ()
    port: str = ""

    @property
    def top(self) -> str:
        """The id of the outermost part, or an empty text for a port of the frame."""
        return self.parts[0] if self.parts else ""

    def ids(self) -> tuple[str, ...]:
        """Return all ids on the path."""
        return (*self.parts, *self.ports, *([self.port] if self.port else []))


class Connection(Struct, frozen=True):
    """One line of an internal block diagram; ``shows`` are the ids of its elements.

    ``near`` and ``far`` are the multiplicities at source and target. ``carried`` are the items that
    flow over the line, each with its domain or an empty text.
    """

    source: Path
    target: Path
    arrow: str
    label: str = ""
    near: str = ""
    far: str = ""
    shows: tuple[str, ...] = ()
    carried: tuple[tuple[str, str], ...] = ()

    def find_top_parts(self) -> set[str]:
        """Return the ids of the outermost parts of both ends."""
        return {end.top for end in (self.source, self.target) if end.top}

    def format_label(self) -> str:
        """Return the label of the line as PlantUML text."""
        rows = [_color_text(format_label(text), domain) for text, domain in self.carried]
        return join_rows([format_keyword_label(self.label), *rows])


FreeFlow = tuple[str, str, str]
"""Ids of flow, source and target."""


def list_connections(graph: Graph, block: Element, flows: Iterable[FreeFlow]) -> list[Connection]:
    """Return the lines of an internal block diagram of the block.

    These are its connectors, its item flows without a connector (*flows*, see ``find_free_flows``)
    and allocations between its features. Bindings to constraint parameters are omitted, because the
    parametric diagram shows them.
    """
    members = [item for item in graph.owned(block) if item.kind is Kind.CONNECTOR]
    connectors = [
        connection for item in members for connection in _iter_connector_lines(graph, item)
    ]
    free_connections = [
        _make_free_connection(graph, graph[flow], graph[source], graph[target])
        for flow, source, target in flows
    ]
    return [*connectors, *free_connections, *_iter_allocations(graph, block)]


def find_classifier(graph: Graph, block: Element) -> Element:
    """Return the owner of the drawn parts: the classifier of an instance, else the block itself.

    That of a usage of SysML v2 is the usage that it specialises, before its definitions.
    """
    targets = graph.targets(block, Edge.INSTANCE_OF) if block.kind is Kind.INSTANCE else []
    usages = [target for target in targets if target.attrs.get("usage")]
    return next(iter([*usages, *targets]), block)


def list_bases(graph: Graph, block: Element) -> list[Element]:
    """Return the elements whose parts and connectors a block inherits, nearest first.

    The classifier of an instance is none, except for a usage of SysML v2 without own members.
    """
    classifier = find_classifier(graph, block)
    if classifier is block:
        return generals(graph, block)
    return [classifier, *generals(graph, classifier)] if classifier.attrs.get("usage") else []


def inherit_connections(
    graph: Graph, block: Element, bases: list[Element], flows: dict[str, tuple[FreeFlow, ...]]
) -> list[Connection]:
    """Return the connections of *bases* as the block inherits them, with ``^`` before their names.

    They lead to the features that redefine those of the base; *flows* are item flows by owner.
    """
    redefining = {
        old.id: new.id
        for element in (*reversed(bases), block)
        for new in graph.owned(element)
        for old in graph.targets(new, Edge.REDEFINES)
    }
    connections = [
        connection
        for base in bases
        if not base.attrs.get("external")
        for connection in list_connections(graph, base, flows.get(base.id, ()))
    ]
    return [
        replace(
            connection,
            source=_redefine(connection.source, redefining),
            target=_redefine(connection.target, redefining),
            label=f"^{connection.label}",
        )
        for connection in connections
        if connection.shows[0] not in redefining
    ]


def _redefine(path: Path, redefining: dict[str, str]) -> Path:
    """Return a path that starts at the feature which redefines its first one."""
    first = path.ids()[0]
    last, visited = first, {first}
    while last in redefining and redefining[last] not in visited:
        last = redefining[last]
        visited.add(last)
    if path.parts:
        return replace(path, parts=(last, *path.parts[1:]))
    if path.ports:
        return replace(path, ports=(last, *path.ports[1:]))
    return replace(path, port=last)


def _iter_connector_lines(graph: Graph, connector: Element) -> Iterator[Connection]:
    """Yield the line of a connector.

    A connector with more than two ends (UML 2.5.1 clause 11.2.3) has a line from its first end to
    each other end.
    """
    if is_parametric(graph, connector):
        return
    ends = graph.targets(connector, Edge.END)
    located = [(end, path) for end in ends if (path := path_of(graph, end)) is not None]
    if len(located) == len(ends) == 2:
        yield _make_line(graph, connector, located)
    elif len(located) > 2:
        for end_and_path in located[1:]:
            yield _make_line(graph, connector, [located[0], end_and_path])


def _make_line(graph: Graph, connector: Element, located: list[tuple[Element, Path]]) -> Connection:
    (near, first), (far, second) = located
    flows = graph.sources(connector, Edge.REALIZING)
    directions = [_find_direction(graph, flow, first, second) for flow in flows]
    names_of_ends = {}
    if len(set(directions)) > 1:
        names_of_ends = dict(zip("→←", _name_ends(graph, second, first), strict=True))
    rows = [
        (_format_item(format_conveyed(graph, flow), names_of_ends.get(direction)), _domain_of(flow))
        for direction, flow in zip(directions, flows, strict=True)
    ]
    ends = graph.targets(connector, Edge.END)
    return Connection(
        first,
        second,
        style_arrow(_choose_arrow(connector, directions), _domain_of(connector)),
        _format_name(graph, connector),
        labels.multiplicity(near),
        labels.multiplicity(far),
        (connector.id, *(end.id for end in ends), *(flow.id for flow in flows)),
        tuple(row for row in rows if row[0]),
    )


def _domain_of(relation: Element) -> str:
    return str(relation.attrs.get("domain", ""))


def _name_ends(graph: Graph, *paths: Path) -> list[str]:
    """Return the names of the ends of a line: their full paths if the last names are equal."""
    names = [graph[path.ids()[-1]].name for path in paths]
    if len(set(names)) == len(names):
        return names
    return [".".join(graph[id].name for id in path.ids()) for path in paths]


def _format_item(text: str, target_name: str | None) -> str:
    """Return the text of an item flow.

    If the connector has flows in both directions, *target_name* is the end to which the item flows.
    An arrow sign would mislead, because the layout may draw either end on the left.
    """
    return text if target_name is None else f"to {target_name}: {text}"


def is_parametric(graph: Graph, connector: Element) -> bool:
    """Whether the connector has an end at a constraint parameter."""
    ends = graph.targets(connector, Edge.END)
    roles = (role for end in ends for role in graph.targets(end, Edge.ROLE))
    return any(role.role == "constraint parameter" for role in roles)


def path_of(graph: Graph, end: Element) -> Path | None:
    """Return the path from the owner of the connector to its end, or None for an end without role.

    A flow property inside a port is drawn as an inner port.
    """
    role = graph.target(end, Edge.ROLE)
    if role is None:
        return None
    steps = graph.targets(end, Edge.PATH)
    parts = tuple(step.id for step in steps if not _is_port(step))
    ports = tuple(step.id for step in steps if _is_port(step))
    if ports or _is_port(role):
        return Path(parts, ports, role.id)
    return Path((*parts, role.id))


def _is_port(item: Element) -> bool:
    return item.kind is Kind.PORT or item.role == "constraint parameter"


def _format_name(graph: Graph, connector: Element) -> str:
    if connector.role == "binding connector":
        return "="
    type_ = labels.type_name(graph, connector)
    words = labels.guillemets(labels.list_stereotypes(graph, connector))
    text = f"{connector.name} : {type_}".strip() if type_ else connector.name
    return " ".join(part for part in (words, text) if part)


def _choose_arrow(connector: Element, directions: list[str]) -> str:
    if connector.role == "binding connector":
        return "-[dashed]-"
    tail = "<" if "←" in directions or "⇄" in directions else ""
    tip = ">" if "→" in directions or "⇄" in directions else ""
    return f"{tail}--{tip}"


def _find_direction(graph: Graph, flow: Element, first: Path, second: Path) -> str:
    """Return the direction of an item flow along a connector from *first* to *second*.

    ``→`` leads to the second end, ``←`` to the first, ``⇄`` in both directions; ``↔`` is an unknown
    direction.
    """
    sources = {item.id for item in graph.targets(flow, Edge.FLOW_SOURCE)}
    targets = {item.id for item in graph.targets(flow, Edge.FLOW_TARGET)}
    if runs_both_ways(graph, flow):
        return "⇄"
    # Tools let a flow refer to parts, ports or only to their types; exact matches weigh more.
    forward = _count_matches(graph, first, sources) + _count_matches(graph, second, targets)
    back = _count_matches(graph, second, sources) + _count_matches(graph, first, targets)
    if forward == back:
        return "↔"
    return "→" if forward > back else "←"


def _count_matches(graph: Graph, path: Path, ids: set[str]) -> int:
    """Return how well *ids*, the ends of a flow, match the path.

    2: they contain an element of the path; 1: they contain the type of such an element; 0: neither.
    """
    if ids & set(path.ids()):
        return 2
    steps = [graph[id] for id in path.ids()]
    types = {type_.id for step in steps for type_ in graph.targets(step, Edge.TYPED_BY)}
    return 1 if ids & types else 0


def find_free_flows(graph: Graph) -> dict[str, tuple[FreeFlow, ...]]:
    """Return the item flows without a connector, by the owner of both their ends.

    A flow within an interface is between the features of two ports, which no block owns together.
    """
    flows_by_owner: dict[str, list[FreeFlow]] = {}
    for flow in graph.of_kind(Kind.ITEM_FLOW):
        if graph.targets(flow, Edge.REALIZING) or is_within_association(graph, flow):
            continue
        for source in graph.targets(flow, Edge.FLOW_SOURCE):
            for target in graph.targets(flow, Edge.FLOW_TARGET):
                if source.owner is not None and source.owner == target.owner:
                    flows_by_owner.setdefault(source.owner, []).append(
                        (flow.id, source.id, target.id)
                    )
    return {owner: tuple(flows) for owner, flows in flows_by_owner.items()}


def is_within_association(graph: Graph, flow: Element) -> bool:
    """Whether an association owns the flow, as an interface or connection definition does."""
    owner = graph.owner(flow)
    return owner is not None and owner.kind is Kind.ASSOCIATION


def _make_free_connection(
    graph: Graph, flow: Element, source: Element, target: Element
) -> Connection:
    carried = ((format_conveyed(graph, flow), _domain_of(flow)),)
    arrow = style_arrow("..>", _domain_of(flow))
    ends = (_make_direct_path(source), _make_direct_path(target))
    return Connection(*ends, arrow, "«flow»", shows=(flow.id,), carried=carried)


def _iter_allocations(graph: Graph, block: Element) -> Iterator[Connection]:
    for dependency, client, supplier in iter_feature_allocations(graph, block):
        text = " ".join(part for part in ("«allocate»", dependency.name) if part)
        yield Connection(
            _make_direct_path(client),
            _make_direct_path(supplier),
            "..>",
            text,
            shows=(dependency.id,),
        )


def _make_direct_path(feature: Element) -> Path:
    return Path(port=feature.id) if _is_port(feature) else Path((feature.id,))


# -- colours and line styles -------------------------------------------------------------------

# Arrows and labels refer to variables of PlantUML (``$physical_line``), which the template defines.
# A name of the model cannot refer to them, because ``$`` is escaped in names.


def style_arrow(arrow: str, domain: str) -> str:
    """Return the arrow in the style of a domain; an arrow with a style of its own is unchanged."""
    if domain not in DOMAINS or "[" in arrow:
        return arrow
    # PlantUML reads the style between the two signs of a line: ``-[$physical_line]-``.
    for sign in ("-", "."):
        if sign * 2 in arrow:
            return arrow.replace(sign * 2, f"{sign}[${domain}_line]{sign}", 1)
    return arrow


def _color_text(row: str, domain: str) -> str:
    """Return escaped text in the colour of a domain."""
    return f"<color:${domain}>{row}</color>" if domain in DOMAINS else row


def sort_domains(domains: Iterable[str]) -> tuple[str, ...]:
    """Return these domains, each once, in the order of legends."""
    present = set(domains)
    return tuple(domain for domain in DOMAINS if domain in present)
