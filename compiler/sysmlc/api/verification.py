"""Check contracts, synthesise controllers and play scenarios from Python.

The games and the interpreter double the time that ``import`` takes, so that programs which only
compile models do not import this module.
"""

from msgspec.structs import replace

from sysmlc.analyses.analysis import analyse
from sysmlc.analyses.controllers import synthesise as synthesise_contract
from sysmlc.analyses.verdicts import ContractChecks, Verdicts
from sysmlc.api.arguments import check_arguments
from sysmlc.diagnostics import Sink, Subject
from sysmlc.driver import Compilation
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.simulation import Report as SimulationReport
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source
from sysmlc.synthesis import Limits
from sysmlc.synthesis.composition_check import CompositionVerdict
from sysmlc.synthesis.contract_checks import CheckedContract
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.run_acceptance import RunVerdict
from sysmlc.synthesis.run_acceptance import accept_run as accept_recorded_run

__all__ = [
    "CheckedContract",
    "CompositionVerdict",
    "ContractChecks",
    "RunVerdict",
    "SimulationReport",
    "Synthesis",
    "accept_run",
    "check_contracts",
    "read_contracts",
    "simulate",
    "synthesise",
    "write_contract",
]


@check_arguments
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


@check_arguments
def synthesise(contract: Contract, *, seconds: float = 0.0) -> Synthesis:
    """Decide whether a contract is realizable, and synthesise a controller (``sysmlc synth``).

    The controller is checked against the contract. *seconds* limits the CPU time; 0 sets no limit.
    The diagnostics of the result explain why there is no controller.
    """
    options = Options("", Limits(seconds=seconds), is_explained=True)
    return synthesise_contract(contract, lambda _: Subject(), Sink(), options)


@check_arguments
def simulate(compilation: Compilation, scenarios: str, sink: Sink) -> SimulationReport:
    """Play scenarios, a text in YAML, with the reference interpreter (``sysmlc simulate``).

    Faults of the text are reported to *sink*, and the result has no scenario with a fault.
    """
    source = Source("scenario.yaml", scenarios.encode(errors="surrogatepass"))
    return run_scenarios(compilation.graph, source, sink)


# -- formats of contracts --------------------------------------------------------------------------


@check_arguments
def read_contracts(
    text: str, sink: Sink, form: str = "", *, name: str = "contract"
) -> tuple[Contract, ...]:
    """Read the contracts, or the formula, in a text in one of the formats of ``--from``.

    Without a *form* the content decides. *name* names the text in findings, and a contract without
    a name of its own. Faults of the text are reported to *sink*. Raises ValueError for a format
    that is not read.
    """
    read = formats.read(text, name, sink, form)
    return tuple(c if c.component else replace(c, component=name) for c in read)


@check_arguments
def write_contract(contract: Contract, form: str) -> str:
    """Return a contract as text in one of the formats of contracts.

    Raises ValueError if the format is unknown or cannot express the contract.
    """
    return formats.write(contract, form)


@check_arguments
def accept_run(contract: Contract, run: str, sink: Sink) -> RunVerdict | None:
    """Evaluate a contract on a recorded run, a text in CSV or JSON (``sysmlc contracts accept``).

    The first violation is reported to *sink*, as are faults of the text; then the result is None.
    """
    name = "run.json" if run.lstrip().startswith(("[", "{")) else "run.csv"
    source = Source(name, run.encode(errors="surrogatepass"))
    return accept_recorded_run(contract, source, lambda _: Subject(), sink)
