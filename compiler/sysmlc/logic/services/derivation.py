"""Contracts of services: assumed preconditions and guaranteed postconditions.

In the thesis machines offer services and recipes request them (3.5.2). UML 2.5.1 clause 9.6.3
defines the conditions of an operation. In each step the environment may call the service
(``call``). The service runs until it is done (``done``), one step later at the earliest.
"""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, query
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Owner,
    Variable,
)
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.formula import Formula
from sysmlc.logic.identifiers import Names
from sysmlc.logic.services.conditions import Condition, Service, is_input, iter_services
from sysmlc.logic.simplification import substitute


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
