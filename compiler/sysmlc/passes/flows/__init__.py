"""Pass ``flows``: item flows on connectors, and checks that ports, flows and connectors agree."""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, list_items
from sysmlc.ir.query import (
    conforms,
    connectors_of,
    domain_of,
    end_direction,
    ends,
    flow_directions,
    flow_properties,
    flow_source,
    flow_target,
    generals,
    is_boundary,
    is_flow_property,
    opposite,
    role_of,
    type_of,
)
from sysmlc.passes.flows.paths import begins_elsewhere, check_paths

FLOW_AGAINST_PORT = rule(
    "SM310",
    "flow-against-port",
    Severity.WARNING,
    "item flow '{flow}' {way} port '{port}', whose direction is {direction}",
    help="reverse the item flow, conjugate the port, or choose another type for it",
)
FLOW_ITEM = rule(
    "SM311",
    "flow-item",
    Severity.WARNING,
    "item flow '{flow}' conveys '{item}', which port '{port}' does not pass",
    help="add a flow property of type '{item}' to the port's type, or convey what it passes",
)
FLOW_WITHOUT_END = rule(
    "SM312",
    "flow-without-end",
    Severity.ERROR,
    "item flow '{flow}' has no {end}",
    help="draw the item flow between two ports or parts",
)
FLOW_BESIDE_CONNECTOR = rule(
    "SM313",
    "flow-beside-connector",
    Severity.WARNING,
    "item flow '{flow}' runs over connector '{connector}', which does not join '{end}'",
    help="draw the item flow over the connector between its source and its target",
)
FLOW_OF_NOTHING = rule(
    "SM314",
    "flow-of-nothing",
    Severity.INFO,
    "item flow '{flow}' does not say what it conveys",
    help="name the block, value type or signal that flows",
)
CONNECTOR_DIRECTIONS = rule(
    "SM315",
    "connector-directions",
    Severity.WARNING,
    "connector '{connector}' joins {first} '{one}' with {second} '{other}'",
    help="conjugate one of the ports, choose another type for it, or connect another port",
)
CONNECTOR_TYPES = rule(
    "SM316",
    "connector-types",
    Severity.WARNING,
    "connector '{connector}' joins '{one}' of type '{type}' with '{other}' of type '{other_type}'",
    help="type both ports with the same interface block, one of them conjugated",
)
CONNECTOR_WITHOUT_FLOW = rule(
    "SM347",
    "connector-without-flow",
    Severity.WARNING,
    "connector '{connector}' joins '{one}' with '{other}', but nothing that leaves one of them can "
    "enter the other",
    help="conjugate one of the ports, or choose another type for it",
)
MIXED_DOMAINS = rule(
    "SM317",
    "mixed-domains",
    Severity.WARNING,
    "connector '{connector}' carries physical items ({physical}) and information ({information})",
    help="draw one connector for the material or energy and one for the information",
)
CONNECTOR_ASSOCIATION = rule(
    "SM246",
    "connector-unlike-association",
    Severity.WARNING,
    "connector '{connector}' joins '{one}' with '{other}', but its association '{association}' "
    "joins '{type}' with '{other_type}'",
    help="choose another association as the type of the connector, or connect other parts",
)
FLOW_PROPERTY_TYPE = rule(
    "SM247",
    "flow-property-type",
    Severity.WARNING,
    "item flow '{flow}' conveys '{item}', but its end '{feature}' has the type '{type}'",
    help="convey what the flow property passes, or choose another end",
)


