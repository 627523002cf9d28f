"""Contracts of services: assumed preconditions and guaranteed postconditions.

In the thesis machines offer services and recipes request them (3.5.2). UML 2.5.1 clause 9.6.3
defines the conditions of an operation. In each step the environment may call the service
(``call``). The service runs until it is done (``done``), one step later at the earliest.
"""

from collections.abc import Iterable, Iterator
from functools import partial

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import Binary, Expression, ExpressionError
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    Owner,
    Variable,
)
from sysmlc.logic.expressions.context import (
    Context,
    context_of,
    find_symbol,
    report_range,
)
from sysmlc.logic.expressions.elaboration import elaborate_condition
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.expressions.parsing import ORDERS, explain_fault, split_chains, tree_of
from sysmlc.logic.expressions.symbols import ElaborationError, Fault
from sysmlc.logic.formal_texts import is_formal_constraint
from sysmlc.logic.formula import Formula
from sysmlc.logic.identifiers import Names
from sysmlc.logic.simplification import simplify_constant, substitute
from sysmlc.support.counts import count

NOT_FORMAL = rule(
    "SM505",
    "condition-not-formal",
    Severity.INFO,
    "the {condition} of '{service}' is in no contract: {reason}{further}",
    help="compare Booleans, enumerations and sums of numbers for a contract about it",
)
_KINDS = ("", "precondition", "postcondition", "body")
_KIND_WORDS = {"": "constraint", "body": "body condition"}
_LANGUAGE_ADVICE = "choose OCL or no language for conditions that are expressions over features"
_LANGUAGES = ("", "kerml", "sysml", "ocl", "alf")


class Condition(Struct, frozen=True):
    """A precondition (``is_before``) or postcondition of a service."""

    constraint: Element
    formula: Formula
    is_before: bool


class Service(Struct, frozen=True):
    """An operation, or an action that no operation performs, with its conditions."""

    element: Element
    context: Context
    conditions: tuple[Condition, ...]

    def feature(self, variable: str) -> Feature:
        """Return the parameter or feature that a variable represents."""
        return next(
            feature for feature in self.context.features.values() if feature.variable == variable
        )


def iter_services(graph: Graph, assumed: tuple[int, int], sink: Sink) -> Iterator[Service]:
    """Yield the services of a model that have conditions, in model order.

    *assumed* is the range of Integers without a stated one. A condition that is not an expression
    over parameters and features with finitely many values is reported.
    """
    informal = _InformalConditions()
    constraints_by_service: dict[str, tuple[Element, list[Element]]] = {}
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        owner = graph.owner(constraint)
        if owner is not None and _is_condition(constraint) and not _is_in_profile(graph, owner):
            for service in _performed_services(graph, owner):
                constraints_by_service.setdefault(service.id, (service, []))[1].append(constraint)
    for service, constraints in constraints_by_service.values():
        result = _read_service(graph, service, constraints, assumed, informal, sink)
        if result.conditions:
            yield result
    informal.report(graph, sink)


def _is_condition(constraint: Element) -> bool:
    body = constraint.attrs.get("body")
    if not isinstance(body, str) or constraint.subkind not in _KINDS:
        return False
    return not constraint.attrs.get("language") or not is_formal_constraint(constraint)


def _is_in_profile(graph: Graph, owner: Element) -> bool:
    """Whether a stereotype owns the element: its operations query models and are no services."""
    return any(above.kind is Kind.STEREOTYPE for above in graph.ancestors(owner))


def _performed_services(graph: Graph, owner: Element) -> Iterator[Element]:
    """Yield the services to which the conditions of *owner* apply.

    Conditions of an operation apply to it and to operations that redefine it. Conditions of an
    action apply to the operations that have the action, or a special of it, as their method.
    Without such operations they apply to the action itself.
    """
    edges = {Kind.OPERATION: Edge.REDEFINES, Kind.ACTIVITY: Edge.SPECIALIZES}
    worklist = [owner] if owner.kind in edges else []
    for element in worklist:
        specializing = graph.sources(element, edges[element.kind])
        # In KerML a structure may specialise a behaviour: it is no service.
        worklist += (
            element for element in specializing if element.kind in edges and element not in worklist
        )
        yield from _services_of(graph, element)


