"""Contracts of services: who asks meets the preconditions, what is done meets the postconditions.

The thesis has machines that offer services and recipes that ask for them (3.5.2); UML 2.5.1 clause
9.6.3 says what the conditions of an operation mean. In a step the environment may ask (``call``);
the service runs until it is done (``done``), one step later at the earliest.
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
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.formula import Formula
from sysmlc.logic.names import Names
from sysmlc.logic.services.conditions import Condition, Service, is_given, services
from sysmlc.logic.simplify import substitute


class _Asked(Struct, frozen=True):
    """A service with the variables that say how far it is."""

    service: Service
    call: Formula
    busy: Formula
    done: Formula
    inputs: tuple[Feature, ...]
    outputs: tuple[Feature, ...]

    @property
    def runs(self) -> Formula:
        """It was asked for, and is not done yet."""
        return f.either(self.call, self.busy)

    def conditions(self, is_before: bool) -> Iterator[Condition]:
        """Its preconditions, or its postconditions."""
        return (one for one in self.service.conditions if one.is_before is is_before)


def derive(
    graph: Graph, taken: Iterable[str], assumed: tuple[int, int], sink: Sink
) -> Iterator[Contract]:
    """A contract for each service with conditions; ``taken`` are names of other contracts.

    ``assumed`` is the range of Integers that have none.
    """
    known = set(taken)
    for service in services(graph, assumed, sink):
        component = _component(graph, service.element)
        name = f"{component}.service" if component in known else component
        yield _contract(name, service)


def _component(graph: Graph, service: Element) -> str:
    """``<Owner>.<service>`` of what a classifier has, else the name of the action."""
    owner = graph.owner(service)
    if owner is None or owner.kind not in query.CLASSIFIERS:
        return graph.qualified_name(service)
    return f"{query.component_name(graph, owner)}.{service.name}"


def _contract(component: str, service: Service) -> Contract:
    asked, own = _asked(service)
    features = (*asked.inputs, *asked.outputs)
    variables = (*own, *(_variable(one) for one in features))
    id = service.element.id
    return Contract(component, id, variables, tuple(_assumed(asked)), tuple(_promised(asked)))


def _asked(service: Service) -> tuple[_Asked, list[Variable]]:
    used = {one.name for each in service.conditions for one in f.variables(each.formula)}
    features = [one for one in service.context.features.values() if one.variable in used]
    names = Names(*(one.variable for one in features))
    made = [names.new(word) for word in ("call", "busy", "done")]
    owners = (Owner.ENVIRONMENT, Owner.SYSTEM, Owner.SYSTEM)
    id, kind = service.element.id, BooleanDomain()
    own = [Variable(name, owner, kind, id) for name, owner in zip(made, owners, strict=True)]
    inputs = tuple(one for one in features if is_given(one))
    outputs = tuple(one for one in features if not is_given(one))
    call, busy, done = (f.var(name) for name in made)
    return _Asked(service, call, busy, done, inputs, outputs), own


def _variable(feature: Feature) -> Variable:
    assert feature.domain is not None, "only features with finite domains are in conditions"
    owner = Owner.ENVIRONMENT if is_given(feature) else Owner.SYSTEM
    return Variable(feature.variable, owner, feature.domain, feature.element.id)


def _assumed(asked: _Asked) -> Iterator[Conjunct]:
    name, id = asked.service.element.name, asked.service.element.id
    after = {one.variable: f.primed(f.var(one.variable)) for one in asked.inputs}
    for one in asked.conditions(is_before=True):
        text = f"Who asks for '{name}' sees to it that {_named(one)} holds."
        if not _speaks_of(one.formula, asked.outputs):
            first = f.implies(asked.call, one.formula)
            yield Conjunct(first, Class.INIT, one.constraint.id, text)
        later = f.implies(f.primed(asked.call), substitute(one.formula, after))
        yield Conjunct(later, Class.SAFETY, one.constraint.id, text)
    waits = f.both(asked.runs, f.negate(asked.done))
    again = f.implies(waits, f.negate(f.primed(asked.call)))
    text = f"'{name}' is not asked for again before it is done."
    yield Conjunct(again, Class.SAFETY, id, text)
    for feature in asked.inputs:
        value = f.var(feature.variable)
        text = f"'{feature.element.name}' stays as it is until '{name}' is done."
        kept = f.implies(waits, _same(f.primed(value), value, feature))
        yield Conjunct(kept, Class.SAFETY, feature.element.id, text)


def _promised(asked: _Asked) -> Iterator[Conjunct]:
    name, id = asked.service.element.name, asked.service.element.id
    after_done, after_busy = f.primed(asked.done), f.primed(asked.busy)
    idle = f.both(f.negate(asked.busy), f.negate(asked.done))
    yield Conjunct(idle, Class.INIT, id, f"'{name}' is not running at the start.")
    goes_on = f.iff(after_busy, f.both(asked.runs, f.negate(asked.done), f.negate(after_done)))
    text = f"'{name}' runs from when it is asked for until it is done."
    yield Conjunct(goes_on, Class.SAFETY, id, text)
    only = f.implies(after_done, f.both(asked.runs, f.negate(asked.done)))
    yield Conjunct(only, Class.SAFETY, id, f"'{name}' is done only when it was asked for.")
    for one in asked.conditions(is_before=False):
        text = f"When '{name}' is done, {_named(one)} holds."
        kept = f.implies(after_done, f.primed(one.formula))
        yield Conjunct(kept, Class.SAFETY, one.constraint.id, text)
    for feature in asked.outputs:
        value = f.var(feature.variable)
        stays = f.implies(f.negate(after_done), _same(f.primed(value), value, feature))
        text = f"What '{name}' makes of '{feature.element.name}' is seen when it is done."
        yield Conjunct(stays, Class.SAFETY, feature.element.id, text)
    text = f"'{name}' is done in the end, whenever it is asked for."
    answered = f.either(asked.done, f.negate(asked.runs))
    yield Conjunct(answered, Class.LIVENESS, id, text)


def _speaks_of(formula: Formula, features: tuple[Feature, ...]) -> bool:
    names = {one.variable for one in features}
    return any(one.name in names for one in f.variables(formula))


def _same(one: Formula, other: Formula, feature: Feature) -> Formula:
    return f.iff(one, other) if isinstance(feature.domain, BooleanDomain) else f.eq(one, other)


def _named(one: Condition) -> str:
    return f"'{one.constraint.name or one.constraint.attrs['body']}'"
