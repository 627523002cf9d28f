"""Reports of the recipe analysis: unreadable tags, levels by position and omitted content."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

from msgspec.structs import replace

from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.data_flow import DataFlow, find_bound_feature
from sysmlc.analyses.recipe.graphs import refine
from sysmlc.analyses.recipe.machines import find_material_unit
from sysmlc.analyses.recipe.profile import MAX_NUMBER, Tags, read_tags
from sysmlc.analyses.recipe.tasks import find_material, list_steps
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.recipe.model import Model
from sysmlc.support.units import convert, find_unit, split_quantity

UNREADABLE_TAG = rule(
    "SM622",
    "recipe-tag-unreadable",
    Severity.WARNING,
    "'{tag}' of «{stereotype}» on '{element}' is '{value}', but must be {expected}; it is ignored",
    help="correct the tagged value",
)

UNIT_MISFIT = rule(
    "SM643",
    "recipe-unit-misfit",
    Severity.ERROR,
    "'{tag}' of «{stereotype}» on '{element}' is '{value}', but {problem}",
    help="{advice}",
)
UNKNOWN_UNIT = rule(
    "SM644",
    "recipe-unit-unknown",
    Severity.WARNING,
    "'{tag}' of «{stereotype}» on '{element}' is '{value}': the size of unit '{unit}' is unknown, "
    "and the value is ignored",
    help="write the value in a usual unit, such as ms, s, min, h, W, kW, g, kg or L",
)
TOO_LARGE = rule(
    "SM652",
    "recipe-number-too-large",
    Severity.ERROR,
    "'{tag}' of «{stereotype}» on '{element}' is '{value}', more than {limit}{unit}, the largest "
    "number that recipes store exactly",
    help="correct the value, or leave it out if there is no limit",
)
REVERSED_BOUNDS = rule(
    "SM653",
    "recipe-bounds-reversed",
    Severity.ERROR,
    "'{low}' of «{stereotype}» on '{element}' is {minimum}, more than '{high}', which is {maximum}",
    help="exchange the two values, or correct one of them",
)

_Expectation = tuple[str, Callable[[Tags, str], object]]
_WHOLE_NUMBER: _Expectation = ("a whole number, 0 or more", Tags.integer)
_AMOUNT: _Expectation = ("a number, 0 or more", Tags.amount)
_ENDPOINT: _Expectation = ("an address opc.tcp://...", Tags.endpoint)
_FLAG: _Expectation = ("true or false", Tags.flag)
_TIME: _Expectation = ("a whole number of milliseconds, 0 or more", Tags.integer)
_EXPECTATIONS: dict[str, _Expectation] = {
    **dict.fromkeys(("duration", "minDuration", "maxDuration", "timeout"), _TIME),
    **dict.fromkeys(("priority", "buffer", "maxIterations"), _WHOLE_NUMBER),
    **dict.fromkeys(("minPower", "maxPower", "quantity"), _AMOUNT),
    **dict.fromkeys(("interruptible", "noWait"), _FLAG),
    "endpoint": _ENDPOINT,
    "kind": ("call, read, write or subscribe", Tags.call_kind),
    "use": ("consumed, produced or carried", Tags.material_use),
}
_EXPECTATIONS_BY_STEREOTYPE: dict[str, dict[str, _Expectation]] = {
    "Capability": {"available": _FLAG},
    "Material": {"available": _AMOUNT},
}
_NUMBERS = (_WHOLE_NUMBER, _AMOUNT, _TIME)


def check_tags(context: Context, sink: Sink) -> set[str]:
    """Report tagged values with a wrong unit, and those that are ignored for their form.

    Return the ids of the elements to which a reported value belongs, and of what they relate to a
    machine.
    """
    faulty: set[str] = set()
    for application, names in context.stereotypes.items():
        if not _check_application(context, context.graph[application], names, sink):
            for owner in context.graph.targets(context.graph[application], Edge.SUBJECT):
                clients = context.graph.targets(owner, Edge.CLIENT)
                faulty.update(element.id for element in (owner, *clients))
    return faulty


def _check_application(
    context: Context, application: Element, stereotypes: tuple[str, ...], sink: Sink
) -> bool:
    """Report the faults of one application; return whether it has none."""
    tags = read_tags(context.graph, application)
    owner = context.graph.target(application, Edge.SUBJECT) or application
    if "Material" in stereotypes:
        tags = replace(tags, material_unit=_find_unit_of_material(context, owner))
    expectations = dict(_EXPECTATIONS)
    for stereotype in stereotypes:
        expectations |= _EXPECTATIONS_BY_STEREOTYPE.get(stereotype, {})
    is_right = True
    for name, expectation in expectations.items():
        # `use` of a MachineFunction lists resources; `use` of a Material is one of three words.
        is_resource = "MachineFunction" in stereotypes and name == "use"
        if tags.text(name) and not is_resource:
            is_right &= _check_tag(context, application, tags, name, expectation, sink)
    for low, high in (("minDuration", "maxDuration"), ("minPower", "maxPower")):
        minimum, maximum = tags.amount(low), tags.amount(high)
        if minimum is not None and maximum is not None and minimum > maximum:
            sink.report(
                REVERSED_BOUNDS,
                context.graph.subject(owner),
                low=low,
                high=high,
                stereotype=str(application.attrs.get("stereotype", "")),
                element=context.name(owner),
                minimum=f"{minimum} {tags.target_unit(low)}",
                maximum=f"{maximum} {tags.target_unit(high)}",
            )
            is_right = False
    return is_right


def _check_tag(
    context: Context,
    application: Element,
    tags: Tags,
    name: str,
    expectation: _Expectation,
    sink: Sink,
) -> bool:
    """Report the fault of one tagged value; return whether it has none."""
    owner = context.graph.target(application, Edge.SUBJECT) or application
    subject = context.graph.subject(owner)
    value, target = tags.text(name), tags.target_unit(name)
    unit = tags.unit(name) if expectation in _NUMBERS else ""
    facts: dict[str, Any] = {
        "tag": name,
        "stereotype": str(application.attrs.get("stereotype", "")),
        "element": context.name(owner),
        "value": value if split_quantity(value) else f"{value} {unit}".rstrip(),
    }
    expected, read_value = expectation
    is_misfit = bool(unit) and convert(Fraction(1), unit, target) is None
    if is_misfit and find_unit(unit) is None:
        sink.report(UNKNOWN_UNIT, subject, **facts, unit=unit)
    elif is_misfit:
        problem, advice = _describe_misfit(unit, target)
        sink.report(UNIT_MISFIT, subject, **facts, problem=problem, advice=advice)
    elif expectation in _NUMBERS and tags.is_too_large(name):
        sink.report(TOO_LARGE, subject, **facts, limit=MAX_NUMBER, unit=f" {target}".rstrip())
    elif read_value(tags, name) is None:
        sink.report(UNREADABLE_TAG, subject, **facts, expected=expected)
    else:
        return True
    return False


def _find_unit_of_material(context: Context, element: Element) -> str:
    """Return the unit of a material, or of the material that a flow or object node refers to."""
    if element.kind is Kind.OBJECT_FLOW:
        material = find_material(context, element)
    else:
        material = query.type_of(context.graph, element) or element
    return "" if material is None else find_material_unit(context, material)


def _describe_misfit(unit: str, target: str) -> tuple[str, str]:
    """Return why a unit does not fit the expected one, which may be none, and what to do."""
    known_unit, expected = find_unit(unit), find_unit(target)
    quantity = "" if known_unit is None else known_unit.quantity
    if not target:
        advice = "write a number without a unit, or state the unit of the material"
        return "no unit is expected there", advice
    if expected is None:
        return f"the material is counted in '{target}'", f"write the number in '{target}'"
    return (
        f"'{unit}' is a unit of {quantity}, not of {expected.quantity}",
        f"write a unit of {expected.quantity}, or a number without a unit, which is in {target}",
    )


BY_POSITION = rule(
    "SM614",
    "recipe-level-by-position",
    Severity.INFO,
    "'{element}' is treated as a {level} because '{caller}' calls it",
    help="apply the stereotype, so that the model states it",
)
STRUCTURED = rule(
    "SM615",
    "recipe-structured-node",
    Severity.WARNING,
    "the content of '{element}' is omitted from the recipe",
    help="draw loops and choices with decision and merge nodes",
)
CHOICE_OF_TASKS = rule(
    "SM617",
    "recipe-chooses-tasks",
    Severity.WARNING,
    "'{decision}' chooses between tasks, but all tasks of recipe '{recipe}' are scheduled",
    help="move the choice into a task, or make two recipes",
)
OUTPUT_VALUE = rule(
    "SM645",
    "recipe-output-bound-to-value",
    Severity.WARNING,
    "output '{pin}' of '{action}' is bound to '{value}', which is not a variable; "
    "the recipe assigns it to '{variable}' only",
    help="bind the output to an attribute, and compare the attribute with the value in a guard",
)
SAME_NAME = rule(
    "SM619",
    "recipe-same-name",
    Severity.INFO,
    "'{element}' is not refined, and the activity '{other}' has the same name",
    help="to refine it, call the activity from the node, or type the node by it",
)


def report_decisions(context: Context, model: Model, sink: Sink) -> None:
    """Report decisions of the analysis that the model does not state.

    These are levels that follow from the position of a call (SM614), omitted content (SM615),
    choices between tasks (SM617), unrefined tasks with the name of an activity (SM619), and
    outputs that are bound to values (SM645).
    """
    recipe = context.graph[model.recipe.element]
    _report_tasks(context, recipe, sink)
    _report_outputs(context, recipe, sink)
    graphs = [(flow_graph, "task") for flow_graph in model.service_graphs]
    graphs += [(flow_graph, "service") for flow_graph in model.function_graphs]
    for graph, activity_level in graphs:
        activity = context.graph[graph.element]
        _report_outputs(context, activity, sink)
        for id, level in refine(context, activity, activity_level).decisions:
            _report_step(context, activity, context.graph[id], level, sink)


def _report_outputs(context: Context, activity: Element, sink: Sink) -> None:
    """Report the outputs of steps that are bound to another expression than a path of names."""
    data = DataFlow.build(context, activity)
    for pin in data.outputs:
        action = context.graph.owner(pin)
        is_bound = "value" in pin.attrs and context.definition(action or pin) is not None
        if action is not None and is_bound and not find_bound_feature(context, pin):
            value = pin.attrs["value"]
            sink.report(
                OUTPUT_VALUE,
                context.graph.subject(pin),
                pin=context.label(pin),
                action=context.name(action),
                value=str(value).lower() if isinstance(value, bool) else str(value),
                variable=data.variable_of(pin),
            )


def _report_tasks(context: Context, recipe: Element, sink: Sink) -> None:
    for step in list_steps(context, recipe):
        if not context.level(step.node):
            _report_by_position(context, step.definition or step.node, "task", recipe, sink)
        if not step.definition:
            for namesake in _find_namesakes(context, step.node):
                names = context.name(step.node), context.name(namesake)
                subject = context.graph.subject(step.node)
                sink.report(SAME_NAME, subject, element=names[0], other=names[1])
    for node in context.read_activity(recipe).nodes:
        if node.kind is Kind.CONTROL and node.subkind == "decision":
            names = context.name(node), context.name(recipe)
            subject = context.graph.subject(node)
            sink.report(CHOICE_OF_TASKS, subject, decision=names[0], recipe=names[1])


def _find_namesakes(context: Context, node: Element) -> Iterator[Element]:
    return (
        activity
        for activity in context.graph.of_kind(Kind.ACTIVITY)
        if node.name and activity.name == node.name and not activity.attrs.get("external")
    )


def _report_step(
    context: Context, activity: Element, element: Element, level: str, sink: Sink
) -> None:
    if level:
        _report_by_position(context, element, level, activity, sink)
    else:
        sink.report(STRUCTURED, context.graph.subject(element), element=context.name(element))


def _report_by_position(
    context: Context, element: Element, level: str, caller: Element, sink: Sink
) -> None:
    names = context.name(element), context.name(caller)
    subject = context.graph.subject(element)
    sink.report(BY_POSITION, subject, element=names[0], level=level, caller=names[1])