def _services_of(graph: Graph, element: Element) -> Iterator[Element]:
    if element.kind is Kind.ACTIVITY:
        operations = graph.sources(element, Edge.METHOD)
        is_service = not operations and not element.attrs.get("external")
        yield from operations or ([element] if is_service else [])
    elif not element.attrs.get("external"):
        yield element


def _read_service(
    graph: Graph,
    service: Element,
    constraints: list[Element],
    assumed: tuple[int, int],
    informal: "_InformalConditions",
    sink: Sink,
) -> Service:
    context = _make_context(graph, service, assumed)
    read_conditions = [
        _read_condition(service, context, condition, informal) for condition in constraints
    ]
    conditions = tuple(part for part in read_conditions if part is not None)
    for name in {
        variable.name: None for part in conditions for variable in f.variables(part.formula)
    }:
        feature = next(feature for feature in context.features.values() if feature.variable == name)
        report_range(graph, feature, sink)
    return Service(service, context, conditions)


def _make_context(graph: Graph, service: Element, assumed: tuple[int, int]) -> Context:
    owner = graph.owner(service)
    is_owned = owner is not None and owner.kind in query.CLASSIFIERS
    method = graph.target(service, Edge.METHOD)
    parameter_owner = service if method is None or not _has_parameters(graph, method) else method
    return context_of(graph, owner if is_owned else service, assumed, parameter_owner)


def _has_parameters(graph: Graph, method: Element) -> bool:
    """Whether a method has parameters of its own or inherited ones."""
    family = (method, *query.generals(graph, method))
    return any(query.parameters(graph, relative) for relative in family)


def _read_condition(
    service: Element, context: Context, constraint: Element, informal: "_InformalConditions"
) -> Condition | None:
    kind = constraint.subkind or "constraint"
    try:
        formula = _read_formula(context, constraint)
    except (ExpressionError, ElaborationError) as error:
        if _has_known_language(constraint):
            informal.add(service, constraint, _explain(context, error, constraint))
        else:
            informal.add_language(service, constraint)
        return None
    if formula == f.TRUE:
        return None
    is_before = kind == "precondition" or (
        kind == "constraint" and _is_precondition(context, formula)
    )
    return Condition(constraint, formula, is_before)


def _read_formula(context: Context, constraint: Element) -> Formula:
    expression = split_chains(tree_of(str(constraint.attrs["body"])))
    formula = elaborate_condition(expression, partial(find_symbol, context))
    domains: dict[str, Domain] = {
        feature.variable: feature.domain
        for feature in context.features.values()
        if feature.domain is not None
    }
    simplified_formula = simplify_constant(formula, domains)
    return (
        formula
        if simplified_formula == f.TRUE and _is_single_bound(expression, formula)
        else simplified_formula
    )


def _is_single_bound(expression: Expression, formula: Formula) -> bool:
    """Whether the expression is a single bound such as ``h > 0``, which is no range."""
    return (
        isinstance(expression, Binary)
        and expression.op in ORDERS
        and bool(list(f.variables(formula)))
    )


def _is_precondition(context: Context, formula: Formula) -> bool:
    """Whether the formula reads only inputs of the service."""
    names = f.variable_names(formula)
    return all(
        is_input(feature) for feature in context.features.values() if feature.variable in names
    )


def is_input(feature: Feature) -> bool:
    """Whether the feature is an input parameter, whose value the caller decides."""
    direction = feature.direction or "in"
    return feature.element.kind is Kind.PARAMETER and direction == "in"


def _has_known_language(constraint: Element) -> bool:
    """Whether the language of the constraint is one of expressions, or not stated."""
    language = str(constraint.attrs.get("language", "")).lower()
    return language.rstrip("0123456789. ") in _LANGUAGES


