"""Literals of the enumerations of a model, by the names that expressions have for them."""

from functools import cached_property

from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.names import unique


class Enumerations:
    """All enumerations; looked through when an expression names what is no property."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph

    @cached_property
    def literals(self) -> dict[str, tuple[str, str]]:
        """Enumeration literals by written name: (enumeration, identifier)."""
        found: dict[str, tuple[str, str]] = {}
        for enumeration in self._graph.of_kind(Kind.ENUMERATION):
            for name, made in literals_of(self._graph, enumeration).items():
                for written in (name, f"{enumeration.name}::{name}", f"{enumeration.name}.{name}"):
                    found.setdefault(written, (enumeration.name, made))
        return found

    @cached_property
    def numbers(self) -> dict[str, int]:
        """Numbers that enumeration literals stand for, by written name."""
        found: dict[str, int] = {}
        for literal in self._graph.of_kind(Kind.ENUMERATION_LITERAL):
            value, owner = literal.attrs.get("value"), self._graph.owner(literal)
            if isinstance(value, int) and not isinstance(value, bool) and owner is not None:
                for sign in ("::", "."):
                    found.setdefault(f"{owner.name}{sign}{literal.name}", value)
        return found


def literals_of(graph: Graph, enumeration: Element) -> dict[str, str]:
    """Identifiers of the literals of an enumeration by their names."""
    owned = graph.owned(enumeration)
    names = [one.name for one in owned if one.kind is Kind.ENUMERATION_LITERAL]
    return dict(zip(names, unique(names, "literal"), strict=True))
