"""Which element an error about a place in a text concerns, so that the others are still emitted."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from sysmlc.ir import Element, Kind
from sysmlc.language.tree import Document, Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)


def blame(low: "Lowering", documents: Sequence[Document]) -> None:
    """Give errors that only know their place the element that stands there.

    What is wrong with metadata concerns the metadata; any other error the whole definition or
    usage of the package that it is in, or the package itself.
    """
    by_path = {one.path: one for one in documents if one.text}
    for found in list(low.sink):
        place = found.subject.place
        document = None if place is None else by_path.get(place.file)
        if place is None or document is None or found.subject.id or not found.is_error:
            continue
        element = _concerned(low, document, place.offset)
        if element is not None:
            low.sink.relate(found, element.id)


def _concerned(low: "Lowering", document: Document, offset: int) -> Element | None:
    found: Element | None = None
    for node in _around(low, document, offset):
        made = low.elements.get(id(node))
        if made is None:
            continue
        if made.kind is Kind.APPLICATION:
            return made
        if found is None or found.kind in _PACKAGES:
            found = made
    return found


def _around(low: "Lowering", document: Document, offset: int) -> Iterator[Node]:
    """The nodes that a place is in, the outermost first."""
    node: Node | None = document.root
    while node is not None:
        node = next((one for one in node.members if _holds(low, document, one, offset)), None)
        if node is not None:
            yield node


def _holds(low: "Lowering", document: Document, node: Node, offset: int) -> bool:
    start, end = low.byte(document, node.start), low.byte(document, node.end)
    return 0 <= start <= offset < end
