"""Pass ``ports``: type and direction of every port, as far as the model states them.

Ports of AutomationML often have neither, so that they are reported once for each file.
"""

from collections.abc import Iterable
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import (
    FLOW_DIRECTIONS,
    applications,
    bounds,
    connectors_of,
    direction_of,
    ends,
    flow_directions,
    flow_properties,
    flow_source,
    flow_target,
    generals,
    has_stereotype,
    is_boundary,
    opposite,
    parameters,
    redefined_features,
    role_of,
    tag,
    type_of,
)
from sysmlc.support.counts import count, list_first

UNDIRECTED_PORTS = rule(
    "SM300",
    "undirected-ports",
    Severity.INFO,
    "ports of '{block}' without a direction ({count}): {ports}",
    help="give the ports' types flow properties with a direction, or draw item flows",
)
UNTYPED_PORT = rule(
    "SM301",
    "untyped-port",
    Severity.WARNING,
    "port '{port}' has no type",
    help="type the port with an interface block, a block or a value type",
)
BAD_MULTIPLICITY = rule(
    "SM302",
    "bad-multiplicity",
    Severity.ERROR,
    "multiplicity {multiplicity} of '{feature}' allows no number of values",
    help="make the upper bound at least as large as the lower one",
)
EMPTY_MULTIPLICITY = rule(
    "SM303",
    "empty-multiplicity",
    Severity.WARNING,
    "port '{port}' has multiplicity {multiplicity}, so no block has it",
    help="remove the port, or allow at least one",
)
UNDIRECTED_PLANT_PORTS = rule(
    "SM121",
    "undirected-plant-ports",
    Severity.INFO,
    "{count} of {all} of '{file}' without direction: {ports}",
    help="give the interfaces an attribute Direction, or say in an overlay what flows",
)
UNTYPED_PLANT_PORTS = rule(
    "SM122",
    "untyped-plant-ports",
    Severity.WARNING,
    "{count} of {all} of '{file}' without type: {ports}",
    help="let the interfaces refer to interface classes",
)


_MAX_LISTED = 8
_CONJUGATED = ("~InterfaceBlock", "_InterfaceBlock", "ConjugatedInterfaceBlock")
"""SysML 1.6 clause 9.3.2.14, as OMG, MagicDraw and Papyrus call the stereotype."""
_PORT_DIRECTIONS = {"in": "in", "out": "out", "return": "out", "inout": "inout"}


