"""Queries that the parts of name resolution ask about elements while a name is looked up.

The protocols let ``implied``, ``expression_results`` and ``metadata`` call back into the
lookup that calls them, without an import cycle.
"""

from collections.abc import Iterator
from typing import Protocol

from sysmlc.language.tree import Node, Relation


class GeneralizationQueries(Protocol):
    """Queries about generals and roles; ``generals.GeneralLookup`` answers and memoises them."""

    def target(self, node: Node, relation: Relation) -> Node | None:
        """Return the element that a relation of ``node`` leads to, or None if it is unresolved."""

    def generals(self, node: Node) -> list[Node]:
        """Return the generals that the text states: types, subsetted, redefined features ..."""

    def all_generals(self, node: Node) -> tuple[Node, ...]:
        """Return the generals that the text states and those that may be implied."""

    def own_features_of_role(self, scope: Node, role: str) -> list[Node]:
        """Return the features of ``scope`` with this positional role, in the order of the text."""

    def features_of_role(self, scope: Node, role: str) -> list[Node]:
        """Return the features of a type with this positional role, own before inherited ones."""


class LookupQueries(GeneralizationQueries, Protocol):
    """Queries about generals, members and redefinition; ``lookup.Lookup`` implements them."""

    def resolve_alias(self, hit: Node) -> Node | None:
        """Return the element that a member stands for: that of an alias, else the member."""

    def conforms(self, node: Node, general: Node) -> bool:
        """Whether ``node`` is ``general`` or specialises it by relations that the text states."""

    def redefined_features(self, feature: Node) -> set[Node]:
        """Return the features that ``feature`` redefines, directly or not."""

    def iter_visible_inside(self, scope: Node, name: str) -> Iterator[Node]:
        """Yield the members named ``name`` that are visible inside ``scope``."""
