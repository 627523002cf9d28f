"""Three files a contract: JSON for tools, SPIN for checkers, Markdown for people."""

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts.explain import explain
from sysmlc.backends.contracts.trace import trace as trace_of
from sysmlc.backends.templates import TemplateError, Templates
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Graph
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats.contract_json import print_contract
from sysmlc.logic.formats.lowering import rename_ambiguous_literals
from sysmlc.logic.formats.spin import TooLargeError, print_spin
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.output import Output

TOO_LARGE = rule(
    "SM520",
    "formula-too-large",
    Severity.WARNING,
    "the contract of '{component}' compares more values than a SPIN formula can list; "
    "'{file}' is not written",
    help="give the properties smaller ranges",
)
BAD_TEMPLATE = rule(
    "SM521",
    "contract-template-fault",
    Severity.ERROR,
    "template contract.md.j2 cannot be used: {fault}",
    help="correct it, or start from the shipped templates/contracts/contract.md.j2",
)


class ContractsBackend(Struct, frozen=True):
    """Writes the contracts that the pass ``contracts`` found."""

    name: str = "contracts"
    summary: str = "assume/guarantee contracts as JSON, SPIN formula and explanation"
    is_default: bool = True

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add three files a contract; their trace names every element that they tell of."""
        contracts = graph.derived(Contract)
        names = assign_file_names(contract.component for contract in contracts)
        with Templates(self.name, options.templates) as templates:
            for contract in contracts:
                path = f"contracts/{names[contract.component]}"
                _add(graph, rename_ambiguous_literals(contract), output, path, sink, templates)


def _add(
    graph: Graph,
    contract: Contract,
    output: Output,
    path: str,
    sink: Sink,
    templates: Templates,
) -> None:
    trace = tuple(trace_of(graph, contract))
    output.add(f"{path}.contract.json", print_contract(contract), trace, "contracts")
    _add_spin(graph, contract, output, f"{path}.spin.ltl", trace, sink)
    _add_page(graph, contract, output, f"{path}.md", trace, sink, templates)


def _add_spin(
    graph: Graph,
    contract: Contract,
    output: Output,
    path: str,
    trace: tuple[str, ...],
    sink: Sink,
) -> None:
    try:
        output.add(path, print_spin(contract), trace, "contracts")
    except TooLargeError:
        subject = graph.subject(graph[contract.origin])
        sink.report(TOO_LARGE, subject, component=contract.component, file=path)


def _add_page(
    graph: Graph,
    contract: Contract,
    output: Output,
    path: str,
    trace: tuple[str, ...],
    sink: Sink,
    templates: Templates,
) -> None:
    try:
        output.add(path, explain(graph, contract, templates), trace, "contracts")
    except TemplateError as fault:
        sink.report(BAD_TEMPLATE, Subject("contract.md.j2"), fault=fault)
