"""Levels 2 and 3: services with their providers, machine functions with their resources."""

from collections.abc import Iterator

from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.data_flow import list_data_parameters
from sysmlc.analyses.recipe.expressions import build_parameter, is_data, read_optional
from sysmlc.analyses.recipe.machines import (
    Relation,
    build_opcua,
    build_providers,
    relations_by_dependency,
    relations_by_owner,
    relations_by_parameters,
    relations_by_partition,
)
from sysmlc.analyses.recipe.nodes import find_refinement
from sysmlc.ir import Element, Kind, query
from sysmlc.recipe.model import Function, MaterialUse, Parameter, Range, Resource, Service

_USES = {"in": "consumed", "out": "produced", "return": "produced", "inout": "carried"}
_RESOURCE_MODES = ("acquire", "hold", "release", "use")


def build_service(context: Context, definition: Element, callers: list[Element]) -> Service:
    """Return the service of a definition; *callers* are the nodes that call it in the recipe.

    A service without a level is a machine service if a machine offers it, or else an infrastructure
    service.
    """
    levels = (context.level(definition), *map(context.own_level, callers))
    level = next(filter(None, levels), "")
    is_machine = level == "machine service"
    offers = build_providers(context, find_service_relations(context, definition, callers))
    is_machine = is_machine or (not level and bool(offers))
    stereotype = "MachineService" if is_machine else "InfrastructureService"
    tags = context.tags(_find_holder(context, definition, callers, stereotype), stereotype)
    refining_activity = find_refinement(context, definition)
    return Service(
        context.name(definition),
        "machine" if is_machine else "infrastructure",
        list_data_parameters(context, definition, "in", "inout"),
        list_data_parameters(context, definition, "out", "inout", "return"),
        _build_constants(context, definition),
        build_material_uses(context, definition),
        offers,
        tags.integer("duration"),
        "" if refining_activity is None else context.name(refining_activity),
        read_optional(tags.text("pre")),
        read_optional(tags.text("post")),
        bool(tags.flag("interruptible")),
        build_opcua(context, definition),
        definition.id,
    )


def _find_holder(
    context: Context, definition: Element, callers: list[Element], stereotype: str
) -> Element:
    family = [definition, *callers]
    return next(
        (element for element in family if context.find_application(element, stereotype)), definition
    )


def find_service_relations(
    context: Context, definition: Element, callers: list[Element]
) -> Iterator[Relation]:
    """Yield the relations of a service to the machines that offer it.

    The first of these sources with a result counts: dependencies of the definition, its owner,
    dependencies of its callers, partitions of its callers, its machine parameters.
    """
    sources = (
        relations_by_dependency(context, definition),
        relations_by_owner(context, definition),
        (relation for node in callers for relation in relations_by_dependency(context, node)),
        (relation for node in callers for relation in relations_by_partition(context, node)),
        relations_by_parameters(context, definition),
    )
    yield from next((relations for source in sources if (relations := list(source))), ())


def _build_constants(context: Context, definition: Element) -> tuple[Parameter, ...]:
    """Return the read-only attributes of a definition, without machines and materials."""
    owned = context.graph.owned(definition)
    attributes = (
        element
        for element in owned
        if element.kind is Kind.PROPERTY and element.attrs.get("readonly")
    )
    return tuple(
        build_parameter(context, element) for element in attributes if is_data(context, element)
    )


def build_material_uses(context: Context, definition: Element) -> tuple[MaterialUse, ...]:
    """Return the materials among the parameters; an input that is also an output is carried."""
    uses: dict[str, MaterialUse] = {}
    for parameter in query.parameters(context.graph, definition):
        type_ = query.type_of(context.graph, parameter)
        if type_ is None or context.level(type_) != "material":
            continue
        limits = query.bounds(parameter.attrs.get("multiplicity"))
        name, quantity = context.name(type_), 1 if limits is None else limits[0]
        use = _USES[query.direction_of(parameter)]
        earlier = uses.get(name)
        if earlier is not None and earlier.use != use:
            use, quantity = "carried", max(quantity, int(earlier.quantity))
        if quantity > 0:
            uses[name] = MaterialUse(name, quantity, use)
    return tuple(uses[name] for name in sorted(uses))


def build_function(context: Context, definition: Element, callers: list[Element]) -> Function:
    """Return the machine function of a definition; *callers* are the nodes that call it."""
    tags = context.tags(
        _find_holder(context, definition, callers, "MachineFunction"), "MachineFunction"
    )
    exact = tags.integer("duration")
    bounds = tags.range("minDuration", "maxDuration")
    return Function(
        context.name(definition),
        list_data_parameters(context, definition, "in", "inout"),
        list_data_parameters(context, definition, "out", "inout", "return"),
        bounds if exact is None else Range(exact, exact),
        tuple(
            Resource(context.reference(id), mode)
            for mode in _RESOURCE_MODES
            for id in sorted(tags.ids(mode), key=context.reference)
        ),
        bool(tags.flag("interruptible")),
        build_opcua(context, definition),
        definition.id,
    )
