"""Checks of guards and variables (REC005, REC006)."""

from collections.abc import Iterator, Mapping

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir.algorithms import sort_topologically
from sysmlc.recipe.checks import Finding, declared, graphs
from sysmlc.recipe.derive import Tables
from sysmlc.recipe.expression import Expr, unreadable, variables
from sysmlc.recipe.flow import forward_edges
from sysmlc.recipe.guards import (
    UndecidedError,
    holds,
    is_condition,
    literals_as_values,
    valuations,
)
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
    "'{text}' at '{element}' is no expression that an executor can evaluate",
    help=(
        "write it in the expression grammar: names, literals, and, or, not, comparisons, arithmetic"
    ),
)


def guards(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC005: Boolean guards, one else at most, no overlap, no gap."""
    for graph in graphs(model):
        for node, problem in _decision_problems(graph):
            yield Finding(GUARDS, node.element, {"decision": node.id, "problem": problem})


def _decision_problems(graph: FlowGraph) -> Iterator[tuple[Node, str]]:
    types = {name: one.type for name, one in declared(graph).items()}
    for node in graph.nodes:
        if node.kind in ("decision", "loop"):
            edges = [edge for edge in graph.edges if edge.source == node.id]
            yield from ((node, problem) for problem in _guard_problems(edges, types))


def _guard_problems(edges: list[FlowEdge], types: Mapping[str, ValueType | None]) -> Iterator[str]:
    others = sum(edge.is_else for edge in edges)
    if others > 1:
        yield f"have {others} times 'else'"
    open_ = [edge for edge in edges if edge.guard is None and not edge.is_else]
    if len(edges) > 1 and open_:
        yield "leave a way without a guard"
        return
    found = [(edge.text, edge.guard) for edge in edges if edge.guard is not None]
    for text, guard in found:
        if not is_condition(guard, types):
            yield f"are not all true or false: '{text}'"
            return
    yield from _tried(found, types, has_else=others > 0)


def _tried(
    found: list[tuple[str, Expr]], types: Mapping[str, ValueType | None], *, has_else: bool
) -> Iterator[str]:
    """At most one overlap and one gap, each with values that show it."""
    expressions = [literals_as_values(guard, types) for _, guard in found]
    overlaps = gaps = False
    for values in valuations(expressions, types):
        try:
            true = [
                text for (text, _), e in zip(found, expressions, strict=True) if holds(e, values)
            ]
        except UndecidedError:
            return
        if len(true) > 1 and not overlaps:
            overlaps = True
            yield f"overlap: '{true[0]}' and '{true[1]}' are both true{_when(values)}"
        if not true and expressions and not has_else and not gaps:
            gaps = True
            yield f"leave a gap: none is true{_when(values)}"


def _when(values: Mapping[str, Scalar]) -> str:
    shown = ", ".join(f"{name} = {_shown(value)}" for name, value in sorted(values.items()))
    return f" for {shown}" if shown else ""


def _shown(value: Scalar) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value).replace("\x00", "an")


# -- variables ---------------------------------------------------------------------------------


def names(model: Model, tables: Tables) -> Iterator[Finding]:
    """REC006: variables are declared and have a value; what is bound fits in type and unit."""
    for graph in graphs(model):
        for element, problem in (*_name_problems(graph), *_misfits(graph, tables)):
            yield Finding(UNDECLARED, element, {"graph": graph.id, "problem": problem})


def _name_problems(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    yield from _undeclared(graph)
    yield from _unset(graph)


def _uses(graph: FlowGraph) -> Iterator[tuple[str, str, Expr]]:
    """Element, node whose variables are read (``<`` before it: as it begins), and expression."""
    for edge in graph.edges:
        if edge.guard is not None:
            yield edge.element, edge.source, edge.guard
    for node in graph.nodes:
        for _, bound in node.bind:
            yield node.element, f"<{node.id}", bound
        if node.expression is not None and node.kind != "loop":
            yield node.element, f"<{node.id}", node.expression


def _literals(graph: FlowGraph) -> set[str]:
    types = (one.type for one in declared(graph).values())
    return {name for type_ in types if isinstance(type_, EnumType) for name in type_.literals}


def _undeclared(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    known = set(declared(graph)) | _literals(graph)
    for element, _, expression in _uses(graph):
        for name in variables(expression):
            base = name.split(".")[0]
            last = name.replace("::", ".").rpartition(".")[2]
            if not {name, base, last} & known:
                yield element, f"'{name}' is declared nowhere"
    for node in graph.nodes:
        if node.variable and node.variable.split(".")[0] not in known:
            yield node.element, f"'{node.variable}' is declared nowhere"


def _unset(graph: FlowGraph) -> Iterator[tuple[str, str]]:
    """Variables that some way reads before anything has set them."""
    defined = _definitely_set(graph)
    names = {one.name for one in graph.variables}
    for element, node, expression in _uses(graph):
        missing = sorted(set(variables(expression)) & names - defined.get(node, names))
        for name in missing:
            yield element, f"'{name}' is read before it has a value"


def _definitely_set(graph: FlowGraph) -> dict[str, set[str]]:
    """What has a value when a node is done, and with ``<`` when it begins, on every way."""
    start = {one.name for one in graph.inputs}
    start |= {one.name for one in graph.variables if one.value is not None}
    nodes = {node.id: node for node in graph.nodes}
    before: dict[str, list[str]] = {}
    pairs = forward_edges(graph)
    for source, target in pairs:
        before.setdefault(target, []).append(source)
    done: dict[str, set[str]] = {}
    for id in sort_topologically(nodes, pairs):
        ways = [done[one] for one in before.get(id, ())]
        joined = nodes[id].kind in ("join", "service", "function")
        have = set.union(*ways) if ways and joined else set.intersection(*ways) if ways else start
        done[f"<{id}"] = have
        done[id] = have | _sets(nodes[id])
    return done


def _sets(node: Node) -> set[str]:
    return {variable for _, variable in node.assign} | ({node.variable} if node.variable else set())


def _misfits(graph: FlowGraph, tables: Tables) -> Iterator[tuple[str, str]]:
    known = declared(graph)
    for node in graph.nodes:
        called = tables.services.get(node.ref) or tables.functions.get(node.ref)
        inputs = {} if called is None else {one.name: one for one in called.inputs}
        for name, bound in node.bind:
            given = next((known.get(one) for one in variables(bound)), None)
            problem = _misfit(inputs.get(name), given)
            if problem:
                yield node.element, f"input '{name}' of '{node.ref}' {problem}"


def _misfit(wanted: Parameter | None, given: Parameter | None) -> str:
    if wanted is None or given is None or wanted.type is None or given.type is None:
        return ""
    if not _fits(given.type, wanted.type):
        return f"and the variable '{given.name}' have different types"
    if wanted.unit and given.unit and wanted.unit != given.unit:
        return f"is in {wanted.unit}, but '{given.name}' in {given.unit}"
    return ""


def _fits(given: ValueType, wanted: ValueType) -> bool:
    """Whether values of one type are values of the other.

    What a reference leads to may be more special than what is wanted; the language judges that.
    An enumeration may be one of numbers (SysML v2, 8.3.8): its values are integers then.
    """
    if given == wanted or (given, wanted) == ("integer", "real"):
        return True
    if isinstance(given, ReferenceType) and isinstance(wanted, ReferenceType):
        return True
    return "integer" in (given, wanted) and any(isinstance(t, EnumType) for t in (given, wanted))


def readable(model: Model, tables: Tables) -> Iterator[Finding]:
    """Expressions that stayed text."""
    for graph in graphs(model):
        yield from _unreadable_in(graph)
    for element, id, expression in _conditions(model):
        yield from _mere_texts(element, id, expression)


def _unreadable_in(graph: FlowGraph) -> Iterator[Finding]:
    for edge in graph.edges:
        yield from _mere_texts(edge.element, edge.source, edge.guard)
    for node in graph.nodes:
        for _, bound in node.bind:
            yield from _mere_texts(node.element, node.id, bound)
        if node.kind != "loop":
            yield from _mere_texts(node.element, node.id, node.expression)


def _mere_texts(element: str, id: str, expression: Expr | None) -> Iterator[Finding]:
    for text in () if expression is None else unreadable(expression):
        yield Finding(UNREADABLE, element, {"text": text, "element": id})


def _conditions(model: Model) -> Iterator[tuple[str, str, Expr | None]]:
    """Conditions of tasks and services: element, id of what they belong to, expression."""
    conditioned: tuple[Task | Service, ...] = (*model.recipe.tasks, *model.services)
    for one in conditioned:
        yield one.element, one.id, one.pre
        yield one.element, one.id, one.post
