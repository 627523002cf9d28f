"""``coverage.json`` and ``trace.json``: what became of the inputs, where outputs come from."""

from collections.abc import Iterable, Iterator
from itertools import chain
from json.encoder import encode_basestring

from sysmlc.diagnostics import Place
from sysmlc.driver.compilation import Compilation
from sysmlc.driver.traced import Start, told
from sysmlc.ir import Element, Graph
from sysmlc.output import json_text

COVERAGE = "coverage.json"
TRACE = "trace.json"


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
    listed = {trace: "".join(_rows(map(encode_basestring, trace), "   ")) for trace in traces}
    outputs = (_output(one.path, listed[one.trace]) for one in written)
    return "".join(
        (
            '{\n "schema": "sysmlc-trace/1",\n "outputs": ',
            *_rows(outputs, " "),
            ',\n "elements": ',
            *_rows(_elements(compilation, ids), " "),
            "\n}\n",
        )
    )


def _rows(items: Iterable[str], indent: str) -> tuple[str, ...]:
    """A list, as pieces: what is large is put together once."""
    joined = f",\n{indent} ".join(items)
    return (f"[\n{indent} ", joined, f"\n{indent}]") if joined else ("[]",)


def _output(path: str, elements: str) -> str:
    return f'{{\n   "path": {encode_basestring(path)},\n   "elements": {elements}\n  }}'


def _elements(compilation: Compilation, ids: Iterable[str]) -> list[str]:
    graph = compilation.graph
    return told(compilation.sources, _starts(graph, filter(None, map(graph.get, ids))))


def _starts(graph: Graph, elements: Iterable[Element]) -> Iterator[Start]:
    """Name, id, file and ordinal of ``graph.subject``; most have a source of their own."""
    names: dict[str, str] = {}
    for one in elements:
        if not one.source:
            subject = graph.subject(one)
            place = subject.place or Place("")
            yield subject.name, one.id, place.file, place.ordinal
            continue
        name = one.name or f"<{one.kind}>"
        if one.owner is not None:
            above = names.get(one.owner)
            if above is None:
                above = names[one.owner] = graph.qualified_name(graph[one.owner])
            name = f"{above}::{name}"
        yield name, one.id, one.source, one.ordinal


def as_text(value: object) -> str:
    """JSON as all our files have it."""
    return json_text(value, 1) + "\n"
