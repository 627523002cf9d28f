"""Analysis ``robots``: studies of robots on floors, with the contracts of the MOOD4I thesis.

A block that specialises ``Floors::Floor`` has contracts of the whole system, of its environment, of
each robot and of the mission (chapter 4).
"""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic.contract import GivenContract
from sysmlc.robots.floor_reader import read_studies
from sysmlc.robots.joint_contracts import study_contracts
from sysmlc.robots.study import Study


class Robots(Struct, frozen=True):
    """Read the floors of a unit that uses the library ``Floors``, and derive their contracts."""

    name: ClassVar[str] = "robots"

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store a Study for each floor, and the contracts of all studies."""
        studies = list(read_studies(graph, sink))
        graph.store(Study, studies)
        contracts = [contract for study in studies for contract in study_contracts(study)]
        graph.store(GivenContract, map(GivenContract, contracts))
