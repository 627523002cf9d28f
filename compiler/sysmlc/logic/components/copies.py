"""Performances of a component and the copies of activities in them, as plain values.

Each call has a copy of the activity that it calls, with names and variables of its own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element
from sysmlc.logic.activities.token_nodes import Guard, Write
from sysmlc.logic.components.machines import PlacedMachine
from sysmlc.logic.components.objects import ComponentObject, Slot
from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Formula, rename_variables
from sysmlc.logic.machines.machine import Vertex

COPY_SEPARATOR = "\x1e"
"""Separates the id of a copy from the id of an element in it."""


class Caller(Struct, frozen=True):
    """Where an activity is performed: the object, the call action if any, and the names so far."""

    owner: ComponentObject
    names: tuple[str, ...]
    prefix: str = ""
    """Prefix of the variables; empty for the behaviour whose contract the component has."""
    call: Element | None = None
    parent: "Copy | None" = None


@dataclass(slots=True)
class Copy:
    """One copy of an activity in the token graph: its root node, and its names for variables."""

    id: str
    activity: Element
    caller: Caller
    variables: dict[str, str] = field(default_factory=dict)
    """Variables of the component by the names in the activity's own token graph."""
    parameters: dict[str, Variable] = field(default_factory=dict)
    """Variables of the parameters by name."""

    @property
    def root(self) -> str:
        """The node of the performance that contains the copy."""
        return COPY_SEPARATOR.join(self.id.split(COPY_SEPARATOR)[:2])

    def rename_guard(self, guard: Guard | None) -> Guard | None:
        """Return a guard of the activity in the variables of the component."""
        if guard is None or guard.condition is None:
            return guard
        return replace(guard, condition=rename_variables(guard.condition, self.variables))

    def rename_write(self, write: Write, ids: Mapping[str, str]) -> Write:
        """Return a write of the activity in the variables of the component.

        *ids* are the nodes of the copy by those of the activity.
        """
        values = tuple(
            (rename_variables(condition, self.variables), rename_variables(value, self.variables))
            for condition, value in write.values
        )
        return replace(write, node=ids[write.node], values=values)


class PlacedWrite(Struct, frozen=True):
    """A write of a slot by a node of a performance; ``root`` is the id of the performance."""

    slot: Slot
    node: str
    values: tuple[tuple[Formula, Formula], ...]
    origin: str
    root: str


@dataclass(slots=True)
class Root:
    """A performance: its node, when it starts and stops, and whether it runs in the first step."""

    id: str
    start: Formula
    stop: Formula
    first: Formula
    machine: PlacedMachine | None = None
    state: Vertex | None = None
    """The state whose entry, do or exit behaviour it is."""
    after: str = ""
    """The entry behaviour after which it starts, if that takes time."""
    service: str = ""
    """The input with which the environment starts it."""
    role: Edge = Edge.DO
    """Whether it is the entry, do or exit behaviour of its state."""
    over: str = ""
    """The variable that its state uses to remember its end."""


def element_of_copy(node: str) -> str:
    """Return the id of the element of which a node of the token graph is a copy."""
    return node.rpartition(COPY_SEPARATOR)[2]