class _InformalConditions:
    """The conditions without formula: one finding for a condition, and one for a language and file.

    Special actions and operations inherit the conditions of general ones.
    """

    def __init__(self) -> None:
        self._groups: dict[tuple[str, ...], list[tuple[Element, Element, str]]] = {}

    def add(self, service: Element, constraint: Element, reason: str) -> None:
        """Record why a condition of *service* has no formula."""
        self._groups.setdefault((constraint.id,), []).append((service, constraint, reason))

    def add_language(self, service: Element, constraint: Element) -> None:
        """Record that a condition of *service* is written in a language that is not read."""
        language = str(constraint.attrs["language"])
        reason = f"it is written in {language}"
        group = self._groups.setdefault((language, constraint.source), [])
        group.append((service, constraint, reason))

    def report(self, graph: Graph, sink: Sink) -> None:
        """Report each group at its first condition, with the number of further ones."""
        for key, conditions in self._groups.items():
            is_language = len(key) > 1
            service, constraint, reason = conditions[0]
            others = len(conditions) - 1
            noun = "condition" if is_language else "service"
            further = f"; the same holds for {count(others, f'more {noun}')}" if others else ""
            kind = _KIND_WORDS.get(constraint.subkind, constraint.subkind)
            text = str(constraint.attrs["body"]).strip()
            sink.report(
                NOT_FORMAL,
                graph.subject(constraint),
                condition=f"{kind} '{text}'" if text else kind,
                service=service.name or graph.qualified_name(service),
                reason=reason,
                further=further,
                help=_LANGUAGE_ADVICE if is_language else "",
            )


def _explain(
    context: Context, error: ExpressionError | ElaborationError, constraint: Element
) -> str:
    if isinstance(error, ExpressionError):
        return str(error)
    if error.fault is Fault.UNKNOWN:
        if error.name == "null":
            return "'null' (no value) is no value of a Boolean, an enumeration or an Integer"
        return f"'{error.name}' is not a parameter or feature with finitely many values"
    return explain_fault(error, tree_of(str(constraint.attrs["body"])))


# -- derivation ------------------------------------------------------------------------------------


class _ServiceCall(Struct, frozen=True):
    """A service with the variables of its handshake."""

    service: Service
    call: Formula
    busy: Formula
    done: Formula
    inputs: tuple[Feature, ...]
    outputs: tuple[Feature, ...]

    @property
    def runs(self) -> Formula:
        """The service is called or busy."""
        return f.either(self.call, self.busy)

    def conditions(self, is_before: bool) -> Iterator[Condition]:
        """Yield the preconditions if *is_before* is true, or else the postconditions."""
        return (
            condition for condition in self.service.conditions if condition.is_before is is_before
        )


def derive_contracts(
    graph: Graph, reserved: Iterable[str], assumed: tuple[int, int], sink: Sink
) -> Iterator[Contract]:
    """Yield a contract for each service with conditions; *reserved* are names of other contracts.

    *assumed* is the range of Integers without a stated one.
    """
    used_names = set(reserved)
    for service in iter_services(graph, assumed, sink):
        component = _component_name(graph, service.element)
        name = f"{component}.service" if component in used_names else component
        yield _derive_contract(name, service)


def _component_name(graph: Graph, service: Element) -> str:
    """Return ``<Owner>.<service>`` for a service of a classifier, else the name of the action."""
    owner = graph.owner(service)
    if owner is None or owner.kind not in query.CLASSIFIERS:
        return graph.qualified_name(service)
    return f"{query.component_name(graph, owner)}.{service.name}"


def _derive_contract(component: str, service: Service) -> Contract:
    call, handshake = _make_call(service)
    features = (*call.inputs, *call.outputs)
    variables = (*handshake, *(_make_variable(feature) for feature in features))
    id = service.element.id
    return Contract(
        component, id, variables, tuple(_derive_assumptions(call)), tuple(_derive_guarantees(call))
    )


