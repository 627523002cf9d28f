"""The JSON form of a recipe model: what is absent is left out, everything is sorted."""

from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

from sysmlc.backends.base import InputFile
from sysmlc.backends.recipe.graphs import expression, flow_graph, parameters, trace, value_type
from sysmlc.recipe.check_tasks import is_complete
from sysmlc.recipe.model import (
    Derived,
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
)

Json = dict[str, object]
_T = TypeVar("_T")


def document(model: Model, inputs: Iterable[InputFile]) -> Json:
    """Return the recipe with everything that it refers to (``sysmlc-recipe/1``)."""
    return {
        "format": "sysmlc-recipe/1",
        "source": _each(_source, sorted(inputs, key=lambda file: file.path)),
        "machines": _each(_machine, model.machines),
        "materials": _each(_material, model.materials),
        "recipes": [_recipe(model.recipe)],
        "services": _each(_service, model.services),
        "functions": _each(_function, model.functions),
        "serviceGraphs": _each(flow_graph, model.service_graphs),
        "functionGraphs": _each(flow_graph, model.function_graphs),
    }


def _source(file: InputFile) -> Json:
    return {"file": file.path, "sha256": file.sha256, "language": file.language}


def _each(write: Callable[[_T], Json], values: Iterable[_T]) -> list[Json]:
    return [write(value) for value in values]


def _without_absent(values: Mapping[str, object]) -> Json:
    """Leave out None, false, empty texts and empty lists."""
    return {
        key: v
        for key, v in values.items()
        if v is not None and v is not False and v not in ("", [], {})
    }


def _range(value: Range | None) -> Json | None:
    return None if value is None else {"min": value.min, "max": value.max}


def _recipe(recipe: Recipe) -> Json:
    found = _without_absent(
        {
            "id": recipe.id,
            "inputs": parameters(recipe.inputs),
            "outputs": parameters(recipe.outputs),
            "variables": parameters(recipe.variables),
            "version": recipe.version,
            "product": recipe.product,
            "defaultPriority": recipe.priority,
            "noWait": recipe.no_wait,
        }
    )
    return {
        **found,
        "tasks": _each(_task, recipe.tasks),
        "precedence": [list(pair) for pair in recipe.precedence],
        **_without_absent({"performedBy": _each(_performance, recipe.performances)}),
        **trace(recipe.element),
    }


def _performance(performance: Performance) -> Json:
    given = {"arguments": dict(performance.arguments), "steps": dict(performance.steps)}
    return {
        "block": performance.block,
        **_without_absent(given),
        **trace(performance.element),
    }


def _task(task: Task) -> Json:
    found = {
        "id": task.id,
        "name": task.name,
        "maxDuration": task.max_duration,
        "materials": _each(_use, task.materials),
        "implementation": task.implementation,
        "pre": expression(task.pre),
        "post": expression(task.post),
        "bind": {name: expression(value) for name, value in task.bind},
        "assign": dict(task.assign),
        "interruptible": task.interruptible,
        "noWait": task.no_wait,
        "derived": None if task.derived is None else _describe_derived_data(task.derived),
    }
    equipment = {"equipment": _each(_mode, task.equipment)}
    return {**_without_absent(found), **equipment, **trace(task.element)}


def _describe_derived_data(derived: Derived) -> Json:
    sub_tasks: list[Json] = [
        {
            "node": one.node,
            "alternatives": _each(_mode, one.alternatives),
            **_without_absent({"after": list(one.after)}),
        }
        for one in derived.sub_tasks
    ]
    groups = [
        {"nodes": list(one.nodes), "because": list(one.because)} for one in derived.same_machine
    ]
    time = _range(derived.duration)
    return _without_absent({"subTasks": sub_tasks, "sameMachine": groups, "duration": time})


def _mode(mode: Mode) -> Json:
    found = _without_absent(
        {
            "machines": list(mode.machines),
            "duration": mode.duration,
            "power": _range(mode.power),
            "tools": list(mode.tools),
        }
    )
    return found if mode.available is None else {**found, "available": mode.available}


def _use(use: MaterialUse) -> Json:
    return {"material": use.material, "quantity": use.quantity, "use": use.use}


def _machine(machine: Machine) -> Json:
    found = {
        "id": machine.id,
        "class": machine.machine_class,
        "amlId": machine.aml_id,
        "endpoint": machine.endpoint,
        "plantElement": machine.plant_element,
        "variables": _each(_machine_variable, machine.variables),
    }
    return {**_without_absent(found), **trace(machine.element)}


def _machine_variable(variable: MachineVariable) -> Json:
    type_ = {} if variable.type is None else {"type": value_type(variable.type)}
    value = {} if variable.value is None else {"value": variable.value}
    rest = _without_absent({"node": variable.node, "elements": list(variable.elements)})
    return {"name": variable.name, **type_, **value, **rest}


def _material(material: Material) -> Json:
    found = {
        "id": material.id,
        "available": material.available,
        "unit": material.unit,
        "position": material.position,
        "buffer": material.buffer,
        "noWait": material.no_wait,
        "properties": dict(material.properties),
    }
    return {**_without_absent(found), **trace(material.element)}


def _service(service: Service) -> Json:
    found = {
        "id": service.id,
        "kind": service.kind,
        "inputs": parameters(service.inputs),
        "outputs": parameters(service.outputs),
        "constants": parameters(service.constants),
        "materials": _each(_use, service.materials),
        "duration": service.duration,
        "implementation": service.implementation,
        "pre": expression(service.pre),
        "post": expression(service.post),
        "interruptible": service.interruptible,
        "opcua": _opcua(service.opcua),
    }
    offered: Json = {}
    if service.kind == "machine" or service.providers:
        offered["providers"] = _each(_provider, service.providers)
    return {**_without_absent(found), **offered, **trace(service.element)}


def _provider(provider: Provider) -> Json:
    return _without_absent(
        {
            "machine": provider.machine,
            "duration": provider.duration,
            "power": _range(provider.power),
            "tools": list(provider.tools),
            "opcua": _opcua(provider.opcua),
        }
    )


def _opcua(call: OpcUa | None) -> Json | None:
    if call is None or not is_complete(call):
        return None
    return _without_absent(
        {
            "kind": call.kind,
            "endpoint": call.endpoint,
            "object": call.object,
            "method": call.method,
            "namespaceUri": call.namespace_uri,
            "doneWhen": expression(call.done_when),
            "timeout": call.timeout,
        }
    )


def _function(function: Function) -> Json:
    found = {
        "id": function.id,
        "inputs": parameters(function.inputs),
        "outputs": parameters(function.outputs),
        "duration": _range(function.duration),
        "resources": [{"id": one.id, "mode": one.mode} for one in function.resources],
        "interruptible": function.interruptible,
        "opcua": _opcua(function.opcua),
    }
    return {**_without_absent(found), **trace(function.element)}
