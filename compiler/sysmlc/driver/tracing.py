"""``coverage.json`` and ``trace.json``: what became of the inputs, where outputs come from."""

from collections.abc import Iterable

from sysmlc.diagnostics import Place, Subject
from sysmlc.diagnostics.locate import positions
from sysmlc.driver.compilation import Compilation
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
    names: dict[str, str] = {}
    found = (element for element in map(graph.get, ids) if element is not None)
    known = sorted((_subject(graph, element, names) for element in found), key=_by_name)
    standing = [subject.place for subject in known if subject.place]
    lines = iter(positions(compilation.sources, standing))
    return [
        {
            "id": subject.id,
            "qualified_name": subject.name,
            "source": _source(subject.place.file, *next(lines)) if subject.place else None,
        }
        for subject in known
    ]


def _by_name(subject: Subject) -> tuple[str, str]:
    return subject.name, subject.id


def _subject(graph: Graph, element: Element, names: dict[str, str]) -> Subject:
    """``graph.subject``; most have a source of their own, and share the names above them."""
    if not element.source:
        return graph.subject(element)
    name = _qualified_name(graph, element, names)
    return Subject(name, element.id, Place(element.source, element.ordinal))


def _qualified_name(graph: Graph, element: Element, names: dict[str, str]) -> str:
    own = element.name or f"<{element.kind}>"
    if element.owner is None:
        return own
    above = names.get(element.owner)
    if above is None:
        names[element.owner] = above = graph.qualified_name(graph[element.owner])
    return f"{above}::{own}"


def _source(file: str, line: int, column: int) -> dict[str, object]:
    return {"file": file, "line": line or None, "column": column or None}


def as_text(value: object) -> str:
    """JSON as all our files have it."""
    return json_text(value, 1) + "\n"
