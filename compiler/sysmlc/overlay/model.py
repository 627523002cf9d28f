"""The model of an overlay: its entries, with their positions in the file."""

from typing import NamedTuple

from msgspec import Struct

from sysmlc.diagnostics import Place, Subject
from sysmlc.documents import Spot
from sysmlc.ir import AttrValue


class Term(NamedTuple):
    """A text that names an element: a name, an id, a path or ``file#qualified name``."""

    text: str
    spot: Spot


class Key(NamedTuple):
    """The element that an entry is about.

    ``text`` is its id or path. ``path`` finds the element if no element has that id any more.
    """

    text: str
    path: str
    spot: Spot


class ItemEntry(Struct, frozen=True):
    """An item type. A key that is a plain name defines a new block."""

    key: Key
    domain: str
    description: str
    specializes: tuple[Term, ...]


class PortEntry(Struct, frozen=True):
    """The direction and type of a port.

    Empty and None mean that the overlay does not change the direction or the type.
    """

    key: Key
    direction: str
    type: Term | None


class FlowEntry(Struct, frozen=True):
    """An item that flows over a connector: to one end, from one end, or in both directions."""

    item: Term
    source: Term | None
    target: Term | None
    is_both: bool
    spot: Spot


class ConnectorEntry(Struct, frozen=True):
    """The item flows of a connector."""

    key: Key
    flows: tuple[FlowEntry, ...]


class ParameterEntry(Struct, frozen=True):
    """A parameter of an operation."""

    name: Term
    type: Term | None
    direction: str


class OperationEntry(Struct, frozen=True):
    """An operation of a block.

    ``method`` is the behaviour that implements it. If ``parameters`` is None, the operation has the
    parameters of its method.
    """

    name: Term
    parameters: tuple[ParameterEntry, ...] | None
    method: Term | None
    description: str


class ValueEntry(Struct, frozen=True):
    """A value property, for state of the block that the plant does not describe."""

    name: Term
    type: Term | None
    default: AttrValue


class BlockEntry(Struct, frozen=True):
    """The additions to a block.

    ``behavior`` becomes its classifier behaviour. ``calls`` are pairs of a call operation action in
    the behaviours of the block and the operation that it calls.
    """

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
    """The content of an overlay.

    Entries are sorted, so that their order in the file has no effect on outputs. ``package`` is the
    path of the package for new item types.
    """

    file: str
    package: str
    spot: Spot
    items: tuple[ItemEntry, ...]
    ports: tuple[PortEntry, ...]
    connectors: tuple[ConnectorEntry, ...]
    blocks: tuple[BlockEntry, ...]
    allocations: tuple[Allocation, ...]

    def subject(self, term: Term | Key, about: str = "") -> Subject:
        """Return the subject of a diagnostic at a text of the overlay.

        *about* is the id of the element that the diagnostic is about, if there is one.
        """
        return Subject(term.text, about, place_of(self.file, term.spot))


class Change(Struct, frozen=True):
    """A fact that an overlay states about an element of the model, without adding an element.

    ``fact`` completes a sentence: "the direction 'in'".
    """

    element_id: str
    fact: str
    place: Place


def place_of(file: str, spot: Spot) -> Place:
    """Return a position in a file as the place of a diagnostic."""
    return Place(file, line=spot.line, column=spot.column)
