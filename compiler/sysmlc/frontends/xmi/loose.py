"""References that nobody follows, as readers note them while they walk."""

from typing import NamedTuple

Names = tuple[str, ...] | frozenset[str]


class Loose(NamedTuple):
    """Ids that a feature names and that its own file does not have."""

    holder: str
    """Id of the element that has the feature, or the nearest one around it."""
    ordinal: int
    feature: str
    targets: list[str]
    is_said_elsewhere: bool
