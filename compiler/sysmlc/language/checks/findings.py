"""Findings of checks, and helpers that checks share."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from sysmlc.diagnostics import Rule
from sysmlc.language.metaclasses import EXPRESSIONS_WITHOUT_BODY, FEATURES, TYPES
from sysmlc.language.names import Model
from sysmlc.language.tree import Node, Relation


class Finding(NamedTuple):
    """A broken rule, the offset of the text that breaks it, and the facts for its message.

    ``node`` is the element that breaks the rule if it is not the checked one. ``help`` replaces the
    help of the rule. ``unless`` has the codes of rules whose finding in the same place explains
    more.
    """

    rule: Rule
    start: int
    facts: Mapping[str, object]
    node: Node | None = None
    help: str = ""
    unless: tuple[str, ...] = ()


DECLARED_TYPES = TYPES - EXPRESSIONS_WITHOUT_BODY
DECLARED_FEATURES = FEATURES - EXPRESSIONS_WITHOUT_BODY
"""Types and features that are declared, without those that only make up an expression."""
Check = Callable[[Model, Node], Iterable[Finding]]
"""Returns the findings about one node; the tables of ``checks`` have the metaclasses for it."""


def iter_stated(node: Node, kinds: frozenset[str]) -> Iterator[tuple[Relation, Node]]:
    """Yield the stated relations of some kinds with their targets; skip unresolved ones."""
    for relation in node.relations:
        if relation.kind in kinds:
            target = relation.reference.target
            if target is not None:
                yield relation, target


def name_of(model: Model, node: Node | None) -> str:
    """Return the name of an element, else its metaclass; empty for None."""
    if node is None:
        return ""
    return model.name(node) or node.kind
