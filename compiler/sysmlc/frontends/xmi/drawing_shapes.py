"""The shapes of a MagicDraw diagram: an entry ``BINARY-...`` of a project archive.

It is XML that leaves its prefix ``xmi`` unbound, so that it is read without namespaces; in a
project that is saved as one XML file it is the content of a ``filePart``.
"""

from collections.abc import Mapping
from itertools import groupby

_BORDER = "DiagramFrame"


class Shapes:
    """Collects which elements are drawn, and inside which others.

    Told of every start and end of an element; ``paths`` are ids, outermost first. The ids of
    MagicDraw mean the same element in every file, so that nothing else of an href is kept.
    """

    def __init__(self) -> None:
        self.paths: dict[tuple[str, ...], None] = {}
        self._open: list[str] = []
        self._is_border: list[bool] = []

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """An element begins."""
        if name == "mdElement":
            self._open.append("")
            self._is_border.append(attributes.get("elementClass") == _BORDER)
        elif name == "elementID" and self._open and not self._open[-1]:
            self._show(attributes)

    def end(self, name: str) -> None:
        """An element ends."""
        if name == "mdElement" and self._open:
            self._open.pop()
            self._is_border.pop()

    def _show(self, attributes: Mapping[str, str]) -> None:
        id = target_of(attributes).rpartition("#")[2]
        if id and not self._is_border[-1]:
            self._open[-1] = id
            path = (one for one in self._open if one)
            self.paths[tuple(one for one, _ in groupby(path))] = None


def target_of(attributes: Mapping[str, str]) -> str:
    """The id or href that an element refers to, whatever its prefix for XMI is."""
    for name, value in attributes.items():
        if name.rpartition(":")[2] in ("idref", "href"):
            return value
    return ""
