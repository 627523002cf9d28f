"""The shapes of a MagicDraw diagram: an entry ``BINARY-...`` of a project archive.

It is XML that leaves its prefix ``xmi`` unbound, so that it is read without namespaces; in a
project that is saved as one XML file it is the content of a ``filePart``.
"""

from collections.abc import Mapping

_BORDER = "DiagramFrame"
_DEEPEST = 40


class Shapes:
    """Collects which elements are drawn, and inside which others.

    Told of every start and end of an element; ``paths`` are ids, outermost first. The ids of
    MagicDraw mean the same element in every file, so that nothing else of an href is kept.
    """

    def __init__(self) -> None:
        self.paths: dict[tuple[str, ...], None] = {}
        self._open: list[tuple[str, ...]] = [()]
        self._is_shown: list[bool] = [True]

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """An element begins."""
        if name == "mdElement":
            self._open.append(self._open[-1])
            self._is_shown.append(attributes.get("elementClass") == _BORDER)
        elif name == "elementID" and not self._is_shown[-1]:
            self._is_shown[-1] = True
            self._show(target_of(attributes).rpartition("#")[2])

    def end(self, name: str) -> None:
        """An element ends."""
        if name == "mdElement":
            self._open.pop()
            self._is_shown.pop()

    def _show(self, id: str) -> None:
        if id:
            self._open[-1] = path = inside(self._open[-1], id)
            self.paths[path] = None


def inside(path: tuple[str, ...], id: str) -> tuple[str, ...]:
    """The path of what is drawn at ``path`` and shows ``id``; some symbols are two of a kind.

    What is nested deeper than any drawing stands beside the last one that counts.
    """
    return path if path[-1:] == (id,) else (*path[: _DEEPEST - 1], id)


def target_of(attributes: Mapping[str, str]) -> str:
    """The id or href that an element refers to, whatever its prefix for XMI is."""
    for name, value in attributes.items():
        if name.rpartition(":")[2] in ("idref", "href"):
            return value
    return ""
