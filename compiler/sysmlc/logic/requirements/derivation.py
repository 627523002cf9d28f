"""Contracts of the subjects of requirements (thesis, 2.2.1)."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.expressions import ExpressionError
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify, word_conjuncts
from sysmlc.logic.components.component import Component
from sysmlc.logic.components.derivation import (
    ComponentBehaviour,
    describe_component,
)
from sysmlc.logic.components.names import ComponentNames, Meaning
from sysmlc.logic.components.objects import ComponentError
from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, Source, name_variables
from sysmlc.logic.expressions.context import report_range
from sysmlc.logic.expressions.elaboration import elaborate_condition
from sysmlc.logic.expressions.parsing import explain_fault, tree_of
from sysmlc.logic.expressions.symbols import ElaborationError, Fault
from sysmlc.logic.feature_writes import WriterIndex
from sysmlc.logic.formal_texts import describe_error, has_pattern_word, read_formal
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.reader import MachineOptions, find_context_classifier
from sysmlc.logic.printing import print_literal
from sysmlc.logic.reduction.contract_reduction import add_history_bits
from sysmlc.logic.region_formulas import word_conjunct
from sysmlc.logic.requirements.scope import (
    Scope,
    make_scope,
    replace_meanings,
    restore_names,
    scope_of,
)
from sysmlc.logic.requirements.statements import (
    Statement,
    collect_statements,
    component_of,
    list_subject_names,
)
from sysmlc.logic.syntax import FormulaError, UnknownNameError
from sysmlc.support.counts import count

NOT_A_FORMULA = rule(
    "SM522",
    "requirement-not-understood",
    Severity.ERROR,
    "the formula of '{constraint}' in requirement '{requirement}' is not understood: {reason}",
    help="write LTL (G F X U or [] <> X U), or in FRET 'when P, the {about} shall eventually "
    "satisfy Q', with these names: {names}",
)
NOT_FORMAL = rule(
    "SM523",
    "requirement-not-formal",
    Severity.INFO,
    "{constraint} of requirement '{requirement}' is in no contract: {reason}{further}",
    help="compare Booleans, enumerations and sums of numbers of the subject for a contract",
)
_EXPRESSION_LANGUAGES = ("", "kerml", "sysml", "ocl", "alf")


class Reading(Struct, frozen=True):
    """The formula of a statement, and the same formula with the names that the author wrote."""

    formula: Formula
    wording: Formula | None = None


class RequiredContract(Struct, frozen=True):
    """The contract of a subject's requirements, and the behaviour that has to satisfy it."""

    contract: Contract
    behaviour: ComponentBehaviour | None


def derive(
    graph: Graph, behaviours: Iterable[Contract], options: MachineOptions, sink: Sink
) -> Iterator[RequiredContract]:
    """Yield the contract of each subject: the assumptions and demands of its requirements.

    *behaviours* are the contracts of behaviours. If the subject has one, formulas may use its
    variables, and the contract of the requirements is named ``<component>.requirements``; the
    behaviour implements it.
    """
    behaviour_by_component = {contract.component: contract for contract in behaviours}
    informal = _InformalStatements()
    writers = WriterIndex(graph)
    for subject, statements in collect_statements(graph):
        behaviour = behaviour_by_component.get(component_of(graph, subject))
        scope = make_scope(graph, subject, behaviour, options.assumed_range, options.tick_seconds)
        component, obstacle = _open_component(graph, subject, options, writers)
        if component is not None:
            scope = replace(scope, names=ComponentNames(component))
        formulas = [
            (statement, reading)
            for statement in statements
            if (reading := _read_statement(graph, scope, statement, informal, sink, obstacle))
            is not None
        ]
        # The formulas have named all features that the behaviour has to describe.
        try:
            whole = _describe_behaviour(graph, subject, component, behaviour, obstacle)
        except ComponentError as problem:
            for statement, _ in formulas:
                informal.add(statement, str(problem))
            continue
        if whole is not None:
            variables = scope_of(scope.context, whole.contract.variables).variables
            scope = replace(scope, variables=variables)
        contract = make_contract(graph, subject, scope, formulas, behaviour)
        if contract is not None:
            atoms = () if whole is None else whole.atoms
            wordings = {atom.replaced: atom.variable.name for atom in atoms}
            yield RequiredContract(name_variables(contract, wordings), whole)
    informal.report(graph, sink)


def _open_component(
    graph: Graph, subject: Element, options: MachineOptions, writers: WriterIndex
) -> tuple[Component | None, str]:
    """Return the component whose behaviour a subject is or has, if any, or why there is none."""
    if subject.kind is Kind.STATE_MACHINE:
        subject = find_context_classifier(graph, subject) or subject
    if subject.kind not in (Kind.CLASS, Kind.COMPONENT, Kind.ACTIVITY):
        return None, ""
    try:
        component = Component(graph, subject, options, writers)
    except ComponentError as problem:
        return None, str(problem)
    # An action without steps is one node: only its contract says what it does.
    has_steps = len(component.performances.nodes) > (subject.kind is Kind.ACTIVITY)
    return (component if component.machines or has_steps else None), ""


