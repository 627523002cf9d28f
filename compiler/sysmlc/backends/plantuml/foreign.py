"""Dependencies of what other diagrams show, as rows of the box that they lead to.

A package of machines on which twenty services depend would be as wide as twenty grey boxes.
"""

from collections.abc import Iterable

from msgspec.structs import replace

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.relations import Relation
from sysmlc.backends.plantuml.views import Box, Compartment
from sysmlc.ir import Graph
from sysmlc.support.plantuml_text import lines

MOST = 3
"""Foreign clients in one diagram that still are boxes with lines."""

_TITLE = "depended on by"
_WIDTH = 46


def folded(
    found: Iterable[Relation], own: set[str]
) -> tuple[list[Relation], dict[str, list[Relation]]]:
    """The relations that stay lines, and those that become rows, by the box that has them."""
    every = list(found)
    inward = [one for one in every if _is_inward(one, own)]
    if len({one.source for one in inward}) <= MOST:
        return every, {}
    rows: dict[str, list[Relation]] = {}
    for one in inward:
        rows.setdefault(one.target, []).append(one)
    return [one for one in every if not _is_inward(one, own)], rows


def _is_inward(relation: Relation, own: set[str]) -> bool:
    is_plain = relation.arrow == "..>" and not relation.near and not relation.far
    return is_plain and relation.source not in own and relation.target in own


def added(graph: Graph, box: Box, rows: list[Relation]) -> Box:
    """The box with a row for each relation."""
    if not rows:
        return box
    texts = (f"{labels.name(graph[one.source])} {one.label}".strip() for one in rows)
    shown = tuple(row for text in texts for row in lines(text, _WIDTH))
    return replace(
        box,
        compartments=(*box.compartments, Compartment(_TITLE, shown)),
        shows=(*box.shows, *(id for one in rows for id in one.shows)),
    )
