"""Machines, materials, and the relations of tasks and services to machines."""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.expressions import (
    is_data,
    literal_default,
    read_default,
    read_optional,
)
from sysmlc.analyses.recipe.profile import read_tags
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.recipe.model import Machine, Material, Mode, OpcUa, Provider, Range, Scalar
from sysmlc.recipe.plant import is_in_plant


class Relation(Struct, frozen=True):
    """A dependency, object flow or partition that relates a task or a service to machines."""

    element: Element
    machines: tuple[Element, ...]


def find_machine(context: Context, element: Element | None) -> Element | None:
    """Return the machine that an element represents, or None.

    An object node or pin represents its type if the type is a machine. A property, instance or
    class of the level machine represents itself.
    """
    if element is None or context.level(element) != "machine":
        return None
    if element.kind in (Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.PIN, Kind.ACTIVITY_PARAMETER):
        type_ = query.type_of(context.graph, element)
        return type_ if type_ is not None and context.level(type_) == "machine" else element
    return element


# -- relations ---------------------------------------------------------------------------------


def relations_by_dependency(context: Context, client: Element) -> Iterator[Relation]:
    """Yield dependencies, allocations and associations from a task or service to machines."""
    for dependency in list_allocations(context, client):
        suppliers = [
            supplier
            for supplier in context.graph.targets(dependency, Edge.SUPPLIER)
            if not _is_plant_location(context, supplier)
        ]
        if suppliers:
            yield Relation(dependency, tuple(suppliers))
    yield from _relations_by_association(context, client)


def list_allocations(context: Context, client: Element) -> list[Element]:
    """Return the allocations and the dependencies with «Capability» of a task or service."""
    return [
        dependency
        for dependency in context.graph.sources(client, Edge.CLIENT)
        if dependency.role == "allocate"
        or context.find_application(dependency, "Capability") is not None
    ]


def _is_plant_location(context: Context, supplier: Element) -> bool:
    """Whether the analysis ``platform`` reads the supplier: an operation or a plant element."""
    if context.level(supplier) == "machine":
        return False
    return supplier.kind is Kind.OPERATION or is_in_plant(context.graph, supplier)


def _relations_by_association(context: Context, client: Element) -> Iterator[Relation]:
    """Yield the associations with «Capability» between the element and a machine."""
    for end in context.graph.sources(client, Edge.TYPED_BY):
        association = context.graph.source(end, Edge.END)
        if association is None or context.find_application(association, "Capability") is None:
            continue
        other = query.opposite_end(context.graph, association, end)
        machine = None if other is None else query.type_of(context.graph, other)
        if machine is not None:
            yield Relation(association, (machine,))


def relations_by_partition(context: Context, node: Element) -> Iterator[Relation]:
    """Yield the partitions of a node that represent machines."""
    for partition in context.graph.targets(node, Edge.IN_PARTITION):
        represented = context.graph.target(partition, Edge.REPRESENTS)
        machine = find_machine(context, represented) or find_machine(context, partition)
        if machine is not None:
            yield Relation(partition, (machine,))


def relations_by_pins(context: Context, step: Element) -> Iterator[Relation]:
    """Yield one relation to all machines that are arguments of a step, which needs all of them."""
    pins = (pin for pin in context.graph.owned(step) if pin.kind is Kind.PIN)
    arguments = (p for p in pins if p.attrs.get("direction") == "in" and "value" in p.attrs)
    machines = _machines_of_features(context, arguments)
    if machines:
        yield Relation(step, machines)


def relations_by_parameters(context: Context, behavior: Element) -> Iterator[Relation]:
    """Yield one relation for each machine among the input parameters of a behaviour."""
    for machine in _machines_of_features(context, query.parameters(context.graph, behavior, "in")):
        yield Relation(behavior, (machine,))


def _machines_of_features(context: Context, features: Iterable[Element]) -> tuple[Element, ...]:
    types = (query.type_of(context.graph, feature) for feature in features)
    machines = (type_ for type_ in types if type_ is not None and context.level(type_) == "machine")
    return tuple(dict.fromkeys(machines))


def relations_by_owner(context: Context, behavior: Element) -> Iterator[Relation]:
    """Yield the machines whose class owns the behaviour, or an operation that it implements."""
    operations = context.graph.sources(behavior, Edge.METHOD)
    for feature in [behavior, *operations]:
        owner = context.graph.owner(feature)
        if owner is None or owner.kind not in (Kind.CLASS, Kind.COMPONENT):
            continue
        for machine in _conforming_machines(context, owner):
            yield Relation(feature, (machine,))


def _conforming_machines(context: Context, owner: Element) -> Iterator[Element]:
    for machine in context.elements_of_level("machine"):
        is_class = machine.kind in (Kind.CLASS, Kind.COMPONENT) and not machine.attrs.get(
            "abstract"
        )
        if is_class and query.conforms(context.graph, machine, owner):
            yield machine


# -- modes and providers -----------------------------------------------------------------------


def build_modes(context: Context, relations: Iterator[Relation]) -> tuple[Mode, ...]:
    """Return the modes of a task: sets of machines, each of which suffices to perform it.

    Relations with the same tag ``mode`` form one set, other relations a set of their own.
    """
    groups: dict[str, list[Mode]] = {}
    for relation in relations:
        tags = context.tags(relation.element, "Capability")
        # No tag contains the character NUL, so that a relation without a mode stays alone.
        key = tags.text("mode") or f"\x00{relation.element.id}"
        groups.setdefault(key, []).append(_build_mode(context, relation))
    return tuple(sorted(map(_combine_modes, groups.values()), key=lambda mode: mode.machines))


