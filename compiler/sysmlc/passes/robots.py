"""Pass ``robots``: studies of robots on floors, with the contracts that the thesis writes by hand.

What specialises ``Floors::Floor`` has contracts of the whole system, of its environment, of each
robot and of the mission (MOOD4I thesis, chapter 4).
"""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, Kind
from sysmlc.logic.contract import Contract
from sysmlc.robots.contracts import study_contracts
from sysmlc.robots.floor_reader import read_studies
from sysmlc.robots.study import Study


class Robots(Struct, frozen=True):
    """Reads floors and adds their contracts to those of behaviours and requirements."""

    name: ClassVar[str] = "robots"
    after: ClassVar[tuple[str, ...]] = ("contracts",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store a Study for each floor, and its contracts beside the others."""
        # Hardly any model has one: the rest is not even imported.
        if not any(one.name == "Floors" for one in graph.of_kind(Kind.PACKAGE)):
            return

        found = list(read_studies(graph, sink))
        made = [contract for study in found for contract in study_contracts(study)]
        names = {one.component for one in made}
        others = (one for one in graph.derived(Contract) if one.component not in names)
        graph.store(Study, found)
        graph.store(Contract, sorted([*others, *made], key=lambda one: one.component))