def _describe_behaviour(
    graph: Graph,
    subject: Element,
    component: Component | None,
    behaviour: Contract | None,
    obstacle: str,
) -> ComponentBehaviour | None:
    """Return the behaviour that requirements of a subject are about. Raises ComponentError."""
    if component is not None:
        whole = describe_component(component, component_of(graph, subject))
        if behaviour is None:
            return replace(whole, is_of_parts=True)
        return _add_stated_conjuncts(whole, behaviour)
    if behaviour is None or not obstacle:
        return None
    return _describe_alone(graph, behaviour, obstacle)


def _describe_alone(graph: Graph, behaviour: Contract, reason: str) -> ComponentBehaviour:
    """Return a behaviour as its own contract describes it, which refutes nothing.

    The contract of an activity describes one that starts again, so that it proves nothing either.
    """
    if graph[behaviour.origin].kind is not Kind.STATE_MACHINE:
        stated = tuple(item for item in behaviour.guarantees if not item.is_derived)
        behaviour = replace(behaviour, guarantees=stated)
    return ComponentBehaviour(behaviour, gaps={"": reason})


def add_features(contract: Contract, scope: Scope, formula: Formula) -> Contract:
    """Return a behaviour's contract with the features of its definition that a formula uses.

    The contract fixes their initial values only; their later values are left to the formulas.
    """
    names = {variable.name for variable in contract.variables}
    added = tuple(
        variable for variable in scope.select_variables((formula,)) if variable.name not in names
    )
    inputs, outputs = state_initial_values(scope, {variable.name for variable in added})
    return replace(
        contract,
        variables=(*contract.variables, *added),
        assumptions=(*contract.assumptions, *inputs),
        guarantees=(*contract.guarantees, *outputs),
    )


# -- formulas of statements ----------------------------------------------------------------------


class _InformalStatements:
    """The statements without formula, each with the reason and the number of its subjects.

    A requirement about a general definition applies to all its specialisations, hundreds in a
    library, and is reported once.
    """

    def __init__(self) -> None:
        self._reasons: dict[str, tuple[Statement, list[str]]] = {}

    def add(self, statement: Statement, reason: str) -> None:
        """Record why *statement* has no formula about one of its subjects."""
        self._reasons.setdefault(statement.constraint.id, (statement, []))[1].append(reason)

    def report(self, graph: Graph, sink: Sink) -> None:
        """Report each statement once, with the reason for its first subject."""
        for statement, reasons in self._reasons.values():
            others, name = len(reasons) - 1, statement.constraint.name
            further = f"; the same holds for {count(others, 'more subject')}" if others else ""
            sink.report(
                NOT_FORMAL,
                graph.subject(statement.constraint),
                constraint=f"constraint '{name}'" if name else "the constraint",
                requirement=statement.requirement.name,
                reason=reasons[0],
                further=further,
            )


def _read_statement(
    graph: Graph,
    scope: Scope,
    statement: Statement,
    informal: _InformalStatements,
    sink: Sink,
    obstacle: str = "",
) -> Reading | None:
    """Return the formula of a statement, or record why it has none.

    *obstacle* is the reason if the names of states, actions and parts are not available.
    """
    subject_names = list_subject_names(graph, statement.requirement)
    scope = replace(scope, component_names=(*scope.component_names, *subject_names))
    # Tools append a version: "OCL2.0", "KerML 1.0".
    language = statement.language.removesuffix(" assume").removesuffix(" require")
    language = language.rstrip("0123456789. ")
    reading: Reading | None = None
    if statement.is_temporal:
        # Without the names of the component, an unknown name may be one of them.
        reading = _read_temporal(graph, scope, statement, Sink() if obstacle else sink)
        if reading is None and obstacle:
            informal.add(statement, obstacle)
    elif (sentence := _read_sentence(scope, statement)) is not None:
        reading = sentence
    else:
        formula, reason = _read_condition(scope, statement)
        if formula is not None:
            reading = Reading(formula)
        elif language in _EXPRESSION_LANGUAGES:
            informal.add(statement, reason)
        else:
            informal.add(statement, _describe_language(scope, statement))
    if reading is not None:
        _report_ranges(graph, scope, reading.formula, sink)
    return reading


def _read_temporal(graph: Graph, scope: Scope, statement: Statement, sink: Sink) -> Reading | None:
    constraint = statement.constraint
    body = str(constraint.attrs.get("body", ""))
    meanings: Mapping[str, Meaning] = {}
    try:
        text, meanings = scope.replace_names(body)
        all_domains = scope.domains | {name: item.domain for name, item in meanings.items()}
        formula = _read_names(scope, text, statement.language, all_domains)
    except FormulaError as error:
        sink.report(
            NOT_A_FORMULA,
            graph.subject(constraint),
            constraint=statement.constraint.name or "the constraint",
            requirement=statement.requirement.name,
            about=scope.context.name,
            names=scope.describe_names(),
            reason=_restore_text(describe_error(error, body), meanings),
        )
        return None
    return _make_reading(scope, formula, meanings)


