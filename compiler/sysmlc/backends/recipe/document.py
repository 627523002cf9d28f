"""The JSON form of a recipe model: absent members are omitted, lists keep the model's order."""

from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

from sysmlc.backends.base import InputFile
from sysmlc.backends.recipe.flow_graphs import (
    describe_expression,
    describe_flow_graph,
    describe_parameters,
    describe_trace,
    describe_type,
)
from sysmlc.recipe.check_tasks import is_complete
from sysmlc.recipe.model import (
    Condition,
    Derived,
    EndTime,
    Function,
    Machine,
    MachineVariable,
    Material,
    MaterialUse,
    Mode,
    Model,
    OpcUa,
    Performance,
    Provider,
    Range,
    Recipe,
    Service,
    Task,
    TimeLimit,
)
from sysmlc.recipe.recipe_times import decide_limit

Json = dict[str, object]
_T = TypeVar("_T")


def describe_model(model: Model, inputs: Iterable[InputFile]) -> Json:
    """Return the recipe with everything that it refers to (``sysmlc-recipe/1``)."""
    return {
        "format": "sysmlc-recipe/1",
        "source": _describe_each(_describe_input, sorted(inputs, key=lambda file: file.path)),
        "machines": _describe_each(_describe_machine, model.machines),
        "materials": _describe_each(_describe_material, model.materials),
        "recipes": [_describe_recipe(model.recipe)],
        "services": _describe_each(_describe_service, model.services),
        "functions": _describe_each(_describe_function, model.functions),
        "serviceGraphs": _describe_each(describe_flow_graph, model.service_graphs),
        "functionGraphs": _describe_each(describe_flow_graph, model.function_graphs),
    }


def _describe_each(describe: Callable[[_T], Json], values: Iterable[_T]) -> list[Json]:
    return [describe(value) for value in values]


def _drop_absent(members: Mapping[str, object]) -> Json:
    """Return the members without None, false, empty texts, empty lists and empty objects."""
    return {
        key: value
        for key, value in members.items()
        if value is not None and value is not False and value not in ("", [], {})
    }


def _describe_input(file: InputFile) -> Json:
    return {"file": file.path, "sha256": file.sha256, "language": file.language}


def _describe_range(value: Range | None) -> Json | None:
    return None if value is None else {"min": value.min, "max": value.max}


# -- level 1: recipes and tasks ----------------------------------------------------------------


def _describe_recipe(recipe: Recipe) -> Json:
    head = {
        "id": recipe.id,
        "inputs": describe_parameters(recipe.inputs),
        "outputs": describe_parameters(recipe.outputs),
        "variables": describe_parameters(recipe.variables),
        "version": recipe.version,
        "product": recipe.product,
        "defaultPriority": recipe.priority,
        "noWait": recipe.no_wait,
    }
    performances = _describe_each(_describe_performance, recipe.performances)
    return {
        **_drop_absent(head),
        "tasks": _describe_each(_describe_task, recipe.tasks),
        "precedence": [list(pair) for pair in recipe.precedence],
        **_drop_absent(
            {
                "performedBy": performances,
                "timeLimits": _describe_limits(recipe.limits, recipe.derived),
                "derived": None if recipe.derived is None else _describe_derived(recipe.derived),
            }
        ),
        **describe_trace(recipe.element),
    }


def _describe_performance(performance: Performance) -> Json:
    members = {"arguments": dict(performance.arguments), "steps": dict(performance.steps)}
    return {
        "block": performance.block,
        **_drop_absent(members),
        **describe_trace(performance.element),
    }


def _describe_task(task: Task) -> Json:
    members = {
        "id": task.id,
        "name": task.name,
        "maxDuration": task.max_duration,
        "materials": _describe_each(_describe_use, task.materials),
        "implementation": task.implementation,
        "pre": describe_expression(task.pre),
        "post": describe_expression(task.post),
        "bind": {name: describe_expression(value) for name, value in task.bind},
        "assign": dict(task.assign),
        "interruptible": task.interruptible,
        "noWait": task.no_wait,
        "timeLimits": _describe_limits(task.limits, task.derived),
        "derived": None if task.derived is None else _describe_derived(task.derived),
    }
    # The schema requires this member, even if it is empty.
    modes = {"equipment": _describe_each(_describe_mode, task.equipment)}
    return {**_drop_absent(members), **modes, **describe_trace(task.element)}


def _describe_limits(limits: Iterable[TimeLimit], derived: Derived | None) -> list[Json]:
    return [
        {
            "requirement": limit.requirement,
            **_drop_absent({"min": limit.least, "max": limit.most}),
            "verdict": decide_limit(limit, derived),
            **describe_trace(limit.element),
        }
        for limit in limits
    ]


