"""Values of the variables of a flow graph during an execution, as far as the graph determines them.

A variable has a known value from its default or a literal argument on, until a service, a function
or a wait assigns it. Only variables on which the choice of a branch depends are tracked.
"""

from collections.abc import Collection, Iterator, Mapping
from itertools import product

from msgspec import Struct

from sysmlc.ir.expressions import Expression, Literal
from sysmlc.recipe.expression import evaluate, iter_variables, resolve_literals
from sysmlc.recipe.model import EnumType, FlowEdge, FlowGraph, Node, Parameter, Scalar, ValueType

Valuation = tuple[tuple[str, Scalar], ...]
"""The known values, sorted by name. An absent variable may have any value."""

CHOICES = frozenset({"decision", "loop", "merge"})
"""Kinds of nodes that take one of their outgoing edges, by its guard."""
_MOST_CASES = 64
"""Most combinations of values that one decision distinguishes."""
_TRACKED_TYPES = ("boolean", "integer", "real", "string", None)


def set_value(values: Valuation, name: str, value: Scalar | None) -> Valuation:
    """Return the valuation with a new value of a variable; None stands for any value."""
    rest = tuple(item for item in values if item[0] != name)
    return rest if value is None else tuple(sorted((*rest, (name, value))))


def merge_values(outcomes: list[Valuation], start: Valuation) -> Valuation | None:
    """Return the values after parallel branches that began with *start*; None if they differ."""
    before = dict(start)
    merged = dict(start)
    changed: dict[str, object] = {}
    for outcome in outcomes:
        after = dict(outcome)
        for name in before.keys() | after.keys():
            value = after.get(name)
            if value == before.get(name):
                continue
            if changed.setdefault(name, value) != value:
                return None
            if value is None:
                merged.pop(name, None)
            else:
                merged[name] = value
    return tuple(sorted(merged.items()))


class Variables(Struct, frozen=True):
    """The tracked variables of a flow graph, and its expressions with resolved literals."""

    types: Mapping[str, ValueType | None]
    start: Valuation
    guards: Mapping[FlowEdge, Expression]
    values: Mapping[str, Expression]
    """The right sides of assignments by the id of their node."""

    @classmethod
    def from_graph(cls, graph: FlowGraph, arguments: Mapping[str, Expression]) -> "Variables":
        """Find the variables of *graph*; *arguments* are the expressions bound to its inputs."""
        all_types = {name: parameter.type for name, parameter in graph.parameters.items()}
        kinds = {node.id: node.kind for node in graph.nodes}
        guards = {
            edge: resolve_literals(edge.guard, all_types)
            for edge in graph.edges
            if edge.guard is not None and kinds[edge.source] in CHOICES
        }
        values = {
            node.id: resolve_literals(node.expression, all_types)
            for node in graph.nodes
            if node.kind == "assign" and node.expression is not None
        }
        names = _find_deciding_variables(graph, guards.values(), values)
        types = {
            name: type_
            for name, type_ in all_types.items()
            # In a numeric context a literal of an enumeration of numbers is its number.
            if name in names
            and (type_ in _TRACKED_TYPES or (isinstance(type_, EnumType) and not type_.values))
        }
        start = tuple(sorted(_iter_start_values(graph, types, arguments)))
        return cls(types, start, guards, values)

    def assign(self, node: Node, values: Valuation, volatile: Collection[str]) -> Valuation:
        """Return the valuation after a node; *volatile* variables have no known value."""
        for _, name in node.assign:
            values = set_value(values, name, None)
        if node.variable in self.types and node.variable not in volatile:
            expression = self.values.get(node.id)
            value = None if expression is None else evaluate(expression, dict(values))
            values = set_value(values, node.variable, value)
        return values

    def list_read(self, nodes: Collection[str]) -> set[str]:
        """Return the variables that the decisions and assignments among *nodes* read."""
        expressions = [value for id, value in self.values.items() if id in nodes]
        expressions += [guard for edge, guard in self.guards.items() if edge.source in nodes]
        return {name for expression in expressions for name in iter_variables(expression)}

    def iter_cases(
        self, guards: list[Expression], values: Valuation, volatile: Collection[str]
    ) -> Iterator[Valuation]:
        """Yield valuations that together cover *values* and decide the guards where possible.

        Unknown Booleans and enumerations of undecided guards take each of their values.
        """
        valuation = dict(values)
        undecided = [guard for guard in guards if evaluate(guard, valuation) is None]
        names = sorted({name for guard in undecided for name in iter_variables(guard)})
        domains = {
            name: domain
            for name in names
            if name not in valuation
            and name not in volatile
            and (domain := self._list_domain(name))
        }
        size = 1
        for domain in domains.values():
            size *= len(domain)
        if not domains or size > _MOST_CASES:
            yield values
            return
        for chosen in product(*domains.values()):
            yield tuple(sorted((*values, *zip(domains, chosen, strict=True))))

    def _list_domain(self, name: str) -> tuple[Scalar, ...]:
        type_ = self.types.get(name)
        if isinstance(type_, EnumType):
            return type_.literals
        return (False, True) if type_ == "boolean" else ()


def _find_deciding_variables(
    graph: FlowGraph, guards: Collection[Expression], values: Mapping[str, Expression]
) -> set[str]:
    """Return the variables in guards, and those from which assignments compute them."""
    names = {name for guard in guards for name in iter_variables(guard)}
    assignments = [(node.variable, values[node.id]) for node in graph.nodes if node.id in values]
    while True:
        sources = {
            name
            for target, value in assignments
            if target in names
            for name in iter_variables(value)
        }
        if sources <= names:
            return names
        names |= sources


def _iter_start_values(
    graph: FlowGraph, types: Mapping[str, ValueType | None], arguments: Mapping[str, Expression]
) -> Iterator[tuple[str, Scalar]]:
    inputs = {parameter.name for parameter in graph.inputs}
    for name, parameter in graph.parameters.items():
        value: object = parameter.value
        if name in inputs:
            # A caller may pass another value than the default.
            argument = arguments.get(name)
            value = argument.value if isinstance(argument, Literal) else None
        if name in types and isinstance(value, bool | int | float | str):
            start = _convert(parameter, value)
            if start is not None:
                yield name, start


def _convert(parameter: Parameter, value: Scalar) -> Scalar | None:
    """Return a value as a guard sees it: an enumeration literal by its last name."""
    if not isinstance(parameter.type, EnumType):
        return value
    literal = str(value).replace("::", ".").rpartition(".")[2]
    return literal if literal in parameter.type.literals else None
