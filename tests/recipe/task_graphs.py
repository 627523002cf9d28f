"""Small task graphs in text form, and their derived times."""

from collections.abc import Mapping

from sysmlc.analyses.recipe.expressions import read_assignments, read_expression
from sysmlc.recipe.derivation import derive
from sysmlc.recipe.flow import add_loop_nodes
from sysmlc.recipe.model import (
    Derived,
    FlowEdge,
    FlowGraph,
    ListType,
    Mode,
    Model,
    Node,
    Parameter,
    Provider,
    Recipe,
    Scalar,
    Service,
    Task,
)

KINDS = {
    "i": "initial",
    "f": "final",
    "D": "decision",
    "M": "merge",
    "F": "fork",
    "J": "join",
    "A": "assign",
    "E": "forEach",
}
"""Kinds of nodes by the first letter of their name; all others are services."""

_TYPES: dict[type, str] = {bool: "boolean", int: "integer", str: "string"}


def build_task_graph(
    text: str,
    variables: Mapping[str, Scalar | tuple[Scalar, ...] | None] | None = None,
    **bounds: int,
) -> FlowGraph:
    """Return the graph of the lines of *text*; *bounds* are the most iterations of loop nodes.

    A line is an edge ``a > b``, ``a > b [guard]``, or ``a > b 70%`` with a probability. An
    assignment is a line ``A1 = n := n + 1``, a for-each node ``E1 = list``, and the output of a
    service ``a -> ok``. A variable with the value None is a Boolean without a value.
    """
    edges: list[FlowEdge] = []
    nodes: dict[str, Node] = {}
    for line in filter(None, map(str.strip, text.splitlines())):
        name, sign, rest = line.split(" ", 2)
        nodes.setdefault(name, _make_node(name))
        if sign == "=":
            nodes[name] = _define_node(nodes[name], rest)
        elif sign == "->":
            nodes[name] = Node(name, "service", ref=name, assign=((rest, rest),))
        else:
            target = rest.split(" ")[0]
            nodes.setdefault(target, _make_node(target))
            edges.append(_make_edge(name, target, rest[len(target) :].strip(), nodes[name].kind))
    declared = tuple(_declare(*item) for item in (variables or {}).items())
    graph = FlowGraph("T", variables=declared, nodes=tuple(nodes.values()), edges=tuple(edges))
    return add_loop_nodes(graph, bounds)


def _make_node(name: str) -> Node:
    kind = KINDS.get(name[0], "service")
    return Node(name, kind, ref=name if kind == "service" else "")


def _define_node(node: Node, text: str) -> Node:
    if node.kind == "forEach":
        return Node(node.id, node.kind, variable="item", expression=read_expression(text))
    ((variable, value),) = read_assignments(text)
    return Node(node.id, node.kind, variable=variable, expression=value)


def _make_edge(source: str, target: str, text: str, kind: str) -> FlowEdge:
    probability = float(text.removesuffix("%")) / 100 if text.endswith("%") else None
    guard = text.strip("[]") if text.startswith("[") else ""
    is_else = guard == "else"
    # The body of a for-each node has small letters, its exit is a final node or a capital letter.
    role = ("exit" if target[0] in "fMJ" else "body") if kind == "forEach" else ""
    expression = read_expression(guard) if guard and not is_else else None
    return FlowEdge(source, target, expression, guard, is_else, "", role, probability=probability)


def _declare(name: str, value: Scalar | tuple[Scalar, ...] | None) -> Parameter:
    if isinstance(value, tuple):
        return Parameter(name, ListType("integer"), value=value)
    type_ = "boolean" if value is None else _TYPES[type(value)]
    return Parameter(name, type_, value=value)


def derive_times(graph: FlowGraph, machines: Mapping[str, str]) -> Derived:
    """Return the derived data of a task with this graph.

    *machines* maps the names of services to ``<machine>:<ms>``, several separated by spaces; a
    service without a machine is ``:<ms>``.
    """
    services = []
    for name, offers in sorted(machines.items()):
        pairs = [offer.split(":") for offer in offers.split()]
        providers = tuple(Provider(machine, int(time)) for machine, time in pairs if machine)
        kind = "machine" if providers else "infrastructure"
        services.append(Service(name, kind, providers=providers, duration=int(pairs[0][1])))
    named = sorted({p.machine for service in services for p in service.providers})
    equipment = tuple(Mode((machine,)) for machine in named)
    task = Task("t", equipment=equipment, implementation="T")
    model = Model(Recipe("R", (task,)), services=tuple(services), service_graphs=(graph,))
    (derived_task,) = derive(model).recipe.tasks
    assert derived_task.derived is not None
    return derived_task.derived
