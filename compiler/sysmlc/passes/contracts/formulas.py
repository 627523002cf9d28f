"""Constraints written in LTL, as conjuncts of the contracts of what they constrain."""

from collections.abc import Iterable, Iterator
from functools import cached_property

from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classified
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.formula import Formula
from sysmlc.logic.reduction.reduce import is_reducible, remembering
from sysmlc.logic.requirements.derivation import with_features
from sysmlc.logic.requirements.scope import Scope, scope_of
from sysmlc.logic.requirements.statements import component_of, definition_of
from sysmlc.logic.spelling import FormulaError
from sysmlc.logic.texts.formal import is_formal, read_formal, told

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
    """The contracts with the formulas of the model's constraints as further conjuncts."""
    made = {contract.component: contract for contract in contracts}
    performed = _Performed(graph, contracts)
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        if not _is_formula(constraint):
            continue
        for component in _components(graph, constraint, performed):
            if component in made:
                made[component] = _with_formula(graph, made[component], constraint, sink)
            else:
                _report_orphan(graph, constraint, component, sink)
    return list(made.values())


def _is_formula(constraint: Element) -> bool:
    body = str(constraint.attrs.get("body", ""))
    if not body:
        return False

    return is_formal(str(constraint.attrs.get("language", "")), body)


class _Performed:
    """Which components perform an action: usages of it, and what else specialises it."""

    def __init__(self, graph: Graph, contracts: list[Contract]) -> None:
        self._graph = graph
        self._contracts = contracts

    def by(self, action: Element) -> list[str]:
        """The components that do what an action definition says."""
        return self._components.get(action.id, [])

    @cached_property
    def _components(self) -> dict[str, list[str]]:
        found: dict[str, list[str]] = {}
        for one in self._contracts:
            origin = self._graph[one.origin]
            if origin.kind in _ACTIONS:
                for action in _family(self._graph, origin):
                    found.setdefault(action.id, []).append(one.component)
        return found


def _family(graph: Graph, usage: Element) -> list[Element]:
    """What says how an action is performed: it, its method, and all that these specialise."""
    action = definition_of(graph, usage)
    return [usage, *dict.fromkeys((action, *query.generals(graph, action)))]


def _components(graph: Graph, constraint: Element, performed: _Performed) -> Iterator[str]:
    """Names of the components that a constraint speaks of, each once.

    What a requirement demands is no part of a behaviour (``logic.requirements``). What constrains
    an action holds of all that perform it; an action of a library is no component itself.
    """
    owner = graph.owner(constraint)
    subjects = graph.targets(constraint, Edge.REFERENCES) or ([] if owner is None else [owner])
    about = [one for one in subjects if not query.is_requirement(one)]
    yield from dict.fromkeys(name for one in about for name in _about(graph, one, performed))


def _about(graph: Graph, one: Element, performed: _Performed) -> list[str]:
    found = performed.by(one) if one.kind in _ACTIONS else []
    return found if found or one.attrs.get("external") else [component_of(graph, one)]


def _report_orphan(graph: Graph, constraint: Element, component: str, sink: Sink) -> None:
    name = constraint.name or "<Constraint>"
    sink.report(NO_CONTRACT, graph.subject(constraint), constraint=name, component=component)


def _with_formula(graph: Graph, contract: Contract, constraint: Element, sink: Sink) -> Contract:

    name = constraint.name or "<Constraint>"
    scope = _scope(graph, contract)
    domains = {variable.name: variable.domain for variable in contract.variables}
    domains = domains if scope is None else domains | scope.domains
    subject = graph.subject(constraint)
    body = str(constraint.attrs["body"])
    try:
        formula = read_formal(body, str(constraint.attrs["language"]), domains)
        if scope is not None:
            formula = scope.settled(formula)
            contract = with_features(contract, scope, formula)
    except FormulaError as error:
        known, facts = ", ".join(domains), told(error, body)
        sink.report(NOT_A_FORMULA, subject, constraint=name, reason=facts, variables=known)
        return contract
    conjuncts = [
        Conjunct(part, class_, constraint.id, f"'{name}' demands it.")
        for class_, part in classified(formula)
    ]
    if any(one.class_ is Class.OTHER and not is_reducible(one.formula) for one in conjuncts):
        sink.report(OUTSIDE_GR1, subject, constraint=name)
    return remembering(_extended(contract, conjuncts))


def report_general(graph: Graph, contracts: Iterable[Contract], sink: Sink) -> None:
    """Report each constraint of requirements that no reduction brings into GR(1)."""

    general = [
        one.origin
        for contract in contracts
        for one in (*contract.assumptions, *contract.guarantees)
        if one.class_ is Class.OTHER and not is_reducible(one.formula)
    ]
    for constraint in map(graph.__getitem__, dict.fromkeys(general)):
        name = constraint.name or "<Constraint>"
        sink.report(OUTSIDE_GR1, graph.subject(constraint), constraint=name)


def _scope(graph: Graph, contract: Contract) -> Scope | None:
    """The features of an action, which formulas about it may speak of, too."""
    origin = graph[contract.origin]
    if origin.kind not in _ACTIONS:
        return None
    return scope_of(context_of(graph, definition_of(graph, origin)), contract)


def _extended(contract: Contract, conjuncts: list[Conjunct]) -> Contract:
    """What speaks of inputs alone is an assumption, everything else a guarantee."""
    assumed = [one for one in conjuncts if _is_about_inputs(contract, one.formula)]
    promised = [one for one in conjuncts if one not in assumed]
    return replace(
        contract,
        assumptions=(*contract.assumptions, *assumed),
        guarantees=(*contract.guarantees, *promised),
    )


def _is_about_inputs(contract: Contract, formula: Formula) -> bool:
    owners = {variable.name: variable.owner for variable in contract.variables}
    used = [owners[variable.name] for variable in f.variables(formula)]
    return bool(used) and all(owner is Owner.ENVIRONMENT for owner in used)
