"""``coverage.json`` and ``trace.json``: what became of the inputs, where outputs come from."""

from collections.abc import Iterable, Mapping

from sysmlc.diagnostics import Place, Subject
from sysmlc.driver.compilation import Compilation
from sysmlc.driver.places import Locator
from sysmlc.ir import Element, Graph
from sysmlc.output import json_text

COVERAGE = "coverage.json"
TRACE = "trace.json"


def coverage_text(compilation: Compilation) -> str:
    """The verdict on every element of the inputs."""
    return as_text({"schema": "sysmlc-coverage/1", **compilation.coverage.as_json()})


def trace_text(compilation: Compilation) -> str:
    """Which elements each file comes from, and where those stand in the inputs."""
    written = compilation.written()
    ids = dict.fromkeys(id for artefact in written for id in artefact.trace)
    return as_text(
        {
            "schema": "sysmlc-trace/1",
            "outputs": [{"path": a.path, "elements": list(a.trace)} for a in written],
            "elements": _elements(compilation, ids),
        }
    )


def _elements(compilation: Compilation, ids: Iterable[str]) -> list[dict[str, object]]:
    graph = compilation.graph
    known = [element for element in map(graph.get, ids) if element is not None]
    names: dict[str, str] = {}
    subjects = {element.id: _subject(graph, element, names) for element in known}
    places = Locator(compilation.sources)(s.place for s in subjects.values() if s.place)
    return [
        {
            "id": id,
            "qualified_name": subject.name,
            "source": _source(subject.place, places) if subject.place else None,
        }
        for id, subject in sorted(subjects.items(), key=lambda pair: (pair[1].name, pair[0]))
    ]


def _subject(graph: Graph, element: Element, names: dict[str, str]) -> Subject:
    """``graph.subject``; most have a source of their own, and share the names above them."""
    if not element.source:
        return graph.subject(element)
    name = _qualified_name(graph, element, names)
    return Subject(name, element.id, Place(element.source, element.ordinal))


def _qualified_name(graph: Graph, element: Element, names: dict[str, str]) -> str:
    owner = graph.owner(element)
    above = "" if owner is None else names.get(owner.id)
    if above is None and owner is not None:
        names[owner.id] = above = graph.qualified_name(owner)
    own = element.name or f"<{element.kind}>"
    return f"{above}::{own}" if owner is not None else own


def _source(place: Place, places: Mapping[Place, Place]) -> dict[str, object]:
    found = places.get(place, place)
    return {"file": place.file, "line": found.line or None, "column": found.column or None}


def as_text(value: object) -> str:
    """JSON as all our files have it."""
    return json_text(value, 1) + "\n"
