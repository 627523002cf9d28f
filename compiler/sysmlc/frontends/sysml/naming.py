"""Names of elements in the graph, and the ids that follow from them."""

from functools import lru_cache

from sysmlc.ir import Element, Kind
from sysmlc.ir.element import derived_id

_NOTATION = "sysml"
"""What ids are derived from, with the qualified name."""


class Names:
    """The qualified names of the elements that were made, and which are taken."""

    def __init__(self) -> None:
        self._paths: dict[str, str] = {}
        self._taken: dict[str, int] = {}

    def give(self, kind: Kind, name: str, owner: Element | None, source: str) -> str:
        """The id of a new element, whose qualified name is taken from now on."""
        above = "" if owner is None else f"{self._paths[owner.id]}::"
        path = f"{above}{name}" if name else f"{above}<{kind}>"
        if path in self._taken:
            path = self._free(f"{path}<{kind}>" if name and owner else f"{source}#{path}")
        else:
            self._taken[path] = 1
        id_ = _id(path)
        self._paths[id_] = path
        return id_

    def _free(self, path: str) -> str:
        """A path that is told apart by a number where another element has it."""
        number = self._taken[path] = self._taken.get(path, 0) + 1
        if number == 1:
            return path
        path = f"{path}#{number}"
        self._taken[path] = 1
        return path

    def id_of(self, name: str) -> str:
        """Id of the element with a qualified name, or the empty string."""
        found = _id(name)
        return found if found in self._paths else ""


@lru_cache(maxsize=2**15)
def _id(path: str) -> str:
    """Id of what has this path: a process that stays asks for most of them again and again."""
    return derived_id(_NOTATION, path)
