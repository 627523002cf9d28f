"""Work that reports comes to what it came to before, told again, where nothing of it changed."""

from collections.abc import Callable

import pytest

from sysmlc.diagnostics import Rule, Severity, Sink
from sysmlc.ir import Edge, Graph, Kind, parse_text, seen
from sysmlc.ir.asking import indexed, look_up
from sysmlc.ir.reads import Literal, Reads
from sysmlc.ir.retold import retold
from sysmlc.ir.rows import rows

ODD = Rule("SM999", "odd", Severity.INFO, "'{name}' is odd", "", "", "", "")
PLANT = """\
Package p "Plant" @a.sysml:0
  Class c "Cell" @a.sysml:10
    Property s "speed" default=1 @a.sysml:20
      -> typed-by d
    Property t "torque" @a.sysml:30
  Class d "Drive" @a.sysml:40
    Property f "force" @a.sysml:50
"""
Make = Callable[[Graph, Sink], object]


@pytest.fixture(autouse=True)
def nothing_is_remembered(monkeypatch):
    monkeypatch.setattr(seen, "_LAST", {})
    monkeypatch.setattr(seen, "_stays", False)


def graph_of(text: str) -> Graph:
    """The next graph of the unit."""
    graph = clean_graph_of(text)
    seen.see(graph, rows(graph))
    return graph


def clean_graph_of(text: str) -> Graph:
    """A graph whose values by default are words of the text."""
    graph = parse_text(text)
    graph.reads = reads = Reads()
    for one in list(graph):
        if "default" in one.attrs:
            reads.watch(one, Literal("a.sysml", one.ordinal, one.id, "default"))
    reads.reader = "pass work"
    return graph


def work(graph: Graph, make: Make, given: object = ()) -> tuple[object, list[object]]:
    """What comes of work on the cell, and what it tells."""
    sink = Sink()
    return retold(graph, sink, "c", given, make), list(sink)


def times(make: Make, *texts: str) -> int:
    """How often the work is done for these graphs in turn, where it always comes to the same as
    without a memory, and has the same readers.
    """
    done: list[Graph] = []

    def counted(graph: Graph, sink: Sink) -> object:
        done.append(graph)
        return make(graph, sink)

    for text in texts:
        graph, clean = graph_of(text), clean_graph_of(text)
        assert work(graph, counted) == work(clean, make)
        assert readers(graph) == readers(clean)
    return len(done)


def readers(graph: Graph) -> object:
    return graph.reads and graph.reads.readers


def parts(graph: Graph, sink: Sink) -> object:
    """The parts of the cell with their values, each of which is odd."""
    found = graph.owned(graph["c"])
    for one in found:
        sink.report(ODD, graph.subject(one), name=one.name, notes=("a note",))
    return [(one.name, one.attrs.get("default")) for one in found]


def test_what_is_as_it_was_is_told_again_where_it_stands_now():
    assert times(parts, PLANT, PLANT, PLANT) == 1
    assert times(parts, PLANT, PLANT.replace("@a.sysml:20", "@a.sysml:25")) == 0


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"speed"', '"rate"'),
        ("default=1", "default=2"),
        ("default=1", "default=1.0"),
        ("default=1", "default=true"),
        ("default=1", 'default="1"'),
        ("default=1", ""),
        ('Property t "torque" @', 'Port t "torque" @'),
        ('    Property t "torque" @a.sysml:30\n', ""),
        ('  Class d "Drive"', '    Property u "u"\n  Class d "Drive"'),
        ('"Plant"', '"Line"'),
    ],
)
def test_what_it_asked_for_is_another_and_it_is_done_again(old, new):
    assert times(parts, PLANT, PLANT.replace(old, new)) == 2


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"Drive"', '"Motor"'),
        ('"force"', '"thrust"'),
        ("-> typed-by d", "-> typed-by p"),
        ('Class d "Drive"', 'Class e "Else"\n  Class d "Drive"'),
    ],
)
def test_what_it_did_not_ask_for_may_be_another(old, new):
    assert times(parts, PLANT, PLANT.replace(old, new)) == 1


def test_what_is_given_is_another():
    for number, given in enumerate([("a", 1), ("a", 1), ("a", 2)]):
        graph = graph_of(PLANT)
        done: list[int] = []
        work(graph, lambda _, __, number=number, done=done: done.append(number), given)
        assert bool(done) == (number != 1)


