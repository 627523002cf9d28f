"""Constraints written in LTL, as conjuncts of the contracts of the constrained components."""

from collections.abc import Iterable, Iterator
from functools import cached_property

from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.formula import Formula
from sysmlc.logic.reduction.contract_reduction import add_history_bits, is_reducible
from sysmlc.logic.requirements.derivation import add_features
from sysmlc.logic.requirements.scope import Scope, scope_of
from sysmlc.logic.requirements.statements import component_of, definition_of
from sysmlc.logic.spelling import FormulaError
from sysmlc.logic.texts.formal import describe_error, is_formal, read_formal

_ACTIONS = (Kind.ACTIVITY, Kind.OPERATION)

NOT_A_FORMULA = rule(
    "SM501",
    "formula-not-understood",
    Severity.ERROR,
    "the formula of '{constraint}' is not understood: {reason}",
    help=(
        "write LTL (G F X U or [] <> X U; of the past Y O H S), or a sentence like 'globally, it "
        "is always the case that if P holds then Q eventually holds', over: {variables}"
    ),
)
NO_CONTRACT = rule(
    "SM502",
    "formula-without-contract",
    Severity.WARNING,
    "'{constraint}' is a formula about '{component}', which has no behaviour with a contract",
    help="give '{component}' a classifier behaviour, or move the formula to what has one",
)
OUTSIDE_GR1 = rule(
    "SM503",
    "formula-outside-gr1",
    Severity.INFO,
    "the formula of '{constraint}' is not in GR(1); the contract keeps it as general LTL",
)


def add_formulas(graph: Graph, contracts: list[Contract], sink: Sink) -> list[Contract]:
    """Return the contracts with the formulas of the model's constraints as further conjuncts."""
    by_component = {contract.component: contract for contract in contracts}
    performed = _Performers(graph, contracts)
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        if not _is_formula(constraint):
            continue
        for component in _list_components(graph, constraint, performed):
            if component in by_component:
                by_component[component] = _add_formula(
                    graph, by_component[component], constraint, sink
                )
            else:
                _report_orphan(graph, constraint, component, sink)
    return list(by_component.values())


def _is_formula(constraint: Element) -> bool:
    body = str(constraint.attrs.get("body", ""))
    if not body:
        return False

    return is_formal(str(constraint.attrs.get("language", "")), body)


class _Performers:
    """Index of the components that perform an action: its usages, and what specialises it."""

    def __init__(self, graph: Graph, contracts: list[Contract]) -> None:
        self._graph = graph
        self._contracts = contracts

    def of_action(self, action: Element) -> list[str]:
        """Return the components that perform an action definition."""
        return self._components.get(action.id, [])

    @cached_property
    def _components(self) -> dict[str, list[str]]:
        components: dict[str, list[str]] = {}
        for contract in self._contracts:
            origin = self._graph[contract.origin]
            if origin.kind in _ACTIONS:
                for action in _list_definitions(self._graph, origin):
                    components.setdefault(action.id, []).append(contract.component)
        return components


def _list_definitions(graph: Graph, usage: Element) -> list[Element]:
    """Return the usage, its method, and everything that these specialise."""
    action = definition_of(graph, usage)
    return [usage, *dict.fromkeys((action, *query.generals(graph, action)))]


def _list_components(graph: Graph, constraint: Element, performed: _Performers) -> Iterator[str]:
    """Yield the names of the components that a constraint is about, each once.

    Constraints of requirements are no part of a behaviour (``logic.requirements``). A constraint of
    an action holds for all that perform it; an action of a library is no component itself.
    """
    owner = graph.owner(constraint)
    subjects = graph.targets(constraint, Edge.REFERENCES) or ([] if owner is None else [owner])
    constrained = [element for element in subjects if not query.is_requirement(element)]
    yield from dict.fromkeys(
        name for element in constrained for name in _components_of(graph, element, performed)
    )


def _components_of(graph: Graph, element: Element, performed: _Performers) -> list[str]:
    performers = performed.of_action(element) if element.kind in _ACTIONS else []
    return (
        performers
        if performers or element.attrs.get("external")
        else [component_of(graph, element)]
    )


def _report_orphan(graph: Graph, constraint: Element, component: str, sink: Sink) -> None:
    name = constraint.name or "<Constraint>"
    sink.report(NO_CONTRACT, graph.subject(constraint), constraint=name, component=component)


def _add_formula(graph: Graph, contract: Contract, constraint: Element, sink: Sink) -> Contract:

    name = constraint.name or "<Constraint>"
    scope = _find_scope(graph, contract)
    domains = {variable.name: variable.domain for variable in contract.variables}
    domains = domains if scope is None else domains | scope.domains
    subject = graph.subject(constraint)
    body = str(constraint.attrs["body"])
    try:
        formula = read_formal(body, str(constraint.attrs["language"]), domains)
        if scope is not None:
            formula = scope.substitute_constants(formula)
            contract = add_features(contract, scope, formula)
    except FormulaError as error:
        variable_names, reason = ", ".join(domains), describe_error(error, body)
        sink.report(
            NOT_A_FORMULA, subject, constraint=name, reason=reason, variables=variable_names
        )
        return contract
    conjuncts = [
        Conjunct(part, class_, constraint.id, f"'{name}' demands it.")
        for class_, part in classify(formula)
    ]
    if any(part.class_ is Class.OTHER and not is_reducible(part.formula) for part in conjuncts):
        sink.report(OUTSIDE_GR1, subject, constraint=name)
    return add_history_bits(_extend(contract, conjuncts))


def report_general(graph: Graph, contracts: Iterable[Contract], sink: Sink) -> None:
    """Report each constraint of requirements that no reduction brings into GR(1)."""

    general = [
        conjunct.origin
        for contract in contracts
        for conjunct in (*contract.assumptions, *contract.guarantees)
        if conjunct.class_ is Class.OTHER and not is_reducible(conjunct.formula)
    ]
    for constraint in map(graph.__getitem__, dict.fromkeys(general)):
        name = constraint.name or "<Constraint>"
        sink.report(OUTSIDE_GR1, graph.subject(constraint), constraint=name)


def _find_scope(graph: Graph, contract: Contract) -> Scope | None:
    """Return the features of an action, which formulas about it may use, too."""
    origin = graph[contract.origin]
    if origin.kind not in _ACTIONS:
        return None
    return scope_of(context_of(graph, definition_of(graph, origin)), contract)


def _extend(contract: Contract, conjuncts: list[Conjunct]) -> Contract:
    """Return the contract with further conjuncts: assumptions if they read only inputs, else
    guarantees.
    """
    assumptions = [
        conjunct for conjunct in conjuncts if _reads_only_inputs(contract, conjunct.formula)
    ]
    guarantees = [conjunct for conjunct in conjuncts if conjunct not in assumptions]
    return replace(
        contract,
        assumptions=(*contract.assumptions, *assumptions),
        guarantees=(*contract.guarantees, *guarantees),
    )


def _reads_only_inputs(contract: Contract, formula: Formula) -> bool:
    owners = {variable.name: variable.owner for variable in contract.variables}
    used = [owners[variable.name] for variable in f.variables(formula)]
    return bool(used) and all(owner is Owner.ENVIRONMENT for owner in used)
