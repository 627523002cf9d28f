"""Definitions specialise definitions that can have the same instances (KerML 8.3.4)."""

from collections.abc import Iterator
from typing import NamedTuple

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of, written
from sysmlc.language.checks.member_rules import VARIATION_OF_VARIATION
from sysmlc.language.metaclasses import describe_kind, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

OTHER_KIND = rule(
    "SM259",
    "specialises-other-kind",
    Severity.ERROR,
    "'{name}', {kind}, cannot specialise '{general}', {found}",
    help="specialise {wanted}, or have a feature of that type",
)

_DATA = kinds_of("DataType")
_CLASSES = kinds_of("Class")
_LINKS = kinds_of("Association")
_STRUCTURES = kinds_of("Structure")
_BEHAVIORS = kinds_of("Behavior")
_SUBCLASSIFICATION = frozenset({"Subclassification"})


class Apart(NamedTuple):
    """Metaclasses that cannot specialise others, and what they can."""

    kinds: frozenset[str]
    others: frozenset[str]
    wanted: str


_APART = (
    Apart(_DATA, _CLASSES | _LINKS, "an attribute definition or data type"),
    Apart(_CLASSES - _LINKS, _DATA | _LINKS, "an item, part, port, action or another class"),
    Apart(_CLASSES & _LINKS, _DATA, "an item, part, connection or another class"),
    Apart(_STRUCTURES, _BEHAVIORS, "an item, part, port or another structure"),
    Apart(_BEHAVIORS, _STRUCTURES, "an action or another behaviour"),
)


def check(model: Model, node: Node) -> Iterator[Found]:
    """Report generals of which no instance can be one of ``node``."""
    for relation, target in written(node, _SUBCLASSIFICATION):
        for apart in _APART:
            if node.kind in apart.kinds and target.kind in apart.others:
                facts = {
                    "name": name_of(model, node),
                    "kind": describe_kind(node),
                    "general": name_of(model, target),
                    "found": describe_kind(target),
                    "wanted": apart.wanted,
                }
                yield Found(OTHER_KIND, relation.reference.start, facts)


def check_variation(model: Model, node: Node) -> Iterator[Found]:
    """Report a variation that a variation specialises; usages are checked with their references."""
    for relation, target in written(node, _SUBCLASSIFICATION):
        is_closed = target.attributes.get("isVariation") or target.kind == "EnumerationDefinition"
        if node.attributes.get("isVariation") and is_closed:
            facts = {"name": name_of(model, node), "owner": ""}
            yield Found(VARIATION_OF_VARIATION, relation.reference.start, facts)


BY_RELATION = ((_SUBCLASSIFICATION, check), (_SUBCLASSIFICATION, check_variation))