@pytest.mark.parametrize(
    ("ask", "old", "new"),
    [
        (lambda graph: graph.of_kind(Kind.CLASS), 'Class d "Drive"', 'Class e\n  Class d "Drive"'),
        (lambda graph: graph.of_kind(Kind.PORT), 'Property t "', 'Port t "'),
        (lambda graph: graph.roots(), "@a.sysml:50\n", "@a.sysml:50\nPackage q\n"),
        (lambda graph: graph.sources(graph["d"], Edge.TYPED_BY), "-> typed-by d", ""),
        (lambda graph: [graph.get("x")], "Property t", "Property x\n    Property t"),
        (lambda graph: [graph["c"]] if "x" in graph else [], "Property t", "Property x"),
        (lambda graph: list(graph.subtree(graph["c"])), '"torque"', '"moment"'),
        (lambda graph: list(graph.ancestors(graph["f"])), '"Drive"', '"Motor"'),
    ],
)
def test_questions_about_more_than_one_element(ask, old, new):
    def make(graph: Graph, _: Sink) -> object:
        return [one and (one.id, one.name) for one in ask(graph)]

    other = PLANT.replace(old, new)
    assert times(make, PLANT, PLANT, other, other, PLANT) == 3


def in_order(graph: Graph, _: Sink) -> object:
    """Names in the order of the document."""
    found = [graph["s"], graph["t"], graph["f"]]
    placed = sorted(zip(graph.ordinals(found), (one.name for one in found), strict=True))
    return [name for _, name in placed]


def test_places_count_where_somebody_compares_them():
    moved = PLANT.replace(":50", ":55")
    before = PLANT.replace(":50", ":25")
    beside = PLANT.replace(":50", ":30")
    assert times(in_order, PLANT, moved, before, before, beside, PLANT) == 4


def classes(graph: Graph) -> dict[str, list]:
    return {one.name: [one] for one in graph.of_kind(Kind.CLASS)}


def test_an_entry_of_an_index_is_another():
    def drive(graph: Graph, _: Sink, known: dict[str, list]) -> object:
        return [one.id for one in look_up(graph, "classes", known, "Drive")]

    done = []
    for name in ("Cell", "Cell", "Box", "Drive", "Drive", "Cell"):
        graph = graph_of(PLANT.replace('"Cell"', f'"{name}"'))
        known = indexed(graph, "classes", classes)

        def make(graph: Graph, sink: Sink, known=known, name=name) -> object:
            done.append(name)
            return drive(graph, sink, known)

        assert work(graph, make)[0] == (["d"])
    assert done == ["Cell"]


def test_an_entry_that_others_get_too():
    done = []
    for name in ("Drive", "Motor", "Motor"):
        graph = graph_of(PLANT.replace('"Drive"', f'"{name}"'))
        known = indexed(graph, "classes", classes)

        def make(graph: Graph, _: Sink, known=known, name=name) -> object:
            done.append(name)
            return [one.id for one in look_up(graph, "classes", known, "Drive")]

        work(graph, make)
    assert done == ["Drive", "Motor"]


def test_an_index_that_nobody_made_answers_nothing():
    graph = graph_of(PLANT)
    known = indexed(graph, "classes", classes)
    work(graph, lambda graph, _: look_up(graph, "classes", known, "Drive"))
    done: list[str] = []
    work(graph_of(PLANT), lambda *_: done.append("again"))
    assert done == ["again"]


@pytest.mark.parametrize(
    "ask",
    [
        len,
        list,
        lambda graph: graph.derived(str),
        lambda graph: graph.has_derived("x"),
        lambda graph: list(graph.edges()),
        lambda graph: graph.has_several(Edge.TYPED_BY),
    ],
)
def test_who_asks_for_everything_is_asked_again(ask):
    assert times(lambda graph, _: bool(ask(graph)), PLANT, PLANT) == 2


def test_what_is_told_of_nothing_or_in_values_that_may_change_is_told_anew():
    def of_nothing(graph: Graph, sink: Sink) -> None:
        sink.report(ODD, graph.subject(graph["c"]).__class__("a file"), name="x")

    def of_a_list(graph: Graph, sink: Sink) -> None:
        sink.report(ODD, graph.subject(graph["c"]), name=["x"])

    assert times(of_nothing, PLANT, PLANT) == 2
    assert times(of_a_list, PLANT, PLANT) == 2


def test_nothing_is_remembered_when_the_graph_was_changed():
    for expected in (["made"], ["made"]):
        graph = graph_of(PLANT)
        graph.rename(graph["t"], "moment")
        done: list[str] = []
        work(graph, lambda _, __, done=done: done.append("made"))
        assert done == expected


def test_nothing_is_noted_of_the_first_graph_of_a_process():
    graphs = [clean_graph_of(PLANT) for _ in range(3)]
    for graph in graphs:
        seen.see_again(graph, rows(graph))
    assert [graph.seen is None for graph in graphs] == [True, False, False]


def test_a_process_that_stays_remembers_the_first_graph_too():
    seen.stay()
    graph = clean_graph_of(PLANT)
    seen.see_again(graph, rows(graph))
    assert graph.seen is not None


def test_work_that_nobody_asked_for_is_forgotten():
    assert times(parts, PLANT) == 1
    graph_of(PLANT)
    assert times(parts, PLANT) == 1
