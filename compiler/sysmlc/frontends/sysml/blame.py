"""Which element an error about a place in a text concerns, so that the others are still emitted."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from sysmlc.ir import Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)


def blame(low: "Lowering") -> None:
    """Give errors that only know their place the element that stands there.

    What is wrong with metadata concerns the metadata; any other error the whole definition or
    usage of the package that it is in, or the package itself.
    """
    by_path = {one.path: one for one in low.homes if one.document.text}
    for found in list(low.sink):
        place = found.subject.place
        home = None if place is None else by_path.get(place.file)
        if place is None or home is None or found.subject.id or not found.is_error:
            continue
        element = _concerned(low, home.document.root, home.character(place.offset))
        if element is not None:
            low.sink.relate(found, element.id)


def _concerned(low: "Lowering", root: Node, offset: int) -> Element | None:
    found: Element | None = None
    for node in _around(root, offset):
        made = low.elements.get(id(node))
        if made is None:
            continue
        if made.kind is Kind.APPLICATION:
            return made
        if found is None or found.kind in _PACKAGES:
            found = made
    return found


def _around(root: Node, offset: int) -> Iterator[Node]:
    """The nodes that a character is in, the outermost first."""
    node: Node | None = root
    while node is not None:
        node = next((one for one in node.members if 0 <= one.start <= offset < one.end), None)
        if node is not None:
            yield node
