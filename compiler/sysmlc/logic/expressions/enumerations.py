"""Literals of the enumerations of a model, by the names that expressions have for them."""

from functools import cached_property

from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.contract import EnumerationDomain
from sysmlc.logic.names import unique


class Enumerations:
    """All enumerations; looked through when an expression names what is no property."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._numbers: dict[str, int | None] = {}

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
    def domains(self) -> dict[str, EnumerationDomain]:
        """The literals (identifiers) of enumerations by the names of these."""
        found: dict[str, dict[str, None]] = {}
        for enumeration, made in self.literals.values():
            found.setdefault(enumeration, {})[made] = None
        return {name: EnumerationDomain(tuple(made)) for name, made in found.items()}

    def number(self, written: str) -> int | None:
        """The number that an enumeration literal stands for, by written name."""
        if written not in self._numbers:
            self._numbers[written] = self._number(written)
        return self._numbers[written]

    def _number(self, written: str) -> int | None:
        for literal in self._graph.of_kind(Kind.ENUMERATION_LITERAL):
            owner = self._graph.owner(literal) if written.endswith(literal.name) else None
            if owner is None or not _is_written(written, owner.name, literal.name):
                continue
            value = literal.attrs.get("value")
            if isinstance(value, int) and not isinstance(value, bool):
                return value
        return None


def _is_written(written: str, owner: str, name: str) -> bool:
    return written in (f"{owner}::{name}", f"{owner}.{name}")


def literals_of(graph: Graph, enumeration: Element) -> dict[str, str]:
    """Identifiers of the literals of an enumeration by their names."""
    owned = graph.owned(enumeration)
    names = [one.name for one in owned if one.kind is Kind.ENUMERATION_LITERAL]
    return dict(zip(names, unique(names, "literal"), strict=True))
