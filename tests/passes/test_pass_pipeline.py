"""The pipeline: order, ``until``, ``verify_each``, what callers see."""

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
class Named:
    """A pass that notes its name."""

    name: str
    after: tuple[str, ...] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        graph.add(Element(self.name, Kind.PACKAGE))


@dataclass(frozen=True)
class Harmful:
    """A pass that breaks ownership."""

    name: ClassVar[str] = "harmful"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        graph.add(Element("a", Kind.PACKAGE)).owner = "nobody"


def test_passes_come_after_those_that_they_name_and_else_in_their_order():
    passes = [Named("c", ("a",)), Named("b"), Named("a", ("absent",)), Named("d", ("c", "b"))]
    assert [one.name for one in sort_passes(passes)] == ["b", "a", "c", "d"]


def test_passes_that_wait_for_one_another_are_refused():
    with pytest.raises(ValueError, match="a, b"):
        sort_passes([Named("a", ("b",)), Named("b", ("a",))])


def test_shipped_passes_are_listed_in_an_order_that_they_accept():
    structural = [load(name) for name in NAMES[:6]]
    assert [one.name for one in sort_passes(structural)] == list(NAMES[:6])
    assert [one.name for one in sort_passes(reversed(structural))] == list(NAMES[:6])


def test_all_shipped_passes_run_in_the_order_of_their_names():
    assert [one.name for one in build_pipeline().passes] == list(NAMES)


def test_run_stops_behind_the_pass_asked_for_and_shows_each_graph():
    seen, graph = [], Graph()
    Pipeline((Named("a"), Named("b"), Named("c"))).run(
        graph, Sink(), until="b", after_pass=lambda name, made: seen.append((name, len(made)))
    )
    assert seen == [("a", 1), ("b", 2)]


def test_unknown_pass_is_refused():
    for name in ("nothing", ""):
        with pytest.raises(KeyError):
            run(Graph(), Sink(), until=name)
        with pytest.raises(KeyError):
            load(name)


def test_pass_that_leaves_an_invalid_graph_is_named():
    with pytest.raises(InvalidGraphError, match="pass harmful"):
        Pipeline((Harmful(),)).run(Graph(), Sink(), verify_each=True)
    Pipeline((Harmful(),)).run(Graph(), Sink())


def test_invalid_graph_of_a_front_end_is_noticed_before_the_first_pass():
    graph = Graph()
    Harmful().run(graph, Sink())
    with pytest.raises(InvalidGraphError, match="front end"):
        Pipeline((Named("b"),)).run(graph, Sink(), verify_each=True)


def test_run_of_the_first_passes_needs_none_of_the_others():
    seen: list[str] = []
    run(Graph(), Sink(), until="classify", after_pass=lambda name, _: seen.append(name))
    assert seen == ["resolve", "kept", "overlay", "inherit", "classify"]
