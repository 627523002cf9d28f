"""What a difference of two models is, in the words of who reviews a new export."""

from enum import StrEnum

from msgspec import Struct


class What(StrEnum):
    """What happened to an element."""

    ADDED = "added"
    REMOVED = "removed"
    RENAMED = "renamed"
    RETYPED = "retyped"
    REWIRED = "rewired"
    MOVED = "moved"
    REORDERED = "reordered"
    CHANGED = "changed"


class Ref(Struct, frozen=True):
    """An element of one of the two models: its id, whole name, and place in its file."""

    id: str
    qualified_name: str
    file: str = ""
    ordinal: int = -1


class Change(Struct, frozen=True):
    """One difference, of the element ``name`` that ``owner`` (a qualified name) owns.

    ``kind`` is the element's role or kind in words, ``aspect`` what of it changed; ``before``
    and ``after`` are texts, empty where there is none. ``contents`` counts what was added or
    removed together with the element, below it. ``old`` or ``new`` is None when it is in one
    model only.
    """

    what: What
    owner: str
    name: str
    kind: str
    aspect: str = ""
    before: str = ""
    after: str = ""
    contents: int = 0
    old: Ref | None = None
    new: Ref | None = None
