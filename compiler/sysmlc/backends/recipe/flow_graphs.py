"""The JSON form of flow graphs (levels 2 and 3 of a recipe), parameters and expressions."""

from collections.abc import Callable, Iterable, Mapping

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
from sysmlc.recipe.expression import Opaque, operands
from sysmlc.recipe.model import (
    EnumType,
    FlowEdge,
    FlowGraph,
    ListType,
    Node,
    Parameter,
    ReferenceType,
    ValueType,
)

Json = dict[str, object]


def describe_trace(element: str) -> Json:
    """Return the member ``trace`` for the id of an element, no member for an empty id."""
    return {"trace": {"element": element}} if element else {}


def describe_flow_graph(graph: FlowGraph) -> Json:
    """Describe a graph of services (level 2) or functions (level 3)."""
    declarations = {
        "inputs": describe_parameters(graph.inputs),
        "outputs": describe_parameters(graph.outputs),
        "variables": describe_parameters(graph.variables),
    }
    nodes = {node.id: node for node in graph.nodes}
    return {
        "id": graph.id,
        **{key: value for key, value in declarations.items() if value},
        "nodes": [_describe_node(node, graph) for node in nodes.values()],
        "edges": [_describe_edge(edge) for edge in graph.edges],
        **describe_trace(graph.element),
    }


def describe_parameters(parameters: Iterable[Parameter]) -> list[Json]:
    """Return parameters, constants or variables, in order."""
    return [_describe_parameter(parameter) for parameter in parameters]


def _describe_parameter(parameter: Parameter) -> Json:
    members: Json = {"name": parameter.name}
    if parameter.type is not None:
        members["type"] = describe_type(parameter.type)
    if parameter.unit:
        members["unit"] = parameter.unit
    if parameter.value is not None:
        value = parameter.value
        members["value"] = list(value) if isinstance(value, tuple) else value
    return members


def describe_type(type_: ValueType) -> object:
    """Return the name of a simple type, or an object for an enumeration, reference or list."""
    match type_:
        case EnumType(name, literals, values):
            numbers = {"values": list(values)} if values else {}
            return {"enumeration": name, "literals": list(literals), **numbers}
        case ReferenceType(target, name):
            return {target: name}
        case ListType(item):
            return {"list": describe_type(item)}
        case name:
            return name


# -- nodes and edges ---------------------------------------------------------------------------


def _describe_node(node: Node, graph: FlowGraph) -> Json:
    describe = _NODES.get(node.kind)
    members = describe(node, graph) if describe else {}
    return {"id": node.id, "kind": node.kind, **members, **describe_trace(node.element)}


def _describe_call(node: Node, graph: FlowGraph) -> Json:
    return {"ref": node.ref, **_describe_data(node)}


def _describe_assignment(node: Node, graph: FlowGraph) -> Json:
    variables = {
        variable.name: variable for variable in (*graph.variables, *graph.outputs, *graph.inputs)
    }
    declared = variables.get(node.variable, Parameter(node.variable))
    target = _describe_parameter(Parameter(declared.name, declared.type, declared.unit))
    return {"variable": target, "value": describe_expression(node.expression)}


def _describe_action(node: Node, graph: FlowGraph) -> Json:
    return {"text": node.text, **_describe_data(node)}


def _describe_wait(node: Node, graph: FlowGraph) -> Json:
    condition = {} if node.expression is None else {"until": describe_expression(node.expression)}
    return {**condition, "text": node.text, **_describe_data(node)}


def _describe_for_each(node: Node, graph: FlowGraph) -> Json:
    variables = {variable.name: variable for variable in graph.variables}
    variable = variables.get(node.variable, Parameter(node.variable))
    limit = {} if node.max_iterations is None else {"maxIterations": node.max_iterations}
    least = {"minIterations": node.min_iterations} if node.min_iterations else {}
    return {
        "variable": _describe_parameter(variable),
        "in": describe_expression(node.expression),
        **least,
        **limit,
    }


def _describe_delay(node: Node, graph: FlowGraph) -> Json:
    return {"time": describe_expression(node.expression, node.text)}


def _describe_loop(node: Node, graph: FlowGraph) -> Json:
    condition = describe_expression(node.expression)
    if node.max_iterations is None:
        return {"while": condition, "unbounded": True}
    return {"while": condition, "maxIterations": node.max_iterations}


def _describe_data(node: Node) -> Json:
    """Return the members ``bind`` and ``assign`` of a node; empty ones are omitted."""
    members: Mapping[str, Json] = {
        "bind": {name: describe_expression(value) for name, value in node.bind},
        "assign": dict(node.assign),
    }
    return {key: value for key, value in members.items() if value}


_NODES: dict[str, Callable[[Node, FlowGraph], Json]] = {
    "service": _describe_call,
    "function": _describe_call,
    "call": _describe_call,
    "assign": _describe_assignment,
    "action": _describe_action,
    "wait": _describe_wait,
    "delay": _describe_delay,
    "loop": _describe_loop,
    "forEach": _describe_for_each,
}
"""The members of a node by its kind; the other kinds are control nodes without members."""


def _describe_edge(edge: FlowEdge) -> Json:
    members: Json = {"from": edge.source, "to": edge.target}
    if edge.guard is not None:
        members["guard"] = describe_expression(edge.guard, edge.text)
    if edge.is_else:
        members["else"] = True
    if edge.probability is not None:
        members["probability"] = edge.probability
    if edge.role:
        members["role"] = edge.role
    if edge.item:
        members["item"] = edge.item
    return members


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
