"""Pre- and postconditions of operations and actions, as formulas over parameters and features."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.expressions.context import Context, context_of, note_range
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.elaborate import (
    ElaborationError,
    Fault,
    Symbol,
    condition,
    literal_of,
)
from sysmlc.logic.expressions.expression import (
    Binary,
    Expression,
    ExpressionError,
    parse_expression,
)
from sysmlc.logic.formula import Formula
from sysmlc.logic.simplify import simplified
from sysmlc.logic.texts.formal import is_formal

NOT_FORMAL = rule(
    "SM505",
    "condition-not-formal",
    Severity.INFO,
    "the {kind} '{text}' of '{service}' is in no contract: {reason}",
)
_ORDERS = frozenset(["<", "<=", ">", ">="])
_KINDS = ("", "precondition", "postcondition", "body")
_LANGUAGES = ("", "kerml", "sysml", "ocl", "alf")


class Condition(Struct, frozen=True):
    """What must hold before a service, or holds after it."""

    constraint: Element
    formula: Formula
    is_before: bool


class Service(Struct, frozen=True):
    """An operation, or an action that no operation performs, with its conditions."""

    element: Element
    context: Context
    conditions: tuple[Condition, ...]

    def feature(self, variable: str) -> Feature:
        """The parameter or feature that a variable stands for."""
        return next(one for one in self.context.features.values() if one.variable == variable)


def services(graph: Graph, assumed: tuple[int, int], sink: Sink) -> Iterator[Service]:
    """The services of a model that have conditions, in its order.

    ``assumed`` is the range of Integers that have none. What is no expression over parameters
    and features with finitely many values is reported.
    """
    found: dict[str, tuple[Element, list[Element]]] = {}
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        owner = graph.owner(constraint)
        if owner is not None and _is_condition(constraint):
            for service in _performed(graph, owner):
                found.setdefault(service.id, (service, []))[1].append(constraint)
    for service, constraints in found.values():
        made = _service(graph, service, constraints, assumed, sink)
        if made.conditions:
            yield made


def _is_condition(constraint: Element) -> bool:
    body = constraint.attrs.get("body")
    if not isinstance(body, str) or constraint.subkind not in _KINDS:
        return False
    language = str(constraint.attrs.get("language", ""))
    if not language:
        return True
    return not is_formal(language, body)


def _performed(graph: Graph, owner: Element) -> Iterator[Element]:
    """The services that what owns a condition is: the operation or those that redefine it, the
    operations of a method or of what specialises it, else the action itself.
    """
    edges = {Kind.OPERATION: Edge.REDEFINES, Kind.ACTIVITY: Edge.SPECIALIZES}
    family = [owner] if owner.kind in edges else []
    for one in family:
        above = graph.sources(one, edges[one.kind])
        # In KerML a structure may specialise a behaviour: it is no service.
        family += (one for one in above if one.kind in edges and one not in family)
        yield from _services_of(graph, one)


def _services_of(graph: Graph, one: Element) -> Iterator[Element]:
    if one.kind is Kind.ACTIVITY:
        performed = graph.sources(one, Edge.METHOD)
        is_own = not performed and not one.attrs.get("external")
        yield from performed or ([one] if is_own else [])
    elif not one.attrs.get("external"):
        yield one


def _service(
    graph: Graph,
    service: Element,
    constraints: list[Element],
    assumed: tuple[int, int],
    sink: Sink,
) -> Service:
    context = _context(graph, service, assumed)
    read = [_condition(graph, service, context, one, sink) for one in constraints]
    found = tuple(one for one in read if one is not None)
    for used in {one.name: None for each in found for one in f.variables(each.formula)}:
        feature = next(one for one in context.features.values() if one.variable == used)
        note_range(graph, feature, sink)
    return Service(service, context, found)


def _context(graph: Graph, service: Element, assumed: tuple[int, int]) -> Context:
    owner = graph.owner(service)
    is_owned = owner is not None and owner.kind in query.CLASSIFIERS
    method = graph.target(service, Edge.METHOD)
    within = service if method is None or not _has_parameters(graph, method) else method
    return context_of(graph, owner if is_owned else service, assumed, within)


def _has_parameters(graph: Graph, method: Element) -> bool:
    """Whether a method has parameters of its own, or of what it specialises."""
    family = (method, *query.generals(graph, method))
    return any(query.parameters(graph, one) for one in family)


def _condition(
    graph: Graph, service: Element, context: Context, constraint: Element, sink: Sink
) -> Condition | None:
    kind = constraint.subkind or "constraint"
    try:
        formula = _formula(context, constraint)
    except (ExpressionError, ElaborationError) as error:
        body = str(constraint.attrs["body"])
        sink.report(
            NOT_FORMAL,
            graph.subject(constraint),
            kind=kind,
            text=body,
            service=service.name,
            reason=_reason(context, error),
        )
        return None
    if formula == f.TRUE:
        return None
    is_before = kind == "precondition" or (kind == "constraint" and _is_given(context, formula))
    return Condition(constraint, formula, is_before)


def _formula(context: Context, constraint: Element) -> Formula:
    language = str(constraint.attrs.get("language", "")).lower()
    if language.rstrip("0123456789. ") not in _LANGUAGES:
        raise ExpressionError(f"it is written in {constraint.attrs['language']}", 0)
    read = _unchained(parse_expression(str(constraint.attrs["body"])))
    formula = condition(read, lambda name: _symbol(context, name))
    domains: dict[str, Domain] = {
        one.variable: one.domain for one in context.features.values() if one.domain is not None
    }
    found = simplified(formula, domains)
    return formula if found == f.TRUE and _is_bound(read, formula) else found


def _is_bound(read: Expression, formula: Formula) -> bool:
    """Whether it is one bound (``h > 0``): the values have it already, but it is no range."""
    return isinstance(read, Binary) and read.op in _ORDERS and bool(list(f.variables(formula)))


def _unchained(read: Expression) -> Expression:
    """``0 <= x <= 4`` is ``0 <= x and x <= 4``."""
    match read:
        case Binary("and" as op, left, right):
            return Binary(op, _unchained(left), _unchained(right))
        case Binary(op, Binary(first, _, middle) as left, right) if {op, first} <= _ORDERS:
            return Binary("and", left, Binary(op, middle, right))
        case _:
            return read


def _symbol(context: Context, name: str) -> Symbol | None:
    feature = context.features.get(name) or context.features.get(name.removeprefix("self."))
    if feature is None:
        return literal_of(context, name)
    if feature.constant and feature.default is not None:
        return Symbol(f.const(feature.default), feature.domain)
    return Symbol(f.var(feature.variable), feature.domain)


def _is_given(context: Context, formula: Formula) -> bool:
    """Whether it speaks of what is given to the service, and of nothing else."""
    used = {one.name for one in f.variables(formula)}
    return all(is_given(one) for one in context.features.values() if one.variable in used)


def is_given(feature: Feature) -> bool:
    """Whether who asks for the service decides it: an input parameter."""
    direction = feature.direction or "in"
    return feature.element.kind is Kind.PARAMETER and direction == "in"


def _reason(context: Context, error: Exception) -> str:
    if isinstance(error, ElaborationError) and error.fault is Fault.UNKNOWN:
        return f"'{error.name}' is no parameter or feature with finitely many values"
    return str(error)
