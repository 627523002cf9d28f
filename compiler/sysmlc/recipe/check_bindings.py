"""Checks of materials and of OPC UA calls (REC011, REC012)."""

import re
from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.recipe.checks import Finding
from sysmlc.recipe.derive import Tables
from sysmlc.recipe.model import Function, Model, OpcUa, Service, Task

MATERIAL_MISSING = rule(
    "SM611",
    "material-not-listed",
    Severity.ERROR,
    "the services of task '{task}' consume {needed} of '{material}', but the task lists {listed}",
    help="give the task an object flow from '{material}' with that quantity",
)
NODE_ID = rule(
    "SM612",
    "opc-ua-node-id-unstable",
    Severity.WARNING,
    "the OPC UA call on '{element}' {problem}",
    help="state namespaceUri, or write the node id with nsu=",
)

_NODE_ID = re.compile(r"(?:(ns)=\d+;|nsu=[^;]+;)?[isgb]=.+", re.DOTALL)


def check_materials(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC011: a task lists the materials that its services consume, in sufficient quantity."""
    for task in model.recipe.tasks:
        listed = {use.material: use.quantity for use in task.materials if use.use != "produced"}
        for material, needed in sorted(_sum_consumption(task, tables).items()):
            if needed > listed.get(material, 0):
                facts = {
                    "task": task.id,
                    "material": material,
                    "needed": needed,
                    "listed": listed.get(material, "none"),
                }
                yield Finding(MATERIAL_MISSING, task.element, facts)


def _sum_consumption(task: Task, tables: Tables) -> dict[str, float]:
    graph = tables.service_graphs.get(task.implementation)
    consumption: dict[str, float] = {}
    for node in () if graph is None else graph.nodes:
        service = tables.service(node)
        for use in () if service is None else service.materials:
            if use.use == "consumed":
                consumption[use.material] = consumption.get(use.material, 0) + use.quantity
    return consumption


def check_opc_ua_calls(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC012: node ids are well-formed and do not depend on a session; calls name a method."""
    for call in _iter_calls(model):
        for problem in _iter_problems(call):
            facts = {"element": _name_owner(model, call), "problem": problem}
            yield Finding(NODE_ID, call.element, facts)


def _iter_calls(model: Model) -> Iterator[OpcUa]:
    owners: tuple[Service | Function, ...] = (*model.services, *model.functions)
    own = [owner.opcua for owner in owners]
    of_providers = [p.opcua for service in model.services for p in service.providers]
    yield from dict.fromkeys(call for call in (*own, *of_providers) if call is not None)


def _name_owner(model: Model, call: OpcUa) -> str:
    for service in model.services:
        for provider in service.providers:
            if provider.opcua == call:
                return f"{service.id} on {provider.machine}"
    owners: tuple[Service | Function, ...] = (*model.services, *model.functions)
    return next((owner.id for owner in owners if owner.opcua == call), call.object)


def is_complete(call: OpcUa) -> bool:
    """Return whether an executor can make the call: its node ids are well-formed, with a method."""
    ids = [call.object, *([call.method] if call.method else [])]
    return all(map(_NODE_ID.fullmatch, ids)) and (call.kind != "call" or bool(call.method))


def _iter_problems(call: OpcUa) -> Iterator[str]:
    if not call.object:
        yield "names no object"
    if call.kind == "call" and not call.method:
        yield "names no method"
    for id in (call.object, call.method):
        match = _NODE_ID.fullmatch(id)
        if id and match is None:
            yield f"has '{id}', which is no node id"
        elif match is not None and match[1] and not call.namespace_uri:
            yield f"has '{id}', which names its namespace by an index only"
