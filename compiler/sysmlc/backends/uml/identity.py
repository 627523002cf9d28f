"""The ``xmi:id`` of every element: its own where XML allows it, else one derived from it."""

import re

from sysmlc.ir import Graph
from sysmlc.ir.identity import derived_id

_NCNAME = re.compile(r"[A-Za-z_][A-Za-z0-9_.-]*")


def xml_ids(graph: Graph) -> dict[str, str]:
    """For the id of each element the id in the file; no two are the same."""
    known = {element.id: element.id for element in graph if _NCNAME.fullmatch(element.id)}
    taken = set(known)
    for element in graph:
        if element.id not in known:
            known[element.id] = _free(element.id, taken)
            taken.add(known[element.id])
    return known


_ADDED = re.compile(r"#(class|part|type|values|unit|quantity|document|required|[AB])(~\d+)?$")
"""Ends of the ids of what a front end adds to an element: words, which are no ids alone."""


def _free(id: str, taken: set[str]) -> str:
    last = "" if _ADDED.search(id) else id.rpartition("#")[2]
    for candidate in (last, f"_{id}"):
        if _NCNAME.fullmatch(candidate) and candidate not in taken:
            return candidate
    return part_id(id, "id")


def part_id(origin: str, role: str) -> str:
    """Id of what is only part of an element: a generalization, a value."""
    return f"_{derived_id(origin, f'uml {role}')}"
