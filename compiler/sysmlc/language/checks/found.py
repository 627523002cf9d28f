"""What a check finds."""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from sysmlc.diagnostics import Rule
from sysmlc.language.metaclasses import FEATURES, TYPES, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node, Relation


class Found(NamedTuple):
    """A rule that is broken, the offset of the text that breaks it, the facts of its phrase."""

    rule: Rule
    start: int
    facts: dict[str, str]


_WITHOUT_DECLARATION = (
    kinds_of("InstantiationExpression")
    | kinds_of("LiteralExpression")
    | {"FeatureReferenceExpression", "MetadataAccessExpression", "NullExpression"}
)
DECLARED_TYPES = TYPES - _WITHOUT_DECLARATION
DECLARED_FEATURES = FEATURES - _WITHOUT_DECLARATION
"""Types and features that somebody declares: not those that only make up an expression."""
Check = Callable[[Model, Node], Iterable[Found]]
"""What is broken by one node; a check is called for the metaclasses that it is entered for."""


def written(node: Node, kinds: frozenset[str]) -> Iterator[tuple[Relation, Node]]:
    """The relations of some kinds that the text says, with what they lead to."""
    for relation in node.relations:
        if relation.kind in kinds:
            target = relation.reference.target
            if target is not None:
                yield relation, target


def name_of(model: Model, node: Node | None) -> str:
    """The name of an element, else its kind in words; empty for none."""
    if node is None:
        return ""
    return model.name(node) or node.kind
