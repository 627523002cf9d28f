"""Which checks are made for which metaclass, and which for which relation."""

from collections.abc import Callable, Iterable
from functools import lru_cache
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
from sysmlc.language.metaclasses import USAGES
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, make_subject

Reporter = Callable[[Model, Document, Node, Sink], None]
"""A check that reports what it finds itself."""
_Entry = TypeVar("_Entry")

_REPORTERS: tuple[tuple[frozenset[str], Reporter], ...] = (
    (typing.KINDS, typing.check),
    (DECLARED_TYPES, single.check),
    (USAGES, members.check),
    (USAGES, references.check),
    (USAGES, references.check_itself),
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


_MEMBERS: dict[object, frozenset[str]] = {
    single.check: single.MEMBERSHIPS,
    bounds.check_condition: bounds.MEMBERSHIPS,
    duplicates.check_inherited: duplicates.MEMBERSHIPS,
    evaluable.check_filter: evaluable.MEMBERSHIPS,
    passing.check_parameters: passing.MEMBERSHIPS,
}
"""Memberships: without a member that has one of them a check finds nothing."""
_RELATIONS: dict[object, frozenset[str]] = {
    typing.check: typing.RELATIONS,
    references.check: references.RELATIONS,
}
"""Kinds of relations: an element that has none of them passes a check."""
_OF_SEVERAL: frozenset[object] = frozenset({combining.check_multiplicity, duplicates.check})
"""Checks that compare members: they find nothing where there is one."""
_NOTHING: frozenset[str] = frozenset()


@lru_cache(maxsize=4096)
def _checks_for(
    kind: str,
    memberships: frozenset[str],
    related: tuple[str, ...],
    has_several: bool,
    is_variable: bool,
) -> tuple[tuple[Reporter, ...], tuple[Check, ...]]:
    """The checks that may find something in elements of a kind, by their members and relations."""

    def may_find(check: Reporter | Check) -> bool:
        if check in _MEMBERS:
            return not _MEMBERS[check].isdisjoint(memberships)
        if check in _RELATIONS:
            return not _RELATIONS[check].isdisjoint(related)
        if check in _OF_SEVERAL:
            return has_several
        return is_variable or check is not owned.check_variable

    by_relation = chain.from_iterable([BY_RELATION.get(one, ()) for one in related])
    checks = dict.fromkeys((*BY_KIND.get(kind, ()), *by_relation))
    return tuple(filter(may_find, REPORTERS.get(kind, ()))), tuple(filter(may_find, checks))


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report what the checks for the metaclass and the relations of ``node`` find."""
    members, relations = node.members, node.relations
    reporters, checks = _checks_for(
        node.kind,
        frozenset([one.membership for one in members]) if members else _NOTHING,
        tuple([one.kind for one in relations]) if relations else (),
        len(members) > 1,
        "isVariable" in node.attributes,
    )
    for reporter in reporters:
        reporter(model, document, node, sink)
    for one in checks:
        for found in one(model, node):
            place = make_subject(document, node, found.start)
            sink.report(found.rule, place, notes=(), help="", **found.facts)
