"""Check contracts, synthesise controllers and play scenarios from Python.

The games and the interpreter double the time that ``import`` takes, so that programs which only
compile models do not import this module.
"""

from msgspec.structs import replace

from sysmlc.analyses.analysis import analyse
from sysmlc.analyses.controllers import synthesise as synthesise_contract
from sysmlc.analyses.verdicts import ContractChecks, Verdicts
from sysmlc.diagnostics import Sink, Subject
from sysmlc.driver import Compilation
from sysmlc.logic.contract import Contract
from sysmlc.simulation import Report as SimulationReport
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source
from sysmlc.synthesis import Limits
from sysmlc.synthesis.composition_check import CompositionVerdict
from sysmlc.synthesis.contract_checks import CheckedContract
from sysmlc.synthesis.controller_synthesis import Synthesis
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


def check_contracts(
    compilation: Compilation, component: str = "", *, seconds: float = 10.0
) -> ContractChecks:
    """Decide the contracts of a model as ``sysmlc contracts check`` does.

    *component* selects one component by its qualified name. A question that takes longer than
    *seconds* of CPU time is not decided; 0 sets no limit. Verdicts are computed again only after a
    change of the graph or with other arguments. Raises ValueError for an unknown component, with a
    suggestion.
    """
    sink = Sink()
    step = Verdicts(Options("", Limits(seconds=seconds)), component)
    analyse(compilation.graph, step, sink)
    (checks,) = compilation.graph.derived(ContractChecks)
    return replace(checks, diagnostics=(*sink, *checks.diagnostics))


def synthesise(contract: Contract, *, seconds: float = 0.0) -> Synthesis:
    """Decide whether a contract is realizable, and synthesise a controller (``sysmlc synth``).

    The controller is checked against the contract. *seconds* limits the CPU time; 0 sets no limit.
    """
    options = Options("", Limits(seconds=seconds), is_explained=True)
    return synthesise_contract(contract, lambda _: Subject(), Sink(), options)


def simulate(compilation: Compilation, scenarios: str, sink: Sink) -> SimulationReport:
    """Play scenarios, a text in YAML, with the reference interpreter (``sysmlc simulate``).

    Faults of the text are reported to *sink*, and the result has no scenario with a fault.
    """
    return run_scenarios(compilation.graph, Source("scenario.yaml", scenarios.encode()), sink)
