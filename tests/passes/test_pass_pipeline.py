"""The pipeline: the order of passes, ``until``, ``verify_each`` and ``after_pass``."""

from dataclasses import dataclass
from typing import ClassVar

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind
from sysmlc.passes.pipeline import (
    NAMES,
    InvalidGraphError,
    Pipeline,
    build_pipeline,
    load,
    run,
    sort_passes,
)


@dataclass(frozen=True)
class RecordingPass:
    """A pass that adds an element of its name."""

    name: str
    after: tuple[str, ...] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        graph.add(Element(self.name, Kind.PACKAGE))


@dataclass(frozen=True)
class HarmfulPass:
    """A pass that leaves an invalid graph: an element has an unknown owner."""

    name: ClassVar[str] = "harmful"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        graph.add(Element("a", Kind.PACKAGE)).owner = "nobody"


def test_passes_follow_their_predecessors_and_otherwise_retain_their_order():
    passes = [
        RecordingPass("c", ("a",)),
        RecordingPass("b"),
        RecordingPass("a", ("absent",)),
        RecordingPass("d", ("c", "b")),
    ]
    assert [pass_.name for pass_ in sort_passes(passes)] == ["b", "a", "c", "d"]


def test_passes_that_follow_each_other_are_rejected():
    with pytest.raises(ValueError, match="a, b"):
        sort_passes([RecordingPass("a", ("b",)), RecordingPass("b", ("a",))])


def test_shipped_passes_are_listed_in_an_order_that_they_accept():
    structural = [load(name) for name in NAMES[:6]]
    assert [pass_.name for pass_ in sort_passes(structural)] == list(NAMES[:6])
    assert [pass_.name for pass_ in sort_passes(reversed(structural))] == list(NAMES[:6])


def test_all_shipped_passes_run_in_the_order_of_their_names():
    assert [pass_.name for pass_ in build_pipeline().passes] == list(NAMES)


def test_a_run_stops_after_until_and_passes_each_graph_to_the_caller():
    sizes, graph = [], Graph()
    Pipeline((RecordingPass("a"), RecordingPass("b"), RecordingPass("c"))).run(
        graph, Sink(), until="b", after_pass=lambda name, graph: sizes.append((name, len(graph)))
    )
    assert sizes == [("a", 1), ("b", 2)]


def test_an_unknown_pass_is_rejected():
    for name in ("nothing", ""):
        with pytest.raises(KeyError):
            run(Graph(), Sink(), until=name)
        with pytest.raises(KeyError):
            load(name)


def test_a_pass_that_leaves_an_invalid_graph_is_named():
    with pytest.raises(InvalidGraphError, match="pass harmful"):
        Pipeline((HarmfulPass(),)).run(Graph(), Sink(), verify_each=True)
    Pipeline((HarmfulPass(),)).run(Graph(), Sink())


def test_an_invalid_graph_of_a_front_end_is_found_before_the_first_pass():
    graph = Graph()
    HarmfulPass().run(graph, Sink())
    with pytest.raises(InvalidGraphError, match="front end"):
        Pipeline((RecordingPass("b"),)).run(graph, Sink(), verify_each=True)


def test_a_run_until_a_pass_omits_the_later_passes():
    names: list[str] = []
    run(Graph(), Sink(), until="classify", after_pass=lambda name, _: names.append(name))
    assert names == ["resolve", "kept", "overlay", "inherit", "classify"]
