"""Marks on the shapes and lines of elements with errors."""

from collections.abc import Collection
from typing import Any

from msgspec import Struct
from msgspec.structs import fields, replace

from sysmlc.backends.plantuml.views import Diagram
from sysmlc.ir import Graph

MARK = "<color:#C53030>⚠</color> "
_TEXT_FIELDS = ("label", "text")


def mark_faults(
    graph: Graph, diagram: Diagram, trace: Collection[str], faulty: frozenset[str]
) -> Diagram:
    """Return the diagram with a mark on each shape and line that shows an element in *faulty*.

    *trace* has the ids of all elements of the diagram. If one of them has an error but no label, or
    if an owner of the diagram's subject has an error, the mark is on the frame.
    """
    if not faulty:
        return diagram
    view = diagram.view if faulty.isdisjoint(trace) else _mark(diagram.view, faulty)
    subject = graph.get(diagram.about)
    owners = [] if subject is None else [subject, *graph.ancestors(subject)]
    concerned = {*trace, *(owner.id for owner in owners)}
    if view != diagram.view or faulty.isdisjoint(concerned):
        return replace(diagram, view=view)
    return replace(diagram, frame=f"{MARK}{diagram.frame}")


def _mark(view: Any, faulty: frozenset[str]) -> Any:  # noqa: ANN401 - any struct of a view
    """Return the view or a part of it with the marks."""
    if isinstance(view, tuple):
        return tuple(_mark(item, faulty) for item in view)
    if not isinstance(view, Struct):
        return view
    marked = {field.name: _mark(getattr(view, field.name), faulty) for field in fields(view)}
    label = next((name for name in _TEXT_FIELDS if marked.get(name)), None)
    if label is not None and not faulty.isdisjoint(marked.get("shows", ())):
        marked[label] = f"{MARK}{marked[label]}"
    return replace(view, **marked)
