"""Pass ``flows``: item flows on connectors, and what connectors and flows must agree on."""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import (
    conforms,
    connectors_of,
    domain_of,
    end_direction,
    ends,
    flow_properties,
    flow_source,
    flow_target,
    generals,
    is_boundary,
    opposite,
    role_of,
    type_of,
)
from sysmlc.passes.flows.paths import check_paths
from sysmlc.passes.flows.rules import (
    CONNECTOR_DIRECTIONS,
    CONNECTOR_TYPES,
    FLOW_AGAINST_PORT,
    FLOW_BESIDE_CONNECTOR,
    FLOW_ITEM,
    FLOW_OF_NOTHING,
    FLOW_WITHOUT_END,
    MIXED_DOMAINS,
)


class Flows(Struct, frozen=True):
    """Attach item flows to connectors and give both a domain.

    Assumes directions of ports. Guarantees: an item flow that names no connector is
    ``realizing`` the one connector between its source and its target, if there is exactly
    one; ``domain`` of item flows and connectors is that of what they convey, where it is the
    same for all. Nothing is repaired: what does not fit is reported.
    """

    name: ClassVar[str] = "flows"
    after: ClassVar[tuple[str, ...]] = ("ports",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Attach in place and report; see the class."""
        for flow in graph.of_kind(Kind.ITEM_FLOW):
            _attach(graph, flow)
            _give_domain(graph, flow)
            _check_flow(graph, sink, flow)
        for connector in graph.of_kind(Kind.CONNECTOR):
            _settle_domain(graph, sink, connector)
            _check_connector(graph, sink, connector)
            check_paths(graph, sink, connector)


# -- item flows --------------------------------------------------------------------------------


def _attach(graph: Graph, flow: Element) -> None:
    source, target = flow_source(graph, flow), flow_target(graph, flow)
    if source is None or target is None or graph.target(flow, Edge.REALIZING) is not None:
        return
    there = {one.id for one in connectors_of(graph, target)}
    joining = [one for one in connectors_of(graph, source) if one.id in there]
    joining = list(dict.fromkeys(joining))
    if len(joining) == 1:
        graph.connect(Edge.REALIZING, flow, joining[0])


def _give_domain(graph: Graph, flow: Element) -> None:
    found = {domain_of(graph, item) for item in graph.targets(flow, Edge.CONVEYS)}
    if len(found) == 1 and "domain" not in flow.attrs:
        graph.set(flow, domain=found.pop())


def _check_flow(graph: Graph, sink: Sink, flow: Element) -> None:
    known = flow.attrs.get("unresolved")
    unresolved = known if isinstance(known, tuple) else ()
    for edge, name in ((Edge.FLOW_SOURCE, "source"), (Edge.FLOW_TARGET, "target")):
        if graph.target(flow, edge) is None and edge.value not in unresolved:
            subject = graph.subject(flow)
            sink.report(FLOW_WITHOUT_END, subject, flow=_title(graph, flow), end=name)
    if not graph.targets(flow, Edge.CONVEYS) and Edge.CONVEYS.value not in unresolved:
        sink.report(FLOW_OF_NOTHING, graph.subject(flow), flow=_title(graph, flow))
    for port, along, way in _ported_ends(graph, flow):
        _check_direction(graph, sink, flow, port, along, way)
        _check_items(graph, sink, flow, port)
    _check_realizing(graph, sink, flow)


def _title(graph: Graph, relation: Element) -> str:
    """A name for a relation, which often has none: that of its ends."""
    if relation.name:
        return graph.qualified_name(relation)
    if relation.kind is Kind.ITEM_FLOW:
        joined = [flow_source(graph, relation), flow_target(graph, relation)]
    else:
        joined = [role_of(graph, end) for end in ends(graph, relation)]
    return " - ".join(graph.qualified_name(one) if one else "?" for one in joined)


def _ported_ends(graph: Graph, flow: Element) -> Iterator[tuple[Element, str, str]]:
    """Ports at the ends of the flow, with the direction that it has in each, and in words."""
    for edge, outside, inside, way in (
        (Edge.FLOW_SOURCE, "out", "in", "leaves"),
        (Edge.FLOW_TARGET, "in", "out", "enters"),
    ):
        for end in graph.targets(flow, edge):
            if end.kind is Kind.PORT:
                yield end, inside if _runs_inside(graph, flow, end) else outside, way


def _runs_inside(graph: Graph, flow: Element, port: Element) -> bool:
    for connector in graph.targets(flow, Edge.REALIZING):
        attached = ends(graph, connector)
        outer = [one for one in attached if is_boundary(graph, one)]
        if len(outer) == 1 and role_of(graph, outer[0]) is port:
            return True
    return False


def _check_direction(
    graph: Graph, sink: Sink, flow: Element, port: Element, along: str, way: str
) -> None:
    if port.attrs.get("direction") != opposite(along):
        return
    sink.report(
        FLOW_AGAINST_PORT,
        graph.subject(flow),
        flow=_title(graph, flow),
        way=way,
        port=graph.qualified_name(port),
        direction=port.attrs["direction"],
    )


def _check_items(graph: Graph, sink: Sink, flow: Element, port: Element) -> None:
    passed = _passed(graph, port)
    for item in graph.targets(flow, Edge.CONVEYS):
        if passed and not any(_fit(graph, item, one) for one in passed):
            sink.report(
                FLOW_ITEM,
                graph.subject(flow),
                flow=_title(graph, flow),
                item=item.name,
                port=graph.qualified_name(port),
            )


def _passed(graph: Graph, port: Element) -> list[Element]:
    """Types of the flow properties of a port; empty when one of them is not known."""
    type_ = type_of(graph, port)
    if type_ is None:
        return []
    types = [type_of(graph, one) for one in flow_properties(graph, type_)]
    return [one for one in types if one is not None] if None not in types else []


def _fit(graph: Graph, item: Element, type_: Element) -> bool:
    return conforms(graph, item, type_) or conforms(graph, type_, item)


def _check_realizing(graph: Graph, sink: Sink, flow: Element) -> None:
    for connector in graph.targets(flow, Edge.REALIZING):
        if connector.kind is not Kind.CONNECTOR or connector.attrs.get("external"):
            continue
        joined = _joined(graph, connector)
        for end in (flow_source(graph, flow), flow_target(graph, flow)):
            if end is not None and joined and end.id not in joined:
                sink.report(
                    FLOW_BESIDE_CONNECTOR,
                    graph.subject(flow),
                    flow=_title(graph, flow),
                    connector=_title(graph, connector),
                    end=graph.qualified_name(end),
                )


def _joined(graph: Graph, connector: Element) -> set[str]:
    """Ids of what a connector joins: roles, the parts on the way, and the types of both."""
    attached = ends(graph, connector)
    found = [one for end in attached for one in graph.targets(end, Edge.ROLE)]
    found += [one for end in attached for one in graph.targets(end, Edge.PATH)]
    types = [type_of(graph, one) for one in found]
    owners = [graph.owner(one) for one in found]
    return {one.id for one in (*found, *types, *owners) if one is not None}


# -- connectors --------------------------------------------------------------------------------


def _settle_domain(graph: Graph, sink: Sink, connector: Element) -> None:
    carried: dict[str, list[str]] = {}
    flows = graph.sources(connector, Edge.REALIZING)
    for flow in flows:
        for item in graph.targets(flow, Edge.CONVEYS):
            domain = domain_of(graph, item)
            if domain is not None:
                carried.setdefault(domain, []).append(f"'{item.name}'")
    if len(carried) == 1:
        graph.set(connector, domain=connector.attrs.get("domain") or next(iter(carried)))
    if len(carried) > 1:
        lists = {domain: ", ".join(dict.fromkeys(names)) for domain, names in carried.items()}
        sink.report(
            MIXED_DOMAINS,
            # What an overlay adds to a connector of the model is mended in the overlay.
            graph.subject(next((f for f in flows if f.source != connector.source), connector)),
            connector=_title(graph, connector),
            physical=lists["physical"],
            information=lists["information"],
        )


def _check_connector(graph: Graph, sink: Sink, connector: Element) -> None:
    attached = ends(graph, connector)
    roles = [role_of(graph, end) for end in attached]
    if len(roles) != 2 or not all(one is not None and one.kind is Kind.PORT for one in roles):
        return
    ports = [one for one in roles if one is not None]
    if not _directions_agree(graph, attached):
        _report_directions(graph, sink, connector, attached, ports)
    _check_types(graph, sink, connector, ports)


def _directions_agree(graph: Graph, attached: list[Element]) -> bool:
    first, second = (end_direction(graph, one) for one in attached)
    if "inout" in (first, second) or None in (first, second):
        return True
    delegates = is_boundary(graph, attached[0]) != is_boundary(graph, attached[1])
    return (first == second) is delegates


def _report_directions(
    graph: Graph, sink: Sink, connector: Element, attached: list[Element], ports: list[Element]
) -> None:
    sink.report(
        CONNECTOR_DIRECTIONS,
        graph.subject(connector),
        connector=_title(graph, connector),
        first=end_direction(graph, attached[0]),
        one=graph.qualified_name(ports[0]),
        second=end_direction(graph, attached[1]),
        other=graph.qualified_name(ports[1]),
    )


def _check_types(graph: Graph, sink: Sink, connector: Element, ports: list[Element]) -> None:
    first, second = (type_of(graph, port) for port in ports)
    if first is None or second is None or _compatible(graph, first, second):
        return
    sink.report(
        CONNECTOR_TYPES,
        graph.subject(connector),
        connector=_title(graph, connector),
        one=graph.qualified_name(ports[0]),
        type=first.name,
        other=graph.qualified_name(ports[1]),
        other_type=second.name,
    )


def _compatible(graph: Graph, first: Element, second: Element) -> bool:
    families = [[one, *generals(graph, one)] for one in (first, second)]
    if any(one.attrs.get("external") for family in families for one in family):
        return True
    if _fit(graph, first, second) or any(one in families[1] for one in families[0]):
        return True
    passed = [flow_properties(graph, one) for one in (first, second)]
    return any(
        _properties_fit(graph, one, other) for one in passed[0] for other in passed[1]
    ) or not (passed[0] and passed[1])


def _properties_fit(graph: Graph, one: Element, other: Element) -> bool:
    types = type_of(graph, one), type_of(graph, other)
    return types[0] is None or types[1] is None or _fit(graph, types[0], types[1])