def _make_reading(scope: Scope, formula: Formula, meanings: Mapping[str, Meaning]) -> Reading:
    """Return a formula in variables, and in the names of the author if they differ."""
    wording = restore_names(formula, meanings) if meanings else None
    return Reading(replace_meanings(scope.substitute_constants(formula), meanings), wording)


def _restore_text(message: str, meanings: Mapping[str, Meaning]) -> str:
    """Return a message with the names of the author instead of the variables for them."""
    return re.sub(r"\b__\d+\b", lambda match: meanings[match[0]].name, message)


def _describe_language(scope: Scope, statement: Statement) -> str:
    """Return that a text is not read, with the language under which it would be."""
    reason = f"it is written in {statement.constraint.attrs['language']}"
    for language in ("FRET", "LTL"):
        if _read_under(scope, statement, language) is not None:
            return f"{reason}; write the language '{language}' to have it read"
    return reason


def _read_sentence(scope: Scope, statement: Statement) -> Reading | None:
    """Return the formula of a sentence of a pattern under any name of a language, or None.

    Tools label any prose as English; prose has names that are unknown, or none of these words.
    """
    is_possible = has_pattern_word(str(statement.constraint.attrs.get("body", "")))
    return _read_under(scope, statement, "pattern") if is_possible else None


def _read_under(scope: Scope, statement: Statement, language: str) -> Reading | None:
    """Return the formula that a text has in another language than its own; None if it has none."""
    try:
        text, meanings = scope.replace_names(str(statement.constraint.attrs.get("body", "")))
        all_domains = scope.domains | {name: item.domain for name, item in meanings.items()}
        formula = _read_names(scope, text, language, all_domains)
    except FormulaError:
        return None
    return _make_reading(scope, formula, meanings)


def _read_names(
    scope: Scope, text: str, language: str, all_domains: Mapping[str, Domain]
) -> Formula:
    """Return the formula of a text; an unknown name is explained by the names of the component."""
    try:
        return read_formal(text, language, all_domains, scope.component_names, scope.tick_seconds)
    except UnknownNameError as error:
        advice = "" if error.has_advice else scope.suggest_name(error.name)
        if not advice:
            raise
        raise FormulaError(f"{error}; {advice}", error.offset) from None


def _read_condition(scope: Scope, statement: Statement) -> tuple[Formula | None, str]:
    """Return the formula of a condition in any language; without one, the reason for that."""
    try:
        expression = tree_of(str(statement.constraint.attrs["body"]))
    except ExpressionError as error:
        return None, str(error)
    try:
        return elaborate_condition(expression, scope.find_symbol), ""
    except ComponentError as error:
        return None, str(error)
    except ElaborationError as error:
        if error.fault is not Fault.UNKNOWN:
            return None, explain_fault(error, expression)
        context = scope.context.name
        reason = f"'{error.name}' is not a feature of '{context}' itself, or has no finite type"
        return None, reason


def _report_ranges(graph: Graph, scope: Scope, formula: Formula, sink: Sink) -> None:
    used = f.variable_names(formula)
    for feature in scope.context.features.values():
        if feature.variable in used:
            report_range(graph, feature, sink)


def _add_stated_conjuncts(behaviour: ComponentBehaviour, stated: Contract) -> ComponentBehaviour:
    """Return the behaviour with the formulas that the author wrote on its own contract.

    *stated* is the contract of the component's own behaviour. Formulas about variables that the
    behaviour of the component does not have are left out; they prove nothing.
    """
    contract = behaviour.contract
    names = {variable.name for variable in contract.variables}
    formulas = (*stated.assumptions, *stated.guarantees)
    origins = {conjunct.origin for conjunct in formulas if not conjunct.is_derived}
    # History bits store the past for a formula of the author.
    bits = [
        variable
        for variable in stated.variables
        if variable.name not in names and variable.origin in origins
    ]
    variables = names | {variable.name for variable in bits}

    def select(conjuncts: tuple[Conjunct, ...]) -> tuple[Conjunct, ...]:
        return tuple(
            conjunct
            for conjunct in conjuncts
            if conjunct.origin in origins
            and variables.issuperset(variable.name for variable in f.variables(conjunct.formula))
        )

    merged = replace(
        contract,
        variables=(*contract.variables, *bits),
        assumptions=(*contract.assumptions, *select(stated.assumptions)),
        guarantees=(*contract.guarantees, *select(stated.guarantees)),
    )
    return replace(behaviour, contract=merged)


# -- conjuncts -------------------------------------------------------------------------------------


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
    for conjunct in word_conjuncts(conjuncts, reading.wording):
        yield word_conjunct(conjunct, scope.variables.values())


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
        is_assumed = statement.is_assumed or (
            statement.is_open and scope.is_about_inputs(reading.formula)
        )
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
            formula = f.has_value(f.var(feature.variable), feature.default)
            conjunct = Conjunct(
                formula, Class.INIT, feature.element.id, text, source=Source.DERIVED
            )
            (inputs if scope.is_about_inputs(formula) else outputs).append(conjunct)
    return inputs, outputs