class Ports(Struct, frozen=True):
    """Set type and direction of every port.

    Assumes effective features and roles. Guarantees: an untyped port has the type of the port that
    it redefines. The first of these that states a direction sets ``direction``: the source, the tag
    of a flow port or of a vendor's stereotype for ports, the flow properties of the type, the
    parameters of operations of the type, item flows, the redefined port. A conjugated port has the
    opposite of the direction of its type. Ports without a direction are reported once for each
    block.
    """

    name: ClassVar[str] = "ports"
    after: ClassVar[tuple[str, ...]] = ("inherit", "classify")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Complete the ports in place; see the class."""
        ports = [port for port in graph.of_kind(Kind.PORT) if port.role != "constraint parameter"]
        for port in ports:
            _give_type(graph, port)
        for port in ports:
            if "direction" not in port.attrs:
                graph.set(port, direction=_find_direction(graph, port))
        for port in ports:
            graph.set(
                port, direction=port.attrs.get("direction") or _redefined_direction(graph, port)
            )
        plants = _find_plant_files(graph)
        drawn_ports = [port for port in ports if port.source not in plants]
        for port in drawn_ports:
            if not _is_typed(graph, port):
                sink.report(UNTYPED_PORT, graph.subject(port), port=graph.qualified_name(port))
        for feature in graph.of_kind(Kind.PORT, Kind.PROPERTY, Kind.FLOW_PROPERTY, Kind.PARAMETER):
            _check_multiplicity(graph, sink, feature)
        _report_undirected(graph, sink, drawn_ports)
        _report_plants(graph, sink, [port for port in ports if port.source in plants])


def _give_type(graph: Graph, port: Element) -> None:
    type_ = type_of(graph, port)
    if type_ is not None:
        graph.connect(Edge.TYPED_BY, port, type_)


# -- direction ---------------------------------------------------------------------------------


def _find_direction(graph: Graph, port: Element) -> str | None:
    return (
        _own_direction(graph, port)
        or _combine(direction for _, direction in flow_directions(graph, port))
        or _conjugate(port, _direction_by_type(graph, port))
        or _direction_by_item_flows(graph, port)
    )


def _own_direction(graph: Graph, port: Element) -> str | None:
    """Return the direction of a flow port (SysML 1.2 clause 9.3.2.3) or vendor port, or None.

    The result is None, too, if the type gives the direction, as a flow specification does. Without
    a tag, the direction of an atomic flow port is inout.
    """
    if port.role != "flow port":
        return _vendor_direction(graph, port)
    stated = tag(graph, port, "direction")
    if stated in FLOW_DIRECTIONS:
        return str(stated)
    type_ = type_of(graph, port)
    return None if type_ is not None and _direction_by_type(graph, port) else "inout"


def _vendor_direction(graph: Graph, port: Element) -> str | None:
    """Return the direction in the tag of a vendor's stereotype for ports, or None.

    Examples are FlowPort of MARTE, DataFlowPort of RobotML and Port of Papyrus' FMI profile. Their
    names end in "Port", and their literals are those of SysML.
    """
    stated = (a.attrs.get("tag.direction") for a in _list_port_applications(graph, port))
    return next((str(direction) for direction in stated if direction in FLOW_DIRECTIONS), None)


def _list_port_applications(graph: Graph, port: Element) -> list[Element]:
    named = applications(graph, port)
    return [a for a in named if str(a.attrs.get("stereotype", "")).endswith("Port")]


def _conjugate(port: Element, direction: str | None) -> str | None:
    return opposite(direction) if port.attrs.get("conjugated") else direction


def _direction_by_type(graph: Graph, port: Element) -> str | None:
    type_ = type_of(graph, port)
    if type_ is None:
        return None
    return _direction_of_type(graph, type_) or opposite(_direction_of_original(graph, type_))


def _direction_of_type(graph: Graph, type_: Element) -> str | None:
    directions = [
        str(flow_property.attrs.get("direction", "inout"))
        for flow_property in flow_properties(graph, type_)
    ]
    return _combine(directions) or _combine(_parameter_directions(graph, type_))


def _direction_of_original(graph: Graph, type_: Element) -> str | None:
    """Return the direction of the block that a ~InterfaceBlock conjugates, or None."""
    if not has_stereotype(graph, type_, *_CONJUGATED):
        return None
    original = graph.get(str(tag(graph, type_, "original")))
    return None if original is None else _direction_of_type(graph, original)


def _parameter_directions(graph: Graph, type_: Element) -> Iterable[str]:
    # The type's operations are called from outside: their arguments come in, unless the type
    # requires the operation (SysML 1.6 clause 9.3.2.3, DirectedFeature).
    for operation in graph.targets(type_, Edge.FEATURE):
        if operation.kind is Kind.OPERATION:
            required = tag(graph, operation, "featureDirection") == "required"
            for parameter in parameters(graph, operation):
                direction = _PORT_DIRECTIONS.get(direction_of(parameter), "inout")
                yield (opposite(direction) or direction) if required else direction


def _combine(directions: Iterable[str]) -> str | None:
    distinct = sorted(set(directions))
    return distinct[0] if len(distinct) == 1 else ("inout" if distinct else None)


def _direction_by_item_flows(graph: Graph, port: Element) -> str | None:
    leaving = [flow for flow in graph.sources(port, Edge.FLOW_SOURCE) if _is_item_flow(flow)]
    arriving = [flow for flow in graph.sources(port, Edge.FLOW_TARGET) if _is_item_flow(flow)]
    directions = ["in" if _runs_inside(graph, port, flow) else "out" for flow in leaving]
    arriving_directions = ["out" if _runs_inside(graph, port, flow) else "in" for flow in arriving]
    return _combine((*directions, *arriving_directions))


def _is_item_flow(flow: Element) -> bool:
    return flow.kind is Kind.ITEM_FLOW


def _runs_inside(graph: Graph, port: Element, flow: Element) -> bool:
    """Whether the flow runs between the port and the inside of its block.

    A flow that leaves the port to a part inside has entered the block through the port.
    """
    realising = [
        connector
        for connector in graph.targets(flow, Edge.REALIZING)
        if connector.kind is Kind.CONNECTOR
    ]
    return any(
        _delegates(graph, connector, port)
        for connector in realising or _find_common_connectors(graph, port, flow)
    )


def _find_common_connectors(graph: Graph, port: Element, flow: Element) -> list[Element]:
    other_end = flow_target(graph, flow) if flow_source(graph, flow) is port else None
    other_end = other_end or flow_source(graph, flow)
    if other_end is None:
        return []
    at_other_end = {connector.id for connector in connectors_of(graph, other_end)}
    return [connector for connector in connectors_of(graph, port) if connector.id in at_other_end]


def _delegates(graph: Graph, connector: Element, port: Element) -> bool:
    connector_ends = ends(graph, connector)
    port_ends = [end for end in connector_ends if role_of(graph, end) is port]
    boundary_ends = [end for end in connector_ends if is_boundary(graph, end)]
    return len(boundary_ends) < len(connector_ends) and any(
        end in boundary_ends for end in port_ends
    )


def _redefined_direction(graph: Graph, port: Element) -> str | None:
    directions = (other.attrs.get("direction") for other in redefined_features(graph, port))
    return next((str(direction) for direction in directions if direction), None)


# -- rules -------------------------------------------------------------------------------------


def _is_typed(graph: Graph, port: Element) -> bool:
    """Whether the port has a type, its missing type has been reported, or it is external."""
    unresolved = port.attrs.get("unresolved") or ()
    is_unresolved = isinstance(unresolved, tuple) and Edge.TYPED_BY.value in unresolved
    has_type = graph.target(port, Edge.TYPED_BY) is not None
    return has_type or is_unresolved or bool(port.attrs.get("external"))


def _report_plants(graph: Graph, sink: Sink, ports: list[Element]) -> None:
    internal = [port for port in ports if not port.attrs.get("external")]
    untyped = [port for port in internal if not _is_typed(graph, port)]
    _report_by_file(graph, sink, UNTYPED_PLANT_PORTS, untyped, internal)
    undirected = _find_undirected_plant_ports(graph, internal)
    _report_by_file(graph, sink, UNDIRECTED_PLANT_PORTS, undirected, internal)


def _check_multiplicity(graph: Graph, sink: Sink, feature: Element) -> None:
    multiplicity = feature.attrs.get("multiplicity")
    limits = bounds(multiplicity)
    if limits is None or limits[1] is None:
        return
    if limits[1] < limits[0]:
        subject = graph.subject(feature)
        sink.report(BAD_MULTIPLICITY, subject, multiplicity=multiplicity, feature=subject.name)
    elif limits[1] == 0 and feature.kind is Kind.PORT:
        subject = graph.subject(feature)
        sink.report(EMPTY_MULTIPLICITY, subject, multiplicity=multiplicity, port=subject.name)


def _report_undirected(graph: Graph, sink: Sink, ports: list[Element]) -> None:
    blocks: dict[str, list[Element]] = {}
    for port in ports:
        is_exempt = _is_reported(graph, port) or _has_explaining_type(graph, port)
        if port.owner is not None and _lacks_direction(port) and not is_exempt:
            blocks.setdefault(port.owner, []).append(port)
    for id, undirected in blocks.items():
        names = [f"'{member.name or member.id}'" for member in undirected]
        sink.report(
            UNDIRECTED_PORTS,
            graph.subject(graph[id]),
            block=graph.qualified_name(graph[id]),
            count=len(names),
            ports=list_first(names, _MAX_LISTED),
        )


def _lacks_direction(port: Element) -> bool:
    return "direction" not in port.attrs


def _is_reported(graph: Graph, port: Element) -> bool:
    """Whether the port redefines or subsets a port of the unit that lacks a direction itself."""
    general_ports = (*redefined_features(graph, port), *graph.targets(port, Edge.SUBSETS))
    return any(
        former.kind is Kind.PORT
        and former is not port
        and _lacks_direction(former)
        and not former.attrs.get("external")
        for former in general_ports
    )


def _has_explaining_type(graph: Graph, port: Element) -> bool:
    """Whether the type or stereotype of the port explains why the port has no direction.

    Everything flows through the ports of the type, or the type or a general of it is in a file that
    is not read. The missing file is reported, and its flow properties may state a direction.
    """
    # Without a tag, the direction of a vendor's port is a default value in the vendor's profile.
    applied = _list_port_applications(graph, port) if port.role == "port" else []
    untagged = (use for use in applied if "tag.direction" not in use.attrs)
    if any(graph.target(use, Edge.INSTANCE_OF) is None for use in untagged):
        return True
    type_ = type_of(graph, port)
    if type_ is None:
        return False
    return any(f.kind is Kind.PORT for f in graph.targets(type_, Edge.FEATURE)) or any(
        classifier.attrs.get("external")
        and not classifier.attrs.get("library")
        and classifier.subkind != "primitive"
        for classifier in (type_, *generals(graph, type_))
    )


# -- AutomationML ------------------------------------------------------------------------------


def _find_plant_files(graph: Graph) -> frozenset[str]:
    """Return the AutomationML files of the unit."""
    documents = graph.of_kind(Kind.DOCUMENT)
    return frozenset(document.source for document in documents if document.subkind == "caex")


def _find_undirected_plant_ports(graph: Graph, ports: Iterable[Element]) -> list[Element]:
    """Return the ports for flows without direction, in files where other ports have one."""
    flow_ports = [port for port in ports if _is_for_flows(graph, port)]
    files_with_directions = {port.source for port in flow_ports if "direction" in port.attrs}
    return [
        p for p in flow_ports if p.source in files_with_directions and "direction" not in p.attrs
    ]


def _is_for_flows(graph: Graph, port: Element) -> bool:
    """Whether something may flow through a port: it is no link to a document or PPRConnector."""
    type_ = type_of(graph, port)
    family = () if type_ is None else (type_, *generals(graph, type_))
    referring = graph.sources(port, Edge.REFERENCES)
    return "PPRConnector" not in {general.name for general in family} and not any(
        element.kind is Kind.DOCUMENT for element in referring
    )


def _report_by_file(
    graph: Graph, sink: Sink, rule: Rule, faulty: Iterable[Element], ports: Iterable[Element]
) -> None:
    """Report the *faulty* ones of *ports* once for each file, at the first faulty port."""
    totals: dict[str, int] = {}
    for port in ports:
        totals[port.source] = totals.get(port.source, 0) + 1
    by_file: dict[str, list[Element]] = {}
    for port in faulty:
        by_file.setdefault(port.source, []).append(port)
    for file, reported in by_file.items():
        names = [f"'{graph.qualified_name(port)}'" for port in reported]
        sink.report(
            rule,
            graph.subject(reported[0]),
            count=len(reported),
            all=count(totals[file], "port"),
            file=file,
            ports=list_first(names, _MAX_LISTED),
        )
