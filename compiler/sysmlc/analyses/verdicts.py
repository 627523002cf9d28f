"""Analysis ``verdicts``: whether contracts are realizable, behaviours satisfy requirements, and
the parts of blocks their contracts.
"""

from functools import partial
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.ir import Graph
from sysmlc.ir.query.libraries import find_unused_library_elements
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.composition.derivation import compose_blocks, list_checked_composites
from sysmlc.logic.contract import Composite, Contract, locate_origin
from sysmlc.support.suggestions import did_you_mean
from sysmlc.synthesis.bdd.limits import Limits
from sysmlc.synthesis.composition_check import CompositionVerdict, check_compositions
from sysmlc.synthesis.contract_checks import CheckedContract, check_contracts
from sysmlc.synthesis.decision import Options


class ContractChecks(Struct, frozen=True):
    """The verdicts on the contracts of a model, and the findings that explain them."""

    contracts: tuple[CheckedContract, ...]
    """The verdict on each contract by itself, and on the requirements of its component."""
    compositions: tuple[CompositionVerdict, ...]
    """The verdict on the parts of each block."""
    diagnostics: tuple[Diagnostic, ...]


class UnknownComponentError(ValueError):
    """The model has no component with the selected name."""


class Verdicts(Struct, frozen=True):
    """Decide contracts, each within the limits of *options*.

    *component* selects one component by its qualified name; empty stands for all but those of
    libraries that the model does not use.
    """

    options: Options = Options("", Limits(seconds=10.0))
    component: str = ""

    name: ClassVar[str] = "verdicts"

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the ContractChecks. Raises UnknownComponentError."""
        contracts, findings = graph.derived(Contract), sink.subset(())
        behaviours = {b.contract.component: b for b in graph.derived(ComponentBehaviour)}
        composites = list_checked_composites(compose_blocks(graph, contracts, findings), behaviours)
        names = {contract.component for contract in contracts}
        names |= {composite.component for composite in composites}
        if self.component and self.component not in names:
            advice = did_you_mean(self.component, names)
            raise UnknownComponentError(f"no component '{self.component}'; {advice}")
        unused = frozenset[str]() if self.component else find_unused_library_elements(graph)

        def is_selected(item: Contract | Composite) -> bool:
            return self.component in ("", item.component) and item.origin not in unused

        place, options = partial(locate_origin, graph), self.options
        chosen = filter(is_selected, contracts)
        alone = tuple(check_contracts(chosen, contracts, place, findings, options, behaviours))
        chosen_blocks = filter(is_selected, composites)
        together = tuple(check_compositions(chosen_blocks, place, findings, options))
        graph.store(ContractChecks, [ContractChecks(alone, together, tuple(findings))])
