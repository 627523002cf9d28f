"""Level 1: the tasks of a recipe, their machines and materials, and the order between them."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.data import Data
from sysmlc.passes.recipe.expressions import optional
from sysmlc.passes.recipe.machines import (
    Relation,
    by_partition,
    by_pins,
    by_relation,
    machine_of,
    modes,
)
from sysmlc.passes.recipe.nodes import activity_flows, flow_ends, refinement
from sysmlc.passes.recipe.profile import number
from sysmlc.recipe.model import MaterialUse, Task


class Step(Struct, frozen=True):
    """A task node of a recipe, what defines it, and the activity that refines it."""

    node: Element
    definition: Element | None
    refinement: Element | None


def steps(context: Context, recipe: Element) -> list[Step]:
    """The task nodes of a recipe, in order; what a recipe calls is a task."""
    found = []
    for node in context.nodes(recipe):
        calls = node.kind is Kind.ACTION and node.subkind in ("call-behavior", "call-operation")
        level = context.level(node)
        if level == "task" or (calls and not level):
            definition = context.definition(node)
            found.append(Step(node, definition, refinement(context, definition)))
    return found


def task(context: Context, recipe: Element, step: Step, data: Data) -> Task:
    """One task node as a value."""
    holder = step.definition or step.node
    source = step.node if context.applied(step.node, "Task") else holder
    tags = context.tags(source, "Task")
    return Task(
        context.name(step.node),
        step.node.name or holder.name,
        tags.integer("maxDuration"),
        material_uses(context, recipe, step),
        modes(context, _relations(context, recipe, step)),
        "" if step.refinement is None else context.name(step.refinement),
        optional(tags.text("pre")),
        optional(tags.text("post")),
        data.bind(step.node),
        data.assign(step.node),
        bool(tags.flag("interruptible")),
        bool(tags.flag("noWait")),
        None,
        step.node.id,
    )


# -- machines ----------------------------------------------------------------------------------


def _relations(context: Context, recipe: Element, step: Step) -> Iterator[Relation]:
    """Relations to machines on the node itself; when it has none, those of its definition."""
    own = [*_by_flow(context, recipe, step.node), *by_relation(context, step.node)]
    own += by_partition(context, step.node)
    if not own and step.definition is not None:
        own = [*by_relation(context, step.definition)]
    if not own:
        own = [*by_pins(context, step.node)]
    yield from own


def _by_flow(context: Context, recipe: Element, node: Element) -> Iterator[Relation]:
    for flow, other in _adjacent(context, recipe, node):
        machine = machine_of(context, other)
        if machine is not None:
            yield Relation(flow, (machine,))


def _adjacent(
    context: Context, recipe: Element, node: Element
) -> Iterator[tuple[Element, Element]]:
    """Flows at a node, each with the node at its other end."""
    for flow in activity_flows(context, recipe):
        source, target = flow_ends(context, flow)
        if target is node and source is not None:
            yield flow, source
        elif source is node and target is not None:
            yield flow, target


def is_machine_flow(context: Context, flow: Element) -> bool:
    """Whether a flow only says which machine a task needs."""
    return any(machine_of(context, end) is not None for end in flow_ends(context, flow))


# -- materials ---------------------------------------------------------------------------------


def material_uses(context: Context, recipe: Element, step: Step) -> tuple[MaterialUse, ...]:
    """Materials of a task by the direction of their flows; in and out again is carried."""
    amounts: dict[tuple[str, str], float] = {}
    for flow in activity_flows(context, recipe):
        for material, use, quantity in _use(context, flow, step):
            key = (context.name(material), use)
            amounts[key] = amounts.get(key, 0) + quantity
    for name in {name for name, _ in amounts}:
        if {(name, "consumed"), (name, "produced")} <= amounts.keys():
            amounts[name, "carried"] = amounts.pop((name, "consumed"))
            del amounts[name, "produced"]
    return tuple(
        MaterialUse(name, int(amount) if amount == int(amount) else amount, use)
        for (name, use), amount in sorted(amounts.items())
    )


def _use(context: Context, flow: Element, step: Step) -> Iterator[tuple[Element, str, float]]:
    source, target = flow_ends(context, flow)
    if flow.kind is not Kind.OBJECT_FLOW or step.node not in (source, target):
        return
    material = material_of(context, flow)
    if material is None:
        return
    other = source if target is step.node else target
    holders = [one for one in (flow, other) if one and context.applied(one, "Material")]
    tags = [context.tags(one, "Material") for one in holders]
    quantity = next((q for one in tags if (q := one.amount("quantity"))), None)
    use = next((u for one in tags if (u := one.material_use("use"))), "")
    default = "consumed" if target is step.node else "produced"
    weight = number(str(flow.attrs.get("weight", "")))
    yield material, use or default, quantity if quantity is not None else weight or 1


def material_of(context: Context, flow: Element) -> Element | None:
    """The material that a flow carries: what is typed at one of its ends."""
    graph = context.graph
    ends = (query.flow_source(graph, flow), query.flow_target(graph, flow))
    for end in ends:
        type_ = None if end is None else query.type_of(graph, end)
        if type_ is not None and context.level(type_) == "material":
            return type_
    for end in ends:
        if end is not None and context.own_level(end) == "material":
            return end
    return None


# -- order -------------------------------------------------------------------------------------


def precedence(context: Context, recipe: Element, found: list[Step]) -> tuple[tuple[str, str], ...]:
    """Pairs of tasks, the first done before the second: along control and material flow."""
    following: dict[str, list[Element]] = {}
    for flow in activity_flows(context, recipe):
        source, target = flow_ends(context, flow)
        if source is not None and target is not None and not is_machine_flow(context, flow):
            following.setdefault(source.id, []).append(target)
    ids = {step.node.id for step in found}
    pairs = {
        (context.name(step.node), context.name(after))
        for step in found
        for after in _next_tasks(step.node, following, ids)
    }
    return tuple(sorted(pairs))


def _next_tasks(
    node: Element, following: dict[str, list[Element]], tasks: set[str]
) -> Iterator[Element]:
    seen: set[str] = set()
    stack = list(following.get(node.id, ()))
    while stack:
        one = stack.pop()
        if one.id in seen:
            continue
        seen.add(one.id)
        if one.id in tasks:
            yield one
        else:
            stack.extend(following.get(one.id, ()))
