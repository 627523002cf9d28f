"""``coverage.json`` and ``trace.json``: what became of the inputs, where outputs come from."""

from collections.abc import Iterable, Mapping
from itertools import chain
from json.encoder import encode_basestring

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locate import positions
from sysmlc.driver.compilation import Compilation
from sysmlc.ir import Element, Graph
from sysmlc.output import json_text

COVERAGE = "coverage.json"
TRACE = "trace.json"

_NOWHERE: Mapping[int, tuple[int, int]] = {}


def coverage_text(compilation: Compilation) -> str:
    """The verdict on every element of the inputs."""
    return as_text({"schema": "sysmlc-coverage/1", **compilation.coverage.as_json()})


def trace_text(compilation: Compilation) -> str:
    """Which elements each file comes from, and where those stand in the inputs.

    It is written as ``json_text`` would, without dicts between: there are thousands of elements.
    """
    written = compilation.written()
    traces = dict.fromkeys(artefact.trace for artefact in written)
    ids = dict.fromkeys(chain.from_iterable(traces))
    # Several files of one element often have one trace, and it can be long.
    listed = {trace: _rows(map(encode_basestring, trace), "   ") for trace in traces}
    outputs = (_output(one.path, listed[one.trace]) for one in written)
    return (
        f'{{\n "schema": "sysmlc-trace/1",\n "outputs": {_rows(outputs, " ")},\n'
        f' "elements": {_rows(_elements(compilation, ids), " ")}\n}}\n'
    )


def _rows(items: Iterable[str], indent: str) -> str:
    joined = f",\n{indent} ".join(items)
    return f"[\n{indent} {joined}\n{indent}]" if joined else "[]"


def _output(path: str, elements: str) -> str:
    return f'{{\n   "path": {encode_basestring(path)},\n   "elements": {elements}\n  }}'


def _elements(compilation: Compilation, ids: Iterable[str]) -> list[str]:
    graph = compilation.graph
    names: dict[str, str] = {}
    there = (element for element in map(graph.get, ids) if element is not None)
    known = sorted(_start(graph, element, names) for element in there)
    ordinals: dict[str, list[int]] = {}
    for _, _, file, ordinal in known:
        ordinals.setdefault(file, []).append(ordinal)
    found = positions(compilation.sources, ordinals)
    return [
        _element(id, name, file, *found.get(file, _NOWHERE).get(ordinal, (0, 0)))
        for name, id, file, ordinal in known
    ]


def _element(id: str, name: str, file: str, line: int, column: int) -> str:
    """One element as ``json_text`` would write it: there are thousands of the same shape."""
    source = (
        f'{{\n    "file": {encode_basestring(file)},\n    "line": {line or "null"},\n'
        f'    "column": {column or "null"}\n   }}'
        if file
        else "null"
    )
    return (
        f'{{\n   "id": {encode_basestring(id)},\n'
        f'   "qualified_name": {encode_basestring(name)},\n   "source": {source}\n  }}'
    )


def _start(graph: Graph, element: Element, names: dict[str, str]) -> tuple[str, str, str, int]:
    """Name, id, file and ordinal of ``graph.subject``; most have a source of their own."""
    if element.source:
        name = _qualified_name(graph, element, names)
        return name, element.id, element.source, element.ordinal
    subject = graph.subject(element)
    place = subject.place or Place("")
    return subject.name, subject.id, place.file, place.ordinal


def _qualified_name(graph: Graph, element: Element, names: dict[str, str]) -> str:
    own = element.name or f"<{element.kind}>"
    if element.owner is None:
        return own
    above = names.get(element.owner)
    if above is None:
        names[element.owner] = above = graph.qualified_name(graph[element.owner])
    return f"{above}::{own}"


def as_text(value: object) -> str:
    """JSON as all our files have it."""
    return json_text(value, 1) + "\n"
