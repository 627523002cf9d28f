"""Contracts in the forms of other tools: what the back ends for them have in common."""

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
"""A text as the files that it is, by their endings."""


class FormBackend(Struct, frozen=True):
    """Writes every contract in the forms of one tool, each with the ending of its files."""

    name: str
    summary: str
    files: tuple[tuple[str, str], ...]
    """Forms (``logic.formats``) and endings."""
    split: Split | None = None
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add the files of each contract; report what cannot be said."""
        contracts = graph.derived(Contract)
        names = assign_file_names(contract.component for contract in contracts)
        for contract in contracts:
            told = tuple(trace(graph, contract))
            for form, ending in self.files:
                for last, text in self._texts(graph, contract, form, ending, sink).items():
                    path = f"contracts/{names[contract.component]}{last}"
                    output.add(path, text, told, self.name)

    def _texts(
        self, graph: Graph, contract: Contract, form: str, ending: str, sink: Sink
    ) -> dict[str, str]:
        try:
            text = formats.write(contract, form)
        except NotExpressibleError as error:
            _report(graph, contract, form, error, sink)
            return {}
        return self.split(text) if self.split else {ending: text}


def _report(
    graph: Graph, contract: Contract, form: str, error: NotExpressibleError, sink: Sink
) -> None:
    conjunct = error.conjunct
    origin = conjunct.origin if conjunct and conjunct.origin in graph else contract.origin
    subject = graph.subject(graph[origin]) if origin in graph else Subject(contract.component)
    what = f"'{print_formula(conjunct.formula)}'" if conjunct else "it"
    sink.report(
        NOT_EXPRESSIBLE,
        subject,
        component=contract.component,
        form=form,
        what=what,
        reason=error.reason,
    )
