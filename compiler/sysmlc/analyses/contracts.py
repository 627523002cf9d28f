"""Analysis ``contracts``: the contract of every behaviour, with the formulas written in the model.

Contracts are derived from state machines and activities (design, section 7). Constraints in LTL
become conjuncts in the contract of the component that they constrain. The requirements of a subject
give a separate contract, and so do the pre- and postconditions of a service.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from functools import cached_property
from math import inf
from typing import ClassVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.analyses.unread_restrictions import report_unread_restrictions
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.activities import derivation as activity_contract
from sysmlc.logic.activities.action_names import name_actions
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.cells import add_facts_about_numbers
from sysmlc.logic.classification import classify
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    GivenContract,
    Owner,
    mark_derived,
    name_variables,
)
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.feature_writes import WriterIndex
from sysmlc.logic.formal_texts import describe_error, is_formal_constraint, read_formal
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines import derivation as statemachine
from sysmlc.logic.machines.reader import MachineOptions, find_context_classifier, read_machine
from sysmlc.logic.reduction.contract_reduction import add_history_bits, is_reducible
from sysmlc.logic.requirements import derivation as requirements
from sysmlc.logic.requirements.derivation import add_features
from sysmlc.logic.requirements.scope import Scope, scope_of
from sysmlc.logic.requirements.statements import component_of, list_component_names
from sysmlc.logic.services import derivation as services
from sysmlc.logic.syntax import FormulaError

SAME_COMPONENT = rule(
    "SM500",
    "components-with-one-name",
    Severity.WARNING,
    "{count} components have the name '{component}'; a number tells their contracts apart",
    help="give them or their owners different names",
)
_IN_FILES = "packages of two files have one name: rename one, or compile the files one by one"


class Contracts(Struct, frozen=True):
    """Derive contracts.

    ``tick_seconds`` is the length of a step in seconds. ``assumed_low`` and ``assumed_high`` are
    the range of Integers without a declared range.
    """

    tick_seconds: float = 1.0
    assumed_low: int = 0
    assumed_high: int = 15

    name: ClassVar[str] = "contracts"

    def __post_init__(self) -> None:
        """Raise ValueError if steps have no length."""
        if not 0 < self.tick_seconds < inf:
            raise ValueError(f"tick_seconds: {self.tick_seconds} is no length of a step")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the Contracts of behaviours, of subjects of requirements and of services."""
        options = MachineOptions(self.tick_seconds, (self.assumed_low, self.assumed_high))
        # `_add_formulas` finds contracts by component, so that these names must be distinct before.
        drawn = (*_derive_machines(graph, options, sink), *_derive_activities(graph))
        derived = list(map(mark_derived, drawn))
        derived = _number_components(graph, derived, sink)
        report_unread_restrictions(graph, derived, sink)
        derived = _add_formulas(graph, derived, options, sink)
        checked = list(requirements.derive(graph, derived, options, sink))
        required = [subject.contract for subject in checked]
        graph.store(
            ComponentBehaviour,
            (subject.behaviour for subject in checked if subject.behaviour is not None),
        )
        _report_general(graph, required, sink)
        derived = [*derived, *required]
        components = [contract.component for contract in derived]
        derived = _number_components(
            graph,
            [*derived, *services.derive_contracts(graph, components, options.assumed_range, sink)],
            sink,
        )
        given = [entry.contract for entry in graph.derived(GivenContract)]
        names = {contract.component for contract in given}
        contracts = [*given, *(_add_facts(graph, c) for c in derived if c.component not in names)]
        graph.store(Contract, sorted(contracts, key=lambda contract: contract.component))


def _add_facts(graph: Graph, contract: Contract) -> Contract:
    """Return a contract with what arithmetic and constraints say about the numbers in it."""
    element = graph.get(contract.origin)
    if element is None or not any(variable.term for variable in contract.variables):
        return contract
    origin = query.definition_of(graph, element)
    is_behaviour = origin.kind in query.BEHAVIORS
    if is_behaviour:
        origin = find_context_classifier(graph, origin) or origin
    # Requirements are compared with a behaviour, which may order other constants.
    facts = context_of(graph, origin).facts
    return add_facts_about_numbers(contract, facts, has_orders=is_behaviour)


def _derive_machines(graph: Graph, options: MachineOptions, sink: Sink) -> Iterator[Contract]:
    writers = WriterIndex(graph)
    for element in graph.of_kind(Kind.STATE_MACHINE):
        if not _is_behaviour(graph, element):
            continue
        machine = read_machine(graph, element, sink, options, writers)
        name = query.component_name(graph, element)
        if machine is not None:
            contract = statemachine.derive_contract(graph, machine, name, sink)
            if contract is not None:
                yield contract


def _is_behaviour(graph: Graph, element: Element) -> bool:
    """Whether the state machine describes the behaviour of a component.

    Protocol state machines, submachines and machines without regions or of other files do not.
    """
    is_drawn = any(region.kind is Kind.REGION for region in graph.owned(element))
    is_concrete = is_drawn and element.subkind != "protocol" and not element.attrs.get("external")
    return is_concrete and not _is_submachine(graph, element)


def _is_submachine(graph: Graph, machine: Element) -> bool:
    """Whether only states refer to the machine, so that no component has it as its behaviour."""
    is_called = any(user.kind is Kind.STATE for user in graph.sources(machine, Edge.CALLS))
    owner_edges = (Edge.CLASSIFIER_BEHAVIOR, Edge.METHOD)
    return is_called and not any(graph.sources(machine, edge) for edge in owner_edges)


