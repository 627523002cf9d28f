"""The content of requirement tables, cell by cell, as plain text."""

import re
from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import AttrValue, Edge, Element, Graph
from sysmlc.ir.query import (
    applications,
    is_requirement,
    lineage,
    list_restated,
    requirement_id,
    requirement_text,
)

COLUMNS = (
    "id",
    "name",
    "kind",
    "text",
    "owner",
    "derived from",
    "satisfied by",
    "verified by",
    "refined by",
    "traced to",
    "copy of",
)
"""Columns of every table; columns of custom tags follow."""

_PLAIN = frozenset(["Requirement", "AbstractRequirement", "extendedRequirement", "NamedElement"])
_STANDARD = frozenset(
    [
        "id",
        "text",
        "derived",
        "derivedfrom",
        "master",
        "refinedby",
        "satisfiedby",
        "tracedto",
        "verifiedby",
    ]
)
"""Tags of SysML in lower case; the derived ones repeat relations, which have columns."""
_NUMBER = re.compile(r"(\d+)")


class Cell(Struct, frozen=True):
    """The values of one cell, in order; a text of several lines is one value."""

    values: tuple[str, ...] = ()


class Row(Struct, frozen=True):
    """One requirement: its cells in the order of the columns."""

    element: Element
    cells: tuple[Cell, ...]


class Table(Struct, frozen=True):
    """The requirements below one root of the model."""

    name: str
    about: str
    columns: tuple[str, ...]
    rows: tuple[Row, ...]

    def trace(self) -> tuple[str, ...]:
        """Return the ids of the requirements."""
        return tuple(row.element.id for row in self.rows)


def is_listed(element: Element) -> bool:
    """Whether tables list the element: a requirement of a file of the unit."""
    return is_requirement(element) and not element.attrs.get("external")


def make_tables(graph: Graph) -> list[Table]:
    """Return one table for each root with requirements, in the order of the roots."""
    tables = []
    for root in graph.roots():
        requirements = [element for element in graph.subtree(root) if is_listed(element)]
        if requirements:
            tables.append(_make_table(graph, root, requirements))
    return tables


def _make_table(graph: Graph, root: Element, requirements: list[Element]) -> Table:
    keys = {r.id: _make_id_key(requirement_id(graph, r)) for r in requirements}
    ordered = sorted(requirements, key=lambda r: (keys[r.id], graph.qualified_name(r), r.id))
    names = {name for requirement in requirements for name in _read_tags(graph, requirement)}
    tags = sorted(names, key=lambda name: (name.lower(), name))
    rows = tuple(
        Row(requirement, tuple(_iter_cells(graph, requirement, tags))) for requirement in ordered
    )
    return Table(graph.qualified_name(root), root.id, (*COLUMNS, *tags), rows)


def _make_id_key(id: str) -> tuple[bool, tuple[tuple[bool, int, str], ...]]:
    """Return a sort key with R2 before R10; requirements without an id come last."""
    parts = (part for part in _NUMBER.split(id) if part)
    ranked = ((not part.isascii() or not part.isdigit(), part) for part in parts)
    return not id, tuple((is_word, 0 if is_word else int(part), part) for is_word, part in ranked)


def _iter_cells(graph: Graph, requirement: Element, tags: list[str]) -> Iterator[Cell]:
    """Yield the cells of a requirement in the order of ``COLUMNS``, then those of *tags*."""
    yield _make_cell(requirement_id(graph, requirement))
    yield _make_cell(requirement.name)
    yield Cell(tuple(_iter_kinds(graph, requirement)))
    yield _make_cell(_find_text(graph, requirement))
    owner = graph.owner(requirement)
    yield _make_cell(graph.qualified_name(owner) if owner is not None else "")
    yield _make_cell(*_list_names(graph, graph.targets(requirement, Edge.DERIVES)))
    restated = list_restated(graph, requirement)
    for edge in (Edge.SATISFIES, Edge.VERIFIES, Edge.REFINES):
        related = (element for member in restated for element in graph.sources(member, edge))
        yield _make_cell(*_list_names(graph, list(dict.fromkeys(related))))
    masters = _list_masters(graph, requirement)
    # A copy is a trace too (SysML 1.6 clause 16.3.2), and has a column of its own.
    traced = [target for target in graph.targets(requirement, Edge.TRACES) if target not in masters]
    yield _make_cell(*_list_names(graph, traced))
    yield _make_cell(*_list_names(graph, masters))
    tagged_values = _read_tags(graph, requirement)
    yield from (_make_cell(*tagged_values.get(name, ())) for name in tags)


def _make_cell(*values: str) -> Cell:
    return Cell(tuple(value for value in values if value))


def _iter_kinds(graph: Graph, requirement: Element) -> Iterator[str]:
    """Yield the stereotypes that are more special than ``Requirement``.

    A custom stereotype is followed by those of SysML that it specialises:
    ``SafetyRequirement (performanceRequirement)``.
    """
    for application in applications(graph, requirement):
        names = lineage(application)
        if not {"Requirement", "AbstractRequirement"}.isdisjoint(names):
            special = [name for name in names if name not in _PLAIN]
            if special:
                general = f" ({', '.join(special[1:])})" if special[1:] else ""
                yield special[0] + general


def _find_text(graph: Graph, requirement: Element) -> str:
    """Return the text of a requirement; a copy has its master's text (SysML 1.6 clause 16.3.2)."""
    for candidate in (requirement, *_list_masters(graph, requirement)):
        text = requirement_text(graph, candidate)
        if text:
            return text
    return ""


def _list_masters(graph: Graph, requirement: Element) -> list[Element]:
    """Return the requirements of which this one is a copy, each once."""
    copies = [edge for edge in graph.sources(requirement, Edge.CLIENT) if edge.role == "copy"]
    masters = (master for copy in copies for master in graph.targets(copy, Edge.SUPPLIER))
    return list(dict.fromkeys(masters))


def _list_names(graph: Graph, elements: list[Element]) -> list[str]:
    """Return requirements by id and name, other elements by qualified name."""
    return [_name_element(graph, element) for element in elements]


def _name_element(graph: Graph, element: Element) -> str:
    id = requirement_id(graph, element) if is_listed(element) else ""
    if id:
        return f"{id} {element.name}".strip()
    return graph.qualified_name(element)


# -- tags --------------------------------------------------------------------------------------


def _read_tags(graph: Graph, requirement: Element) -> dict[str, tuple[str, ...]]:
    """Return the values of custom tags by name; ids of elements become their names."""
    tags: dict[str, tuple[str, ...]] = {}
    for application in applications(graph, requirement):
        for key, value in application.attrs.items():
            name = key.removeprefix("tag.")
            if key.startswith("tag.") and name.lower() not in _STANDARD:
                tags.setdefault(name, tuple(_iter_texts(graph, value)))
    return tags


def _iter_texts(graph: Graph, value: AttrValue) -> Iterator[str]:
    """Yield the values of a tag as texts, those of a nested list one after the other."""
    if isinstance(value, tuple):
        for item in value:
            yield from _iter_texts(graph, item)
    elif isinstance(value, bool):
        yield "true" if value else "false"
    elif value is not None:
        element = graph.get(value) if isinstance(value, str) else None
        yield _name_element(graph, element) if element is not None else str(value).strip()
