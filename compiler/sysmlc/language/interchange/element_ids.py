"""Ids of elements: those that the standard gives its libraries, the same scheme for the rest.

KerML 1.0, 9.1: an element of a standard library has a version 5 UUID (RFC 9562) of its path in
the namespace of its package, whose UUID is that of its IRI.
"""

from uuid import NAMESPACE_URL, UUID, uuid5

from sysmlc.language.interchange.effective_names import Redefined, effective, nothing
from sysmlc.language.interchange.elements import Element, walk
from sysmlc.language.interchange.unfolding import unfold
from sysmlc.language.metaclasses import is_a
from sysmlc.language.text.lexer import quote_name
from sysmlc.language.tree import Document, Node

_STANDARD = {"kerml": "https://www.omg.org/spec/KerML/", "sysml": "https://www.omg.org/spec/SysML/"}
_OPERANDS = {
    **dict.fromkeys(("and", "or", "implies"), ("firstValue", "secondValue")),
    **dict.fromkeys(("<", ">", "<=", ">=", "==", "!=", "===", "!==", "xor", "not"), ("x", "y")),
    **dict.fromkeys(("+", "-", "*", "/", "%", "^", "**", "|", "&"), ("x", "y")),
}
"""Parameters of the functions of operators, which those of an expression redefine (KerML 9.4)."""


def ids(document: Document) -> dict[str, Node]:
    """The elements of a document by the ids that they and their memberships have in interchange."""
    root = unfold(document.root)
    identify(root, document)
    found: dict[str, Node] = {}
    for element, owner in walk(root):
        node = element.node
        if element.kind == "ConjugatedPortDefinition" and owner is not None:
            node = conjugated(element)
        if node is not None:
            found[element.id] = node
    return found


def identify(root: Element, document: Document, redefined: Redefined = nothing) -> None:
    """Give the element and all below it their ids."""
    package = next(
        (member for member in document.root.members if member.kind == "LibraryPackage"), None
    )
    standard = package is not None and package.attributes.get("isStandard") is True
    if package is not None and standard:
        name = package.name or ""
        base, path = uuid5(NAMESPACE_URL, _STANDARD[document.language] + name), f"{name}/owner"
    else:
        stem = document.path.rpartition(".")[0] or document.path
        base, path = uuid5(NAMESPACE_URL, f"urn:sysmlc:{stem}"), ""
    _Ids(base, document.root, redefined).give(root, path)
    if package is not None and standard:
        _name_package(root, str(base))


def _name_package(root: Element, id: str) -> None:
    """A standard package has the UUID of its IRI itself."""
    for membership in root.owned:
        for one in membership.owned:
            if one.kind == "LibraryPackage":
                one.id = id


_RESULTS = frozenset({"ReturnParameterMembership"})


class _Ids:
    def __init__(self, base: UUID, root: Node, redefined: Redefined) -> None:
        self._redefined = redefined
        self._base = base
        self._root = root
        self._todo: list[tuple[Element, str, str]] = []

    def give(self, root: Element, path: str) -> None:
        """Give ids to the root namespace and to all below it."""
        self._todo.append((root, path, ""))
        while self._todo:
            self._element(*self._todo.pop())

    def _of(self, path: str) -> str:
        return str(uuid5(self._base, path))

    def _element(self, element: Element, path: str, qualified: str) -> None:
        """Ids of an element that is no owned relationship, and of all below it.

        ``qualified`` is its qualified name, empty when it has none.
        """
        element.id = self._of(path)
        is_root = element.node is self._root
        taken: set[str] = set()
        operands = iter(_OPERANDS.get(str(element.attributes.get("operator")), ()))
        for index, owned in enumerate(element.owned, 1):
            name = _name(owned, self._redefined) if is_root or qualified else ""
            if element.kind == "OperatorExpression" and qualified:
                name = "result" if owned.kind in _RESULTS else next(operands, "")
            first = name if name not in taken else ""
            taken.add(name)
            inner = _joined("" if is_root else qualified, first)
            self._relationship(owned, path, index, inner)

    def _relationship(self, element: Element, above: str, index: int, qualified: str) -> None:
        """Ids of an owned relationship, and of all below it; ``qualified`` names its member."""
        path = f"{qualified}/owningMembership" if qualified else f"{above}/{index}"
        element.id = self._of(path)
        for position, owned in enumerate(element.owned, 1):
            if _is_relationship(owned):
                self._relationship(owned, path, position, "")
            else:
                inner = qualified if position == 1 else ""
                self._todo.append((owned, inner or f"{path}/{position}", inner))


def _joined(above: str, name: str) -> str:
    if not name:
        return ""
    return f"{above}::{quote_name(name)}" if above else quote_name(name)


def _is_relationship(element: Element) -> bool:
    return element.kind == "Annotation"


def _name(owned: Element, redefined: Redefined) -> str:
    """The name of the member of a membership; nothing for other relationships."""
    if not is_a(owned.kind, "OwningMembership") or not owned.owned:
        return ""
    member = owned.owned[0]
    if member.kind == "ConjugatedPortDefinition":
        original = conjugated(member)
        return f"~{effective(original, redefined)}" if original else ""
    return effective(member.node, redefined) if member.node is not None else ""


def conjugated(definition: Element) -> Node | None:
    """The port definition that a ConjugatedPortDefinition conjugates."""
    targets = (target for _, target in definition.owned[0].targets)
    return next(
        (target.node for target in targets if isinstance(target, Element) and target.node), None
    )
