"""Common part of the back ends that write contracts in the formats of other tools."""

from collections.abc import Callable

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts.trace import trace
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Graph
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats import NotExpressibleError
from sysmlc.logic.printing import print_formula
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.output import Output

NOT_EXPRESSIBLE = rule(
    "SM590",
    "contract-not-expressible",
    Severity.WARNING,
    "the contract of '{component}' is not written for {form}: the format cannot "
    "express {what}, because {reason}",
    help="emit a format for general LTL (contracts, spot, tlsf), or state the "
    "requirement as a property pattern",
)

Split = Callable[[str], dict[str, str]]
"""Splits a text into files; the keys are the endings of their names."""


class FormBackend(Struct, frozen=True):
    """Writes every contract in the formats of one tool."""

    name: str
    summary: str
    files: tuple[tuple[str, str], ...]
    """Names of formats (``logic.formats``) with the endings of their files."""
    split: Split | None = None
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add the files of each contract; report conjuncts that a format cannot express."""
        contracts = graph.derived(Contract)
        names = assign_file_names(contract.component for contract in contracts)
        for contract in contracts:
            traced_ids = tuple(trace(graph, contract))
            for format_name, ending in self.files:
                texts = self._print(graph, contract, format_name, ending, sink)
                for file_ending, text in texts.items():
                    path = f"contracts/{names[contract.component]}{file_ending}"
                    output.add(path, text, traced_ids, self.name)

    def _print(
        self, graph: Graph, contract: Contract, format_name: str, ending: str, sink: Sink
    ) -> dict[str, str]:
        """Return the texts of a contract by the endings of their files."""
        try:
            text = formats.write(contract, format_name)
        except NotExpressibleError as error:
            _report(graph, contract, format_name, error, sink)
            return {}
        return self.split(text) if self.split else {ending: text}


def _report(
    graph: Graph, contract: Contract, format_name: str, error: NotExpressibleError, sink: Sink
) -> None:
    conjunct = error.conjunct
    origin = conjunct.origin if conjunct and conjunct.origin in graph else contract.origin
    subject = graph.subject(graph[origin]) if origin in graph else Subject(contract.component)
    formula = f"'{print_formula(conjunct.formula)}'" if conjunct else "it"
    sink.report(
        NOT_EXPRESSIBLE,
        subject,
        component=contract.component,
        form=format_name,
        what=formula,
        reason=error.reason,
    )
