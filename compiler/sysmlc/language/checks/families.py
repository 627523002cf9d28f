"""Which checks are made for which metaclass."""

from collections.abc import Iterable

from sysmlc.language.checks import combining, conformance, kinds
from sysmlc.language.checks.found import Check

_FAMILIES: tuple[Iterable[tuple[frozenset[str], Check]], ...] = (
    conformance.CHECKS,
    combining.CHECKS,
    kinds.CHECKS,
)


def _by_kind() -> dict[str, tuple[Check, ...]]:
    found: dict[str, tuple[Check, ...]] = {}
    for family in _FAMILIES:
        for metaclasses, check in family:
            for kind in sorted(metaclasses):
                found[kind] = (*found.get(kind, ()), check)
    return found


BY_KIND = _by_kind()
"""The checks of each metaclass, in the order of the families."""
