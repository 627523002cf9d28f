"""Check contracts, synthesise controllers and play scenarios from Python.

The games and the interpreter double the time that ``import`` takes, so that programs which only
compile models do not import this module.
"""

from msgspec import Struct

from sysmlc.diagnostics import Diagnostic, Sink, Subject
from sysmlc.driver import Compilation
from sysmlc.ir.query.libraries import find_unused_library_elements
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.composition.derivation import compose_blocks, list_checked_composites
from sysmlc.logic.contract import Composite, Contract
from sysmlc.logic.formats.lowering import rename_ambiguous_literals
from sysmlc.simulation import Report as SimulationReport
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source
from sysmlc.support.suggestions import did_you_mean
from sysmlc.synthesis import Limits
from sysmlc.synthesis.composition_check import CompositionVerdict, check_compositions
from sysmlc.synthesis.contract_checks import CheckedContract
from sysmlc.synthesis.contract_checks import check_contracts as check_each_contract
from sysmlc.synthesis.controller_synthesis import Synthesis, synthesise_controller
from sysmlc.synthesis.decision import Options

__all__ = [
    "CheckedContract",
    "CompositionVerdict",
    "ContractChecks",
    "SimulationReport",
    "Synthesis",
    "check_contracts",
    "simulate",
    "synthesise",
]


class ContractChecks(Struct, frozen=True):
    """The verdicts of ``check_contracts``, and the findings that explain them."""

    contracts: tuple[CheckedContract, ...]
    """The verdict on each contract by itself, and on the requirements of its component."""
    compositions: tuple[CompositionVerdict, ...]
    """The verdict on the parts of each block."""
    diagnostics: tuple[Diagnostic, ...]


def check_contracts(
    compilation: Compilation, component: str = "", *, seconds: float = 10.0
) -> ContractChecks:
    """Decide the contracts of a model as ``sysmlc contracts check`` does.

    *component* selects one component by its qualified name. A question that takes longer than
    *seconds* of CPU time is not decided; 0 sets no limit. Raises ValueError for an unknown
    component, with a suggestion.
    """
    graph, sink = compilation.graph, Sink()
    contracts = graph.derived(Contract)
    unused = frozenset[str]() if component else find_unused_library_elements(graph)
    behaviours = {b.contract.component: b for b in graph.derived(ComponentBehaviour)}
    composites = list_checked_composites(compose_blocks(graph, contracts, sink), behaviours)

    names = {contract.component for contract in contracts}
    names |= {composite.component for composite in composites}
    if component and component not in names:
        raise ValueError(f"no component '{component}'; {did_you_mean(component, names)}")

    def is_selected(item: Contract | Composite) -> bool:
        return component in ("", item.component) and item.origin not in unused

    def place(origin: str) -> Subject:
        element = graph.get(origin)
        return Subject() if element is None else graph.subject(element)

    chosen, options = filter(is_selected, contracts), Options("", Limits(seconds=seconds))
    return ContractChecks(
        tuple(check_each_contract(chosen, contracts, place, sink, options, behaviours)),
        tuple(check_compositions(filter(is_selected, composites), place, sink, options)),
        tuple(sink),
    )


def synthesise(contract: Contract, *, seconds: float = 0.0) -> Synthesis:
    """Decide whether a contract is realizable, and synthesise a controller (``sysmlc synth``).

    The controller is checked against the contract. *seconds* limits the CPU time; 0 sets no limit.
    """
    options = Options("", Limits(seconds=seconds), is_explained=True)
    return synthesise_controller(
        rename_ambiguous_literals(contract), lambda _: Subject(), Sink(), options
    )


def simulate(compilation: Compilation, scenarios: str, sink: Sink) -> SimulationReport:
    """Play scenarios, a text in YAML, with the reference interpreter (``sysmlc simulate``).

    Faults of the text are reported to *sink*, and the result has no scenario with a fault.
    """
    return run_scenarios(compilation.graph, Source("scenario.yaml", scenarios.encode()), sink)
