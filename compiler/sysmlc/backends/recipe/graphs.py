"""The JSON form of flow graphs, their parameters and expressions."""

from collections.abc import Callable, Iterable, Mapping

from sysmlc.logic.expressions.expression import (
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


def trace(element: str) -> Json:
    """The member ``trace`` for an element, nothing for none."""
    return {"trace": {"element": element}} if element else {}


def flow_graph(graph: FlowGraph) -> Json:
    """A graph of level 2 or 3."""
    declared = {
        "inputs": parameters(graph.inputs),
        "outputs": parameters(graph.outputs),
        "variables": parameters(graph.variables),
    }
    names = {node.id: node for node in graph.nodes}
    return {
        "id": graph.id,
        **{key: value for key, value in declared.items() if value},
        "nodes": [_node(node, graph) for node in names.values()],
        "edges": [_edge(edge) for edge in graph.edges],
        **trace(graph.element),
    }


def parameters(values: Iterable[Parameter]) -> list[Json]:
    """Parameters, constants or variables, in order."""
    return [_parameter(value) for value in values]


def _parameter(parameter: Parameter) -> Json:
    found: Json = {"name": parameter.name}
    if parameter.type is not None:
        found["type"] = value_type(parameter.type)
    if parameter.unit:
        found["unit"] = parameter.unit
    if parameter.value is not None:
        value = parameter.value
        found["value"] = list(value) if isinstance(value, tuple) else value
    return found


def value_type(type_: ValueType) -> object:
    """A type: its name, or an object that says what it is made of."""
    match type_:
        case EnumType(name, literals, values):
            given = {"values": list(values)} if values else {}
            return {"enumeration": name, "literals": list(literals), **given}
        case ReferenceType(to, name):
            return {to: name}
        case ListType(of):
            return {"list": value_type(of)}
        case name:
            return name


# -- nodes and edges ---------------------------------------------------------------------------


def _node(node: Node, graph: FlowGraph) -> Json:
    own = _MEMBERS.get(node.kind, _nothing)(node, graph)
    return {"id": node.id, "kind": node.kind, **own, **trace(node.element)}


def _nothing(node: Node, graph: FlowGraph) -> Json:
    return {}


def _describe_call(node: Node, graph: FlowGraph) -> Json:
    return {"ref": node.ref, **_data(node)}


def _describe_assignment(node: Node, graph: FlowGraph) -> Json:
    variables = {
        variable.name: variable for variable in (*graph.variables, *graph.outputs, *graph.inputs)
    }
    declared = variables.get(node.variable, Parameter(node.variable))
    target = _parameter(Parameter(declared.name, declared.type, declared.unit))
    return {"variable": target, "value": expression(node.expression)}


def _action(node: Node, graph: FlowGraph) -> Json:
    return {"text": node.text, **_data(node)}


def _waiting(node: Node, graph: FlowGraph) -> Json:
    until = {} if node.expression is None else {"until": expression(node.expression)}
    return {**until, "text": node.text, **_data(node)}


def _repeating(node: Node, graph: FlowGraph) -> Json:
    known = {one.name: one for one in graph.variables}
    found = known.get(node.variable, Parameter(node.variable))
    limit = {} if node.max_iterations is None else {"maxIterations": node.max_iterations}
    return {"variable": _parameter(found), "in": expression(node.expression), **limit}


def _delaying(node: Node, graph: FlowGraph) -> Json:
    return {"time": expression(node.expression, node.text)}


def _looping(node: Node, graph: FlowGraph) -> Json:
    if node.max_iterations is None:
        return {"while": expression(node.expression), "unbounded": True}
    return {"while": expression(node.expression), "maxIterations": node.max_iterations}


def _data(node: Node) -> Json:
    found: Mapping[str, Json] = {
        "bind": {name: expression(value) for name, value in node.bind},
        "assign": dict(node.assign),
    }
    return {key: value for key, value in found.items() if value}


_MEMBERS: dict[str, Callable[[Node, FlowGraph], Json]] = {
    "service": _describe_call,
    "function": _describe_call,
    "call": _describe_call,
    "assign": _describe_assignment,
    "action": _action,
    "wait": _waiting,
    "delay": _delaying,
    "loop": _looping,
    "forEach": _repeating,
}


def _edge(edge: FlowEdge) -> Json:
    found: Json = {"from": edge.source, "to": edge.target}
    if edge.guard is not None:
        found["guard"] = expression(edge.guard, edge.text)
    if edge.is_else:
        found["else"] = True
    if edge.role:
        found["role"] = edge.role
    if edge.item:
        found["item"] = edge.item
    return found


# -- expressions -------------------------------------------------------------------------------


def expression(value: Expression | None, text: str = "") -> Json | None:
    """An expression as a tree, with its source text on top when it is given."""
    if value is None:
        return None
    beside = {"text": text} if text and not isinstance(value, Opaque) else {}
    return {**_tree(value), **beside}


def _tree(value: Expression) -> Json:  # noqa: PLR0911 - one for each kind
    match value:
        case Literal(literal):
            return {"lit": literal}
        case Opaque((text,)):
            return {"text": text}
        case Name((name,)):
            return {"var": name}
        case Unary(op, _) | Binary(op, _, _):
            return {"op": op, "args": [_tree(operand) for operand in operands(value)]}
        case Index(base, index):
            return {"index": [_tree(base), _tree(index)]}
        case Call(Name((function,)), args):
            return {"call": function, "args": [_tree(arg) for arg in args]}
        case _:
            return {"text": print_expression(value)}