def _make_call(service: Service) -> tuple[_ServiceCall, list[Variable]]:
    names_used = f.variable_names(*(condition.formula for condition in service.conditions))
    features = [
        feature for feature in service.context.features.values() if feature.variable in names_used
    ]
    names = Names(*(feature.variable for feature in features))
    variable_names = [names.new(word) for word in ("call", "busy", "done")]
    owners = (Owner.ENVIRONMENT, Owner.SYSTEM, Owner.SYSTEM)
    id, boolean = service.element.id, BooleanDomain()
    handshake = [
        Variable(name, owner, boolean, id)
        for name, owner in zip(variable_names, owners, strict=True)
    ]
    inputs = tuple(feature for feature in features if is_input(feature))
    outputs = tuple(feature for feature in features if not is_input(feature))
    call, busy, done = (f.var(name) for name in variable_names)
    return _ServiceCall(service, call, busy, done, inputs, outputs), handshake


def _make_variable(feature: Feature) -> Variable:
    return feature.make_variable(Owner.ENVIRONMENT if is_input(feature) else Owner.SYSTEM)


def _derive_assumptions(call: _ServiceCall) -> Iterator[Conjunct]:
    name, id = call.service.element.name, call.service.element.id
    next_inputs = {
        condition.variable: f.prime(f.var(condition.variable)) for condition in call.inputs
    }
    for condition in call.conditions(is_before=True):
        text = f"The caller of '{name}' ensures that {_name_of(condition)} holds."
        if not _reads_any(condition.formula, call.outputs):
            first = f.implies(call.call, condition.formula)
            yield Conjunct(first, Class.INIT, condition.constraint.id, text)
        later = f.implies(f.prime(call.call), substitute(condition.formula, next_inputs))
        yield Conjunct(later, Class.SAFETY, condition.constraint.id, text)
    waiting = f.both(call.runs, f.negate(call.done))
    no_repetition = f.implies(waiting, f.negate(f.prime(call.call)))
    text = f"'{name}' is not called again before it is done."
    yield Conjunct(no_repetition, Class.SAFETY, id, text)
    for feature in call.inputs:
        value = f.var(feature.variable)
        text = f"'{feature.element.name}' does not change until '{name}' is done."
        unchanged = f.implies(waiting, _equality(f.prime(value), value, feature))
        yield Conjunct(unchanged, Class.SAFETY, feature.element.id, text)


def _derive_guarantees(call: _ServiceCall) -> Iterator[Conjunct]:
    name, id = call.service.element.name, call.service.element.id
    after_done, after_busy = f.prime(call.done), f.prime(call.busy)
    idle = f.both(f.negate(call.busy), f.negate(call.done))
    yield Conjunct(idle, Class.INIT, id, f"'{name}' is not running at the start.")
    runs = f.iff(after_busy, f.both(call.runs, f.negate(call.done), f.negate(after_done)))
    text = f"'{name}' runs from its call until it is done."
    yield Conjunct(runs, Class.SAFETY, id, text)
    ends = f.implies(after_done, f.both(call.runs, f.negate(call.done)))
    yield Conjunct(ends, Class.SAFETY, id, f"'{name}' is done only after it was called.")
    for condition in call.conditions(is_before=False):
        text = f"When '{name}' is done, {_name_of(condition)} holds."
        conjunct = f.implies(after_done, f.prime(condition.formula))
        yield Conjunct(conjunct, Class.SAFETY, condition.constraint.id, text)
    for feature in call.outputs:
        value = f.var(feature.variable)
        unchanged = f.implies(f.negate(after_done), _equality(f.prime(value), value, feature))
        text = f"'{feature.element.name}' changes only in steps in which '{name}' is done."
        yield Conjunct(unchanged, Class.SAFETY, feature.element.id, text)
    text = f"Whenever '{name}' is called, it is done sooner or later."
    finishes = f.either(call.done, f.negate(call.runs))
    yield Conjunct(finishes, Class.LIVENESS, id, text)


def _reads_any(formula: Formula, features: tuple[Feature, ...]) -> bool:
    names = {feature.variable for feature in features}
    return not f.variable_names(formula).isdisjoint(names)


def _equality(left: Formula, right: Formula, feature: Feature) -> Formula:
    return f.iff(left, right) if isinstance(feature.domain, BooleanDomain) else f.eq(left, right)


def _name_of(condition: Condition) -> str:
    return f"'{condition.constraint.name or condition.constraint.attrs['body']}'"
