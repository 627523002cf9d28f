"""What an edit may change in a unit: items and files, and what mentions those by name."""

from collections.abc import Iterable, Iterator
from collections.abc import Set as AbstractSet

from sysmlc.language.grafts import copied, grafted, is_same, is_same_head, move
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.contents import TYPES, naming
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.tree import Node, Relation

_PACKAGES = frozenset({"Package", "LibraryPackage"})
_ITEMS = TYPES - kinds_of("MetadataFeature") - kinds_of("Multiplicity") | kinds_of("Comment")
"""Metaclasses of items: what else a package has says how its members are seen."""
_IMPORTS = kinds_of("Import")
_EVERYTHING = "**"
"""What an import mentions that may lead from one to the other without a name."""
_GLOBAL = "$"
"""The global scope, or a name in quotes: the tree is the same, the text says which it is."""


def names_of(member: Node) -> set[str]:
    """The names by which a namespace has a member."""
    found = {one for one in (member.name, member.short) if one is not None}
    reference = None if found else naming(member)
    return {reference.chain[-1][-1]} if reference is not None else found


def is_item(member: Node) -> bool:
    """Whether a member of a package is seen by nobody who does not mention its name."""
    return member.kind in _ITEMS and member.membership == "OwningMembership"


def mentioned(trees: Iterable[Node]) -> frozenset[str]:
    """The names in trees that may lead to a member of a package.

    What follows a dot is a member of a feature, as is what has the name of an inherited one:
    only public imports could let those be members of packages.
    """
    found: set[str] = set()
    for tree in trees:
        for node in tree.walk():
            for relation in node.relations:
                found.update(relation.reference.chain[0])
            if node.kind in _IMPORTS and _brings_more(node):
                found.add(_EVERYTHING)
    return frozenset(found)


def _brings_more(node: Node) -> bool:
    """Whether an import brings what nobody names, or brings it to who sees the importing type."""
    is_in_type = node.visibility == "public" and node.owner is not None and node.owner.kind in TYPES
    return is_in_type or bool(node.facts.get("isRecursive"))


class Changes:
    """What is new in a unit: files, items in other files, names that may mean something new.

    ``mentions`` has the names in items and, by root, in what is around the items of a file.
    """

    def __init__(self, lookup: Lookup, mentions: dict[Node, frozenset[str]]) -> None:
        self.names = {_EVERYTHING, _GLOBAL}
        self.stale: set[Node] = set()
        """Nodes that are no more, and those that now own others."""
        self._lookup = lookup
        self._mentions = mentions
        self._roots: dict[Node, Node] = {}
        """For the root of each file that of its text now."""
        self._files: set[Node] = set()
        self._items: set[Node] = set()
        self._come: set[Node] = set()
        """Items that were read now."""

    def compare(self, old: Node, new: Node) -> bool:
        """Look for what is new in a file; False where root members have other names."""
        self._roots[old] = new
        if old is new:
            return True
        if [names_of(one) for one in old.members] != [names_of(one) for one in new.members]:
            return False
        if all(map(self._is_like, old.members, new.members)):
            self._stand(old, new)
        else:
            self._renew(old)
        return True

    def _is_like(self, old: Node, new: Node) -> bool:
        """Whether what is around the items of a package is as it was; it then has those of now."""
        if old.kind not in _PACKAGES:
            is_like = is_same(old, new)
            move(old, new.start - old.start if is_like else 0)
            return is_like
        made, gone, come = grafted(old.members, new.members)
        if not is_same_head(old, new) or not all(map(is_item, (*gone, *come))):
            return False
        for one in gone:
            self._forget(one)
        for one in come:
            self._come.add(one)
            self._renew_item(one)
        self.names.update(*map(names_of, gone))
        old.members = made
        self._stand(old, new)
        return True

    def _stand(self, old: Node, new: Node) -> None:
        old.start, old.end, old.name_start = new.start, new.end, new.name_start
        self.stale.add(old)

    def add(self, doubtful: Iterable[Node]) -> None:
        """Take what these nodes are in for new."""
        for node in doubtful:
            within = list(_around(node))
            if within[-1] not in self._roots:
                continue
            if len(within) > 2 and within[-2].kind in _PACKAGES and is_item(within[-3]):
                self._renew_item(within[-3])
            else:
                self._renew(within[-1])

    def spread(self) -> None:
        """Take for new what mentions a name of what is new."""
        count = -1
        while count != len(self._files) + len(self._items):
            count = len(self._files) + len(self._items)
            for root in self._roots:
                if root not in self._files and self._touched(root, _beside_items(root)):
                    self._renew(root)
                for item in _items(root) if root not in self._files else ():
                    if item not in self._items and self._is_touched(item):
                        self._renew_item(item)

    def _touched(self, part: Node, trees: Iterable[Node]) -> AbstractSet[str]:
        said = self._mentions.get(part)
        if said is None:
            said = self._mentions[part] = mentioned(trees)
        return self.names & said

    def _is_touched(self, item: Node) -> bool:
        """Whether a name of what is new, that an item mentions, is looked for outside of it."""
        names = self._touched(item, (item,))
        if not names or _EVERYTHING in names:
            return bool(names)
        nodes = list(item.walk())
        return any(one.kind in _IMPORTS for one in nodes) or any(
            not (
                names.isdisjoint(relation.reference.chain[0])
                or self._is_within(node, relation, item)
            )
            for node in nodes
            for relation in node.relations
        )

    def _is_within(self, node: Node, relation: Relation, item: Node) -> bool:
        return item.owner is not None and self._lookup.is_within(node, relation, item.owner)

    def _renew(self, root: Node) -> None:
        self._files.add(root)
        for one in root.members:
            self.names |= names_of(one)

    def _renew_item(self, item: Node) -> None:
        self._items.add(item)
        self.names |= names_of(item)

    def _forget(self, tree: Node) -> None:
        self._mentions.pop(tree, None)
        self.stale.update(tree.walk())

    def apply(self) -> dict[Node, Node]:
        """Put new nodes where something may be new; for the root of each file the root now."""
        return {root: self._applied(root, new) for root, new in self._roots.items()}

    def _applied(self, root: Node, new: Node) -> Node:
        items = _items(root)
        if root in self._files:
            list(map(self._forget, (*items, root)))
            made = copied(root) if new is root else new
        else:
            if self._items.isdisjoint(items):
                return root
            made = root
            self.stale.add(root)
        for package in _packages(made):
            self.stale.add(package)
            package.members = [self._now(one) for one in package.members]
            for one in package.members:
                one.owner = package
        return made

    def _now(self, member: Node) -> Node:
        """The node of a member, a new one for an item of which something may be new."""
        if member not in self._items or member in self._come:
            return member
        self._forget(member)
        return copied(member)


def _around(node: Node | None) -> Iterator[Node]:
    """A node and what it is in, up to the root of its file."""
    while node is not None:
        yield node
        node = node.owner


def _packages(root: Node) -> list[Node]:
    return [one for one in root.members if one.kind in _PACKAGES]


def _items(root: Node) -> list[Node]:
    return [one for package in _packages(root) for one in package.members if is_item(one)]


def _beside_items(root: Node) -> list[Node]:
    """What a file has around its items."""
    within = [one for package in _packages(root) for one in package.members if not is_item(one)]
    return [*within, *(one for one in root.members if one.kind not in _PACKAGES)]
