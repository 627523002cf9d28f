"""Back ends that write contracts in the formats of other tools (``logic.formats``).

``chase``, ``gr1c``, ``promela``, ``slugs``, ``smv``, ``spot`` and ``tlsf`` are the targets of
``--emit``. ``promela`` and ``smv`` describe the behaviour as a model and check the requirements on
it; the other formats have the contract as a formula.
"""

from collections.abc import Callable, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import list_traced_elements
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Graph
from sysmlc.logic import formats
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.formats import NotExpressibleError
from sysmlc.logic.formula import variable_names
from sysmlc.logic.printing import print_formula
from sysmlc.support.output import Output, assign_file_names
from sysmlc.support.program_text import format_comment

NOT_EXPRESSIBLE = rule(
    "SM590",
    "contract-not-expressible",
    Severity.WARNING,
    "the contract of '{component}' is not written for {form}: the format cannot "
    "express {what}, because {reason}",
    help="emit a format for general LTL (contracts, spot, tlsf), or state the "
    "requirement as a property pattern",
)

_SUFFIX = ".requirements"
"""End of the name of a contract whose requirements a behaviour has to satisfy."""


class ContractFormatBackend(Struct, frozen=True):
    """Writes every contract in one or more formats of one tool."""

    name: str
    summary: str
    formats: tuple[tuple[str, str], ...]
    """Name of each format, and the suffix of its files."""
    split: Callable[[str], dict[str, str]] | None = None
    """Distributes the text of a format to several files, which are returned by suffix."""
    comment: str = ""
    """Spelling of a comment with text ``{}``, for formats that describe the behaviour itself."""
    is_default: bool = False
    needs: tuple[str, ...] = ("contracts",)

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add the files of each contract; report contracts that a format cannot express."""
        contracts = graph.derived(Contract)
        names = assign_file_names(contract.component for contract in contracts)
        behaviours = {
            behaviour.contract.component: behaviour
            for behaviour in graph.derived(ComponentBehaviour)
            if self.comment
        }
        for contract in contracts:
            trace = tuple(list_traced_elements(graph, contract))
            notes = ""
            behaviour = _find_behaviour(contract, behaviours)
            if behaviour is not None:
                notes = "".join(map(self._print_gap, behaviour.gaps.values()))
                contract = add_behaviour(contract, behaviour)
            for format_name, suffix in self.formats:
                try:
                    text = formats.write(contract, format_name)
                except NotExpressibleError as error:
                    _report_not_expressible(graph, contract, format_name, error, sink)
                    continue
                texts = self.split(text) if self.split else {suffix: text}
                for file_suffix, file_text in texts.items():
                    component = contract.component
                    path = f"contracts/{names[component]}{file_suffix}"
                    output.add(path, notes + file_text, trace, self.name, name=component)

    def _print_gap(self, reason: str) -> str:
        text = format_comment(f"not described, so that a violation may be none: {reason}")
        return f"{self.comment.format(text)}\n"


def _find_behaviour(
    contract: Contract, behaviours: Mapping[str, ComponentBehaviour]
) -> ComponentBehaviour | None:
    """Return the behaviour that has to satisfy a contract of requirements, or None."""
    component = contract.component.removesuffix(_SUFFIX)
    behaviour = behaviours.get(component)
    is_of_requirements = component != contract.component or (
        behaviour is not None and behaviour.is_of_parts
    )
    return behaviour if is_of_requirements else None


def add_behaviour(requirements: Contract, behaviour: ComponentBehaviour) -> Contract:
    """Return the steps of a behaviour, its recurring assumptions, and the requirements on it."""
    contract = behaviour.contract
    names = {variable.name for variable in contract.variables}
    added = (variable for variable in requirements.variables if variable.name not in names)
    assumed = (
        conjunct
        for conjunct in requirements.assumptions
        # Something that is not described decides the initial value of such a variable.
        if not conjunct.is_derived
        or behaviour.gaps.keys().isdisjoint(variable_names(conjunct.formula))
    )
    steps = (
        conjunct
        for conjunct in contract.guarantees
        if conjunct.is_derived and conjunct.class_ in (Class.INIT, Class.SAFETY)
    )
    endings = (conjunct for conjunct in contract.assumptions if conjunct.is_derived)
    return replace(
        requirements,
        variables=(*contract.variables, *added),
        assumptions=(*endings, *assumed),
        guarantees=(*steps, *requirements.guarantees),
    )


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
PROMELA = ContractFormatBackend(
    "promela",
    "behaviours with their requirements for SPIN (.pml)",
    (("promela", ".pml"),),
    comment="/* {} */",
)
SMV = ContractFormatBackend(
    "smv",
    "behaviours with their requirements for NuSMV and nuXmv (.smv)",
    (("smv", ".smv"),),
    comment="-- {}",
)
SPOT = ContractFormatBackend(
    "spot", "contracts for Spot (.spot.ltl, .spot.part)", (("spot", ".spot.ltl"),), _split_spot
)
TLSF = ContractFormatBackend("tlsf", "contracts for LTL synthesis (TLSF)", (("tlsf", ".tlsf"),))
