"""The contract that its requirements make with a subject."""

from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.formula import Formula, Literal
from sysmlc.logic.printing import print_literal
from sysmlc.logic.requirements.scope import Scope, scope_of
from sysmlc.logic.requirements.statements import (
    Statement,
    component_of,
    definition_of,
    redefining,
    statements,
)


def derive(
    graph: Graph, behaviours: Iterable[Contract], assumed: tuple[int, int], sink: Sink
) -> Iterator[Contract]:
    """Contracts of subjects of requirements (thesis 2.2.1): what is assumed, what is demanded.

    ``behaviours`` are the contracts of behaviours: where the subject has one, formulas may speak
    of its variables, and the requirements are the contract ``<component>.requirements``, of which
    the behaviour is an implementation. ``assumed`` is the range of Integers that have none.
    """
    known = {one.component: one for one in behaviours}
    for subject, said in statements(graph):
        from sysmlc.logic.requirements.meaning import meaning

        component = component_of(graph, subject)
        behaviour = known.get(component)
        definition, within = definition_of(graph, subject), redefining(graph, subject)
        scope = scope_of(context_of(graph, definition, assumed, within), behaviour)
        assumptions: list[Conjunct] = []
        demands: list[Conjunct] = []
        for statement in said:
            formula = meaning(graph, scope, statement, sink)
            if formula is not None:
                is_assumed = _is_assumed(scope, statement, formula)
                into = assumptions if is_assumed else demands
                into += _classified(scope, statement, formula, is_assumed)
        if demands:
            name = component if behaviour is None else f"{component}.requirements"
            yield _contract(name, subject, scope, assumptions, demands)


def _is_assumed(scope: Scope, statement: Statement, formula: Formula) -> bool:
    return statement.is_assumed or (statement.is_open and scope.is_input(formula))


def _classified(
    scope: Scope, statement: Statement, formula: Formula, is_assumed: bool
) -> Iterator[Conjunct]:
    """A formula's conjuncts; a condition without temporal operators holds at all times.

    One of inputs alone is assumed of the first step and of each next one, so that the
    environment never gets where it cannot keep it.
    """
    id, name = statement.constraint.id, statement.requirement.name
    text = _words(statement, is_assumed)
    for class_, part in _parts(scope, statement, formula, is_assumed):
        yield Conjunct(part, class_, id, text, name)


def _parts(
    scope: Scope, statement: Statement, formula: Formula, is_assumed: bool
) -> Iterator[tuple[Class, Formula]]:
    from sysmlc.logic.classification import classify
    from sysmlc.logic.requirements.meaning import is_temporal

    if is_temporal(statement.constraint):
        yield from classify(formula)
    elif is_assumed and scope.is_input(formula):
        yield Class.INIT, formula
        yield Class.SAFETY, f.primed(formula)
    else:
        yield Class.SAFETY, formula


def _words(statement: Statement, is_assumed: bool) -> str:
    name, constraint = statement.requirement.name, statement.constraint.name
    what = f"'{constraint}' of '{name}'" if constraint else f"'{name}'"
    return f"{what} {'assumes' if is_assumed else 'demands'} it."


def _contract(
    name: str,
    subject: Element,
    scope: Scope,
    assumptions: list[Conjunct],
    demands: list[Conjunct],
) -> Contract:
    from sysmlc.logic.reduction.reduce import remembering

    used = scope.used(one.formula for one in (*assumptions, *demands))
    starts = list(_starts(scope, {one.name for one in used}))
    given = [one for one in starts if scope.is_input(one.formula)]
    own = [one for one in starts if not scope.is_input(one.formula)]
    return remembering(Contract(name, subject.id, used, (*given, *assumptions), (*own, *demands)))


def with_features(contract: Contract, scope: Scope, formula: Formula) -> Contract:
    """A behaviour's contract with the features of its definition that a formula speaks of.

    They start with their values; what they become later is for the formulas to say.
    """
    known = {one.name for one in contract.variables}
    added = tuple(one for one in scope.used((formula,)) if one.name not in known)
    starts = list(_starts(scope, {one.name for one in added}))
    given = tuple(one for one in starts if scope.is_input(one.formula))
    own = tuple(one for one in starts if not scope.is_input(one.formula))
    return replace(
        contract,
        variables=(*contract.variables, *added),
        assumptions=(*contract.assumptions, *given),
        guarantees=(*contract.guarantees, *own),
    )


def _starts(scope: Scope, used: set[str]) -> Iterator[Conjunct]:
    """What the variables start with, where their features have a value."""
    for one in scope.context.features.values():
        if one.variable in used and one.default is not None and not one.constant:
            text = f"'{one.element.name}' starts with {print_literal(one.default)}."
            yield Conjunct(_is(one.variable, one.default), Class.INIT, one.element.id, text)


def _is(variable: str, value: Literal) -> Formula:
    if isinstance(value, bool):
        return f.var(variable) if value else f.negate(f.var(variable))
    return f.eq(f.var(variable), f.const(value))
