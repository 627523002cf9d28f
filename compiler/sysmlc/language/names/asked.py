"""What is asked about elements while a name is looked up, for who must not know how it is found."""

from typing import Protocol

from sysmlc.language.tree import Node, Relation


class Asked(Protocol):
    """Answers about single elements; ``generals.Generals`` finds them, each once."""

    def target(self, node: Node, relation: Relation) -> Node | None:
        """The element that a relation of ``node`` leads to; None when a name leads nowhere."""

    def generals(self, node: Node) -> list[Node]:
        """What ``node`` specialises as the text says: types, subsetted, redefined features ..."""

    def all_generals(self, node: Node) -> tuple[Node, ...]:
        """What ``node`` specialises as the text says and what it may implicitly."""

    def own_of_role(self, scope: Node, role: str) -> list[Node]:
        """The features of ``scope`` with one role by position, in the order of the text."""

    def at_positions(self, scope: Node, role: str) -> list[Node]:
        """The features of a type with one role by position, own ones before inherited ones."""
