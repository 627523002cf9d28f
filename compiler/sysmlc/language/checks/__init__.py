"""Checks of a resolved model: the constraints of the specifications on well-formed models.

The tables below have the checks for each metaclass, and for each kind of relation.
"""

from collections.abc import Iterable
from functools import lru_cache
from itertools import chain

from sysmlc.diagnostics import Sink
from sysmlc.language.checks import (
    annotations,
    behaviors,
    conformance,
    connectors,
    duplicate_names,
    expressions,
    memberships,
    references,
    specializations,
)
from sysmlc.language.checks.findings import DECLARED_TYPES, Check
from sysmlc.language.metaclasses import USAGES
from sysmlc.language.names import TOO_DEEP, Model
from sysmlc.language.tree import Document, Node, make_subject
from sysmlc.support.interpreter import allow_recursion

_GENERALS = 1_000
"""Generals in a row for which the members of an element are checked."""


def check(model: Model, sink: Sink) -> None:
    """Report everything in the documents of the model that breaks a constraint."""
    # Inherited members are looked up by recursion along the generals.
    with allow_recursion(_GENERALS):
        for document in model.documents:
            for node in model.nodes(document):
                try:
                    check_node(model, document, node, sink)
                except RecursionError:
                    model.lookup.abandon()
                    name = node.name or node.kind
                    sink.report(TOO_DEEP, make_subject(document, node, -1), name=name)
                    # The lookup of further nodes would take as long, and fail in the same way.
                    return


# The order within each table is the order of the diagnostics about one node.
_CHECKS: tuple[tuple[frozenset[str], Check], ...] = (
    (specializations.TYPED_KINDS, specializations.check_types),
    (DECLARED_TYPES, memberships.check_own_members),
    (USAGES, memberships.check_member),
    (USAGES, references.check_references),
    (USAGES, references.check_usage),
    (references.REFERRING_KINDS, references.check_accessibility),
    *conformance.CHECKS,
    *specializations.CHECKS,
    *conformance.MULTIPLICITY_CHECKS,
    *expressions.CONDITION_CHECKS,
    *annotations.CHECKS,
    *memberships.SINGLE_MEMBER_CHECKS,
    *connectors.END_CHECKS,
    *memberships.CHECKS,
    *behaviors.STEP_CHECKS,
    *expressions.CHECKS,
    *duplicate_names.CHECKS,
    *connectors.BINDING_CHECKS,
    *behaviors.CALL_CHECKS,
)
_RELATION_CHECKS: tuple[tuple[frozenset[str], Check], ...] = (
    *conformance.BY_RELATION,
    *specializations.BY_RELATION,
    *connectors.BY_RELATION,
    *conformance.MULTIPLICITY_BY_RELATION,
)


def _group_by_key(
    entries: Iterable[tuple[frozenset[str], Check]],
) -> dict[str, tuple[Check, ...]]:
    groups: dict[str, tuple[Check, ...]] = {}
    for keys, check in entries:
        for key in sorted(keys):
            groups[key] = (*groups.get(key, ()), check)
    return groups


BY_KIND = _group_by_key(_CHECKS)
BY_RELATION = _group_by_key(_RELATION_CHECKS)
"""The checks for each metaclass and for each kind of relation, in the order of the tables."""

# Most checks cannot find anything in most nodes. These conditions are cheaper than the checks.
_REQUIRED_MEMBERSHIPS: dict[object, frozenset[str]] = {
    memberships.check_own_members: memberships.SINGLE_MEMBERSHIPS,
    expressions.check_condition: expressions.CONDITION_MEMBERSHIPS,
    duplicate_names.check_inherited: duplicate_names.MEMBERSHIPS,
    expressions.check_filter: expressions.FILTER_MEMBERSHIPS,
    behaviors.check_parameters: behaviors.MEMBERSHIPS,
}
"""Checks that find nothing in a node without a member of one of these memberships."""
_REQUIRED_RELATIONS: dict[object, frozenset[str]] = {
    specializations.check_types: specializations.TYPING_RELATIONS,
    references.check_references: references.RELATIONS,
}
"""Checks that find nothing in a node without a relation of one of these kinds."""
_COMPARING_MEMBERS: frozenset[object] = frozenset(
    {specializations.check_multiplicity, duplicate_names.check_names}
)
"""Checks that find nothing in a node with one member."""
_NO_MEMBERSHIPS: frozenset[str] = frozenset()


@lru_cache(maxsize=4096)
def _select_checks(
    kind: str,
    memberships_of_members: frozenset[str],
    relation_kinds: tuple[str, ...],
    has_several_members: bool,
    is_variable: bool,
) -> tuple[Check, ...]:
    """Return the checks that may find something in a node, by its kind, members and relations."""

    def may_find(check: Check) -> bool:
        if check in _REQUIRED_MEMBERSHIPS:
            return not _REQUIRED_MEMBERSHIPS[check].isdisjoint(memberships_of_members)
        if check in _REQUIRED_RELATIONS:
            return not _REQUIRED_RELATIONS[check].isdisjoint(relation_kinds)
        if check in _COMPARING_MEMBERS:
            return has_several_members
        return is_variable or check is not memberships.check_variable

    by_relation = chain.from_iterable([BY_RELATION.get(kind, ()) for kind in relation_kinds])
    checks = dict.fromkeys((*BY_KIND.get(kind, ()), *by_relation))
    return tuple(filter(may_find, checks))


def check_node(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report the findings of the checks for the metaclass and the relations of ``node``."""
    members, relations = node.members, node.relations
    checks = _select_checks(
        node.kind,
        frozenset([member.membership for member in members]) if members else _NO_MEMBERSHIPS,
        tuple([relation.kind for relation in relations]) if relations else (),
        len(members) > 1,
        "isVariable" in node.attributes,
    )
    for check in checks:
        for finding in check(model, node):
            subject = make_subject(document, finding.node or node, finding.start)
            if not sink.has_reported(finding.unless, subject.place):
                sink.report(
                    finding.rule,
                    subject,
                    notes=(),
                    help=finding.help,
                    cause="",
                    **finding.facts,
                )
