"""Pass ``ports``: type and direction of every port, as far as the model gives them."""

from collections.abc import Iterable
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import (
    FLOW_DIRECTIONS,
    bounds,
    connectors_of,
    direction_of,
    ends,
    flow_properties,
    flow_source,
    flow_target,
    has_stereotype,
    is_boundary,
    opposite,
    parameters,
    redefined_features,
    role_of,
    tag,
    type_of,
)
from sysmlc.passes.ports import plants as plant_ports

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


_LISTED = 8
_CONJUGATED = ("~InterfaceBlock", "_InterfaceBlock", "ConjugatedInterfaceBlock")
"""SysML 1.6 clause 9.3.2.14, as OMG, MagicDraw and Papyrus call the stereotype."""
_BY_PARAMETER = {"in": "in", "out": "out", "return": "out", "inout": "inout"}


class Ports(Struct, frozen=True):
    """Give every port its type and direction.

    Assumes effective features and roles. Guarantees: a port without a type that redefines a
    typed one is typed alike; ``direction`` is set where, in this order, a flow port's own
    direction, the flow properties of its type, the parameters of its type's operations, item
    flows, or the port that it redefines give it; a conjugated port has the opposite of what
    its type says. All other ports stay undirected and are counted, block by block. A
    direction that the source states stays.
    """

    name: ClassVar[str] = "ports"
    after: ClassVar[tuple[str, ...]] = ("inherit", "classify")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Complete the ports in place; see the class."""
        ports = [one for one in graph.of_kind(Kind.PORT) if one.role != "constraint parameter"]
        for port in ports:
            _give_type(graph, port)
        for port in ports:
            if "direction" not in port.attrs:
                graph.set(port, direction=_direction(graph, port))
        for port in ports:
            graph.set(port, direction=port.attrs.get("direction") or _redefined(graph, port))
        plants = plant_ports.files(graph)
        ours = [port for port in ports if port.source not in plants]
        for port in ours:
            if not _is_typed(graph, port):
                sink.report(UNTYPED_PORT, graph.subject(port), port=graph.qualified_name(port))
        for feature in graph.of_kind(Kind.PORT, Kind.PROPERTY, Kind.FLOW_PROPERTY, Kind.PARAMETER):
            _check_multiplicity(graph, sink, feature)
        _report_undirected(graph, sink, ours)
        _report_plants(graph, sink, [port for port in ports if port.source in plants])


def _give_type(graph: Graph, port: Element) -> None:
    type_ = type_of(graph, port)
    if type_ is not None:
        graph.connect(Edge.TYPED_BY, port, type_)


# -- direction ---------------------------------------------------------------------------------


def _direction(graph: Graph, port: Element) -> str | None:
    return (
        _own_direction(graph, port)
        or _seen_through(port, _by_type(graph, port))
        or _by_item_flows(graph, port)
    )


def _own_direction(graph: Graph, port: Element) -> str | None:
    """Direction of a flow port (SysML 1.2 clause 9.3.2.3; an atomic one is inout by default).

    One that a flow specification types takes its direction from there.
    """
    if port.role != "flow port":
        return None
    given = tag(graph, port, "direction")
    if given in FLOW_DIRECTIONS:
        return str(given)
    type_ = type_of(graph, port)
    return None if type_ is not None and _by_type(graph, port) else "inout"


def _seen_through(port: Element, direction: str | None) -> str | None:
    return opposite(direction) if port.attrs.get("conjugated") else direction


def _by_type(graph: Graph, port: Element) -> str | None:
    type_ = type_of(graph, port)
    if type_ is None:
        return None
    return _of_type(graph, type_) or opposite(_of_original(graph, type_))


def _of_type(graph: Graph, type_: Element) -> str | None:
    flowing = [str(one.attrs.get("direction", "inout")) for one in flow_properties(graph, type_)]
    return _together(flowing) or _together(_parameter_directions(graph, type_))


def _of_original(graph: Graph, type_: Element) -> str | None:
    """Direction of the block that a ~InterfaceBlock conjugates, for tools that leave it empty."""
    if not has_stereotype(graph, type_, *_CONJUGATED):
        return None
    original = graph.get(str(tag(graph, type_, "original")))
    return None if original is None else _of_type(graph, original)


def _parameter_directions(graph: Graph, type_: Element) -> Iterable[str]:
    # The type's operations are called from outside: their arguments come in, unless the type
    # requires the operation (SysML 1.6 clause 9.3.2.3, DirectedFeature).
    for operation in graph.targets(type_, Edge.FEATURE):
        if operation.kind is Kind.OPERATION:
            required = tag(graph, operation, "featureDirection") == "required"
            for parameter in parameters(graph, operation):
                direction = _BY_PARAMETER.get(direction_of(parameter), "inout")
                yield (opposite(direction) or direction) if required else direction


def _together(directions: Iterable[str]) -> str | None:
    found = sorted(set(directions))
    return found[0] if len(found) == 1 else ("inout" if found else None)


def _by_item_flows(graph: Graph, port: Element) -> str | None:
    leaving = [one for one in graph.sources(port, Edge.FLOW_SOURCE) if _is_item_flow(one)]
    arriving = [one for one in graph.sources(port, Edge.FLOW_TARGET) if _is_item_flow(one)]
    out = ["in" if _enters(graph, port, one) else "out" for one in leaving]
    in_ = ["out" if _enters(graph, port, one) else "in" for one in arriving]
    return _together((*out, *in_))


def _is_item_flow(flow: Element) -> bool:
    return flow.kind is Kind.ITEM_FLOW


def _enters(graph: Graph, port: Element, flow: Element) -> bool:
    """Whether the flow runs between the port and the inside of its block.

    What starts at a block's own port and goes to a part has come in through it.
    """
    realising = [one for one in graph.targets(flow, Edge.REALIZING) if one.kind is Kind.CONNECTOR]
    return any(_delegates(graph, one, port) for one in realising or _joining(graph, port, flow))


def _joining(graph: Graph, port: Element, flow: Element) -> list[Element]:
    other = flow_target(graph, flow) if flow_source(graph, flow) is port else None
    other = other or flow_source(graph, flow)
    if other is None:
        return []
    there = {one.id for one in connectors_of(graph, other)}
    return [one for one in connectors_of(graph, port) if one.id in there]


def _delegates(graph: Graph, connector: Element, port: Element) -> bool:
    attached = ends(graph, connector)
    own = [one for one in attached if role_of(graph, one) is port]
    outer = [one for one in attached if is_boundary(graph, one)]
    return len(outer) < len(attached) and any(one in outer for one in own)


def _redefined(graph: Graph, port: Element) -> str | None:
    directions = (one.attrs.get("direction") for one in redefined_features(graph, port))
    return next((str(one) for one in directions if one), None)


# -- rules -------------------------------------------------------------------------------------


def _is_typed(graph: Graph, port: Element) -> bool:
    """Whether it has a type, or what is missing is told already."""
    unresolved = port.attrs.get("unresolved") or ()
    broken = isinstance(unresolved, tuple) and Edge.TYPED_BY.value in unresolved
    has_type = graph.target(port, Edge.TYPED_BY) is not None
    return has_type or broken or bool(port.attrs.get("external"))


def _report_plants(graph: Graph, sink: Sink, ports: list[Element]) -> None:
    own = [port for port in ports if not port.attrs.get("external")]
    untyped = [port for port in own if not _is_typed(graph, port)]
    plant_ports.report(graph, sink, plant_ports.UNTYPED, untyped, own)
    undirected = plant_ports.undirected(graph, own)
    plant_ports.report(graph, sink, plant_ports.UNDIRECTED, undirected, own)


def _check_multiplicity(graph: Graph, sink: Sink, feature: Element) -> None:
    multiplicity = feature.attrs.get("multiplicity")
    limits = bounds(multiplicity)
    if limits is None or limits[1] is None:
        return
    if limits[1] < limits[0]:
        name = graph.qualified_name(feature)
        sink.report(
            BAD_MULTIPLICITY, graph.subject(feature), multiplicity=multiplicity, feature=name
        )
    elif limits[1] == 0 and feature.kind is Kind.PORT:
        name = graph.qualified_name(feature)
        sink.report(
            EMPTY_MULTIPLICITY, graph.subject(feature), multiplicity=multiplicity, port=name
        )


def _report_undirected(graph: Graph, sink: Sink, ports: list[Element]) -> None:
    blocks: dict[str, list[Element]] = {}
    for port in ports:
        if port.owner is not None and "direction" not in port.attrs:
            blocks.setdefault(port.owner, []).append(port)
    for id, undirected in blocks.items():
        names = [f"'{one.name or one.id}'" for one in undirected]
        more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
        sink.report(
            UNDIRECTED_PORTS,
            graph.subject(graph[id]),
            block=graph.qualified_name(graph[id]),
            count=len(names),
            ports=", ".join(names[:_LISTED]) + more,
        )
