"""The model of one recipe: the recipe itself and everything that it refers to.

The model includes a variable of a machine if expressions of the recipe read or assign it.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Protocol, TypeVar

from msgspec.structs import replace

from sysmlc.analyses.activities.regions import FLOWS, NODES
from sysmlc.analyses.recipe.context import Context, segment_word
from sysmlc.analyses.recipe.data_flow import DataFlow
from sysmlc.analyses.recipe.expressions import (
    find_member,
    literal_default,
    read_default,
    value_type,
)
from sysmlc.analyses.recipe.graphs import refine
from sysmlc.analyses.recipe.machines import (
    build_machine,
    build_material,
    find_opcua_node,
    list_allocations,
)
from sysmlc.analyses.recipe.nodes import find_refinement
from sysmlc.analyses.recipe.services import (
    build_function,
    build_service,
    find_service_relations,
)
from sysmlc.analyses.recipe.tasks import (
    Step,
    build_task,
    find_material,
    find_precedence,
    find_task_relations,
    list_steps,
    read_limits,
)
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.ir.expressions import Expression
from sysmlc.recipe.derivation import derive
from sysmlc.recipe.expression import iter_variables
from sysmlc.recipe.model import (
    FlowGraph,
    MachineVariable,
    Model,
    Parameter,
    Performance,
    Recipe,
    ReferenceType,
)


class _Named(Protocol):
    @property
    def id(self) -> str: ...


_T = TypeVar("_T", bound=_Named)


@dataclass(slots=True)
class _Closure:
    """The transitive callees of a recipe.

    ``services`` and ``functions`` map the id of a definition to the definition and the nodes that
    call it. The graphs have ids of activities as keys.
    """

    services: dict[str, tuple[Element, list[Element]]] = field(default_factory=dict)
    functions: dict[str, tuple[Element, list[Element]]] = field(default_factory=dict)
    service_graphs: dict[str, FlowGraph] = field(default_factory=dict)
    function_graphs: dict[str, FlowGraph] = field(default_factory=dict)


def build_model(context: Context, activity: Element) -> Model:
    """Return the model of the recipe that an activity describes."""
    steps = list_steps(context, activity)
    closure = _Closure()
    for step in steps:
        if step.refinement is not None:
            _add_refinement(context, step.refinement, "task", closure)
    recipe = _build_recipe(context, activity, steps, closure)
    services = [build_service(context, *entry) for entry in closure.services.values()]
    functions = [build_function(context, *entry) for entry in closure.functions.values()]
    named = {
        machine for entry in recipe.tasks for mode in entry.equipment for machine in mode.machines
    }
    named |= {provider.machine for entry in services for provider in entry.providers}
    model = Model(
        recipe,
        _build_named(context, named, build_machine, "machine"),
        _build_named(
            context, _name_materials(context, recipe, activity), build_material, "material"
        ),
        _sort_by_id(services),
        _sort_by_id(functions),
        _sort_by_id(closure.service_graphs.values()),
        _sort_by_id(closure.function_graphs.values()),
        tuple(sorted(set(_iter_sources(context, activity, steps, closure)))),
    )
    return derive(_add_machine_variables(context, model))


def _iter_sources(
    context: Context, activity: Element, steps: list[Step], closure: _Closure
) -> Iterator[str]:
    """Yield the ids of the relations to machines, and of the nodes and flows of the recipe.

    A dependency whose supplier is missing is no relation, but the recipe lacks what it states.
    """
    clients = [element for step in steps for element in (step.node, step.definition) if element]
    for step in steps:
        for relation in find_task_relations(context, activity, step):
            yield relation.element.id
    for definition, callers in closure.services.values():
        clients += [definition, *callers]
        for relation in find_service_relations(context, definition, callers):
            yield relation.element.id
    for client in clients:
        yield from (dependency.id for dependency in list_allocations(context, client))
    yield from (e.id for e in context.contents(activity) if e.kind in (*NODES, *FLOWS))


def _build_recipe(
    context: Context, activity: Element, steps: list[Step], closure: _Closure
) -> Recipe:
    tags = context.tags(activity, "Recipe")
    product = tags.text("product")
    data = DataFlow.build(context, activity)
    tasks = [build_task(context, activity, step, data) for step in steps]
    return Recipe(
        context.name(activity),
        _sort_by_id(tasks),
        find_precedence(context, activity, steps),
        data.list_parameters("in", "inout"),
        data.list_parameters("out", "inout", "return"),
        data.list_variables(),
        tags.text("version"),
        context.reference(product) if product else "",
        tags.integer("priority"),
        bool(tags.flag("noWait")),
        activity.id,
        _build_performances(context, activity, [*closure.service_graphs, *closure.function_graphs]),
        read_limits(context, [activity]),
    )


def _add_refinement(
    context: Context, activity: Element, activity_level: str, closure: _Closure
) -> None:
    """Add the graph of an activity and, recursively, the graphs of its callees, each once."""
    graphs = closure.service_graphs if activity_level == "task" else closure.function_graphs
    if activity.id in graphs:
        return
    refinement = refine(context, activity, activity_level)
    graphs[activity.id] = refinement.graph
    tables = {"service": closure.services, "function": closure.functions}
    for call in refinement.calls:
        definition = context.graph[call.definition]
        if call.kind in tables:
            callers = tables[call.kind].setdefault(definition.id, (definition, []))[1]
            callers.append(context.graph[call.node])
        inner = None if call.kind == "function" else find_refinement(context, definition)
        if inner is not None:
            _add_refinement(context, inner, "service", closure)


def _name_materials(context: Context, recipe: Recipe, activity: Element) -> set[str]:
    flows = context.read_activity(activity).flows
    carried = (find_material(context, flow.element) for flow in flows)
    named = {context.name(element) for element in carried if element is not None}
    return named | ({recipe.product} if recipe.product else set())


def _build_named(
    context: Context, names: set[str], make: Callable[[Context, Element], _T], level: str
) -> tuple[_T, ...]:
    """Build a value with *make* for each element of the level with one of the names, sorted."""
    # Computing a qualified name is slow, so skip elements whose own word occurs in no name.
    all_names = "\n".join(names)
    candidates = (
        element
        for element in context.elements_of_level(level)
        if segment_word(element) in all_names
    )
    by_name = {context.name(element): element for element in candidates}
    return tuple(make(context, by_name[name]) for name in sorted(names) if name in by_name)


def _sort_by_id(values: Iterable[_T]) -> tuple[_T, ...]:
    return tuple(sorted(values, key=lambda value: value.id))


def _build_performances(
    context: Context, recipe: Element, graphs: Iterable[str]
) -> tuple[Performance, ...]:
    """Return, for each block that runs the recipe, its allocations of parameters and steps.

    *graphs* are the ids of the activities that refine tasks and services of the recipe.
    """
    owners = {recipe.id, *graphs}
    blocks = context.graph.sources(recipe, Edge.CLASSIFIER_BEHAVIOR)
    performances = (_build_performance(context, block, recipe, owners) for block in blocks)
    stated = (
        performance for performance in performances if performance.arguments or performance.steps
    )
    return tuple(sorted(stated, key=lambda performance: performance.block))


def _build_performance(
    context: Context, block: Element, recipe: Element, owners: set[str]
) -> Performance:
    arguments: dict[str, str] = {}
    steps: dict[str, str] = {}
    for client, path in _list_allocations(context, block):
        if client.kind is Kind.PARAMETER and client.owner == recipe.id:
            arguments[client.name] = path
        elif client.kind is not Kind.PARAMETER and client.owner in owners:
            steps[context.name(client)] = path
    name = context.name(block)
    return Performance(name, _sort_pairs(arguments), _sort_pairs(steps), block.id)


def _list_allocations(context: Context, block: Element) -> Iterator[tuple[Element, str]]:
    """Yield each element that the block allocates, with the path of names to the target."""
    graph = context.graph
    for allocation in graph.owned(block):
        if allocation.kind is Kind.DEPENDENCY and allocation.role == "allocate":
            client, supplier = (
                graph.target(allocation, Edge.CLIENT),
                graph.target(allocation, Edge.SUPPLIER),
            )
            if client is not None and supplier is not None:
                yield client, ".".join([*_read_path(context, allocation), context.label(supplier)])


def _read_path(context: Context, allocation: Element) -> Iterator[str]:
    target_path = allocation.attrs.get("target_path")
    for id in target_path if isinstance(target_path, tuple) else str(target_path or "").split():
        element = context.graph.get(str(id))
        yield str(id) if element is None else context.label(element)


def _sort_pairs(pairs: dict[str, str]) -> tuple[tuple[str, str], ...]:
    return tuple(sorted(pairs.items()))


# -- variables of machines ---------------------------------------------------------------------

_NAME = re.compile(r"[^\W\d]\w*")


def _add_machine_variables(context: Context, model: Model) -> Model:
    """Return the model with, for each machine, the variables that expressions refer to."""
    names_by_machine: dict[str, set[str]] = {}
    for parameters, expressions in _list_scopes(model):
        machines = {
            parameter.name: parameter.type.name
            for parameter in parameters
            if isinstance(parameter.type, ReferenceType) and parameter.type.to == "machine"
        }
        for name in (name for expression in expressions for name in iter_variables(expression)):
            head, _, rest = name.partition(".")
            if rest and head in machines:
                names_by_machine.setdefault(machines[head], set()).add(rest)
    machines_of_model = tuple(
        replace(
            machine,
            variables=_build_variables(
                context, machine.element, sorted(names_by_machine.get(machine.id, ()))
            ),
        )
        for machine in model.machines
    )
    return replace(model, machines=machines_of_model)


def _list_scopes(model: Model) -> Iterator[tuple[tuple[Parameter, ...], list[Expression]]]:
    """Yield each scope of names: the declared parameters, and the expressions that use them."""
    recipe: Recipe = model.recipe
    bindings = [value for task in recipe.tasks for _, value in task.bind]
    yield (*recipe.inputs, *recipe.variables), bindings
    for graph in model.graphs:
        expressions = [value for node in graph.nodes for _, value in node.bind]
        expressions += [node.expression for node in graph.nodes if node.expression is not None]
        expressions += [edge.guard for edge in graph.edges if edge.guard is not None]
        yield (*graph.inputs, *graph.variables), expressions


def _build_variables(
    context: Context, machine: str, names: Iterable[str]
) -> tuple[MachineVariable, ...]:
    element = context.graph.get(machine)
    variables_by_name: dict[str, MachineVariable] = {}
    if element is not None:
        type_ = query.type_of(context.graph, element) or element
        for name in names:
            _add_variable(context, type_, name, variables_by_name)
    return tuple(variables_by_name[name] for name in sorted(variables_by_name, key=_natural_order))


def _natural_order(name: str) -> tuple[str, int, str]:
    """Return the sort key of a name: ``pallet2`` precedes ``pallet10``."""
    head = name.partition(".")[0]
    digits = re.search(r"\d*$", head)
    number = digits[0] if digits else ""
    return head[: len(head) - len(number)], int(number or 0), name


def _add_variable(
    context: Context, type_: Element, name: str, variables_by_name: dict[str, MachineVariable]
) -> None:
    """Add the variable of a dotted name, the elements of a list and the features of a part."""
    feature: Element | None = None
    owner: Element | None = type_
    for part in name.split("."):
        feature = None if owner is None else find_member(context, owner, part)
        owner = None if feature is None else query.type_of(context.graph, feature)
    if feature is None or name in variables_by_name:
        return
    elements = _list_elements(context, type_, feature)
    variables_by_name[name] = _build_variable(context, feature, name, elements)
    for element in elements:
        _add_variable(context, type_, element, variables_by_name)
    if owner is not None and owner.attrs.get("property_specific"):
        for part_feature in query.features(context.graph, owner):
            default = literal_default(context, part_feature)
            has_data = default is not None or find_opcua_node(context, part_feature)
            if part_feature.kind is Kind.PROPERTY and has_data:
                _add_variable(context, type_, f"{name}.{part_feature.name}", variables_by_name)


def _list_elements(context: Context, type_: Element, feature: Element) -> tuple[str, ...]:
    """Return the names of the features that a list consists of (``= (pallet1, pallet2)``)."""
    text = feature.attrs.get("default")
    if not isinstance(text, str) or "default_language" not in feature.attrs:
        return ()
    names = [element_name.strip() for element_name in text.strip("() ").split(",")]
    features = [
        element_name
        for element_name in names
        if _NAME.fullmatch(element_name) and find_member(context, type_, element_name)
    ]
    return tuple(features) if len(features) == len(names) else ()


def _build_variable(
    context: Context, feature: Element, name: str, elements: tuple[str, ...]
) -> MachineVariable:
    node = find_opcua_node(context, feature)
    return MachineVariable(
        name,
        value_type(context, feature),
        literal_default(context, feature),
        node,
        elements,
        read_default(context, feature)[0],
    )