def _describe_derived(derived: Derived) -> Json:
    sub_tasks: list[Json] = [
        {
            "node": sub_task.node,
            "alternatives": _describe_each(_describe_mode, sub_task.alternatives),
            **_drop_absent(
                {
                    "after": list(sub_task.after),
                    "runs": _describe_range(sub_task.runs),
                    "when": _describe_each(_describe_condition, sub_task.when),
                }
            ),
        }
        for sub_task in derived.sub_tasks
    ]
    groups = [
        {"nodes": list(group.nodes), "because": list(group.because)}
        for group in derived.same_machine
    ]
    duration = _describe_range(derived.duration)
    if duration is not None:
        duration |= _drop_absent({"expected": derived.expected, "because": derived.because})
    ends = _describe_each(_describe_end, derived.ends)
    members = {
        "subTasks": sub_tasks,
        "sameMachine": groups,
        "duration": duration,
        "ends": ends,
    }
    return _drop_absent(members)


def _describe_condition(condition: Condition) -> Json:
    guard = describe_expression(condition.guard, condition.text)
    members = {"decision": condition.decision, "guard": guard, "else": condition.is_else}
    return _drop_absent(members)


def _describe_end(end: EndTime) -> Json:
    duration = _describe_range(end.duration)
    return {"node": end.node, "duration": duration, **_drop_absent({"early": end.is_early})}


def _describe_mode(mode: Mode) -> Json:
    members = {
        "machines": list(mode.machines),
        "duration": mode.duration,
        "power": _describe_range(mode.power),
        "tools": list(mode.tools),
    }
    return {**_drop_absent(members), **_describe_availability(mode)}


def _describe_availability(mode: Mode | Provider) -> Json:
    """Return the member that states whether machines are available; false is not omitted."""
    return {} if mode.available is None else {"available": mode.available}


def _describe_use(use: MaterialUse) -> Json:
    return {"material": use.material, "quantity": use.quantity, "use": use.use}


# -- machines and materials --------------------------------------------------------------------


def _describe_machine(machine: Machine) -> Json:
    members = {
        "id": machine.id,
        "class": machine.machine_class,
        "amlId": machine.aml_id,
        "endpoint": machine.endpoint,
        "plantElement": machine.plant_element,
        "variables": _describe_each(_describe_machine_variable, machine.variables),
    }
    return {**_drop_absent(members), **describe_trace(machine.element)}


def _describe_machine_variable(variable: MachineVariable) -> Json:
    type_ = {} if variable.type is None else {"type": describe_type(variable.type)}
    value = {} if variable.value is None else {"value": variable.value}
    members = {"unit": variable.unit, "node": variable.node, "elements": list(variable.elements)}
    return {"name": variable.name, **type_, **value, **_drop_absent(members)}


def _describe_material(material: Material) -> Json:
    members = {
        "id": material.id,
        "available": material.available,
        "unit": material.unit,
        "position": material.position,
        "buffer": material.buffer,
        "noWait": material.no_wait,
        "properties": dict(material.properties),
        "propertyUnits": dict(material.property_units),
    }
    return {**_drop_absent(members), **describe_trace(material.element)}


# -- levels 2 and 3: services and functions ----------------------------------------------------


def _describe_service(service: Service) -> Json:
    members = {
        "id": service.id,
        "kind": service.kind,
        "inputs": describe_parameters(service.inputs),
        "outputs": describe_parameters(service.outputs),
        "constants": describe_parameters(service.constants),
        "materials": _describe_each(_describe_use, service.materials),
        "duration": service.duration,
        "implementation": service.implementation,
        "pre": describe_expression(service.pre),
        "post": describe_expression(service.post),
        "interruptible": service.interruptible,
        "opcua": _describe_opcua(service.opcua),
    }
    providers: Json = {}
    if service.kind == "machine" or service.providers:
        providers["providers"] = _describe_each(_describe_provider, service.providers)
    return {**_drop_absent(members), **providers, **describe_trace(service.element)}


def _describe_provider(provider: Provider) -> Json:
    members = {
        "machine": provider.machine,
        "duration": provider.duration,
        "power": _describe_range(provider.power),
        "tools": list(provider.tools),
        "opcua": _describe_opcua(provider.opcua),
    }
    return {**_drop_absent(members), **_describe_availability(provider)}


def _describe_opcua(call: OpcUa | None) -> Json | None:
    """Describe an OPC UA call; None if it is none or not complete (SM612)."""
    if call is None or not is_complete(call):
        return None
    return _drop_absent(
        {
            "kind": call.kind,
            "endpoint": call.endpoint,
            "object": call.object,
            "method": call.method,
            "namespaceUri": call.namespace_uri,
            "doneWhen": describe_expression(call.done_when),
            "timeout": call.timeout,
        }
    )


def _describe_function(function: Function) -> Json:
    members = {
        "id": function.id,
        "inputs": describe_parameters(function.inputs),
        "outputs": describe_parameters(function.outputs),
        "duration": _describe_range(function.duration),
        "resources": [{"id": r.id, "mode": r.mode} for r in function.resources],
        "interruptible": function.interruptible,
        "opcua": _describe_opcua(function.opcua),
    }
    return {**_drop_absent(members), **describe_trace(function.element)}
