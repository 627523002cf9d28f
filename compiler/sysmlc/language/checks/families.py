"""Which checks are made for which metaclass, and which for which relation."""

from collections.abc import Callable, Iterable
from itertools import chain
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


def _without_members(checks: dict[str, tuple[_Entry, ...]]) -> dict[str, tuple[_Entry, ...]]:
    return {
        key: tuple([one for one in some if one not in _OF_MEMBERS]) for key, some in checks.items()
    }


_OF_MEMBERS: frozenset[object] = frozenset(
    {
        combining.check_multiplicity,
        duplicates.check,
        duplicates.check_inherited,
        passing.check_parameters,
        single.check,
    }
)
"""Checks that find nothing where an element has no members."""
_REPORTERS_OF_LEAVES = _without_members(REPORTERS)
_CHECKS_OF_LEAVES = _without_members(BY_KIND)


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report what the checks for the metaclass and the relations of ``node`` find."""
    kind, has_members = node.kind, bool(node.members)
    for reporter in (REPORTERS if has_members else _REPORTERS_OF_LEAVES).get(kind, ()):
        reporter(model, document, node, sink)
    checks = (BY_KIND if has_members else _CHECKS_OF_LEAVES).get(kind, ())
    related = [BY_RELATION[r.kind] for r in node.relations if r.kind in BY_RELATION]
    if related:
        checks = tuple(dict.fromkeys((*checks, *chain.from_iterable(related))))
    for one in checks:
        for found in one(model, node):
            place = subject(document, node, found.start)
            sink.report(found.rule, place, notes=(), help="", **found.facts)
