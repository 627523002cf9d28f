"""Connections inside a block: connectors with their item flows, and item flows between parts."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.allocations import iter_feature_allocations
from sysmlc.backends.plantuml.relations import conveyed
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import DOMAINS, runs_both_ways
from sysmlc.support.plantuml_text import keyword_label, label, stack


class Path(Struct, frozen=True):
    """Where a connection ends: through ``parts`` and ``ports`` to ``port``.

    All are ids, outermost first. Without a port it ends at the last part, without parts at
    the frame.
    """

    parts: tuple[str, ...] = ()
    ports: tuple[str, ...] = ()
    port: str = ""

    @property
    def top(self) -> str:
        """Id of the part of the frame's block that the path leads into, or nothing."""
        return self.parts[0] if self.parts else ""

    def ids(self) -> tuple[str, ...]:
        """Everything on the path."""
        return (*self.parts, *self.ports, *([self.port] if self.port else []))


class Connection(Struct, frozen=True):
    """One line of an internal block diagram; ``shows`` are the ids that it stands for.

    ``carried`` are the items that flow over it, each with its domain or the empty text.
    """

    source: Path
    target: Path
    arrow: str
    label: str = ""
    near: str = ""
    far: str = ""
    shows: tuple[str, ...] = ()
    carried: tuple[tuple[str, str], ...] = ()

    def tops(self) -> set[str]:
        """Ids of the parts of the frame's block that it connects."""
        return {end.top for end in (self.source, self.target) if end.top}

    def text(self) -> str:
        """What stands at the line, as PlantUML text."""
        rows = [coloured(label(text), domain) for text, domain in self.carried]
        return stack([keyword_label(self.label), *rows])


FreeFlow = tuple[str, str, str]
"""Ids of flow, source and target."""


def connections(graph: Graph, block: Element, flows: Iterable[FreeFlow]) -> list[Connection]:
    """Connectors of the block; item flows without a connector and allocations between features.

    ``flows`` are those of the block (``free_flows``), for they are few and blocks are many.
    What is bound to a constraint parameter stands in the parametric diagram.
    """
    owned = [item for item in graph.owned(block) if item.kind is Kind.CONNECTOR]
    drawn = [made for item in owned for made in _connector(graph, item)]
    free = [_free_flow(graph, *map(graph.__getitem__, ends)) for ends in flows]
    return [*drawn, *free, *_allocations(graph, block)]


def _connector(graph: Graph, connector: Element) -> Iterator[Connection]:
    """One line, or as many as join the first end to all others (UML 2.5.1 clause 11.2.3)."""
    if is_parametric(graph, connector):
        return
    ends = graph.targets(connector, Edge.END)
    known = [(end, path) for end in ends if (path := path_of(graph, end)) is not None]
    if len(known) == len(ends) == 2:
        yield _line(graph, connector, known)
    elif len(known) > 2:
        yield from (_line(graph, connector, [known[0], other]) for other in known[1:])


def _line(graph: Graph, connector: Element, joined: list[tuple[Element, Path]]) -> Connection:
    (near, first), (far, second) = joined
    flows = graph.sources(connector, Edge.REALIZING)
    ways = [_way(graph, flow, first, second) for flow in flows]
    aims = {"→": _end_name(graph, second), "←": _end_name(graph, first)}
    rows = [
        (_row(conveyed(graph, flow), way, aims, is_both=len(set(ways)) > 1), _domain(flow))
        for way, flow in zip(ways, flows, strict=True)
    ]
    ends = graph.targets(connector, Edge.END)
    return Connection(
        first,
        second,
        styled(_arrow(connector, ways), _domain(connector)),
        _name(graph, connector),
        labels.multiplicity(near),
        labels.multiplicity(far),
        (connector.id, *(end.id for end in ends), *(flow.id for flow in flows)),
        tuple(row for row in rows if row[0]),
    )


def _domain(relation: Element) -> str:
    return str(relation.attrs.get("domain", ""))


def _end_name(graph: Graph, path: Path) -> str:
    return graph[path.ids()[-1]].name


def _row(text: str, way: str, aims: Mapping[str, str], is_both: bool) -> str:
    """One way is told by the arrow head; two ways need the end that each flow runs to.

    A layout may draw either end on the left, so that an arrow sign alone would mislead.
    """
    return f"to {aims[way]}: {text}" if is_both and way in aims else text


