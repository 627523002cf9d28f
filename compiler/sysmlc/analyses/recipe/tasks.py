"""Level 1: tasks of a recipe, their machines, materials and order, and their required times."""

import re
from collections.abc import Iterator
from fractions import Fraction
from math import ceil, floor

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.analyses.recipe.activity_graph import Flow
from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.data_flow import DataFlow
from sysmlc.analyses.recipe.expressions import read_optional
from sysmlc.analyses.recipe.machines import (
    Relation,
    build_modes,
    find_machine,
    find_material_unit,
    relations_by_dependency,
    relations_by_partition,
    relations_by_pins,
)
from sysmlc.analyses.recipe.nodes import find_refinement
from sysmlc.analyses.recipe.profile import read_number
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.ir.algorithms import find_reachable
from sysmlc.recipe.model import MaterialUse, Task, TimeLimit
from sysmlc.support.units import read_duration


class Step(Struct, frozen=True):
    """A task node of a recipe, its definition, and the activity that refines it."""

    node: Element
    definition: Element | None
    refinement: Element | None


def list_steps(context: Context, recipe: Element) -> list[Step]:
    """Return the task nodes of a recipe, in order. Called elements without a level are tasks."""
    steps = []
    for node in context.read_activity(recipe).nodes:
        calls = node.kind is Kind.ACTION and node.subkind in ("call-behavior", "call-operation")
        level = context.level(node)
        if level == "task" or (calls and not level):
            definition = context.definition(node)
            steps.append(Step(node, definition, find_refinement(context, definition)))
    return steps


def build_task(context: Context, recipe: Element, step: Step, data: DataFlow) -> Task:
    """Return the task for a task node."""
    holder = step.definition or step.node
    tags = context.tags(holder, "Task")
    if holder is not step.node:
        tags = tags.override(context.tags(step.node, "Task"))
    return Task(
        context.name(step.node),
        step.node.name or holder.name,
        tags.integer("maxDuration"),
        build_material_uses(context, recipe, step),
        build_modes(context, find_task_relations(context, recipe, step)),
        "" if step.refinement is None else context.name(step.refinement),
        read_optional(tags.text("pre")),
        read_optional(tags.text("post")),
        data.bind_inputs(step.node),
        data.assign_outputs(step.node),
        bool(tags.flag("interruptible")),
        bool(tags.flag("noWait")),
        None,
        step.node.id,
        read_limits(context, [step.node, step.definition, step.refinement]),
    )


# -- machines ----------------------------------------------------------------------------------


def find_task_relations(context: Context, recipe: Element, step: Step) -> Iterator[Relation]:
    """Yield the relations of a task to machines.

    These are the relations of its node, or else of its definition, or else its machine arguments.
    """
    relations = [
        *_relations_by_flow(context, recipe, step.node),
        *relations_by_dependency(context, step.node),
    ]
    relations += relations_by_partition(context, step.node)
    if not relations and step.definition is not None:
        relations = [*relations_by_dependency(context, step.definition)]
    if not relations:
        relations = [*relations_by_pins(context, step.node)]
    yield from relations


def _relations_by_flow(context: Context, recipe: Element, node: Element) -> Iterator[Relation]:
    """Yield the flows between the node and object nodes that stand for machines."""
    for flow in context.read_activity(recipe).flows:
        if node in (flow.source, flow.target):
            neighbour = flow.source if flow.target is node else flow.target
            machine = find_machine(context, neighbour)
            if machine is not None:
                yield Relation(flow.element, (machine,))


# -- materials ---------------------------------------------------------------------------------


def build_material_uses(context: Context, recipe: Element, step: Step) -> tuple[MaterialUse, ...]:
    """Return the materials that a task consumes, produces or carries.

    The direction of a flow decides between consumed and produced. A material in both directions is
    carried.
    """
    amounts: dict[tuple[str, str], float] = {}
    for flow in context.read_activity(recipe).flows:
        for material, use, quantity in _read_use(context, flow, step):
            key = (context.name(material), use)
            amounts[key] = amounts.get(key, 0) + quantity
    # A material that flows in and out again is one use; the amount that flows in counts.
    for name in {name for name, _ in amounts}:
        if {(name, "consumed"), (name, "produced")} <= amounts.keys():
            amounts[name, "carried"] = amounts.pop((name, "consumed"))
            del amounts[name, "produced"]
    return tuple(
        MaterialUse(name, int(amount) if amount == int(amount) else amount, use)
        for (name, use), amount in sorted(amounts.items())
    )


