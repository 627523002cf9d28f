"""Which checks are made for which metaclass, and which for which relation."""

from collections.abc import Callable, Iterable
from typing import TypeVar

from sysmlc.diagnostics import Sink
from sysmlc.language.checks import (
    access,
    binding,
    bounds,
    cases,
    combining,
    conformance,
    crossing,
    duplicates,
    ends,
    evaluable,
    expressions,
    kinds,
    members,
    metadata,
    multiplicity,
    owned,
    passing,
    references,
    single,
    steps,
    typing,
)
from sysmlc.language.checks.found import DECLARED_TYPES, Check
from sysmlc.language.composition import USAGES
from sysmlc.language.names import Model
from sysmlc.language.names.unresolved import subject
from sysmlc.language.tree import Document, Node

Reporter = Callable[[Model, Document, Node, Sink], None]
"""A check that reports what it finds itself."""
_Entry = TypeVar("_Entry")

_REPORTERS: tuple[tuple[frozenset[str], Reporter], ...] = (
    (typing.KINDS, typing.check),
    (DECLARED_TYPES, single.check),
    (USAGES, members.check),
    (USAGES, references.check),
    (access.KINDS, access.check),
)
_CHECKS: tuple[tuple[frozenset[str], Check], ...] = (
    *conformance.CHECKS,
    *combining.CHECKS,
    *bounds.CHECKS,
    *evaluable.CHECKS,
    *metadata.CHECKS,
    *cases.CHECKS,
    *ends.CHECKS,
    *owned.CHECKS,
    *steps.CHECKS,
    *expressions.CHECKS,
    *duplicates.CHECKS,
    *binding.CHECKS,
    *passing.CHECKS,
)
_RELATED: tuple[tuple[frozenset[str], Check], ...] = (
    *conformance.BY_RELATION,
    *combining.BY_RELATION,
    *kinds.BY_RELATION,
    *crossing.BY_RELATION,
    *multiplicity.BY_RELATION,
)


def _by_key(entries: Iterable[tuple[frozenset[str], _Entry]]) -> dict[str, tuple[_Entry, ...]]:
    found: dict[str, tuple[_Entry, ...]] = {}
    for keys, check in entries:
        for key in sorted(keys):
            found[key] = (*found.get(key, ()), check)
    return found


REPORTERS = _by_key(_REPORTERS)
BY_KIND = _by_key(_CHECKS)
BY_RELATION = _by_key(_RELATED)
"""The checks for each metaclass and for each kind of relation, in the order of the families."""


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report what the checks for the metaclass and the relations of ``node`` find."""
    for reporter in REPORTERS.get(node.kind, ()):
        reporter(model, document, node, sink)
    checks = BY_KIND.get(node.kind, ())
    for relation in node.relations:
        if relation.kind in BY_RELATION:
            checks = (*checks, *BY_RELATION[relation.kind])
    for one in dict.fromkeys(checks):
        for found in one(model, node):
            place = subject(document, node, found.start)
            sink.report(found.rule, place, notes=(), help="", **found.facts)