def _derive_activities(graph: Graph) -> Iterator[Contract]:
    for tokens in graph.derived(TokenGraph):
        yield name_variables(activity_contract.derive_contract(tokens), name_actions(graph, tokens))


def _number_components(graph: Graph, contracts: list[Contract], sink: Sink) -> list[Contract]:
    """Return the contracts with distinct component names; the second of a name gets ``#2``."""
    totals = Counter(contract.component for contract in contracts)
    counts: Counter[str] = Counter()
    numbered: list[Contract] = []
    for contract in contracts:
        name = contract.component
        counts[name] += 1
        if totals[name] > 1 and counts[name] == 1:
            _report_same_name(graph, [c for c in contracts if c.component == name], sink)
        number = counts[name]
        numbered.append(
            contract if number == 1 else replace(contract, component=f"{name}#{number}")
        )
    return numbered


def _report_same_name(graph: Graph, same: list[Contract], sink: Sink) -> None:
    """Report the first of the components of one name; the notes name the files of the others."""
    behaviour, name = graph[same[0].origin], same[0].component
    files = dict.fromkeys(graph[contract.origin].source for contract in same)
    files.pop(behaviour.source, None)
    sink.report(
        SAME_COMPONENT,
        graph.subject(behaviour),
        notes=tuple(f"another '{name}' is in {file}" for file in files),
        help=_IN_FILES if files else "",
        count=len(same),
        component=name,
    )


# -- formulas ----------------------------------------------------------------------------------

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
    help="give '{component}' a classifier behaviour, or move the formula to a component "
    "that has one",
)
OUTSIDE_GR1 = rule(
    "SM503",
    "formula-outside-gr1",
    Severity.INFO,
    "the formula of '{constraint}' is not in GR(1); the contract keeps it as general LTL",
)


def _add_formulas(
    graph: Graph, contracts: list[Contract], options: MachineOptions, sink: Sink
) -> list[Contract]:
    """Return the contracts, extended by the formulas in constraints of the model."""
    by_component = {contract.component: contract for contract in contracts}
    performed = _Performers(graph, contracts)
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        if not is_formal_constraint(constraint):
            continue
        for component in _list_components(graph, constraint, performed):
            if component in by_component:
                contract = by_component[component]
                scope = _find_scope(graph, contract, options.assumed_range)
                by_component[component] = _add_formula(
                    graph, contract, constraint, scope, options.tick_seconds, sink
                )
            else:
                _report_orphan(graph, constraint, component, sink)
    return list(by_component.values())


class _Performers:
    """Index of the components that perform an action definition, directly or as a special one."""

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
    """Return the usage, its definition or method, and the generals of the definition."""
    action = query.definition_of(graph, usage)
    return [usage, *dict.fromkeys((action, *query.generals(graph, action)))]


def _list_components(graph: Graph, constraint: Element, performed: _Performers) -> Iterator[str]:
    """Yield the names of the components that a constraint restricts, each once.

    Constraints of requirements have contracts of their own (``logic.requirements``). A constraint
    of an action restricts all components that perform the action. An action of a library is not a
    component itself.
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


def _add_formula(
    graph: Graph,
    contract: Contract,
    constraint: Element,
    scope: Scope | None,
    tick_seconds: float,
    sink: Sink,
) -> Contract:
    """Return the contract, extended by the formula of a constraint; report a formula with a fault.

    *scope* has the features of the contract's action, and is None for a machine.
    """
    name = constraint.name or "<Constraint>"
    domains = {variable.name: variable.domain for variable in contract.variables}
    domains = domains if scope is None else domains | scope.domains
    subject = graph.subject(constraint)
    body = str(constraint.attrs.get("body", ""))
    try:
        language = str(constraint.attrs.get("language", ""))
        formula = read_formal(body, language, domains, (), tick_seconds)
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


def _report_general(graph: Graph, contracts: Iterable[Contract], sink: Sink) -> None:
    """Report each constraint of requirements that no reduction transforms to GR(1)."""
    general = [
        conjunct.origin
        for contract in contracts
        for conjunct in (*contract.assumptions, *contract.guarantees)
        if conjunct.class_ is Class.OTHER and not is_reducible(conjunct.formula)
    ]
    for constraint in map(graph.__getitem__, dict.fromkeys(general)):
        name = constraint.name or "<Constraint>"
        sink.report(OUTSIDE_GR1, graph.subject(constraint), constraint=name)


def _find_scope(graph: Graph, contract: Contract, assumed_range: tuple[int, int]) -> Scope | None:
    """Return the scope of an action, whose features formulas may use, or None for a machine."""
    origin = graph[contract.origin]
    if origin.kind not in _ACTIONS:
        return None
    context = context_of(graph, query.definition_of(graph, origin), assumed_range)
    scope = scope_of(context, contract.variables)
    return replace(scope, component_names=list_component_names(graph, origin))


def _extend(contract: Contract, conjuncts: list[Conjunct]) -> Contract:
    """Return the contract with further conjuncts.

    A conjunct over inputs only becomes an assumption, any other a guarantee.
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
    # A formula without variables assumes nothing of the environment.
    used = [owners[name] for name in f.variable_names(formula)]
    return bool(used) and all(owner is Owner.ENVIRONMENT for owner in used)
