"""Conjuncts of the contract of requirements: what each requirement assumes and demands."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.ir import Element, Graph
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify, word_conjuncts
from sysmlc.logic.contract import Class, Conjunct, Contract, Source
from sysmlc.logic.formula import Formula, Literal
from sysmlc.logic.printing import print_literal
from sysmlc.logic.reduction.contract_reduction import add_history_bits
from sysmlc.logic.requirements.scope import Scope
from sysmlc.logic.requirements.statements import Statement, component_of


class Reading(Struct, frozen=True):
    """The formula of a statement, and the same formula with the names that the author wrote."""

    formula: Formula
    wording: Formula | None = None


def _is_assumed(scope: Scope, statement: Statement, formula: Formula) -> bool:
    return statement.is_assumed or (statement.is_open and scope.is_about_inputs(formula))


def _name_viewpoints(graph: Graph, requirements: Iterable[Element]) -> dict[str, str]:
    """Return the names of requirements by their ids, qualified if several have the same name."""
    by_id = {requirement.id: requirement for requirement in requirements}
    counts = Counter(requirement.name for requirement in by_id.values())
    return {
        id: requirement.name if counts[requirement.name] == 1 else graph.qualified_name(requirement)
        for id, requirement in by_id.items()
    }


def _list_viewpoints(graph: Graph, statement: Statement, names: Mapping[str, str]) -> list[str]:
    """Return the requirements whose demands depend on an assumption.

    These are the requirement that states it and the demanding ones within it. If there is none, the
    assumption is common to all requirements, for which the name is empty.
    """
    outer = statement.requirement
    viewpoints = [
        name
        for id, name in names.items()
        if any(owner.id == outer.id for owner in (graph[id], *graph.ancestors(graph[id])))
    ]
    return viewpoints or ([outer.name] if statement.has_demands else [""])


def _classify(
    scope: Scope, statement: Statement, reading: Reading, viewpoint: str, is_assumed: bool = False
) -> Iterator[Conjunct]:
    """Yield the conjuncts of a statement; their texts name its requirement."""
    id, text = statement.constraint.id, _describe(statement, is_assumed)
    conjuncts = [
        Conjunct(part, class_, id, text, viewpoint)
        for class_, part in _split_by_class(scope, statement, reading.formula, is_assumed)
    ]
    yield from word_conjuncts(conjuncts, reading.wording)


def _split_by_class(
    scope: Scope, statement: Statement, formula: Formula, is_assumed: bool
) -> Iterator[tuple[Class, Formula]]:
    """Yield the conjuncts of a formula with their classes.

    A condition, which has no temporal operators, must hold in every step. If it is an assumption
    about inputs alone, it is stated for the first step and for each next step: the environment can
    then never reach a step in which it has to violate the assumption.
    """
    if statement.is_temporal or f.has_future(formula) or f.has_past(formula):
        yield from classify(formula)
    elif is_assumed and scope.is_about_inputs(formula):
        yield Class.INIT, formula
        yield Class.SAFETY, f.prime(formula)
    else:
        yield Class.SAFETY, formula


def _describe(statement: Statement, is_assumed: bool) -> str:
    name, constraint = statement.requirement.name, statement.constraint.name
    subject = f"'{constraint}' of '{name}'" if constraint else f"'{name}'"
    return f"{subject} {'assumes' if is_assumed else 'demands'} it."


def _list_used_names(scope: Scope, conjuncts: Iterable[Conjunct]) -> set[str]:
    formulas = (conjunct.formula for conjunct in conjuncts)
    return {variable.name for variable in scope.select_variables(formulas)}


def make_contract(
    graph: Graph,
    subject: Element,
    scope: Scope,
    formulas: list[tuple[Statement, Reading]],
    behaviour: Contract | None,
) -> Contract | None:
    """Return the contract of a subject's formulas; None if they demand nothing."""
    assumed: list[tuple[Statement, Reading]] = []
    demanded: list[tuple[Statement, Reading]] = []
    for statement, reading in formulas:
        is_assumed = _is_assumed(scope, statement, reading.formula)
        (assumed if is_assumed else demanded).append((statement, reading))
    if not demanded:
        return None
    names = _name_viewpoints(graph, [statement.requirement for statement, _ in demanded])
    demands = [
        conjunct
        for statement, reading in demanded
        for conjunct in _classify(scope, statement, reading, names[statement.requirement.id])
    ]
    assumptions = [
        conjunct
        for statement, reading in assumed
        for viewpoint in _list_viewpoints(graph, statement, names)
        for conjunct in _classify(scope, statement, reading, viewpoint, is_assumed=True)
        # The values of constants may make an assumption true: it assumes nothing.
        if conjunct.formula != f.TRUE
    ]
    inputs, outputs = state_initial_values(scope, _list_used_names(scope, (*assumptions, *demands)))
    component = component_of(graph, subject)
    if behaviour is not None:
        # Initial values of outputs belong to the behaviour, whose first entries may assign others.
        component, outputs = f"{component}.requirements", []
    stated = (*inputs, *assumptions, *outputs, *demands)
    variables = scope.select_variables(conjunct.formula for conjunct in stated)
    contract = Contract(
        component, subject.id, variables, (*inputs, *assumptions), (*outputs, *demands)
    )
    # Behaviour and requirements are compared: their history bits need different names.
    taken = () if behaviour is None else (variable.name for variable in behaviour.variables)
    return add_history_bits(contract, taken)


def state_initial_values(scope: Scope, names: set[str]) -> tuple[list[Conjunct], list[Conjunct]]:
    """Return conjuncts for the initial values of the named variables: of inputs, then of others."""
    inputs: list[Conjunct] = []
    outputs: list[Conjunct] = []
    for feature in scope.context.features.values():
        if feature.variable in names and feature.default is not None and not feature.is_constant:
            text = f"'{feature.element.name}' starts with {print_literal(feature.default)}."
            formula = _equals(feature.variable, feature.default)
            conjunct = Conjunct(
                formula, Class.INIT, feature.element.id, text, source=Source.DERIVED
            )
            (inputs if scope.is_about_inputs(formula) else outputs).append(conjunct)
    return inputs, outputs


def _equals(variable: str, value: Literal) -> Formula:
    if isinstance(value, bool):
        return f.var(variable) if value else f.negate(f.var(variable))
    return f.eq(f.var(variable), f.const(value))
