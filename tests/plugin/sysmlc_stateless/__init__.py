"""Pass ``statelessness``: a rule about state machines without states."""

from pathlib import Path
from typing import ClassVar

from msgspec import Struct

from sysmlc import Graph, Kind, Severity, Sink, rule

STATELESS_MACHINE = rule(
    "ACME002",
    "stateless-machine",
    Severity.WARNING,
    "state machine '{machine}' has no states",
    help="draw the states, or remove the state machine",
    page=Path(__file__).with_name("ACME002.md").read_text(encoding="utf-8"),
)


class Statelessness(Struct, frozen=True):
    """Report state machines without states. The pass changes nothing."""

    name: ClassVar[str] = "statelessness"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        """Report each state machine without a state."""
        for machine in graph.of_kind(Kind.STATE_MACHINE):
            if all(below.kind is not Kind.STATE for below in graph.subtree(machine)):
                sink.report(STATELESS_MACHINE, graph.subject(machine), machine=machine.name)


PASS = Statelessness()