def is_parametric(graph: Graph, connector: Element) -> bool:
    """Whether the connector has an end at a constraint parameter."""
    ends = graph.targets(connector, Edge.END)
    roles = (role for end in ends for role in graph.targets(end, Edge.ROLE))
    return any(role.role == "constraint parameter" for role in roles)


def path_of(graph: Graph, end: Element) -> Path | None:
    """Where a connector end is, seen from the connector's owner; None when nothing is there.

    What is inside a port (a flow property of its type) is drawn as that port's inner one.
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


def _name(graph: Graph, connector: Element) -> str:
    if connector.role == "binding connector":
        return "="
    type_ = labels.type_name(graph, connector)
    words = labels.guillemets(labels.applied(graph, connector))
    text = f"{connector.name} : {type_}".strip() if type_ else connector.name
    return " ".join(part for part in (words, text) if part)


def _arrow(connector: Element, ways: list[str]) -> str:
    if connector.role == "binding connector":
        return "-[dashed]-"
    tail = "<" if "←" in ways or "⇄" in ways else ""
    tip = ">" if "→" in ways or "⇄" in ways else ""
    return f"{tail}--{tip}"


def _way(graph: Graph, flow: Element, first: Path, second: Path) -> str:
    """``→`` when the flow runs from the first end to the second, ``←`` back, ``⇄`` both ways.

    ``↔`` when that is not known.
    """
    sources = {item.id for item in graph.targets(flow, Edge.FLOW_SOURCE)}
    targets = {item.id for item in graph.targets(flow, Edge.FLOW_TARGET)}
    if runs_both_ways(graph, flow):
        return "⇄"
    forward = _fits(graph, first, sources) + _fits(graph, second, targets)
    back = _fits(graph, second, sources) + _fits(graph, first, targets)
    if forward == back:
        return "↔"
    return "→" if forward > back else "←"


def _fits(graph: Graph, path: Path, named: set[str]) -> int:
    """2 if the flow names something on the path, 1 if it names a type of something there."""
    if named & set(path.ids()):
        return 2
    steps = [graph[id] for id in path.ids()]
    types = {type_.id for step in steps for type_ in graph.targets(step, Edge.TYPED_BY)}
    return 1 if named & types else 0


def free_flows(graph: Graph) -> dict[str, tuple[FreeFlow, ...]]:
    """Item flows that no connector realises, by what owns both the features that they join."""
    found: dict[str, list[FreeFlow]] = {}
    for flow in graph.of_kind(Kind.ITEM_FLOW):
        if graph.targets(flow, Edge.REALIZING):
            continue
        for source in graph.targets(flow, Edge.FLOW_SOURCE):
            for target in graph.targets(flow, Edge.FLOW_TARGET):
                if source.owner is not None and source.owner == target.owner:
                    found.setdefault(source.owner, []).append((flow.id, source.id, target.id))
    return {owner: tuple(flows) for owner, flows in found.items()}


def _free_flow(graph: Graph, flow: Element, source: Element, target: Element) -> Connection:
    carried = ((conveyed(graph, flow), _domain(flow)),)
    arrow = styled("..>", _domain(flow))
    ends = (_direct(source), _direct(target))
    return Connection(*ends, arrow, "«flow»", shows=(flow.id,), carried=carried)


def _allocations(graph: Graph, block: Element) -> Iterator[Connection]:
    for dependency, client, supplier in iter_feature_allocations(graph, block):
        text = " ".join(part for part in ("«allocate»", dependency.name) if part)
        yield Connection(_direct(client), _direct(supplier), "..>", text, shows=(dependency.id,))


def _direct(feature: Element) -> Path:
    return Path(port=feature.id) if _is_port(feature) else Path((feature.id,))


# The template gives these PlantUML variables their colours and line styles; a name of the model
# never has a ``$`` that is not escaped.


def styled(arrow: str, domain: str) -> str:
    """The arrow in the style of a domain; one that has a style of its own stays."""
    if domain not in DOMAINS or "[" in arrow:
        return arrow
    for sign in ("-", "."):
        if sign * 2 in arrow:
            return arrow.replace(sign * 2, f"{sign}[${domain}_line]{sign}", 1)
    return arrow


def coloured(row: str, domain: str) -> str:
    """Escaped text in the colour of a domain."""
    return f"<color:${domain}>{row}</color>" if domain in DOMAINS else row


def in_order(found: Iterable[str]) -> tuple[str, ...]:
    """The domains among these, each once, as legends list them."""
    there = set(found)
    return tuple(domain for domain in DOMAINS if domain in there)
