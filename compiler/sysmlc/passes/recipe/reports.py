"""Reports of the recipe pass: unreadable tags, levels by position and omitted content."""

from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Kind
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.data_flow import DataFlow, find_bound_feature
from sysmlc.passes.recipe.graphs import refine
from sysmlc.passes.recipe.profile import NAMESPACE, Tags
from sysmlc.passes.recipe.tasks import list_steps
from sysmlc.recipe.model import Model

UNREADABLE_TAG = rule(
    "SM622",
    "recipe-tag-unreadable",
    Severity.WARNING,
    "'{tag}' of «{stereotype}» on '{element}' is '{value}', but must be {expected}; it is ignored",
    help="correct the tagged value",
)

_Expectation = tuple[str, Callable[[Tags, str], object]]
_WHOLE_NUMBER: _Expectation = ("a whole number, 0 or more", Tags.integer)
_AMOUNT: _Expectation = ("a number, 0 or more", Tags.amount)
_ENDPOINT: _Expectation = ("an address opc.tcp://...", Tags.endpoint)
_TIMES = ("duration", "minDuration", "maxDuration", "timeout")
_EXPECTATIONS: dict[str, _Expectation] = {
    **dict.fromkeys((*_TIMES, "priority", "buffer", "maxIterations"), _WHOLE_NUMBER),
    **dict.fromkeys(("minPower", "maxPower", "quantity"), _AMOUNT),
    "endpoint": _ENDPOINT,
    "kind": ("call, read, write or subscribe", Tags.call_kind),
    "use": ("consumed, produced or carried", Tags.material_use),
}


def check_tags(context: Context, sink: Sink) -> None:
    """Report tagged values that are ignored because they have another form than expected."""
    for application, stereotype in _list_applications(context):
        tags = Tags(application.attrs)
        for name, (expected, reading) in _EXPECTATIONS.items():
            value = tags.text(name)
            # `use` of a MachineFunction lists resources; `use` of a Material is one of three words.
            is_resource = stereotype == "MachineFunction" and name == "use"
            if value and not is_resource and reading(tags, name) is None:
                owner = context.graph.owner(application) or application
                sink.report(
                    UNREADABLE_TAG,
                    context.graph.subject(owner),
                    tag=name,
                    stereotype=stereotype,
                    element=context.name(owner),
                    value=value,
                    expected=expected,
                )


def _list_applications(context: Context) -> Iterator[tuple[Element, str]]:
    """Yield the applications of stereotypes of the shipped profile, with their names."""
    for application in context.graph.of_kind(Kind.APPLICATION):
        if application.attrs.get("namespace") == NAMESPACE:
            yield application, str(application.attrs.get("stereotype", ""))


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
    """Report decisions of the pass that the model does not state.

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
    for node in context.nodes(recipe):
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
