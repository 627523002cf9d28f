"""Recipe levels: what specialises our library RecipeLevels has the level's stereotype."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.annotations import give_tag
from sysmlc.frontends.sysml.libraries import PROFILE, RECIPES
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_GENERALS = ("Subclassification", "FeatureTyping", "Specialization")


def give_levels(low: "Lowering", node: Node, made: Element) -> None:
    """Apply the stereotype of each level that a definition directly specialises.

    Its tagged values are those that the definition's members give to the level's attributes.
    """
    for level in _levels(node):
        name = level.name or ""
        one = low.make(node, Kind.APPLICATION, name, made, stereotype=name, namespace=PROFILE)
        low.graph.connect(Edge.SUBJECT, one, made)
        for member, key in _values(node):
            value = nodes.value_of(member)
            low.skipped.add(id(member))
            if value is not None:
                give_tag(low, one, key, value)


def _levels(node: Node) -> Iterator[Node]:
    for found in nodes.references(node, *_GENERALS):
        if found.target is not None and is_of_recipes(found.target):
            yield found.target


def _values(node: Node) -> Iterator[tuple[Node, str]]:
    """Members that redefine an attribute of a level, with its name."""
    for one in node.members:
        redefined = nodes.target(one, "Redefinition")
        owner = None if redefined is None else redefined.owner
        if redefined is not None and owner is not None and is_of_recipes(owner):
            yield one, redefined.name or ""


def is_of_recipes(node: Node) -> bool:
    """Whether the node is a definition of our library of recipe levels."""
    owner = node.owner
    return owner is not None and owner.name == RECIPES and owner.kind == "LibraryPackage"
