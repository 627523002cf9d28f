"""Machines, materials, and the relations of tasks and services to machines."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.expressions import optional
from sysmlc.passes.recipe.features import is_data, value
from sysmlc.passes.recipe.profile import Tags
from sysmlc.recipe.model import Machine, Material, Mode, OpcUa, Provider, Range
from sysmlc.recipe.plant import is_of_plant


class Relation(Struct, frozen=True):
    """What relates a task or a service to machines: a dependency, object flow or partition."""

    element: Element
    machines: tuple[Element, ...]


def machine_of(context: Context, element: Element | None) -> Element | None:
    """The machine that an element is or stands for; None when it is none.

    An object node or pin stands for its type when that is a machine; a property, instance or
    class is itself one.
    """
    if element is None or context.level(element) != "machine":
        return None
    if element.kind in (Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.PIN, Kind.ACTIVITY_PARAMETER):
        type_ = query.type_of(context.graph, element)
        return type_ if type_ is not None and context.level(type_) == "machine" else element
    return element


# -- relations ---------------------------------------------------------------------------------


def by_relation(context: Context, client: Element) -> Iterator[Relation]:
    """Dependencies, allocations and associations from a task or service to machines."""
    for one in context.graph.sources(client, Edge.CLIENT):
        is_allocation = one.role == "allocate" or context.applied(one, "Capability") is not None
        suppliers = [
            supplier
            for supplier in context.graph.targets(one, Edge.SUPPLIER)
            if not _is_of_plant(context, supplier)
        ]
        if is_allocation and suppliers:
            yield Relation(one, tuple(suppliers))
    yield from _by_association(context, client)


def _is_of_plant(context: Context, supplier: Element) -> bool:
    """Whether it says where in the plant a service runs: the pass ``platform`` reads that."""
    if context.level(supplier) == "machine":
        return False
    return supplier.kind is Kind.OPERATION or is_of_plant(context.graph, supplier)


def _by_association(context: Context, client: Element) -> Iterator[Relation]:
    """Associations with «Capability» between the element and a machine."""
    for end in context.graph.sources(client, Edge.TYPED_BY):
        association = context.graph.source(end, Edge.END)
        if association is None or context.applied(association, "Capability") is None:
            continue
        other = query.opposite_end(context.graph, association, end)
        machine = None if other is None else query.type_of(context.graph, other)
        if machine is not None:
            yield Relation(association, (machine,))


def by_partition(context: Context, node: Element) -> Iterator[Relation]:
    """Partitions that represent machines."""
    for partition in context.graph.targets(node, Edge.IN_PARTITION):
        represented = context.graph.target(partition, Edge.REPRESENTS)
        machine = machine_of(context, represented) or machine_of(context, partition)
        if machine is not None:
            yield Relation(partition, (machine,))


def by_pins(context: Context, step: Element) -> Iterator[Relation]:
    """The machines that are given to a step as arguments: it needs all of them at once."""
    found = _machines_in(context, (pin for pin in context.graph.owned(step) if _is_in(pin)))
    if found:
        yield Relation(step, found)


def by_parameters(context: Context, behavior: Element) -> Iterator[Relation]:
    """The machines that are given to a behaviour as parameters."""
    for machine in _machines_in(context, query.parameters(context.graph, behavior, "in")):
        yield Relation(behavior, (machine,))


def _is_in(pin: Element) -> bool:
    return pin.kind is Kind.PIN and pin.attrs.get("direction") == "in" and "value" in pin.attrs


def _machines_in(context: Context, features: Iterable[Element]) -> tuple[Element, ...]:
    types = (query.type_of(context.graph, one) for one in features)
    found = (one for one in types if one is not None and context.level(one) == "machine")
    return tuple(dict.fromkeys(found))


def by_owner(context: Context, behavior: Element) -> Iterator[Relation]:
    """Machines whose class owns the operation or behaviour, or an operation that it implements."""
    operations = context.graph.sources(behavior, Edge.METHOD)
    for feature in [behavior, *operations]:
        owner = context.graph.owner(feature)
        if owner is None or owner.kind not in (Kind.CLASS, Kind.COMPONENT):
            continue
        for machine in _machines_like(context, owner):
            yield Relation(feature, (machine,))


def _machines_like(context: Context, owner: Element) -> Iterator[Element]:
    for one in context.of_level("machine"):
        is_class = one.kind in (Kind.CLASS, Kind.COMPONENT) and not one.attrs.get("abstract")
        if is_class and query.conforms(context.graph, one, owner):
            yield one


# -- modes and providers -----------------------------------------------------------------------


def modes(context: Context, relations: Iterator[Relation]) -> tuple[Mode, ...]:
    """Ways to equip a task; relations with one ``mode`` are needed at the same time."""
    groups: dict[str, list[Mode]] = {}
    for relation in relations:
        tags = context.tags(relation.element, "Capability")
        key = tags.text("mode") or f"\x00{relation.element.id}"
        groups.setdefault(key, []).append(_mode(context, relation))
    return tuple(sorted(map(_together, groups.values()), key=lambda mode: mode.machines))


def _mode(context: Context, relation: Relation) -> Mode:
    tags = context.tags(relation.element, "Capability")
    return Mode(
        tuple(sorted(context.name(one) for one in relation.machines)),
        tags.integer("duration"),
        tags.range("minPower", "maxPower"),
        tuple(sorted(map(context.reference, tags.ids("tools")))),
        tags.flag("available"),
    )


def _together(parts: list[Mode]) -> Mode:
    durations = [part.duration for part in parts if part.duration is not None]
    powers = [part.power for part in parts if part.power is not None]
    known = [part.available for part in parts if part.available is not None]
    return Mode(
        tuple(sorted({machine for part in parts for machine in part.machines})),
        max(durations, default=None),
        _sum(powers),
        tuple(sorted({tool for part in parts for tool in part.tools})),
        all(known) if known else None,
    )


def _sum(powers: list[Range]) -> Range | None:
    if not powers:
        return None
    highs = [one.max for one in powers if one.max is not None]
    return Range(sum(one.min for one in powers), sum(highs))


def providers(context: Context, relations: Iterator[Relation]) -> tuple[Provider, ...]:
    """Machines that offer a service, each once, sorted."""
    found: dict[str, Provider] = {}
    for relation in relations:
        mode = _mode(context, relation)
        for machine in mode.machines:
            call = opcua(context, relation.element)
            made = Provider(machine, mode.duration, mode.power, mode.tools, call)
            found.setdefault(machine, made)
    return tuple(found[machine] for machine in sorted(found))


_OPC_UA = ("opc ua call", "opc ua variable")
_OF_SPACE = ("parentNodeId", "nodeId")
"""Tags of other stereotypes for OPC UA calls: the object and its method."""


def _call(context: Context, element: Element) -> Element | None:
    if not context.may_have_stereotype(element):
        return None
    found = context.applied(element, "OpcUaCall")
    for one in query.applications(context.graph, element):
        stereotype = context.graph.target(one, Edge.INSTANCE_OF)
        if stereotype is not None and context.own_level(stereotype) in _OPC_UA:
            found = found or one
    return found


def opcua(context: Context, element: Element) -> OpcUa | None:
    """The OPC UA call on an element, or on the behaviour that implements it; or None.

    A stereotype that the options give the level has the node ids as ``nodeId`` and
    ``parentNodeId``, the words of OPC UA's own address space.
    """
    family = [element, *context.graph.targets(element, Edge.METHOD)]
    application = next((one for each in family if (one := _call(context, each))), None)
    if application is None:
        return None
    tags = Tags(application.attrs)
    return OpcUa(
        tags.call_kind("kind") or "call",
        tags.text("object") or tags.text(_OF_SPACE[0]),
        tags.text("method") or tags.text(_OF_SPACE[1]),
        tags.endpoint("endpoint") or "",
        tags.text("namespaceUri"),
        optional(tags.text("doneWhen")),
        tags.integer("timeout"),
        element.id,
    )


def opcua_node(context: Context, variable: Element) -> str:
    """The OPC UA node of a variable as written, or the empty string."""
    application = _call(context, variable)
    tags = Tags({} if application is None else application.attrs)
    found = (tags.text(name) for name in ("node", _OF_SPACE[1], "object"))
    return next((text for text in found if text), "")


# -- machines and materials --------------------------------------------------------------------


def machine(context: Context, element: Element) -> Machine:
    """An element at the level machine as a value; tags may stand on its class."""
    family = [element, *query.generals(context.graph, element)]
    type_ = query.type_of(context.graph, element)
    family += [] if type_ is None else [type_]
    holder = next((one for one in family if context.applied(one, "Machine")), element)
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


def material(context: Context, element: Element) -> Material:
    """An element at the level material as a value, with its attributes as properties."""
    tags = context.tags(element, "Material")
    return Material(
        context.name(element),
        tags.amount("available"),
        tags.text("unit"),
        tags.text("position"),
        tags.integer("buffer"),
        bool(tags.flag("noWait")),
        tuple(sorted(_properties(context, element), key=_by_name)),
        element.id,
    )


def _by_name(property_: tuple[str, object]) -> tuple[str, str]:
    """Properties of one name can have values that do not compare, as 1 and ``red``."""
    return property_[0], str(property_[1])


def _properties(
    context: Context, element: Element
) -> Iterator[tuple[str, bool | int | float | str]]:
    for one in query.features(context.graph, element):
        found = value(one)
        if one.kind is Kind.PROPERTY and found is not None and is_data(context, one):
            named = context.graph.get(found) if isinstance(found, str) else None
            yield one.name, found if named is None else named.name
