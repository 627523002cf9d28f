"""What is made of elements again: only where nothing that it was made of is another."""

import inspect
from itertools import count

import pytest
from graphs import EDGES, KINDS, graphs, values, words
from hypothesis import given
from hypothesis import strategies as st

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir import seen as module
from sysmlc.ir.noting import Noting
from sysmlc.ir.reads import Literal, Reads
from sysmlc.ir.rows import graph_of, rows
from sysmlc.ir.seen import again, see


@pytest.fixture(autouse=True)
def nothing_seen(monkeypatch):
    monkeypatch.setattr(module, "_LAST", {})


def watched(graph: Graph) -> Graph:
    """The graph as a compilation has it when the first back end begins."""
    graph.reads = Reads()
    graph.reads.reader = "emit x"
    return graph


def seen(graph: Graph) -> Graph:
    see(watched(graph), rows(graph))
    return graph


def copy(graph: Graph) -> Graph:
    return graph_of(rows(graph), Graph())


def plant() -> Graph:
    graph = Graph()
    graph.add(Element("p", Kind.PACKAGE, "plant"))
    graph.add(Element("c", Kind.CLASS, "Cell", "p", attrs={"speed": 1}))
    graph.add(Element("a", Kind.PROPERTY, "arm", "c"))
    graph.add(Element("d", Kind.CLASS, "Arm", "p"))
    graph.connect(Edge.TYPED_BY, "a", "d")
    return graph


def told(graph: Graph, id: str) -> tuple[str, ...]:
    """A text that reads all that there is around an element."""
    element = graph.get(id)
    if element is None:
        return ("none",)
    near = [
        [one.name for edge in EDGES for one in graph.targets(element, edge)],
        [one.id for edge in EDGES for one in graph.sources(element, edge)],
        [(one.id, one.name) for one in graph.owned(element)],
        [one.kind for one in graph.subtree(element)],
        [edge for edge in EDGES if graph.target(element, edge) or graph.source(element, edge)],
    ]
    return (graph.qualified_name(element), element.source, repr(element.attrs), repr(near))


def made(graph: Graph, id: str, calls: list[str] | None = None) -> tuple[str, ...]:
    def make(given: Graph) -> tuple[str, ...]:
        if calls is not None:
            calls.append(id)
        return told(given, id)

    return again(graph, f"of {id}", id, make)


def changed(graph: Graph, draw: st.DrawFn) -> None:
    """One change of any kind."""
    every = list(graph)
    one, other = draw(st.sampled_from(every)), draw(st.sampled_from(every))
    edge = draw(st.sampled_from(EDGES))
    match draw(st.integers(0, 7)):
        case 0:
            graph.rename(one, draw(words))
        case 1:
            graph.set(one, key=draw(values))
        case 2:
            graph.connect(edge, one, other)
        case 3:
            for target in graph.targets(one, edge):
                graph.disconnect(edge, one, target)
        case 4:
            id = next(f"new {number}" for number in count() if f"new {number}" not in graph)
            graph.add(Element(id, draw(st.sampled_from(KINDS)), "n", one.id))
        case 5 if one is not every[0]:
            graph.remove(one)
        case 6 if one not in (other, *graph.ancestors(other)):
            graph.move(one, other)
        case _:
            one.source = "other.uml"


@given(graphs(), st.data())
def test_it_is_what_would_be_made_now(graph, data):
    module._LAST.clear()
    if not len(graph):
        graph.add(Element("root", Kind.PACKAGE))
    for _ in range(3):
        seen(graph)
        ids = [*(one.id for one in graph), "not there", "new 0", "new 1"]
        assert [made(graph, id) for id in ids] == [told(graph, id) for id in ids]
        graph = copy(graph)
        for _ in range(data.draw(st.integers(0, 2))):
            changed(graph, data.draw)


