"""Checks of guards and variables (REC005, REC006)."""

from collections.abc import Iterator, Mapping

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir.algorithms import sort_topologically
from sysmlc.ir.expressions import Expression, last_name
from sysmlc.recipe.expression import (
    ANOTHER_TEXT,
    evaluate,
    is_condition,
    iter_opaque_texts,
    iter_valuations,
    iter_variables,
    resolve_literals,
)
from sysmlc.recipe.flow import list_forward_edges
from sysmlc.recipe.model import (
    EnumType,
    FlowEdge,
    FlowGraph,
    Model,
    Node,
    Parameter,
    ReferenceType,
    Scalar,
    Service,
    Task,
    ValueType,
)
from sysmlc.recipe.tables import Finding, Tables

GUARDS = rule(
    "SM605",
    "recipe-decision-unclear",
    Severity.WARNING,
    "the guards of '{decision}' {problem}",
    help="write guards that exclude one another, and 'else' on one edge",
)
UNDECLARED = rule(
    "SM606",
    "recipe-variable-undeclared",
    Severity.ERROR,
    "in '{graph}', {problem}",
    help=(
        "give the activity an attribute of that name, with a default value when it is read before "
        "it is set"
    ),
)
UNREADABLE = rule(
    "SM616",
    "recipe-expression-unreadable",
    Severity.WARNING,
    "'{text}' at '{element}' is not an expression that an executor can evaluate",
    help=(
        "write it in the expression grammar: names, literals, and, or, not, comparisons, arithmetic"
    ),
)


