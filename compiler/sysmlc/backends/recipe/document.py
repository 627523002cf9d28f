"""The JSON form of a recipe model (metamodels/sysmlc-recipe.schema.json).

A part of the model becomes an object of its fields, in camel case. Members without a value are
omitted, lists keep the order of the model, and ``trace`` leads to the element of the part.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.backends.base import InputFile
from sysmlc.ir.expressions import (
    Binary,
    Call,
    Expression,
    Index,
    Literal,
    Name,
    Unary,
    print_expression,
)
from sysmlc.recipe.check_tasks import is_complete
from sysmlc.recipe.expression import Opaque, operands
from sysmlc.recipe.model import (
    Condition,
    Derived,
    EnumType,
    FlowEdge,
    FlowGraph,
    ListType,
    MachineVariable,
    Model,
    Node,
    OpcUa,
    Parameter,
    Recipe,
    ReferenceType,
    Service,
    Task,
)
from sysmlc.recipe.recipe_times import decide_limit

Json = dict[str, Any]


def describe_model(model: Model, inputs: Iterable[InputFile]) -> Json:
    """Return the recipe with everything that it refers to (``sysmlc-recipe/1``)."""
    return {
        "format": "sysmlc-recipe/1",
        "source": [
            {"file": file.path, "sha256": file.sha256, "language": file.language}
            for file in sorted(inputs, key=lambda file: file.path)
        ],
        "machines": _describe(model.machines),
        "materials": _describe(model.materials),
        "recipes": [_describe(model.recipe)],
        "services": _describe(model.services),
        "functions": _describe(model.functions),
        "serviceGraphs": _describe(model.service_graphs),
        "functionGraphs": _describe(model.function_graphs),
    }


_NAMES = {
    "machine_class": "class",
    "priority": "defaultPriority",
    "performances": "performedBy",
    "limits": "timeLimits",
    "is_else": "else",
    "is_early": "early",
    "least": "min",
    "most": "max",
    "source": "from",
    "target": "to",
}
"""Members with another name than their field in camel case."""
_PAIRS = frozenset(["bind", "assign", "arguments", "steps", "properties", "property_units"])
"""Fields with pairs of a name and a value, which become objects."""
_HIDDEN = frozenset(["element", "text"])
_REQUIRED: Mapping[type[Struct], frozenset[str]] = {
    Recipe: frozenset(["precedence"]),
    Task: frozenset(["equipment"]),
    FlowGraph: frozenset(["nodes", "edges"]),
}
"""Fields that are written without a value, too, because the schema requires them."""
_LAST: Mapping[type[Struct], tuple[str, ...]] = {
    Recipe: ("tasks", "precedence", "performedBy", "timeLimits", "derived"),
    Task: ("timeLimits", "derived", "equipment"),
    Service: ("providers",),
    MachineVariable: ("node", "elements"),
    OpcUa: ("object", "method", "namespaceUri", "doneWhen", "timeout"),
    FlowEdge: ("role", "item"),
}
"""Members that come after those of the other fields."""


def _describe(value: object) -> object:
    """Return the JSON form of a part of a model, of a list of parts, or of a plain value."""
    if isinstance(value, Expression):
        return describe_expression(value)
    if isinstance(value, tuple):
        return [_describe(item) for item in value]
    if isinstance(value, Struct):
        return _FORMS.get(type(value), _describe_fields)(value)
    return value


def _describe_fields(part: Struct, **described: object) -> Json:
    """Return the members for the fields of a part; *described* are members already."""
    fields, defaults = part.__struct_fields__, part.__struct_defaults__
    default_of = dict(zip(fields[len(fields) - len(defaults) :], defaults, strict=True))
    members: Json = {}
    for field in fields:
        value = getattr(part, field)
        is_default = field in default_of and value == default_of[field]
        if field in _HIDDEN or (is_default and field not in _REQUIRED.get(type(part), ())):
            continue
        is_object = field in _PAIRS
        content = {a: _describe(b) for a, b in value} if is_object else _describe(value)
        if value is None or content not in (None, {}):
            name = re.sub("_(.)", lambda match: match[1].upper(), field)
            members[_NAMES.get(field, name)] = content
    members |= described
    for name in _LAST.get(type(part), ()):
        if name in members:
            members[name] = members.pop(name)
    element = getattr(part, "element", "") if type(part) not in (FlowEdge, OpcUa) else ""
    return {**members, **({"trace": {"element": element}} if element else {})}


def _describe_owner(owner: Recipe | Task) -> Json:
    """Describe a recipe or a task, with verdicts on the times that requirements allow."""
    limits = [
        _describe_fields(limit, verdict=decide_limit(limit, owner.derived))
        for limit in owner.limits
    ]
    return _describe_fields(owner, **({"timeLimits": limits} if limits else {}))


def _describe_derived(derived: Derived) -> Json:
    members = _describe_fields(derived)
    details = {key: members.pop(key) for key in ("expected", "because") if key in members}
    if derived.duration is not None:
        members["duration"] |= details
    return members


def _describe_service(service: Service) -> Json:
    required = service.kind == "machine" or service.providers
    return _describe_fields(
        service, **({"providers": _describe(service.providers)} if required else {})
    )


def _describe_opcua(call: OpcUa) -> Json | None:
    """Describe an OPC UA call; None if it is not complete (SM612)."""
    return _describe_fields(call) if is_complete(call) else None


def _describe_type(type_: EnumType | ReferenceType | ListType) -> Json:
    match type_:
        case EnumType(name, literals, values):
            numbers = {"values": list(values)} if values else {}
            return {"enumeration": name, "literals": list(literals), **numbers}
        case ReferenceType(target, name):
            return {target: name}
        case ListType(item):
            return {"list": _describe(item)}


# -- graphs ------------------------------------------------------------------------------------


def _describe_graph(graph: FlowGraph) -> Json:
    nodes = {node.id: _describe_node(node, graph) for node in graph.nodes}
    return _describe_fields(graph, nodes=list(nodes.values()))


def _describe_guarded(part: Condition | FlowEdge) -> Json:
    guard = describe_expression(part.guard, part.text)
    return _describe_fields(part, **({"guard": guard} if guard else {}))


def _describe_node(node: Node, graph: FlowGraph) -> Json:
    trace = {"trace": {"element": node.element}} if node.element else {}
    return {"id": node.id, "kind": node.kind, **_describe_step(node, graph), **trace}


def _describe_step(  # noqa: PLR0911 - one for each kind
    node: Node, graph: FlowGraph
) -> Json:
    """Return the members of a node that depend on its kind; control nodes have none."""
    expression = describe_expression(node.expression, node.text if node.kind == "delay" else "")
    data = {
        "bind": {name: describe_expression(value) for name, value in node.bind},
        "assign": dict(node.assign),
    }
    data = {key: value for key, value in data.items() if value}
    most = {} if node.max_iterations is None else {"maxIterations": node.max_iterations}
    match node.kind:
        case "service" | "function" | "call":
            return {"ref": node.ref, **data}
        case "action":
            return {"text": node.text, **data}
        case "wait":
            return {**({"until": expression} if expression else {}), "text": node.text, **data}
        case "assign":
            variable = graph.parameters.get(node.variable, Parameter(node.variable))
            return {"variable": _describe(replace(variable, value=None)), "value": expression}
        case "delay":
            return {"time": expression}
        case "loop":
            return {"while": expression, **(most or {"unbounded": True})}
        case "forEach":
            variables = {variable.name: variable for variable in graph.variables}
            variable = variables.get(node.variable, Parameter(node.variable))
            least = {"minIterations": node.min_iterations} if node.min_iterations else {}
            return {"variable": _describe(variable), "in": expression, **least, **most}
        case _:
            return {}


# -- expressions -------------------------------------------------------------------------------


def describe_expression(expression: Expression | None, source_text: str = "") -> Json | None:
    """Return an expression as a tree, with its source text at the root if there is one."""
    if expression is None:
        return None
    has_text = bool(source_text) and not isinstance(expression, Opaque)
    return {**_describe_tree(expression), **({"text": source_text} if has_text else {})}


def _describe_tree(expression: Expression) -> Json:  # noqa: PLR0911 - one for each kind
    match expression:
        case Literal(literal):
            return {"lit": literal}
        case Opaque((text,)):
            return {"text": text}
        case Name((name,)):
            return {"var": name}
        case Unary(op, _) | Binary(op, _, _):
            return {"op": op, "args": [_describe_tree(operand) for operand in operands(expression)]}
        case Index(base, index):
            return {"index": [_describe_tree(base), _describe_tree(index)]}
        case Call(Name((function,)), args):
            return {"call": function, "args": [_describe_tree(arg) for arg in args]}
        case _:
            return {"text": print_expression(expression)}


_FORMS: Mapping[type[Struct], Callable[[Any], Any]] = {
    Recipe: _describe_owner,
    Task: _describe_owner,
    Derived: _describe_derived,
    Service: _describe_service,
    OpcUa: _describe_opcua,
    EnumType: _describe_type,
    ReferenceType: _describe_type,
    ListType: _describe_type,
    FlowGraph: _describe_graph,
    Condition: _describe_guarded,
    FlowEdge: _describe_guarded,
}
"""The parts that differ from their fields."""
