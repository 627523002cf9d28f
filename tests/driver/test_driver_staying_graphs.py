"""Graphs that are changed in turn: what is made of them again is what is made of each alone."""

import random
from pathlib import Path

import pytest

from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model, load_backends, registry
from sysmlc.driver.compilation import Observer
from sysmlc.ir import Edge, Element, Graph, seen
from sysmlc.ir.reads import Reads
from sysmlc.ir.rows import Rows, graph_of, rows
from sysmlc.output import Output

EXAMPLES = Path(__file__).parents[2] / "examples"
MODELS = (
    "baygate-behaviour/baygate-behaviour.uml",
    "four-tasks/four-tasks.uml",
    "lego-recipe-v2/lego-recipe.sysml",
)
BACKENDS = ("contracts", "plantuml", "recipe", "platform")
VALUES = (True, 1, 1.0, 0, "", "count > 2", "x := 1")
OPTIONS = ({}, {"contracts": {"assumed_high": 3}}, {"activities": {"collapse_over": 1}})


class Kept(Observer):
    """The graph before the first pass that uses anything again."""

    rows: Rows

    def after(self, what: str, graph: Graph) -> None:
        if what == "flows":
            self.rows = rows(graph)


def made(kept: Rows, options: dict[str, dict[str, object]], stays: bool) -> tuple[object, ...]:
    """All that later passes and back ends report and write, and who asked for derived values."""
    graph = graph_of(kept, Graph())
    graph.reads = Reads()
    sink, output, told = Sink(), Output(), []
    sink.listen(told)
    if stays:
        seen.see(graph, kept)
    passes = registry.passes(options)
    first = [one.name for one in passes].index("flows") + 1
    faults = []
    for one in passes[first:]:
        graph.reads.reader = f"pass {one.name}"
        faults += fault_of(one.run, graph, sink)
    for one in load_backends(BACKENDS):
        graph.reads.reader = f"emit {one.name}"
        faults += fault_of(one.emit, graph, output, sink, EmitOptions())
    return told, output.artefacts(), faults, graph.reads.used


def fault_of(act, *given: object) -> list[str]:
    """What goes wrong: graphs like these are no models."""
    try:
        act(*given)
    except Exception as fault:
        return [repr(fault)]
    return []


def changed(graph: Graph, chosen: random.Random) -> None:
    one, other = (chosen.choice(list(graph)) for _ in "ab")
    match chosen.randrange(8):
        case 0:
            graph.rename(one, chosen.choice([other.name, f"{one.name}x", ""]))
        case 1 | 2 if one.attrs:
            key = chosen.choice(list(one.attrs))
            graph.set(one, **{key: chosen.choice([*VALUES, other.attrs.get(key)])})
        case 3:
            one.ordinal = chosen.randrange(1000)
        case 4 if len(list(graph.subtree(one))) < len(graph) / 10:
            graph.remove(one)
        case 5 if (owned := graph.owned(one)) and one not in owned:
            graph.move(owned[0], None)
            graph.move(owned[0], one)
        case _:
            retarget(graph, one, chosen)


def retarget(graph: Graph, one: Element, chosen: random.Random) -> None:
    """Let edges of the element lead to where others of their kind lead."""
    for edge in Edge:
        if edge is not Edge.OWNS and graph.targets(one, edge):
            ends = [target for _, _, target in graph.edges(edge)]
            graph.replace_targets(edge, one, [graph[chosen.choice(ends)]])


@pytest.mark.parametrize("model", MODELS)
def test_any_changes_of_a_graph_in_turn(model, monkeypatch):
    monkeypatch.setattr(seen, "_LAST", {})
    used, real = [], seen.Seen.known

    def known(self: seen.Seen, reader: str, given: object) -> object:
        found = real(self, reader, given)
        used.extend([reader] if found else [])
        return found

    monkeypatch.setattr(seen.Seen, "known", known)
    kept, chosen = Kept(), random.Random(1)
    compile_model(Request((EXAMPLES / model,)), kept)
    last, options = kept.rows, OPTIONS[0]
    for number in range(40):
        graph = graph_of(last if number % 10 else kept.rows, Graph())
        for _ in range(chosen.randrange(1, 4)):
            changed(graph, chosen)
        last = rows(graph)
        options = chosen.choice(OPTIONS) if number % 8 == 7 else options
        assert made(last, options, stays=True) == made(last, options, stays=False)
    assert {reader.split()[1] for reader in used} >= {"activities", "contracts", "plantuml"}