@pytest.mark.parametrize(
    ("change", "ids"),
    [
        (lambda _: None, []),
        (lambda graph: graph.rename(graph["a"], "hand"), ["a", "c", "d", "p"]),
        (lambda graph: graph.set(graph["c"], speed=True), ["a", "c", "p"]),
        (lambda graph: graph.set(graph["c"], speed=1.0), ["a", "c", "p"]),
        (lambda graph: graph.connect(Edge.REFERENCES, "c", "d"), ["c", "d"]),
        (lambda graph: graph.add(Element("n", Kind.CLASS, "N", "p")), ["n", "p"]),
    ],
)
def test_what_is_as_it_was_is_not_made_again(change, ids):
    calls: list[str] = []
    every = ["p", "c", "a", "d", "n"]
    graph = seen(plant())
    [made(graph, id, calls) for id in every]
    assert calls == every
    graph = copy(graph)
    change(graph)
    seen(graph)
    calls.clear()
    [made(graph, id, calls) for id in every]
    assert sorted(calls) == ids


def test_ordinals_do_not_count():
    calls: list[str] = []
    made(seen(plant()), "c", calls)
    graph = plant()
    graph["c"].ordinal = 7
    made(seen(graph), "c", calls)
    assert calls == ["c"]


def test_what_is_given_counts():
    first = again(seen(plant()), "of c", ("x",), lambda graph: [graph["c"].name])
    second = again(seen(plant()), "of c", ("y",), lambda graph: [graph["c"].id])
    assert (first, second) == (("Cell",), ("c",))


def test_who_asks_for_all_of_the_graph_is_asked_again():
    def all_names(graph: Graph) -> list[str]:
        return [one.name for one in graph.of_kind(Kind.CLASS)]

    again(seen(plant()), "of all", (), all_names)
    graph = plant()
    graph.add(Element("n", Kind.CLASS, "New"))
    assert again(seen(graph), "of all", (), all_names) == ("Cell", "Arm", "New")


def test_nothing_is_known_of_a_graph_that_changed_since():
    made(seen(plant()), "c")
    graph = seen(plant())
    graph.rename(graph["c"], "Station")
    assert made(graph, "c") == told(graph, "c")


def test_what_the_last_graph_did_not_need_is_forgotten():
    calls: list[str] = []
    made(seen(plant()), "c", calls)
    seen(plant())
    made(seen(plant()), "c", calls)
    assert calls == ["c", "c"]


def test_few_units_are_remembered():
    for number in range(20):
        graph = Graph()
        graph.add(Element(f"p{number}", Kind.PACKAGE))
        seen(graph)
    assert len(module._LAST) == module._UNITS


def test_an_attribute_that_is_no_value_costs_time_only():
    calls: list[str] = []
    for _ in range(2):
        graph = plant()
        graph["c"].attrs["speed"] = object()  # type: ignore[assignment]
        made(seen(graph), "d", calls)
    assert calls == ["d", "d"]


def with_literals(*keys: str) -> Graph:
    graph = watched(plant())
    for key in keys:
        graph.reads.watch(graph["c"], Literal("f", (), "c", key))
    see(graph, rows(graph))
    return graph


def test_who_asked_for_literals_has_asked_again():
    def speed(graph: Graph) -> list[object]:
        return [graph["c"].attrs.get("speed")]

    found = []
    for _ in range(2):
        graph = with_literals("speed", "label")
        again(graph, "of c", (), speed)
        found.append(graph.reads.readers)
    assert found[0] == found[1] == {("c", "speed"): {"emit x of c": None}, ("c", "label"): {}}


def test_an_attribute_that_becomes_a_literal_is_asked_for():
    again(with_literals(), "of c", (), lambda graph: [graph["c"].attrs.get("speed")])
    graph = with_literals("speed")
    again(graph, "of c", (), lambda graph: [graph["c"].attrs.get("speed")])
    assert graph.reads.readers == {("c", "speed"): {"emit x of c": None}}


MADE_OF_OTHERS = {"roots", "owner", "ancestors", "qualified_name"}
CHANGES = {
    *("add", "new", "connect", "connect_new", "connect_fan", "connect_all", "connect_each"),
    *("disconnect", "replace_targets", "move", "remove", "rename", "set", "refer", "store"),
    *("fill", "add_loose"),
}


def test_whoever_reads_a_graph_is_noted():
    def methods(cls: type) -> set[str]:
        own = {name for name, one in vars(cls).items() if inspect.isfunction(one)}
        return {name for name in own if not name.startswith("_") or name.endswith("__")}

    assert methods(Graph) - methods(Noting) == MADE_OF_OTHERS | CHANGES
