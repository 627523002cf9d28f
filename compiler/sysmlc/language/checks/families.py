"""Which checks are made for which metaclass."""

from collections.abc import Iterable

from sysmlc.diagnostics import Sink
from sysmlc.language.checks import (
    bounds,
    cases,
    combining,
    conformance,
    crossing,
    ends,
    evaluable,
    expressions,
    kinds,
    metadata,
    owned,
    steps,
)
from sysmlc.language.checks.found import Check
from sysmlc.language.names import Model
from sysmlc.language.names.unresolved import subject
from sysmlc.language.tree import Document, Node

_FAMILIES: tuple[Iterable[tuple[frozenset[str], Check]], ...] = (
    conformance.CHECKS,
    combining.CHECKS,
    kinds.CHECKS,
    bounds.CHECKS,
    evaluable.CHECKS,
    metadata.CHECKS,
    cases.CHECKS,
    ends.CHECKS,
    owned.CHECKS,
    steps.CHECKS,
    expressions.CHECKS,
    crossing.CHECKS,
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


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report what the checks of the metaclass of ``node`` find."""
    for one in BY_KIND.get(node.kind, ()):
        for found in one(model, node):
            place = subject(document, node, found.start)
            sink.report(found.rule, place, notes=(), help="", **found.facts)
