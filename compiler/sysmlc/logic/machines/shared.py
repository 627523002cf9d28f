"""Features that a state machine writes and others write, too: its contract does not follow them."""

from msgspec import Struct

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir import Element, Graph
from sysmlc.logic.samples import arrow, machine
from sysmlc.logic.writers import Writers


def _beside(body: str) -> str:
    """A machine that sets ``ready``, and what else its owner does."""
    made = machine(arrow("a", "b", "start", effect="ready := true"))
    beside = f'    Activity w "fill" subkind="opaque" body="{body}"\n'
    return made.replace("    StateMachine", f"{beside}    StateMachine", 1)


SHARED = rule(
    "SM546",
    "others-write-it-too",
    Severity.INFO,
    "the contract of '{machine}' leaves '{name}' to the environment and shows '{text}' as output "
    "'{variable}': '{writer}' writes it too",
    why="A contract says of what a component writes that it keeps its value else. That is not so "
    "where another behaviour writes it: two such contracts would contradict each other.",
    help="let one behaviour alone write it, or say in a requirement what becomes of it",
    wrong=_beside("ready := false"),
    right=_beside("openGate()"),
)


class Sharing(Struct, frozen=True):
    """Who else writes what a state machine writes."""

    graph: Graph
    machine: Element
    writers: Writers | None = None
    """None: it alone is looked at."""

    def other(self, feature: Element) -> Element | None:
        """What writes the feature beside the machine."""
        return None if self.writers is None else self.writers.beside(feature, self.machine)