def check_guards(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC005: guards are Boolean, with at most one else, without overlap or gap."""
    for graph in model.graphs:
        for node, problem in _iter_decision_problems(graph):
            yield Finding(GUARDS, node.element, {"decision": node.id, "problem": problem})


def _iter_decision_problems(graph: FlowGraph) -> Iterator[tuple[Node, str]]:
    types = {name: parameter.type for name, parameter in graph.parameters.items()}
    for node in graph.nodes:
        if node.kind in ("decision", "loop"):
            edges = [edge for edge in graph.edges if edge.source == node.id]
            yield from ((node, problem) for problem in _iter_guard_problems(edges, types))


def _iter_guard_problems(
    edges: list[FlowEdge], types: Mapping[str, ValueType | None]
) -> Iterator[str]:
    else_count = sum(edge.is_else for edge in edges)
    if else_count > 1:
        yield f"contain 'else' {else_count} times"
    unguarded = [edge for edge in edges if edge.guard is None and not edge.is_else]
    if len(edges) > 1 and unguarded:
        yield "leave an edge without a guard"
        return
    guards = [(edge.text, edge.guard) for edge in edges if edge.guard is not None]
    for text, guard in guards:
        if not is_condition(guard, types):
            yield f"are not all Boolean: '{text}'"
            return
    yield from _iter_conflicts(guards, types, has_else=else_count > 0)


def _iter_conflicts(
    guards: list[tuple[str, Expression]], types: Mapping[str, ValueType | None], *, has_else: bool
) -> Iterator[str]:
    """Yield at most one overlap and one gap of guards, each with values as an example."""
    expressions = [resolve_literals(guard, types) for _, guard in guards]
    has_overlap = has_gap = False
    for values in iter_valuations(expressions, types):
        truths = [evaluate(expression, values) for expression in expressions]
        if None in truths:
            return
        satisfied = [text for (text, _), truth in zip(guards, truths, strict=True) if truth]
        if len(satisfied) > 1 and not has_overlap:
            has_overlap = True
            first, second, *_ = satisfied
            yield f"overlap: '{first}' and '{second}' are both true{_format_values(values)}"
        if not satisfied and expressions and not has_else and not has_gap:
            has_gap = True
            yield f"leave a gap: none is true{_format_values(values)}"


def _format_values(values: Mapping[str, Scalar]) -> str:
    text = ", ".join(f"{name} = {_format_value(value)}" for name, value in sorted(values.items()))
    return f" for {text}" if text else ""


def _format_value(value: Scalar) -> str:
    if value == ANOTHER_TEXT:
        return "another"
    return str(value).lower() if isinstance(value, bool) else str(value)


# -- variables ---------------------------------------------------------------------------------


def check_names(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC006: variables are declared, and set before they are read; bindings fit."""
    for graph in model.graphs:
        problems = (*_iter_undeclared(graph), *_iter_unset(graph), *_iter_misfits(graph, tables))
        for element, problem in problems:
            yield Finding(UNDECLARED, element, {"graph": graph.id, "problem": problem})


def _iter_uses(graph: FlowGraph) -> Iterator[tuple[str, str, Expression]]:
    """Yield the element of each expression, the time at which it is evaluated, and the expression.

    The time is ``<id`` when the node begins, ``id`` when it is done (``_collect_set_variables``).
    """
    for edge in graph.edges:
        if edge.guard is not None:
            yield edge.element, edge.source, edge.guard
    for node in graph.nodes:
        for _, argument in node.bind:
            yield node.element, f"<{node.id}", argument
        if node.expression is not None and node.kind != "loop":
            yield node.element, f"<{node.id}", node.expression


def _iter_undeclared(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    declared = set(graph.parameters)
    types = (parameter.type for parameter in graph.parameters.values())
    declared.update(
        name for type_ in types if isinstance(type_, EnumType) for name in type_.literals
    )
    for element, _, expression in _iter_uses(graph):
        for name in iter_variables(expression):
            base = name.split(".")[0]
            last = last_name(name)
            if not {name, base, last} & declared:
                yield element, f"'{name}' is not declared"
    for node in graph.nodes:
        if node.variable and node.variable.split(".")[0] not in declared:
            yield node.element, f"'{node.variable}' is not declared"


def _iter_unset(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    """Yield the variables that an expression reads although a path to it does not set them."""
    set_variables = _collect_set_variables(graph)
    names = {variable.name for variable in graph.variables}
    for element, time, expression in _iter_uses(graph):
        missing = sorted(set(iter_variables(expression)) & names - set_variables.get(time, names))
        for name in missing:
            yield element, f"'{name}' is read before it has a value"


def _collect_set_variables(graph: FlowGraph) -> dict[str, set[str]]:
    """Return, for each time, the variables that every path to it has set.

    The time ``id`` is when the node of this id is done, ``<id`` is when it begins.
    """
    start = {parameter.name for parameter in graph.inputs}
    start |= {variable.name for variable in graph.variables if variable.value is not None}
    nodes = {node.id: node for node in graph.nodes}
    predecessors: dict[str, list[str]] = {}
    edges = list_forward_edges(graph)
    for source, target in edges:
        predecessors.setdefault(target, []).append(source)
    defined: dict[str, set[str]] = {}
    for id in sort_topologically(nodes, edges):
        incoming = [defined[predecessor] for predecessor in predecessors.get(id, ())]
        # A join or a step waits for all incoming edges; elsewhere only one of them is taken.
        if not incoming:
            before = start
        elif nodes[id].kind in ("join", "service", "function"):
            before = set.union(*incoming)
        else:
            before = set.intersection(*incoming)
        defined[f"<{id}"] = before
        defined[id] = before | _assigned_variables(nodes[id])
    return defined


def _assigned_variables(node: Node) -> set[str]:
    return {variable for _, variable in node.assign} | ({node.variable} if node.variable else set())


def _iter_misfits(graph: FlowGraph, tables: Tables) -> Iterator[tuple[str, str]]:
    parameters = graph.parameters
    for node in graph.nodes:
        called = tables.services.get(node.ref) or tables.functions.get(node.ref)
        inputs = (
            {} if called is None else {parameter.name: parameter for parameter in called.inputs}
        )
        for name, argument in node.bind:
            variables = iter_variables(argument)
            actual = next((parameters.get(variable) for variable in variables), None)
            problem = _describe_misfit(inputs.get(name), actual)
            if problem:
                yield node.element, f"input '{name}' of '{node.ref}' {problem}"


def _describe_misfit(formal: Parameter | None, actual: Parameter | None) -> str:
    if formal is None or actual is None or formal.type is None or actual.type is None:
        return ""
    if not _is_assignable(actual.type, formal.type):
        return f"and the variable '{actual.name}' have different types"
    if formal.unit and actual.unit and formal.unit != actual.unit:
        return f"is in {formal.unit}, but '{actual.name}' in {actual.unit}"
    return ""


def _is_assignable(actual: ValueType, formal: ValueType) -> bool:
    """Whether values of the actual type are values of the formal type.

    References are not compared: their types may specialise one another, which the language checks.
    An enumeration may be one of numbers (SysML v2, 8.3.8): its values are integers then.
    """
    types = (actual, formal)
    if actual == formal or types == ("integer", "real"):
        return True
    if isinstance(actual, ReferenceType) and isinstance(formal, ReferenceType):
        return True
    return "integer" in types and any(isinstance(type_, EnumType) for type_ in types)


def check_expressions(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM616: executors can evaluate every expression."""
    for graph in model.graphs:
        yield from _check_graph(graph)
    for element, id, expression in _iter_conditions(model):
        yield from _check_expression(element, id, expression)


def _check_graph(graph: FlowGraph) -> Iterator[Finding]:
    for edge in graph.edges:
        yield from _check_expression(edge.element, edge.source, edge.guard)
    for node in graph.nodes:
        for _, argument in node.bind:
            yield from _check_expression(node.element, node.id, argument)
        if node.kind != "loop":
            yield from _check_expression(node.element, node.id, node.expression)


def _check_expression(element: str, id: str, expression: Expression | None) -> Iterator[Finding]:
    if expression is None:
        return
    for text in iter_opaque_texts(expression):
        yield Finding(UNREADABLE, element, {"text": text, "element": id})


def _iter_conditions(model: Model) -> Iterator[tuple[str, str, Expression | None]]:
    """Yield each condition of tasks and services: element and id of its owner, and expression."""
    owners: tuple[Task | Service, ...] = (*model.recipe.tasks, *model.services)
    for owner in owners:
        yield owner.element, owner.id, owner.pre
        yield owner.element, owner.id, owner.post