def _read_use(context: Context, flow: Flow, step: Step) -> Iterator[tuple[Element, str, float]]:
    if flow.element.kind is not Kind.OBJECT_FLOW or step.node not in (flow.source, flow.target):
        return
    material = find_material(context, flow.element)
    if material is None:
        return
    neighbour = flow.source if flow.target is step.node else flow.target
    holders = [
        holder
        for holder in (flow.element, neighbour)
        if context.find_application(holder, "Material")
    ]
    unit = find_material_unit(context, material)
    tags = [replace(context.tags(holder, "Material"), material_unit=unit) for holder in holders]
    quantity = next((amount for holder in tags if (amount := holder.amount("quantity"))), None)
    use = next((use for holder in tags if (use := holder.material_use("use"))), "")
    default = "consumed" if flow.target is step.node else "produced"
    weight = read_number(str(flow.element.attrs.get("weight", "")))
    yield material, use or default, quantity if quantity is not None else weight or 1


def find_material(context: Context, flow: Element) -> Element | None:
    """Return the material that a flow transports: the type of one end, or the end itself."""
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


def find_precedence(
    context: Context, recipe: Element, steps: list[Step]
) -> tuple[tuple[str, str], ...]:
    """Return the pairs of tasks that a path of control and material flows connects directly."""
    following: dict[str, list[str]] = {}
    for flow in context.read_activity(recipe).flows:
        # A flow to or from a machine only states which machine a task needs.
        if not any(find_machine(context, end) for end in (flow.source, flow.target)):
            following.setdefault(flow.source.id, []).append(flow.target.id)
    names = {step.node.id: context.name(step.node) for step in steps}
    return tuple(
        sorted(
            (names[task], names[next_task])
            for task in names
            for next_task in names.keys()
            & find_reachable(
                following.get(task, ()),
                lambda id: () if id in names else following.get(id, ()),
            )
        )
    )


# -- times that requirements state -------------------------------------------------------------

_NUMBER = r"(\d+(?:\.\d+)?\s*[a-z\u00b5\u03bc]+)\b(?!/)"
_MOST = re.compile(
    rf"\b(?:at most|within|in less than|no longer than|not longer than|no more than|not more than"
    rf"|less than|up to)\s+{_NUMBER}",
    re.IGNORECASE,
)
_LEAST = re.compile(
    rf"\b(?:at least|no less than|not less than|more than|longer than)\s+{_NUMBER}", re.IGNORECASE
)
_NOT_BOUND = re.compile(r"\b(?:no|not)\s+(?:more|longer) than", re.IGNORECASE)
_PART = re.compile(
    r"\b(?:after|before|when|whenever|if|while|once|until|unless|each|every|between|since"
    r"|per|interval)\b",
    re.IGNORECASE,
)
"""Words of statements about a part of an execution, which its whole time does not decide."""


def read_limits(context: Context, elements: list[Element | None]) -> tuple[TimeLimit, ...]:
    """Return the times in the texts of the requirements that *elements* satisfy, sorted."""
    limits = {
        requirement.id: limit
        for element in elements
        if element is not None
        for requirement in context.graph.targets(element, Edge.SATISFIES)
        if query.is_requirement(requirement)
        and (limit := _read_limit(context, requirement)) is not None
    }
    return tuple(sorted(limits.values(), key=lambda limit: limit.requirement))


def _read_limit(context: Context, requirement: Element) -> TimeLimit | None:
    text = query.requirement_text(context.graph, requirement)
    if _PART.search(text):
        return None
    least = list(_iter_times(_LEAST, _NOT_BOUND.sub("at most", text)))
    most = list(_iter_times(_MOST, text))
    if len(least) > 1 or len(most) > 1 or not (least or most):
        return None
    # Derived times are whole numbers, so that they reach a limit just when they reach these.
    return TimeLimit(
        context.name(requirement),
        ceil(least[0]) if least else None,
        floor(most[0]) if most else None,
        requirement.id,
    )


def _iter_times(pattern: re.Pattern[str], text: str) -> Iterator[Fraction]:
    """Yield the times in milliseconds that follow the words of *pattern*."""
    for quantity in pattern.findall(text):
        duration = read_duration(quantity)
        if duration is not None and duration.milliseconds is not None:
            yield duration.milliseconds
