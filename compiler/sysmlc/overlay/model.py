"""What one overlay says, as values with the places where it says it."""

from typing import NamedTuple

from msgspec import Struct

from sysmlc.diagnostics import Place, Subject
from sysmlc.ir import AttrValue


class Spot(NamedTuple):
    """Where something stands: line and column from 1, and the byte from 0."""

    line: int = 1
    column: int = 1
    offset: int = 0


class Term(NamedTuple):
    """A word of the overlay: a name, an id, a path or ``file#qualified name``."""

    text: str
    spot: Spot


class Key(NamedTuple):
    """What an entry is about: an id or a path, and the path that helps when the id is gone."""

    text: str
    path: str
    spot: Spot


class ItemEntry(Struct, frozen=True):
    """A kind of thing that flows. A plain name makes a new block."""

    key: Key
    domain: str
    description: str
    specializes: tuple[Term, ...]


class PortEntry(Struct, frozen=True):
    """What the author says of a port; empty and None where the model is left as it is."""

    key: Key
    direction: str
    type: Term | None


class FlowEntry(Struct, frozen=True):
    """An item that flows over a connector, to one end, from one end, or both ways."""

    item: Term
    source: Term | None
    target: Term | None
    is_both: bool
    spot: Spot


class ConnectorEntry(Struct, frozen=True):
    """Item flows of a connector."""

    key: Key
    flows: tuple[FlowEntry, ...]


class ParameterEntry(Struct, frozen=True):
    """A parameter of an operation, in its place among the others."""

    name: Term
    type: Term | None
    direction: str


class OperationEntry(Struct, frozen=True):
    """An operation; ``parameters`` is None when those of its method count."""

    name: Term
    parameters: tuple[ParameterEntry, ...] | None
    method: Term | None
    description: str


class ValueEntry(Struct, frozen=True):
    """A value property, for what a plant does not say of its state."""

    name: Term
    type: Term | None
    default: AttrValue


class BlockEntry(Struct, frozen=True):
    """What the author adds to a block."""

    key: Key
    specializes: tuple[Term, ...]
    values: tuple[ValueEntry, ...]
    operations: tuple[OperationEntry, ...]
    behavior: Term | None
    calls: tuple[tuple[Term, Term], ...]


class Allocation(Struct, frozen=True):
    """Something of the model that is allocated to something else of it."""

    source: Term
    target: Term
    spot: Spot


class Refinement(Struct, frozen=True):
    """One overlay. Entries are in an order of their own, whatever order the file has."""

    file: str
    package: str
    spot: Spot
    items: tuple[ItemEntry, ...]
    ports: tuple[PortEntry, ...]
    connectors: tuple[ConnectorEntry, ...]
    blocks: tuple[BlockEntry, ...]
    allocations: tuple[Allocation, ...]

    def subject(self, term: Term | Key, about: str = "") -> Subject:
        """A word of the overlay as the subject of a finding about the element of this id."""
        return Subject(term.text, about, place_of(self.file, term.spot))


def place_of(file: str, spot: Spot) -> Place:
    """The place of a spot in a file."""
    return Place(file, line=spot.line, column=spot.column)
