"""All members of a namespace: own, inherited and imported ones."""

from collections.abc import Sequence

from sysmlc.language.names.lookup import Lookup
from sysmlc.language.tree import Node


def members(lookup: Lookup, node: Node, generals: Sequence[Node], *, imported: bool) -> list[Node]:
    """Members in the order of the text, then those of generals that nothing nearer redefines."""
    found = dict.fromkeys(node.members)
    if generals:
        redefined = _redefined(lookup, node.members)
        for general in generals:
            for member in general.members:
                if member.visibility != "private" and member not in redefined:
                    found.setdefault(member)
            redefined |= _redefined(lookup, general.members)
    if imported:
        for member in _imported(lookup, node):
            found.setdefault(member)
    return list(found)


def _redefined(lookup: Lookup, owned: list[Node]) -> set[Node]:
    return {general for member in owned for general in lookup.redefined(member)}


def _imported(lookup: Lookup, node: Node) -> list[Node]:
    found: list[Node] = []
    for declaration in lookup.imports(node):
        for relation in declaration.relations:
            target = lookup.target(declaration, relation)
            if target is not None and relation.kind == "importedMembership":
                found.append(target)
            elif target is not None:
                found += [m for m in target.members if m.visibility in ("", "public")]
    return found
