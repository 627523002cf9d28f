"""The words before a member: their order, and which declarations they are for."""

from sysmlc.language.text.scan import Remark, Tokens
from sysmlc.language.tree import Node

_RANKS = {
    "member": 0,
    "end": 1,
    "standard": 1,
    "library": 2,
    "in": 2,
    "out": 2,
    "inout": 2,
    "derived": 3,
    "abstract": 4,
    "variation": 4,
    "constant": 5,
    "composite": 5,
    "portion": 5,
    "ref": 6,
    "var": 6,
    "const": 6,
    "individual": 7,
    "snapshot": 8,
    "timeslice": 8,
}
_METADATA = 9
_OF_DEFINITIONS = {"abstract", "variation", "individual"}
_OF_PACKAGES = {"standard", "library"}
_PLAIN = {"Package", "LibraryPackage", "Namespace"}
_BARE = {
    "Comment": "a comment",
    "Documentation": "documentation",
    "TextualRepresentation": "a representation",
    "Dependency": "a dependency",
    "Membership": "an alias",
    "MembershipImport": "an import",
    "NamespaceImport": "an import",
    "MembershipExpose": "'expose'",
    "NamespaceExpose": "'expose'",
    "MetadataUsage": "metadata",
    "MetadataFeature": "metadata",
}
_TYPES = {
    "Type",
    "Classifier",
    "DataType",
    "Class",
    "Structure",
    "Metaclass",
    "Association",
    "AssociationStructure",
    "Interaction",
    "Behavior",
    "Function",
    "Predicate",
}


def check(tokens: Tokens, prefixes: list[int | Node], node: Node) -> None:
    """Remark words that are out of order, or not for this declaration."""
    given = [(one, tokens[one]) for one in prefixes if isinstance(one, int)]
    for token, word in given:
        if word and not _allowed(word, node):
            text = f"'{word}' cannot stand before {_kind(node)}"
            _remark(tokens, token, text, f"take '{word}' away")
            return
    if len(prefixes) > 1:
        _check_order(tokens, prefixes)


def _check_order(tokens: Tokens, prefixes: list[int | Node]) -> None:
    last, before = -1, ""
    for one in prefixes:
        word = "metadata" if isinstance(one, Node) else tokens[one]
        rank = _METADATA if isinstance(one, Node) else _RANKS.get(word, last + 1)
        if (before, word) == ("const", "end"):
            rank = last + 1
        if rank < last or (rank == last != _METADATA):
            start = one.start if isinstance(one, Node) else tokens.starts[one]
            _told(tokens, start, word, before, rank == last)
            return
        last, before = rank, word


def _told(tokens: Tokens, start: int, word: str, before: str, same: bool) -> None:
    if same:
        text = f"'{word}' and '{before}' exclude one another"
        advice = "say only one of both"
    else:
        text = f"'{word}' stands after '{before}'"
        advice = f"write '{word}' before '{before}'"
    tokens.remarks.append(Remark("prefix", start, text, advice))


def _remark(tokens: Tokens, token: int, text: str, advice: str) -> None:
    tokens.remarks.append(Remark("prefix", tokens.starts[token], text, advice))


def _allowed(word: str, node: Node) -> bool:
    if word in _OF_PACKAGES:
        return node.kind == "Package"
    if node.kind in _PLAIN or node.kind in _BARE:
        return False
    if node.kind in _TYPES:
        return word == "abstract"
    if node.kind.endswith("Definition"):
        return word in _OF_DEFINITIONS
    return True


def _kind(node: Node) -> str:
    if node.kind in _BARE:
        return _BARE[node.kind]
    if node.kind in _PLAIN:
        return "a package"
    return "a definition" if node.kind.endswith("Definition") else "this declaration"
