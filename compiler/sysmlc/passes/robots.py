"""Pass ``robots``: studies of robots on floors, with the contracts of the MOOD4I thesis.

A block that specialises ``Floors::Floor`` has contracts of the whole system, of its environment, of
each robot and of the mission (chapter 4).
"""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, Kind
from sysmlc.logic.contract import Contract
from sysmlc.robots.floor_reader import read_studies
from sysmlc.robots.joint_contracts import study_contracts
from sysmlc.robots.study import Study


class Robots(Struct, frozen=True):
    """Read floors and add their contracts to those of behaviours and requirements."""

    name: ClassVar[str] = "robots"
    after: ClassVar[tuple[str, ...]] = ("contracts",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store a Study for each floor, and add its contracts to the others."""
        if not any(package.name == "Floors" for package in graph.of_kind(Kind.PACKAGE)):
            return
        floor_studies = list(read_studies(graph, sink))
        contracts = [contract for study in floor_studies for contract in study_contracts(study)]
        names = {contract.component for contract in contracts}
        # The contract of a study replaces a derived contract of the same component.
        contracts += [
            contract for contract in graph.derived(Contract) if contract.component not in names
        ]
        graph.store(Study, floor_studies)
        graph.store(Contract, sorted(contracts, key=lambda contract: contract.component))
