"""Trees of two versions of a text: what says the same in both, moved to where it is now; copies."""

from collections.abc import Sequence
from itertools import takewhile
from operator import attrgetter

from sysmlc.language.tree import Node, Reference, Relation

_HEAD = attrgetter("kind", "name", "short", "membership", "role", "visibility")
_PLACES = attrgetter("start", "end", "name_start")


def is_same_head(old: Node, new: Node) -> bool:
    """Whether two nodes say the same, apart from their members and places."""
    return (
        _HEAD(old) == _HEAD(new)
        and old.facts == new.facts
        and [_said(one) for one in old.relations] == [_said(one) for one in new.relations]
    )


def _said(relation: Relation) -> tuple[str, tuple[tuple[str, ...], ...]]:
    return relation.kind, relation.reference.chain


def is_same(old: Node, new: Node) -> bool:
    """Whether two trees say the same at places that are all as far from each other."""
    by = new.start - old.start
    waiting = [(old, new)]
    for one, other in waiting:
        if _HEAD(one) != _HEAD(other) or one.facts != other.facts:
            return False
        if [place + by for place in _PLACES(one)] != list(_PLACES(other)):
            return False
        if len(one.members) != len(other.members) or not _are_same(one, other, by):
            return False
        waiting += zip(one.members, other.members, strict=True)
    return True


def _are_same(old: Node, new: Node, by: int) -> bool:
    """Whether the relations of two nodes say the same at places that are so far from each other."""
    if not old.relations and not new.relations:
        return True
    was = [(*_said(r), r.reference.start + by, r.reference.end + by) for r in old.relations]
    return was == [(*_said(r), r.reference.start, r.reference.end) for r in new.relations]


def move(tree: Node, by: int) -> None:
    """Let a tree stand so many characters further on."""
    for node in tree.walk() if by else ():
        node.start += by
        node.end += by
        node.name_start += by
        for relation in node.relations:
            relation.reference.start += by
            relation.reference.end += by


def grafted(old: Sequence[Node], new: Sequence[Node]) -> tuple[list[Node], list[Node], list[Node]]:
    """The new members of a package with the old ones that say the same, at the places of now.

    Beside them those of the old ones and those of the new ones that have no equal.
    """
    first = sum(1 for _ in takewhile(bool, map(is_same, old, new)))
    rest = zip(reversed(old[first:]), reversed(new[first:]), strict=False)
    last = sum(1 for _ in takewhile(lambda pair: is_same(*pair), rest))
    gone, come = old[first : len(old) - last], new[first : len(new) - last]
    made = [*old[:first], *come, *old[len(old) - last :]]
    for one, now in zip(made, new, strict=True):
        move(one, now.start - one.start)
    return made, list(gone), list(come)


def copied(tree: Node) -> Node:
    """The same tree as it was read: no reference leads anywhere yet."""
    made = Node(tree.kind)
    waiting = [(tree, made)]
    for node, copy in waiting:
        copy.kind, copy.name, copy.short = node.kind, node.name, node.short
        copy.membership, copy.role, copy.visibility = node.membership, node.role, node.visibility
        copy.start, copy.end, copy.name_start = node.start, node.end, node.name_start
        copy.facts = node.facts
        copy.relations = [Relation(one.kind, _copied(one.reference)) for one in node.relations]
        for member in node.members:
            waiting.append((member, copy.own(Node(member.kind))))
    return made


def _copied(reference: Reference) -> Reference:
    return Reference(reference.chain, reference.start, reference.end)
