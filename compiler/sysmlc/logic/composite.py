"""Blocks whose parts have contracts: the parts' contracts over shared variables, and their wiring.

Design section 7 (structure): the direction of ports decides ownership, connectors rename.
"""

from msgspec import Struct

from sysmlc.logic.contract import Conjunct, Contract


class Part(Struct, frozen=True):
    """A part with the contract of its type, in the variables of the whole.

    What two parts share has one name in both contracts; what only one knows is named behind the
    part (``gate.state``). ``origin`` is the id of the part.
    """

    name: str
    contract: Contract
    origin: str


class Composite(Struct, frozen=True):
    """A block with parts. ``whole`` is what it promises itself, in the same variables.

    ``wiring`` is what connectors make true and no renaming says, as that an event of the receiver
    occurs when the sender sends it; it restricts no part. ``crowding`` is what has to hold for
    nothing to be lost on the way, which nobody owes.
    """

    component: str
    origin: str
    parts: tuple[Part, ...]
    wiring: tuple[Conjunct, ...] = ()
    whole: Contract | None = None
    crowding: tuple[Conjunct, ...] = ()