def _build_mode(context: Context, relation: Relation) -> Mode:
    tags = context.tags(relation.element, "Capability")
    return Mode(
        tuple(sorted(context.name(machine) for machine in relation.machines)),
        tags.integer("duration"),
        tags.range("minPower", "maxPower"),
        tuple(sorted(map(context.reference, tags.ids("tools")))),
        tags.flag("available"),
    )


def _combine_modes(parts: list[Mode]) -> Mode:
    durations = [part.duration for part in parts if part.duration is not None]
    powers = [part.power for part in parts if part.power is not None]
    availabilities = [part.available for part in parts if part.available is not None]
    return Mode(
        tuple(sorted({machine for part in parts for machine in part.machines})),
        max(durations, default=None),
        _sum_powers(powers),
        tuple(sorted({tool for part in parts for tool in part.tools})),
        all(availabilities) if availabilities else None,
    )


def _sum_powers(powers: list[Range]) -> Range | None:
    if not powers:
        return None
    highs = [power.max for power in powers if power.max is not None]
    return Range(sum(power.min for power in powers), sum(highs))


def build_providers(context: Context, relations: Iterator[Relation]) -> tuple[Provider, ...]:
    """Return the machines that offer a service, each once, sorted."""
    by_machine: dict[str, Provider] = {}
    for relation in relations:
        mode = _build_mode(context, relation)
        for machine in mode.machines:
            call = build_opcua(context, relation.element)
            provider = Provider(
                machine, mode.duration, mode.power, mode.tools, call, mode.available
            )
            by_machine.setdefault(machine, provider)
    return tuple(by_machine[machine] for machine in sorted(by_machine))


_OPC_UA_LEVELS = ("opc ua call", "opc ua variable")
_ADDRESS_SPACE_TAGS = ("parentNodeId", "nodeId")
"""Tags for the object and its method, in stereotypes of other profiles for OPC UA calls."""


def _find_opcua_application(context: Context, element: Element) -> Element | None:
    application = context.find_application(element, "OpcUaCall")
    for candidate in query.applications(context.graph, element):
        stereotype = context.graph.target(candidate, Edge.INSTANCE_OF)
        if stereotype is not None and context.own_level(stereotype) in _OPC_UA_LEVELS:
            application = application or candidate
    return application


def build_opcua(context: Context, element: Element) -> OpcUa | None:
    """Return the OPC UA call of an element or of the behaviour that implements it, or None.

    A stereotype of another profile with this level has its node ids in the tags ``nodeId`` and
    ``parentNodeId``, the words of OPC UA's own address space.
    """
    family = [element, *context.graph.targets(element, Edge.METHOD)]
    application = next(
        (call for holder in family if (call := _find_opcua_application(context, holder))), None
    )
    if application is None:
        return None
    tags = read_tags(context.graph, application)
    return OpcUa(
        tags.call_kind("kind") or "call",
        tags.text("object") or tags.text(_ADDRESS_SPACE_TAGS[0]),
        tags.text("method") or tags.text(_ADDRESS_SPACE_TAGS[1]),
        tags.endpoint("endpoint") or "",
        tags.text("namespaceUri"),
        read_optional(tags.text("doneWhen")),
        tags.integer("timeout"),
        element.id,
    )


def find_opcua_node(context: Context, variable: Element) -> str:
    """Return the text of a variable's OPC UA node id, or the empty string."""
    application = _find_opcua_application(context, variable)
    tags = read_tags(context.graph, application)
    texts = (tags.text(name) for name in ("node", _ADDRESS_SPACE_TAGS[1], "object"))
    return next((text for text in texts if text), "")


# -- machines and materials --------------------------------------------------------------------


def build_machine(context: Context, element: Element) -> Machine:
    """Return the machine of an element; its tags may be on the element, a general or its type."""
    family = [element, *query.generals(context.graph, element)]
    type_ = query.type_of(context.graph, element)
    family += [] if type_ is None else [type_]
    holder = next(
        (candidate for candidate in family if context.find_application(candidate, "Machine")),
        element,
    )
    tags = context.tags(holder, "Machine")
    plant = tags.text("plantElement")
    return Machine(
        context.name(element),
        tags.text("machineClass"),
        tags.text("amlId"),
        tags.endpoint("endpoint") or "",
        context.reference(plant) if plant else "",
        element=element.id,
    )


def build_material(context: Context, element: Element) -> Material:
    """Return the material of an element, with its attributes as properties."""
    unit = find_material_unit(context, element)
    tags = replace(context.tags(element, "Material"), material_unit=unit)
    # By text: values of one name, such as `1` and `red`, may not be comparable.
    properties = sorted(
        _list_properties(context, element), key=lambda item: (item[0], str(item[1]))
    )
    return Material(
        context.name(element),
        tags.amount("available"),
        unit,
        tags.text("position"),
        tags.integer("buffer"),
        bool(tags.flag("noWait")),
        tuple((name, value) for name, value, _ in properties),
        element.id,
        tuple((name, measure) for name, _, measure in properties if measure),
    )


def find_material_unit(context: Context, material: Element) -> str:
    """Return the unit of a material: its tag ``unit``, else the unit of the available amount."""
    tags = context.tags(material, "Material")
    return tags.text("unit") or tags.unit("available")


def _list_properties(context: Context, element: Element) -> Iterator[tuple[str, Scalar, str]]:
    """Yield the name, the value and the unit of each attribute with a constant value."""
    for feature in query.features(context.graph, element):
        default = literal_default(context, feature)
        if feature.kind is Kind.PROPERTY and default is not None and is_data(context, feature):
            value_element = context.graph.get(default) if isinstance(default, str) else None
            value = default if value_element is None else value_element.name
            yield feature.name, value, read_default(context, feature)[0]
