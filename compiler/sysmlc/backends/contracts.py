"""Back end ``contracts``: three files for each contract.

They are JSON for tools, a SPIN formula for model checkers, and a Markdown page for people.
"""

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contract_pages import print_page
from sysmlc.backends.templates import TemplateError, Templates
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats.contract_json import print_contract
from sysmlc.logic.formats.lowering import rename_ambiguous_literals
from sysmlc.logic.formats.spin import TooLargeError, print_spin
from sysmlc.support.output import Output, assign_file_names

TOO_LARGE = rule(
    "SM520",
    "formula-too-large",
    Severity.WARNING,
    "the contract of '{component}' compares more values than a SPIN formula can list; "
    "'{file}' is not written",
    help="give the properties smaller ranges",
)
TOO_LONG = rule(
    "SM711",
    "contract-too-long",
    Severity.WARNING,
    "the contract of '{component}' has {size} million characters, more than {limit} million; "
    "its files are not written",
    help="split the behaviour: move a group of actions or states into a behaviour of its own",
)
BAD_TEMPLATE = rule(
    "SM521",
    "contract-template-fault",
    Severity.ERROR,
    "template contract.md.j2 cannot be used: {fault}",
    help="correct it, or start from the shipped templates/contracts/contract.md.j2",
)


_MILLION = 1_000_000
_MAX_MILLIONS = 10
"""Million characters of a contract as JSON. Longer ones come from hundreds of parallel actions."""


class ContractsBackend(Struct, frozen=True):
    """Writes the contracts of the analysis ``contracts``."""

    name: str = "contracts"
    summary: str = "assume/guarantee contracts as JSON, SPIN formula and explanation"
    is_default: bool = True
    needs: tuple[str, ...] = ("contracts",)

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add three files for each contract, with the same trace."""
        contracts = graph.derived(Contract)
        names = assign_file_names(contract.component for contract in contracts)
        with Templates(self.name, options.templates) as templates:
            for contract in contracts:
                component = contract.component
                path = f"contracts/{names[component]}"
                writer = _Writer(graph, output, sink, templates, path, component)
                writer.write_contract(rename_ambiguous_literals(contract))


class _Writer(Struct, frozen=True):
    """Adds the files of one contract."""

    graph: Graph
    output: Output
    sink: Sink
    templates: Templates
    path: str
    """Path of the files without suffix."""
    component: str

    def write_contract(self, contract: Contract) -> None:
        trace = tuple(list_traced_elements(self.graph, contract))
        text = print_contract(contract)
        if len(text) > _MAX_MILLIONS * _MILLION:
            subject = self.graph.subject(self.graph[contract.origin])
            size = len(text) // _MILLION
            self.sink.report(
                TOO_LONG, subject, component=contract.component, size=size, limit=_MAX_MILLIONS
            )
            return
        self._add(".contract.json", text, trace)
        self._add_spin(contract, trace)
        self._add_page(contract, trace)

    def _add(self, suffix: str, content: str, trace: tuple[str, ...]) -> None:
        path = f"{self.path}{suffix}"
        self.output.add(path, content, trace, "contracts", name=self.component)

    def _add_spin(self, contract: Contract, trace: tuple[str, ...]) -> None:
        try:
            self._add(".spin.ltl", print_spin(contract), trace)
        except TooLargeError:
            subject = self.graph.subject(self.graph[contract.origin])
            file = f"{self.path}.spin.ltl"
            self.sink.report(TOO_LARGE, subject, component=contract.component, file=file)

    def _add_page(self, contract: Contract, trace: tuple[str, ...]) -> None:
        try:
            self._add(".md", print_page(self.graph, contract, self.templates), trace)
        except TemplateError as fault:
            self.sink.report(BAD_TEMPLATE, Subject("contract.md.j2"), fault=fault)


def list_traced_elements(graph: Graph, contract: Contract) -> list[str]:
    """Return the ids of the elements from which a contract is derived.

    These are the behaviour with all its parts, the constraints on its owner, and the origins of
    variables and conjuncts. An error in any of them may make the contract incomplete.
    """
    behaviour = graph[contract.origin]
    ids = [element.id for element in graph.subtree(behaviour)]
    owner = graph.owner(behaviour)
    if owner is not None:
        candidates = [*graph.owned(owner), *graph.sources(owner, Edge.REFERENCES)]
        ids += [element.id for element in candidates if element.kind is Kind.CONSTRAINT]
    origins = dict.fromkeys(variable.origin for variable in contract.variables)
    conjuncts = contract.assumptions + contract.guarantees
    origins |= dict.fromkeys(conjunct.origin for conjunct in conjuncts)
    return [*ids, *(id for id in origins if id in graph)]


BACKEND = ContractsBackend()
