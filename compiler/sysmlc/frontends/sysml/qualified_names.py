"""Qualified names of elements in the graph, and the ids derived from them."""

from functools import lru_cache

from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.element import derived_id

_NOTATION = "sysml"
"""Origin of all ids of this front end."""


class QualifiedNames:
    """Symbol table of the qualified names that elements of the unit have."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._names: dict[str, str] = {}
        """Qualified names by id."""
        self._used: dict[str, int] = {}
        """How many elements asked for a qualified name."""

    def add(self, kind: Kind, name: str, owner: Element | None, source: str) -> str:
        """Return the id of a new element and enter its qualified name.

        An element without a name is named by its kind. A name that is already used gets the kind
        appended, or the file in front at the root, and then a number.
        """
        prefix = "" if owner is None else f"{self._names[owner.id]}::"
        qualified_name = f"{prefix}{name}" if name else f"{prefix}<{kind}>"
        if qualified_name in self._used:
            is_member = bool(name and owner)
            qualified_name = self._make_unique(
                f"{qualified_name}<{kind}>" if is_member else f"{source}#{qualified_name}"
            )
        else:
            self._used[qualified_name] = 1
        # ``--emit uml`` keeps the ids: the unit may contain the text and the UML made from it.
        while _derive_id(qualified_name) in self._graph:
            qualified_name = self._make_unique(f"{source}#{qualified_name}")
        id_ = _derive_id(qualified_name)
        self._names[id_] = qualified_name
        return id_

    def _make_unique(self, qualified_name: str) -> str:
        """Return the name, with a number if another element has it."""
        number = self._used[qualified_name] = self._used.get(qualified_name, 0) + 1
        if number == 1:
            return qualified_name
        numbered = f"{qualified_name}#{number}"
        self._used[numbered] = 1
        return numbered

    def id_of(self, qualified_name: str) -> str:
        """Return the id of the element with a qualified name, or the empty string."""
        id_ = _derive_id(qualified_name)
        return id_ if id_ in self._names else ""


@lru_cache(maxsize=2**15)
def _derive_id(qualified_name: str) -> str:
    """Return the id for a qualified name; ``sysmlc watch`` derives the same ids at each edit."""
    return derived_id(_NOTATION, qualified_name)
