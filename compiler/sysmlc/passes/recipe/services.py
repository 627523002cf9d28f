"""Levels 2 and 3: services with their providers, machine functions with their resources."""

from collections.abc import Iterator

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.data import data_parameters
from sysmlc.passes.recipe.expressions import optional
from sysmlc.passes.recipe.features import is_data, parameter
from sysmlc.passes.recipe.machines import (
    Relation,
    by_owner,
    by_parameters,
    by_partition,
    by_relation,
    opcua,
    providers,
)
from sysmlc.passes.recipe.nodes import refinement
from sysmlc.recipe.model import Function, MaterialUse, Parameter, Range, Resource, Service

_USES = {"in": "consumed", "out": "produced", "return": "produced", "inout": "carried"}
_MODES = ("acquire", "hold", "release", "use")


def service(context: Context, definition: Element, callers: list[Element]) -> Service:
    """A service as a value; ``callers`` are the nodes that call it in the recipe's tasks.

    Without a level it is a machine service when a machine offers it, else infrastructure.
    """
    level = context.level(definition) or _callers_level(context, callers)
    is_machine = level == "machine service"
    offered = providers(context, _relations(context, definition, callers))
    is_machine = is_machine or (not level and bool(offered))
    stereotype = "MachineService" if is_machine else "InfrastructureService"
    tags = context.tags(_holder(context, definition, callers, stereotype), stereotype)
    refined = refinement(context, definition)
    return Service(
        context.name(definition),
        "machine" if is_machine else "infrastructure",
        data_parameters(context, definition, "in", "inout"),
        data_parameters(context, definition, "out", "inout", "return"),
        constants(context, definition),
        materials(context, definition),
        offered,
        tags.integer("duration"),
        "" if refined is None else context.name(refined),
        optional(tags.text("pre")),
        optional(tags.text("post")),
        bool(tags.flag("interruptible")),
        opcua(context, definition),
        definition.id,
    )


def _callers_level(context: Context, callers: list[Element]) -> str:
    return next((found for one in callers if (found := context.own_level(one))), "")


def _holder(
    context: Context, definition: Element, callers: list[Element], stereotype: str
) -> Element:
    family = [definition, *callers]
    return next((one for one in family if context.applied(one, stereotype)), definition)


def _relations(context: Context, definition: Element, callers: list[Element]) -> Iterator[Relation]:
    """Where a service can run: what is stated, else the owner's machines, else partitions."""
    found = list(by_relation(context, definition)) or list(by_owner(context, definition))
    if not found:
        found = [one for node in callers for one in by_relation(context, node)]
    if not found:
        found = [one for node in callers for one in by_partition(context, node)]
    yield from found or by_parameters(context, definition)


def constants(context: Context, definition: Element) -> tuple[Parameter, ...]:
    """Read-only attributes that hold values."""
    owned = context.graph.owned(definition)
    found = (one for one in owned if one.kind is Kind.PROPERTY and one.attrs.get("readonly"))
    return tuple(parameter(context, one) for one in found if is_data(context, one))


def materials(context: Context, definition: Element) -> tuple[MaterialUse, ...]:
    """Materials that go in or out as parameters; in and out again is carried."""
    found: dict[str, MaterialUse] = {}
    for one in query.parameters(context.graph, definition):
        type_ = query.type_of(context.graph, one)
        if type_ is None or context.level(type_) != "material":
            continue
        limits = query.bounds(one.attrs.get("multiplicity"))
        name, quantity = context.name(type_), 1 if limits is None else limits[0]
        use = _USES[query.direction_of(one)]
        before = found.get(name)
        if before is not None and before.use != use:
            use, quantity = "carried", max(quantity, int(before.quantity))
        if quantity > 0:
            found[name] = MaterialUse(name, quantity, use)
    return tuple(found[name] for name in sorted(found))


def function(context: Context, definition: Element, callers: list[Element]) -> Function:
    """A machine function as a value."""
    tags = context.tags(_holder(context, definition, callers, "MachineFunction"), "MachineFunction")
    exact = tags.integer("duration")
    bounds = tags.range("minDuration", "maxDuration")
    return Function(
        context.name(definition),
        data_parameters(context, definition, "in", "inout"),
        data_parameters(context, definition, "out", "inout", "return"),
        bounds if exact is None else Range(exact, exact),
        tuple(
            Resource(context.reference(id), mode)
            for mode in _MODES
            for id in sorted(tags.ids(mode), key=context.reference)
        ),
        bool(tags.flag("interruptible")),
        opcua(context, definition),
        definition.id,
    )
