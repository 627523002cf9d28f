"""All members of a namespace: own, inherited and imported ones."""

from typing import TYPE_CHECKING

from sysmlc.language.names.contents import TYPES
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.language.names.model import Model


def members(model: "Model", node: Node, *, inherited: bool, imported: bool) -> list[Node]:
    """Members in the order of the text, then those of generals that nothing nearer redefines."""
    found = dict.fromkeys(node.members)
    if inherited and node.kind in TYPES:
        redefined = _redefined(model, node.members)
        for general in model.supers(node)[1:]:
            for member in general.members:
                if member.visibility != "private" and member not in redefined:
                    found.setdefault(member)
            redefined |= _redefined(model, general.members)
    if imported:
        for member in _imported(model, node):
            found.setdefault(member)
    return list(found)


def _redefined(model: "Model", owned: list[Node]) -> set[Node]:
    return {general for member in owned for general in model.lookup.redefined(member)}


def _imported(model: "Model", node: Node) -> list[Node]:
    found: list[Node] = []
    for declaration in model.lookup.imports(node):
        for relation in declaration.relations:
            target = model.lookup.target(declaration, relation)
            if target is not None and relation.kind == "importedMembership":
                found.append(target)
            elif target is not None:
                found += [m for m in target.members if m.visibility in ("", "public")]
    return found
