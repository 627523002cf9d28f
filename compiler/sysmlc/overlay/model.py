"""The model of an overlay: its entries, with their positions in the file."""

from typing import NamedTuple

from msgspec import Struct

from sysmlc.diagnostics import Place, Subject
from sysmlc.ir import AttrValue


class Spot(NamedTuple):
    """A position in a file: line and column from 1, and the byte offset from 0."""

    line: int = 1
    column: int = 1
    offset: int = 0


class Term(NamedTuple):
    """A word of the overlay: a name, an id, a path or ``file#qualified name``."""

    text: str
    spot: Spot


class Key(NamedTuple):
    """The subject of an entry: an id or a path, and the path that replaces an id that is gone."""

    text: str
    path: str
    spot: Spot


class ItemEntry(Struct, frozen=True):
    """An item type. A plain name makes a new block."""

    key: Key
    domain: str
    description: str
    specializes: tuple[Term, ...]


class PortEntry(Struct, frozen=True):
    """The direction and type of a port; empty and None where the model is left unchanged."""

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
    """An operation; ``parameters`` is None if those of its method count."""

    name: Term
    parameters: tuple[ParameterEntry, ...] | None
    method: Term | None
    description: str


class ValueEntry(Struct, frozen=True):
    """A value property, for parts of the state that a plant does not describe."""

    name: Term
    type: Term | None
    default: AttrValue


class BlockEntry(Struct, frozen=True):
    """The additions to a block."""

    key: Key
    specializes: tuple[Term, ...]
    values: tuple[ValueEntry, ...]
    operations: tuple[OperationEntry, ...]
    behavior: Term | None
    calls: tuple[tuple[Term, Term], ...]


class Allocation(Struct, frozen=True):
    """An allocation of one element of the model to another."""

    source: Term
    target: Term
    spot: Spot


class Refinement(Struct, frozen=True):
    """One overlay. The order of its entries does not depend on the file."""

    file: str
    package: str
    spot: Spot
    items: tuple[ItemEntry, ...]
    ports: tuple[PortEntry, ...]
    connectors: tuple[ConnectorEntry, ...]
    blocks: tuple[BlockEntry, ...]
    allocations: tuple[Allocation, ...]

    def subject(self, term: Term | Key, about: str = "") -> Subject:
        """Return a word of the overlay as the subject of a diagnostic on element *about*."""
        return Subject(term.text, about, place_of(self.file, term.spot))


def place_of(file: str, spot: Spot) -> Place:
    """Return the place of a position in a file."""
    return Place(file, line=spot.line, column=spot.column)
