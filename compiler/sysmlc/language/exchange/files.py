"""Documents as interchange files have them, for references into them: each is unfolded once."""

from collections.abc import Iterable

from sysmlc.language.exchange.elements import Element, walk
from sysmlc.language.exchange.identity import conjugated, identify
from sysmlc.language.exchange.naming import Redefined, nothing
from sysmlc.language.exchange.unfolding import unfold
from sysmlc.language.tree import Document, Node

_MEMBERSHIPS = {"importedMembership"}
"""Features that refer to the membership of an element, not to the element."""


class File:
    """An unfolded document, and which elements of it are those of which nodes."""

    def __init__(self, document: Document, redefined: Redefined = nothing) -> None:
        self.document = document
        self.root = unfold(document.root)
        identify(self.root, document, redefined)
        self._elements: dict[Node, Element] = {}
        self._memberships: dict[Node, Element] = {}
        self._conjugates: dict[Node | None, Element] = {}
        for element, owner in walk(self.root):
            if element.node is not None:
                self._memberships.setdefault(element.node, element)
                self._elements[element.node] = element
            if element.kind == "ConjugatedPortDefinition" and owner is not None:
                self._conjugates[conjugated(element)] = element

    def target(self, node: Node, feature: str) -> Element | None:
        """The element that a feature refers to when it leads to ``node``."""
        if feature == "conjugatedPortDefinition":
            return self._conjugates.get(node)
        return (self._memberships if feature in _MEMBERSHIPS else self._elements).get(node)


class Files:
    """The documents that references may lead to; those of a library may be shared by models.

    ``redefined`` says what features redefine implicitly: they are named, and have ids, by that.
    """

    def __init__(
        self,
        documents: Iterable[Document],
        library: "Files | None" = None,
        redefined: Redefined = nothing,
    ) -> None:
        self.redefined = redefined
        self._documents: dict[Node, Document] = {}
        self._files: dict[Node, File] = {}
        self._library = library
        self.add(documents)

    def add(self, documents: Iterable[Document]) -> None:
        """References may lead to these documents too."""
        self._documents.update((one.root, one) for one in documents)

    def of(self, root: Node) -> File | None:
        """The file of the document with that root; None for one that is not known."""
        if root in self._files:
            return self._files[root]
        if root in self._documents:
            return self._files.setdefault(root, File(self._documents[root], self.redefined))
        return self._library.of(root) if self._library is not None else None
