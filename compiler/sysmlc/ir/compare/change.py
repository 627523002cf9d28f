"""The difference of two models as a value, in the words of a reviewer."""

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
    """A reference to an element of one of the models: id, qualified name and position."""

    id: str
    qualified_name: str
    file: str = ""
    ordinal: int = -1


class Change(Struct, frozen=True):
    """One difference of the element ``name``, whose owner has the qualified name ``owner``.

    ``kind`` is the role or kind of the element in words, ``aspect`` the attribute or relation that
    differs; ``before`` and ``after`` are texts, empty for an absent value. ``contents`` is the
    number of elements below an added or removed element. ``old`` or ``new`` is None when only one
    model has the element.
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
