"""Ids of elements: those that the standard gives its libraries, and the same scheme for the rest.

KerML 1.0, 9.1: an element of a standard library has a version 5 UUID (RFC 9562) of its path in the
namespace of its package, whose UUID is that of its IRI.
"""

from uuid import NAMESPACE_URL, UUID, uuid5

from sysmlc.language.interchange.effective_names import (
    RedefinitionQuery,
    find_effective_name,
    redefine_nothing,
)
from sysmlc.language.interchange.unfolding import Element, unfold, walk_elements
from sysmlc.language.metaclasses import is_a
from sysmlc.language.text.lexer import quote_name
from sysmlc.language.tree import Document, Node

_STANDARD = {"kerml": "https://www.omg.org/spec/KerML/", "sysml": "https://www.omg.org/spec/SysML/"}
_OPERATOR_PARAMETERS = {
    **dict.fromkeys(("and", "or", "implies"), ("firstValue", "secondValue")),
    **dict.fromkeys(("<", ">", "<=", ">=", "==", "!=", "===", "!==", "xor", "not"), ("x", "y")),
    **dict.fromkeys(("+", "-", "*", "/", "%", "^", "**", "|", "&"), ("x", "y")),
}
"""Parameters of the functions of operators; operands redefine them (KerML 9.4)."""


def map_ids(document: Document) -> dict[str, Node]:
    """Return the nodes of a document by the ids that they and their memberships have."""
    root = unfold(document.root)
    assign_ids(root, document)
    nodes: dict[str, Node] = {}
    for element, owner in walk_elements(root):
        node = element.node
        if element.kind == "ConjugatedPortDefinition" and owner is not None:
            node = find_conjugated(element)
        if node is not None:
            nodes[element.id] = node
    return nodes


def assign_ids(
    root: Element, document: Document, redefined: RedefinitionQuery = redefine_nothing
) -> None:
    """Assign ids to the element and all below it."""
    package = next(
        (member for member in document.root.members if member.kind == "LibraryPackage"), None
    )
    is_standard = package is not None and package.attributes.get("isStandard") is True
    if package is not None and is_standard:
        name = package.name or ""
        base, path = uuid5(NAMESPACE_URL, _STANDARD[document.language] + name), f"{name}/owner"
    else:
        # Not the content: ids must survive edits of the model.
        stem = document.path.rpartition(".")[0] or document.path
        base, path = uuid5(NAMESPACE_URL, f"urn:sysmlc:{stem}"), ""
    _IdAssigner(base, document.root, redefined).assign(root, path)
    if package is not None and is_standard:
        _set_package_id(root, str(base))


def _set_package_id(root: Element, id: str) -> None:
    """Set the id of a standard package, which is the UUID of its IRI."""
    for membership in root.owned:
        for element in membership.owned:
            if element.kind == "LibraryPackage":
                element.id = id


_RESULTS = frozenset({"ReturnParameterMembership"})


class _IdAssigner:
    def __init__(self, base: UUID, root: Node, redefined: RedefinitionQuery) -> None:
        self._redefined = redefined
        self._base = base
        self._root = root
        self._worklist: list[tuple[Element, str, str]] = []

    def assign(self, root: Element, path: str) -> None:
        """Assign ids to the root namespace and all below it."""
        self._worklist.append((root, path, ""))
        # No recursion: expressions nest deeper than Python recurses.
        while self._worklist:
            self._assign_to_element(*self._worklist.pop())

    def _make_id(self, path: str) -> str:
        return str(uuid5(self._base, path))

    def _assign_to_element(self, element: Element, path: str, qualified: str) -> None:
        """Assign ids to an element that is no owned relationship, and to its relationships.

        ``qualified`` is its qualified name, empty if it has none.
        """
        element.id = self._make_id(path)
        is_root = element.node is self._root
        used_names: set[str] = set()
        operands = iter(_OPERATOR_PARAMETERS.get(str(element.attributes.get("operator")), ()))
        for index, owned in enumerate(element.owned, 1):
            name = _find_member_name(owned, self._redefined) if is_root or qualified else ""
            if element.kind == "OperatorExpression" and qualified:
                name = "result" if owned.kind in _RESULTS else next(operands, "")
            unique_name = name if name not in used_names else ""
            used_names.add(name)
            qualified_member = _join_names("" if is_root else qualified, unique_name)
            self._assign_to_relationship(owned, path, index, qualified_member)

    def _assign_to_relationship(
        self, element: Element, owner_path: str, index: int, qualified: str
    ) -> None:
        """Assign ids to an owned relationship and all below it; ``qualified`` names its member."""
        path = f"{qualified}/owningMembership" if qualified else f"{owner_path}/{index}"
        element.id = self._make_id(path)
        for position, owned in enumerate(element.owned, 1):
            if _is_relationship(owned):
                self._assign_to_relationship(owned, path, position, "")
            else:
                qualified_member = qualified if position == 1 else ""
                self._worklist.append(
                    (owned, qualified_member or f"{path}/{position}", qualified_member)
                )


def _join_names(owner: str, name: str) -> str:
    if not name:
        return ""
    return f"{owner}::{quote_name(name)}" if owner else quote_name(name)


def _is_relationship(element: Element) -> bool:
    return element.kind == "Annotation"


def _find_member_name(owned: Element, redefined: RedefinitionQuery) -> str:
    """Return the name of the member of a membership; empty for other relationships."""
    if not is_a(owned.kind, "OwningMembership") or not owned.owned:
        return ""
    member = owned.owned[0]
    if member.kind == "ConjugatedPortDefinition":
        original = find_conjugated(member)
        return f"~{find_effective_name(original, redefined)}" if original else ""
    return find_effective_name(member.node, redefined) if member.node is not None else ""


def find_conjugated(definition: Element) -> Node | None:
    """Return the port definition that a ConjugatedPortDefinition conjugates."""
    targets = (target for _, target in definition.owned[0].targets)
    return next(
        (target.node for target in targets if isinstance(target, Element) and target.node), None
    )
