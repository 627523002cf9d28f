"""Pass ``contracts``: the contract of every behaviour, with the formulas written in the model.

State machines and activities are derived (design, section 7); constraints written in LTL are
conjuncts of the contract of the component that they constrain; what requirements assume and
demand of a subject is a contract of its own, and so are the pre- and postconditions of a service.
"""

from collections import Counter
from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.activities import derivation as activity_contract
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Contract
from sysmlc.logic.machines import derivation as statemachine
from sysmlc.logic.machines.reader import MachineOptions, read_machine
from sysmlc.logic.requirements import derivation as requirements
from sysmlc.logic.services import derivation as services
from sysmlc.logic.writers import Writers
from sysmlc.passes.contracts.formulas import add_formulas, report_general

SAME_COMPONENT = rule(
    "SM500",
    "components-with-one-name",
    Severity.WARNING,
    "{count} components have the name '{component}'; a number tells their contracts apart",
    help="give them or their owners different names",
)


class Contracts(Struct, frozen=True):
    """Derive contracts.

    ``tick_seconds`` is the length of a step for durations with a unit; ``assumed_low`` and
    ``assumed_high`` are the range of Integers that declare none.
    """

    tick_seconds: float = 1.0
    assumed_low: int = 0
    assumed_high: int = 15

    name: ClassVar[str] = "contracts"
    after: ClassVar[tuple[str, ...]] = ("classify", "activities", "behaviours")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the Contracts of behaviours, of subjects of requirements and of services."""
        derived = [*self._derive_machines(graph, sink), *_derive_activities(graph)]
        derived = add_formulas(graph, _number_components(graph, derived, sink), sink)
        assumed_range = self.assumed_low, self.assumed_high
        required = list(requirements.derive(graph, derived, assumed_range, sink))
        report_general(graph, required, sink)
        derived = [*derived, *required]
        components = [contract.component for contract in derived]
        derived = _number_components(
            graph,
            [*derived, *services.derive_contracts(graph, components, assumed_range, sink)],
            sink,
        )
        graph.store(Contract, sorted(derived, key=lambda contract: contract.component))

    def _derive_machines(self, graph: Graph, sink: Sink) -> Iterator[Contract]:
        writers = Writers(graph)
        for element in graph.of_kind(Kind.STATE_MACHINE):
            contract = self._derive_machine(graph, element, writers, sink)
            if contract is not None:
                yield contract

    def _derive_machine(
        self, graph: Graph, element: Element, writers: Writers, sink: Sink
    ) -> Contract | None:
        if not _is_behaviour(graph, element):
            return None
        options = MachineOptions(self.tick_seconds, (self.assumed_low, self.assumed_high))
        machine = read_machine(graph, element, sink, options, writers)
        if machine is None:
            return None
        name = query.component_name(graph, element)
        return statemachine.derive_contract(graph, machine, name, sink)


def _is_behaviour(graph: Graph, element: Element) -> bool:
    """Whether the state machine states what a component does: drawn here, and no protocol."""
    is_drawn = any(region.kind is Kind.REGION for region in graph.owned(element))
    is_concrete = is_drawn and element.subkind != "protocol" and not element.attrs.get("external")
    return is_concrete and not _is_submachine(graph, element)


def _is_submachine(graph: Graph, machine: Element) -> bool:
    """Whether only states refer to the machine, so that it is nobody's behaviour by itself."""
    is_called = any(user.kind is Kind.STATE for user in graph.sources(machine, Edge.CALLS))
    owner_edges = (Edge.CLASSIFIER_BEHAVIOR, Edge.METHOD)
    return is_called and not any(graph.sources(machine, edge) for edge in owner_edges)


def _derive_activities(graph: Graph) -> Iterator[Contract]:
    for tokens in graph.derived(TokenGraph):
        yield activity_contract.derive_contract(tokens)


def _number_components(graph: Graph, contracts: list[Contract], sink: Sink) -> list[Contract]:
    """Return the contracts with distinct components: the second of a name gets ``#2``."""
    totals = Counter(contract.component for contract in contracts)
    counts: Counter[str] = Counter()
    numbered: list[Contract] = []
    for contract in contracts:
        name = contract.component
        counts[name] += 1
        if totals[name] > 1:
            _report_same_name(
                graph, contract, [other for other in contracts if other.component == name], sink
            )
        number = counts[name]
        numbered.append(
            contract if number == 1 else replace(contract, component=f"{name}#{number}")
        )
    return numbered


def _report_same_name(graph: Graph, contract: Contract, same: list[Contract], sink: Sink) -> None:
    """Report that a component is not the only one of its name, with the files of the others."""
    behaviour, name = graph[contract.origin], contract.component
    files = dict.fromkeys(graph[other.origin].source for other in same)
    files.pop(behaviour.source, None)
    sink.report(
        SAME_COMPONENT,
        graph.subject(behaviour),
        notes=tuple(f"another '{name}' is in {file}" for file in files),
        help=_IN_FILES if files else "",
        count=len(same),
        component=name,
    )


_IN_FILES = "packages of two files have one name: rename one, or compile the files one by one"