class Flows(Struct, frozen=True):
    """Attach item flows to connectors and give both a domain.

    Assumes directions of ports. Guarantees: an item flow that names no connector has an edge
    ``realizing`` to the connector between its source and its target, if there is exactly one; item
    flows and connectors have the ``domain`` of the conveyed items, if all have the same. Conflicts
    are reported and not repaired.
    """

    name: ClassVar[str] = "flows"
    after: ClassVar[tuple[str, ...]] = ("ports",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Attach flows in place and report; see the class."""
        for flow in graph.of_kind(Kind.ITEM_FLOW):
            _attach(graph, flow)
            _give_domain(graph, flow)
            _check_flow(graph, sink, flow)
        for connector in graph.of_kind(Kind.CONNECTOR):
            _settle_domain(graph, sink, connector)
            _check_connector(graph, sink, connector)
            _check_association(graph, sink, connector)
            check_paths(graph, sink, connector)


# -- item flows --------------------------------------------------------------------------------


def _attach(graph: Graph, flow: Element) -> None:
    source, target = flow_source(graph, flow), flow_target(graph, flow)
    if source is None or target is None or graph.target(flow, Edge.REALIZING) is not None:
        return
    # Several connectors between the same ends: the model must say which one the flow uses.
    at_target = {connector.id for connector in connectors_of(graph, target)}
    candidates = [
        connector for connector in connectors_of(graph, source) if connector.id in at_target
    ]
    candidates = list(dict.fromkeys(candidates))
    if len(candidates) == 1:
        graph.connect(Edge.REALIZING, flow, candidates[0])


def _give_domain(graph: Graph, flow: Element) -> None:
    domains = {domain_of(graph, item) for item in graph.targets(flow, Edge.CONVEYS)}
    if len(domains) == 1 and "domain" not in flow.attrs:
        graph.set(flow, domain=domains.pop())


def _check_flow(graph: Graph, sink: Sink, flow: Element) -> None:
    unresolved = list_items(flow.attrs.get("unresolved"))
    for edge, name in ((Edge.FLOW_SOURCE, "source"), (Edge.FLOW_TARGET, "target")):
        if graph.target(flow, edge) is None and edge.value not in unresolved:
            _report_flow(graph, sink, FLOW_WITHOUT_END, flow, end=name)
    if not graph.targets(flow, Edge.CONVEYS) and Edge.CONVEYS.value not in unresolved:
        _report_flow(graph, sink, FLOW_OF_NOTHING, flow)
    for port, along, way in _list_port_ends(graph, flow):
        if _runs_against(port, along):
            facts = {"port": graph.qualified_name(port), "direction": opposite(along)}
            _report_flow(graph, sink, FLOW_AGAINST_PORT, flow, way=way, **facts)
        _check_items(graph, sink, flow, port)
    _check_flow_properties(graph, sink, flow)
    _check_realizing(graph, sink, flow)


def _report_flow(graph: Graph, sink: Sink, rule: Rule, flow: Element, **facts: str | None) -> None:
    title, subject = _title(graph, flow), graph.subject(flow)
    sink.report(rule, subject, notes=(), help="", cause="", flow=title, **facts)


def _title(graph: Graph, relation: Element) -> str:
    """Return the name of a relation in messages: its own name, or the names of its ends."""
    if relation.name:
        return graph.qualified_name(relation)
    if relation.kind is Kind.ITEM_FLOW:
        elements = [flow_source(graph, relation), flow_target(graph, relation)]
    else:
        elements = [role_of(graph, end) for end in ends(graph, relation)]
    return " - ".join(graph.qualified_name(element) if element else "?" for element in elements)


def _list_port_ends(graph: Graph, flow: Element) -> Iterator[tuple[Element, str, str]]:
    """Yield each port at an end of the flow, its expected direction, and the verb for messages."""
    for edge, outside, inside in (
        (Edge.FLOW_SOURCE, ("out", "leaves"), ("in", "enters its block through")),
        (Edge.FLOW_TARGET, ("in", "enters"), ("out", "leaves its block through")),
    ):
        for end in graph.targets(flow, edge):
            if end.kind is Kind.PORT:
                yield end, *(inside if _runs_inside(graph, flow, end) else outside)


def _runs_inside(graph: Graph, flow: Element, port: Element) -> bool:
    """Whether the flow runs between the port and the inside of its block.

    A delegation connector leads it there, or the element at its other end is in the block.
    """
    block = graph.owner(port)
    flow_ends = (*graph.targets(flow, Edge.FLOW_SOURCE), *graph.targets(flow, Edge.FLOW_TARGET))
    # Another port of the block is outside, too.
    if block is not None and any(
        graph.owner(end) is not block and block in graph.ancestors(end) for end in flow_ends
    ):
        return True
    for connector in graph.targets(flow, Edge.REALIZING):
        connector_ends = ends(graph, connector)
        outer = [end for end in connector_ends if is_boundary(graph, end)]
        if len(outer) == 1 and role_of(graph, outer[0]) is port:
            return True
    return False


def _runs_against(port: Element, along: str) -> bool:
    return bool(port.attrs.get("direction") == opposite(along))


def _check_items(graph: Graph, sink: Sink, flow: Element, port: Element) -> None:
    item_types = _list_item_types(graph, port)
    for item in graph.targets(flow, Edge.CONVEYS):
        if item_types and not any(_conform(graph, item, item_type) for item_type in item_types):
            port_name = graph.qualified_name(port)
            _report_flow(graph, sink, FLOW_ITEM, flow, item=item.name, port=port_name)


def _check_flow_properties(graph: Graph, sink: Sink, flow: Element) -> None:
    """Report an end that is a flow property of another type than what the flow conveys."""
    for feature in (flow_source(graph, flow), flow_target(graph, flow)):
        type_ = type_of(graph, feature) if feature and is_flow_property(feature) else None
        if feature is None or type_ is None:
            continue
        for item in graph.targets(flow, Edge.CONVEYS):
            if not _are_related(graph, item, type_):
                facts = {"feature": graph.qualified_name(feature), "type": type_.name}
                _report_flow(graph, sink, FLOW_PROPERTY_TYPE, flow, item=item.name, **facts)


def _list_item_types(graph: Graph, port: Element) -> list[Element]:
    """Return the types of the flow properties of a port; empty if one of them is unknown."""
    type_ = type_of(graph, port)
    if type_ is None:
        return []
    types = [type_of(graph, flow_property) for flow_property in flow_properties(graph, type_)]
    return [] if None in types else [type_ for type_ in types if type_ is not None]


def _conform(graph: Graph, item: Element, type_: Element) -> bool:
    return conforms(graph, item, type_) or conforms(graph, type_, item)


def _are_related(graph: Graph, left: Element, right: Element) -> bool:
    """Whether one type specialises the other, or may do so in a file that is not there."""
    family = [left, right, *generals(graph, left), *generals(graph, right)]
    is_known = not any(general.attrs.get("external") for general in family)
    return not is_known or _conform(graph, left, right)


def _check_realizing(graph: Graph, sink: Sink, flow: Element) -> None:
    for connector in graph.targets(flow, Edge.REALIZING):
        if connector.kind is not Kind.CONNECTOR or connector.attrs.get("external"):
            continue
        attached = _find_attached(graph, connector)
        for end in (flow_source(graph, flow), flow_target(graph, flow)):
            if end is not None and attached and end.id not in attached:
                facts = {"connector": _title(graph, connector), "end": graph.qualified_name(end)}
                _report_flow(graph, sink, FLOW_BESIDE_CONNECTOR, flow, **facts)


def _find_attached(graph: Graph, connector: Element) -> set[str]:
    """Return the ids of the roles of a connector, the parts on its paths, and the types of both."""
    connector_ends = ends(graph, connector)
    elements = [element for end in connector_ends for element in graph.targets(end, Edge.ROLE)]
    elements += [element for end in connector_ends for element in graph.targets(end, Edge.PATH)]
    types = [type_of(graph, element) for element in elements]
    owners = [graph.owner(element) for element in elements]
    return {element.id for element in (*elements, *types, *owners) if element is not None}


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
            # A flow that an overlay adds must be corrected in the overlay, not at the connector.
            graph.subject(next((f for f in flows if f.source != connector.source), connector)),
            connector=_title(graph, connector),
            physical=lists["physical"],
            information=lists["information"],
        )


def _check_connector(graph: Graph, sink: Sink, connector: Element) -> None:
    connector_ends = ends(graph, connector)
    roles = [role_of(graph, end) for end in connector_ends]
    if len(roles) != 2 or not all(role is not None and role.kind is Kind.PORT for role in roles):
        return
    ports = [role for role in roles if role is not None]
    # The finding about a flow that runs against a port (SM310) is about the same fact.
    is_reported = any(
        _runs_against(port, along)
        for flow in graph.sources(connector, Edge.REALIZING)
        for port, along, _ in _list_port_ends(graph, flow)
    )
    has_sides = not any(begins_elsewhere(graph, connector, end) for end in connector_ends)
    types = [type_ for type_ in (type_of(graph, port) for port in ports) if type_ is not None]
    are_compatible = len(types) < 2 or _are_compatible(graph, *types)
    if not are_compatible:
        names = {"type": types[0].name, "other_type": types[1].name}
        _report_connector(graph, sink, CONNECTOR_TYPES, connector, **names)
    if not has_sides or is_reported:
        return
    if not _has_matching_directions(graph, connector_ends):
        first, second = (end_direction(graph, end) for end in connector_ends)
        _report_connector(graph, sink, CONNECTOR_DIRECTIONS, connector, first=first, second=second)
    elif are_compatible and not _can_exchange_items(graph, connector_ends, types):
        _report_connector(graph, sink, CONNECTOR_WITHOUT_FLOW, connector)


def _report_connector(
    graph: Graph, sink: Sink, rule: Rule, connector: Element, **facts: str | None
) -> None:
    """Report a rule about a connector and its two ends."""
    first, second = (_name_end(graph, connector, end) for end in ends(graph, connector))
    facts |= {"connector": _title(graph, connector), "one": first, "other": second}
    sink.report(rule, graph.subject(connector), notes=(), help="", cause="", **facts)


def _has_matching_directions(graph: Graph, connector_ends: list[Element]) -> bool:
    first, second = (end_direction(graph, end) for end in connector_ends)
    if "inout" in (first, second) or None in (first, second):
        return True
    # A delegation connector continues the direction of the outer port; others join opposites.
    delegates = is_boundary(graph, connector_ends[0]) != is_boundary(graph, connector_ends[1])
    return (first == second) is delegates


def _name_end(graph: Graph, connector: Element, end: Element) -> str:
    """Return the path of the port from the owner of the connector, or its name without a path.

    The port alone belongs to a class, which many parts may have.
    """
    role, owner = role_of(graph, end), graph.owner(connector)
    steps = [step.name for step in graph.targets(end, Edge.PATH)]
    if role is None or owner is None or not steps:
        return "" if role is None else graph.qualified_name(role)
    return "::".join([graph.qualified_name(owner), *steps, role.name])


def _can_exchange_items(graph: Graph, connector_ends: list[Element], types: list[Element]) -> bool:
    """Whether something may pass between two ports whose types have inputs and outputs.

    An output needs an input that may have its type (SysML 1.6 clause 9.3.2.8). Ports whose types
    have other features as well may be there for these.
    """
    is_continued = is_boundary(graph, connector_ends[0]) != is_boundary(graph, connector_ends[1])
    kinds = {feature.kind for type_ in types for feature in graph.targets(type_, Edge.FEATURE)}
    if is_continued or kinds & {Kind.PORT, Kind.OPERATION, Kind.RECEPTION}:
        return True
    first, second = (_list_flow_features(graph, end) for end in connector_ends)
    return not (first and second) or any(
        direction != other_direction or "inout" in (direction, other_direction)
        for item, direction in first
        for other_item, other_direction in second
        if _may_equal_types(graph, item, other_item)
    )


def _list_flow_features(graph: Graph, end: Element) -> list[tuple[Element, str]]:
    """Return the flow properties of the port at an end, with directions as in ``end_direction``."""
    port = role_of(graph, end)
    directions = [] if port is None else flow_directions(graph, port)
    outer_ports = [step for step in graph.targets(end, Edge.PATH) if step.kind is Kind.PORT]
    if sum(bool(outer.attrs.get("conjugated")) for outer in outer_ports) % 2:
        return [(item, opposite(direction) or direction) for item, direction in directions]
    return directions


def _may_equal_types(graph: Graph, left: Element, right: Element) -> bool:
    first, second = type_of(graph, left), type_of(graph, right)
    return first is None or second is None or _are_related(graph, first, second)


def _are_compatible(graph: Graph, first: Element, second: Element) -> bool:
    families = [[classifier, *generals(graph, classifier)] for classifier in (first, second)]
    # The generals and features of an external stub are unknown, so that nothing is reported.
    if any(classifier.attrs.get("external") for family in families for classifier in family):
        return True
    if _conform(graph, first, second) or any(
        classifier in families[1] for classifier in families[0]
    ):
        return True
    properties = [flow_properties(graph, classifier) for classifier in (first, second)]
    return any(
        _do_properties_conform(graph, classifier, other_property)
        for classifier in properties[0]
        for other_property in properties[1]
    ) or not (properties[0] and properties[1])


def _do_properties_conform(graph: Graph, left: Element, right: Element) -> bool:
    types = type_of(graph, left), type_of(graph, right)
    return types[0] is None or types[1] is None or _conform(graph, types[0], types[1])


# -- associations of connectors ----------------------------------------------------------------


def _check_association(graph: Graph, sink: Sink, connector: Element) -> None:
    """Report a connector between elements that the ends of its association cannot be.

    Tools write the ends of both in either order.
    """
    association, attached = type_of(graph, connector), ends(graph, connector)
    roles = [role_of(graph, end) for end in attached]
    if association is None or association.attrs.get("external") or len(attached) != 2:
        return
    types = [type_of(graph, end) for end in ends(graph, association)]
    if len(types) != 2 or None in (*types, *roles):
        return
    first, second = ([_may_be(graph, end, type_) for type_ in types] for end in attached)
    if (first[0] and second[1]) or (first[1] and second[0]):
        return
    names = [type_.name for type_ in types if type_ is not None]
    facts = {"association": association.name, "type": names[0], "other_type": names[1]}
    _report_connector(graph, sink, CONNECTOR_ASSOCIATION, connector, **facts)


def _may_be(graph: Graph, end: Element, type_: Element | None) -> bool:
    """Whether the role of an end, or the part with the port, may have a type."""
    steps = [*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)]
    for step_type in (type_of(graph, step) for step in steps):
        if type_ is None or step_type is None or _are_related(graph, step_type, type_):
            return True
    return False
