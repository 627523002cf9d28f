"""What a requirement table says, cell by cell, as plain text."""

import re
from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import AttrValue, Edge, Element, Graph
from sysmlc.ir.query import applications, is_requirement, lineage

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
"""Columns of every table; those of custom tags follow."""

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
"""Tags of SysML's own, in lower case; relations say what the derived ones among them repeat."""
_NUMBER = re.compile(r"(\d+)")


class Cell(Struct, frozen=True):
    """Values of one cell, in order; a text is one value with its line ends."""

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
        """Ids of the requirements."""
        return tuple(row.element.id for row in self.rows)


def is_listed(element: Element) -> bool:
    """Whether tables list it: a requirement of a file of the unit."""
    return is_requirement(element) and not element.attrs.get("external")


def tables(graph: Graph) -> list[Table]:
    """One table for each root with requirements, in the order of the roots."""
    found = []
    for root in graph.roots():
        held = [one for one in graph.subtree(root) if is_listed(one)]
        if held:
            found.append(_table(graph, root, held))
    return found


def _table(graph: Graph, root: Element, held: list[Element]) -> Table:
    ordered = sorted(held, key=lambda one: (_natural(_id(one)), graph.qualified_name(one), one.id))
    tags = sorted({name for one in held for name in _tags(graph, one)}, key=_make_sort_key)
    rows = tuple(Row(one, tuple(_cells(graph, one, tags))) for one in ordered)
    return Table(graph.qualified_name(root), root.id, (*COLUMNS, *tags), rows)


def _make_sort_key(name: str) -> tuple[str, str]:
    return name.lower(), name


def _id(requirement: Element) -> str:
    return str(requirement.attrs.get("req_id", "")).strip()


def _natural(id: str) -> tuple[bool, tuple[tuple[bool, int, str], ...]]:
    """Order in which R2 goes before R10; requirements without an id go last."""
    parts = (part for part in _NUMBER.split(id) if part)
    ranked = ((not part.isascii() or not part.isdigit(), part) for part in parts)
    return not id, tuple((word, 0 if word else int(part), part) for word, part in ranked)


def _cells(graph: Graph, requirement: Element, tags: list[str]) -> Iterator[Cell]:
    yield _cell(_id(requirement))
    yield _cell(requirement.name)
    yield Cell(tuple(kinds(graph, requirement)))
    yield _cell(text_of(graph, requirement))
    owner = graph.owner(requirement)
    yield _cell(graph.qualified_name(owner) if owner is not None else "")
    yield _cell(*_list_names(graph, graph.targets(requirement, Edge.DERIVES)))
    for edge in (Edge.SATISFIES, Edge.VERIFIES, Edge.REFINES):
        yield _cell(*_list_names(graph, graph.sources(requirement, edge)))
    masters = _masters(graph, requirement)
    traced = [one for one in graph.targets(requirement, Edge.TRACES) if one not in masters]
    yield _cell(*_list_names(graph, traced))
    yield _cell(*_list_names(graph, masters))
    given = _tags(graph, requirement)
    yield from (_cell(*given.get(name, ())) for name in tags)


def _cell(*values: str) -> Cell:
    return Cell(tuple(value for value in values if value))


def kinds(graph: Graph, requirement: Element) -> Iterator[str]:
    """Stereotypes that make it a requirement of some kind, with the SysML kind behind a custom one.

    ``SafetyRequirement (performanceRequirement)``; a plain requirement gives none.
    """
    for application in applications(graph, requirement):
        names = lineage(application)
        if not {"Requirement", "AbstractRequirement"}.isdisjoint(names):
            telling = [name for name in names if name not in _PLAIN]
            if telling:
                general = f" ({', '.join(telling[1:])})" if telling[1:] else ""
                yield telling[0] + general


def text_of(graph: Graph, requirement: Element) -> str:
    """The text of a requirement; a copy without one has its master's (SysML 1.6 clause 16.3.2)."""
    for one in (requirement, *_masters(graph, requirement)):
        text = str(one.attrs.get("text", "")).strip()
        if text:
            return text
    return ""


def _masters(graph: Graph, requirement: Element) -> list[Element]:
    copies = [one for one in graph.sources(requirement, Edge.CLIENT) if one.role == "copy"]
    found = (master for copy in copies for master in graph.targets(copy, Edge.SUPPLIER))
    return list(dict.fromkeys(found))


def _list_names(graph: Graph, elements: list[Element]) -> list[str]:
    """Return requirements by id and name, other elements by qualified name."""
    return [_name(graph, element) for element in elements]


def _name(graph: Graph, element: Element) -> str:
    if is_listed(element) and _id(element):
        return f"{_id(element)} {element.name}".strip()
    return graph.qualified_name(element)


# -- tags --------------------------------------------------------------------------------------


def _tags(graph: Graph, requirement: Element) -> dict[str, tuple[str, ...]]:
    """Custom tagged values by name; ids of elements are shown as their names."""
    found: dict[str, tuple[str, ...]] = {}
    for application in applications(graph, requirement):
        for key, value in application.attrs.items():
            name = key.removeprefix("tag.")
            if key.startswith("tag.") and name.lower() not in _STANDARD:
                found.setdefault(name, tuple(_texts(graph, value)))
    return found


def _texts(graph: Graph, value: AttrValue) -> Iterator[str]:
    if isinstance(value, tuple):
        for one in value:
            yield from _texts(graph, one)
    elif isinstance(value, bool):
        yield "true" if value else "false"
    elif value is not None:
        known = graph.get(value) if isinstance(value, str) else None
        yield _name(graph, known) if known is not None else str(value).strip()
