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
    """Derives contracts.

    ``tick_seconds`` is the length of a step for durations with a unit; ``assumed_low`` and
    ``assumed_high`` are the range of Integers that declare none.
    """

    tick_seconds: float = 1.0
    assumed_low: int = 0
    assumed_high: int = 15

    name: ClassVar[str] = "contracts"
    after: ClassVar[tuple[str, ...]] = ("classify", "activities", "behaviours")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store a Contract for each behaviour that is derived and for subjects of requirements."""
        found = [*self._of_machines(graph, sink), *_of_activities(graph)]
        found = add_formulas(graph, _told_apart(graph, found, sink), sink)
        assumed = self.assumed_low, self.assumed_high
        required = list(requirements.derive(graph, found, assumed, sink))
        report_general(graph, required, sink)
        found = [*found, *required]
        taken = [contract.component for contract in found]
        found = _told_apart(graph, [*found, *services.derive(graph, taken, assumed, sink)], sink)
        graph.store(Contract, sorted(found, key=lambda contract: contract.component))

    def _of_machines(self, graph: Graph, sink: Sink) -> Iterator[Contract]:
        writers = Writers(graph)
        for element in graph.of_kind(Kind.STATE_MACHINE):
            contract = self._of_machine(graph, element, writers, sink)
            if contract is not None:
                yield contract

    def _of_machine(
        self, graph: Graph, about: Element, writers: Writers, sink: Sink
    ) -> Contract | None:
        if not _is_behaviour(graph, about):
            return None
        options = MachineOptions(self.tick_seconds, (self.assumed_low, self.assumed_high))
        machine = read_machine(graph, about, sink, options, writers)
        if machine is None:
            return None
        return statemachine.derive_contract(
            graph, machine, query.component_name(graph, about), sink
        )


def _is_behaviour(graph: Graph, element: Element) -> bool:
    """Whether it says what a component does: drawn here, and no protocol of an interface."""
    is_drawn = any(one.kind is Kind.REGION for one in graph.owned(element))
    is_own = is_drawn and element.subkind != "protocol" and not element.attrs.get("external")
    return is_own and not _is_submachine(graph, element)


def _is_submachine(graph: Graph, machine: Element) -> bool:
    """Whether it is there for states to be it: it is nobody's behaviour by itself."""
    is_called = any(one.kind is Kind.STATE for one in graph.sources(machine, Edge.CALLS))
    own = (Edge.CLASSIFIER_BEHAVIOR, Edge.METHOD)
    return is_called and not any(graph.sources(machine, edge) for edge in own)


def _of_activities(graph: Graph) -> Iterator[Contract]:
    for tokens in graph.derived(TokenGraph):
        yield activity_contract.derive(tokens)


def _told_apart(graph: Graph, contracts: list[Contract], sink: Sink) -> list[Contract]:
    """The contracts with components that differ: the second of a name gets ``#2``."""
    totals = Counter(contract.component for contract in contracts)
    seen: Counter[str] = Counter()
    made: list[Contract] = []
    for contract in contracts:
        name = contract.component
        seen[name] += 1
        if totals[name] > 1:
            _report(graph, contract, [one for one in contracts if one.component == name], sink)
        number = seen[name]
        made.append(contract if number == 1 else replace(contract, component=f"{name}#{number}"))
    return made


def _report(graph: Graph, contract: Contract, same: list[Contract], sink: Sink) -> None:
    """Tell that a component is not the only one of its name, with the files of the others."""
    behaviour, name = graph[contract.origin], contract.component
    files = dict.fromkeys(graph[one.origin].source for one in same)
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
