"""Back ends that write contracts in the formats of other tools (``logic.formats``).

``chase``, ``gr1c``, ``slugs``, ``smv``, ``spot`` and ``tlsf`` are the targets of ``--emit``.
"""

from collections.abc import Callable

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import list_traced_elements
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Graph
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats import NotExpressibleError
from sysmlc.logic.printing import print_formula
from sysmlc.support.output import Output, assign_file_names

NOT_EXPRESSIBLE = rule(
    "SM590",
    "contract-not-expressible",
    Severity.WARNING,
    "the contract of '{component}' is not written for {form}: the format cannot "
    "express {what}, because {reason}",
    help="emit a format for general LTL (contracts, spot, tlsf), or state the "
    "requirement as a property pattern",
)


class ContractFormatBackend(Struct, frozen=True):
    """Writes every contract in one or more formats of one tool."""

    name: str
    summary: str
    formats: tuple[tuple[str, str], ...]
    """Name of each format, and the suffix of its files."""
    split: Callable[[str], dict[str, str]] | None = None
    """Distributes the text of a format to several files, which are returned by suffix."""
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add the files of each contract; report contracts that a format cannot express."""
        contracts = graph.derived(Contract)
        names = assign_file_names(contract.component for contract in contracts)
        for contract in contracts:
            trace = tuple(list_traced_elements(graph, contract))
            for format_name, suffix in self.formats:
                try:
                    text = formats.write(contract, format_name)
                except NotExpressibleError as error:
                    _report_not_expressible(graph, contract, format_name, error, sink)
                    continue
                texts = self.split(text) if self.split else {suffix: text}
                for file_suffix, file_text in texts.items():
                    path = f"contracts/{names[contract.component]}{file_suffix}"
                    output.add(path, file_text, trace, self.name)


def _report_not_expressible(
    graph: Graph, contract: Contract, format_name: str, error: NotExpressibleError, sink: Sink
) -> None:
    """Report the fault about the element of the conjunct, or else of the contract."""
    conjunct = error.conjunct
    origin = conjunct.origin if conjunct and conjunct.origin in graph else contract.origin
    subject = graph.subject(graph[origin]) if origin in graph else Subject(contract.component)
    sink.report(
        NOT_EXPRESSIBLE,
        subject,
        component=contract.component,
        form=format_name,
        what=f"'{print_formula(conjunct.formula)}'" if conjunct else "it",
        reason=error.reason,
    )


def _split_spot(text: str) -> dict[str, str]:
    """Return the formula and the partition of its variables, which ltlsynt reads separately."""
    formula, _, partition = text.partition("\n")
    return {".spot.ltl": f"{formula}\n", ".spot.part": partition}


CHASE = ContractFormatBackend(
    "chase",
    "contracts for CHASE (.chase.ltl, .chase.json)",
    (("chase", ".chase.ltl"), ("chasejson", ".chase.json")),
)
GR1C = ContractFormatBackend("gr1c", "contracts for gr1c (.spc)", (("gr1c", ".spc"),))
SLUGS = ContractFormatBackend(
    "slugs",
    "contracts for slugs (.structuredslugs, .slugsin)",
    (("structured", ".structuredslugs"), ("slugsin", ".slugsin")),
)
SMV = ContractFormatBackend("smv", "contracts for NuSMV and nuXmv (.smv)", (("smv", ".smv"),))
SPOT = ContractFormatBackend(
    "spot", "contracts for Spot (.spot.ltl, .spot.part)", (("spot", ".spot.ltl"),), _split_spot
)
TLSF = ContractFormatBackend("tlsf", "contracts for LTL synthesis (TLSF)", (("tlsf", ".tlsf"),))
