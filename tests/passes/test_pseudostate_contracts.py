"""History, forks, joins, entry and exit points, submachines: what of them is in a contract."""

import pytest

from machine_samples import arrow, choice, machine_of, region, state
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline


def derived(text, messages=False):
    graph, sink = parse_text(text), Sink()
    pipeline.run(graph, sink, verify_each=True)
    found = {one.component: one for one in graph.derived(Contract)}
    told = [diagnostic.message if messages else diagnostic.rule.code for diagnostic in sink]
    return found.get("Plant::Gate"), told, graph


def contract(*parts):
    made, codes, graph = derived(machine_of(region("r", *parts)))
    assert codes == []
    for conjunct in made.guarantees:
        assert conjunct.origin in graph
    return made


def safety(made):
    return [print_formula(one.formula) for one in made.guarantees if one.class_ is Class.SAFETY]


def inner(kind="", *ways):
    """A state with D and E inside, and perhaps a pseudostate."""
    pseudo = [choice("h", kind)] if kind else []
    return state("b", region("s", state("d"), state("e"), *pseudo, arrow("si", "d"), *ways, INSIDE))


INSIDE = arrow("d", "e", "start")
LEFT = arrow("b", "a", "stop")


def test_shallow_history_leads_to_what_the_region_was_in():
    made = contract(
        *(state("a"), inner("shallow-history"), arrow("i", "a"), arrow("a", "h", "start"), LEFT)
    )
    assert [one.name for one in made.variables] == ["event", "state", "B_state", "last_B_state"]
    lines = safety(made)
    assert lines[:3] == [
        "state=A & event=start & (B_state=D | B_state=inactive & last_B_state=D)"
        " -> state'=B & B_state'=D",
        "state=A & event=start & (B_state=E | B_state=inactive & last_B_state=E)"
        " -> state'=B & B_state'=E",
        "state=A & event=start & !(B_state=D | B_state=inactive & last_B_state=D)"
        " & !(B_state=E | B_state=inactive & last_B_state=E) -> state'=B & B_state'=D",
    ]
    assert lines[-2:] == [
        "B_state!=inactive -> last_B_state'=B_state",
        "B_state=inactive -> last_B_state'=last_B_state",
    ]
    assert "last_B_state=inactive" in [print_formula(one.formula) for one in made.guarantees]


def test_a_history_that_knows_nothing_has_a_way_of_its_own():
    ways = (state("a"), inner("shallow-history", arrow("h", "e")), arrow("i", "a"), LEFT)
    made = contract(*ways, arrow("a", "h", "start"))
    assert safety(made)[2].endswith("-> state'=B & B_state'=E")


def test_deep_history_remembers_every_region_below():
    deep = state("d", region("t", state("f"), state("g"), arrow("ti", "f"), arrow("f", "g", "go")))
    outer = state("b", region("s", deep, state("e"), choice("h", "deep-history"), arrow("si", "e")))
    made, codes, _ = derived(
        machine_of(
            region("r", state("a"), outer, arrow("i", "a"), arrow("a", "h", "start"), LEFT)
        ).replace('Signal stop "stop"', 'Signal stop "stop"\n  Signal go "go"')
    )
    assert codes == []
    assert [one.name for one in made.variables][-2:] == ["last_B_state", "last_D_state"]
    assert any(one.endswith("state'=B & B_state'=D & D_state'=G_") for one in safety(made))


def orthogonal():
    return state(
        "b",
        region("s", state("d"), state("e"), arrow("si", "d"), arrow("d", "e", "start")),
        region("t", state("f1"), state("f2"), arrow("ti", "f1"), arrow("f1", "f2", "stop")),
    )


def test_all_ways_of_a_fork_are_taken():
    made = contract(
        *(state("a"), orthogonal(), choice("x", "fork"), arrow("i", "a")),
        *(arrow("a", "x", "start"), arrow("x", "e"), arrow("x", "f2")),
    )
    assert safety(made)[0] == "state=A & event=start -> state'=B & B_state'=E & B_state_2'=F2"


def test_a_join_waits_for_all_that_lead_to_it():
    made = contract(
        *(state("a"), orthogonal(), choice("x", "join"), arrow("i", "b")),
        *(arrow("e", "x"), arrow("f2", "x", effect="level := 1"), arrow("x", "a")),
    )
    (found,) = [one for one in made.guarantees if "state'=A" in print_formula(one.formula)]
    assert print_formula(found.formula) == (
        "B_state=E & B_state_2=F2 -> B_state'=inactive & B_state_2'=inactive & state'=A & level'=1"
    )
    assert found.text.startswith("In 'E' and 'F2', when 'E' and 'F2' are complete:")


@pytest.mark.parametrize("into", ["d", "a"])
def test_a_fork_leads_into_different_regions(into):
    parts = (state("a"), orthogonal(), choice("x", "fork"), arrow("i", "a"))
    ways = (arrow("a", "x", "start"), arrow("x", "e"), arrow("x", into))
    made, codes, _ = derived(machine_of(region("r", *parts, *ways)))
    assert made is None
    assert codes == ["SM504"]


def test_a_join_beside_another_completion_is_not_derived():
    parts = (state("a"), orthogonal(), choice("x", "join"), arrow("i", "b"))
    ways = (arrow("e", "x"), arrow("f2", "x"), arrow("x", "a"), arrow("e", "d"))
    made, found, _ = derived(machine_of(region("r", *parts, *ways)), messages=True)
    assert made is None
    assert found == [
        "'E' of state machine 'Behaviour' completes along 'E -> D' before its join can wait; the "
        "component gets no contract"
    ]
    made, found, _ = derived(machine_of(region("r", *parts, *ways[:-1], arrow("e", "d", "stop"))))
    assert made is not None
    assert found == []


def acting(text, edge, vertex, body):
    """The text with a behaviour at a vertex."""
    name = vertex.upper()
    line = f'State {vertex} "{name}"\n'
    before, _, after = text.partition(line)
    pad = " " * (len(before) - len(before.rstrip(" ")) + 2)
    made = f'{pad}-> {edge} {vertex}x\n{pad}Activity {vertex}x subkind="opaque" body="{body}"\n'
    return before + line + made + after


def test_an_exit_point_leaves_its_state_behind_the_effect_that_leads_to_it():
    point = 'Pseudostate x "x" subkind="exit-point"\n'
    boxed = state("b", region("s", state("d"), arrow("si", "d"))) + f"  {point}"
    ways = (
        arrow("i", "b"),
        arrow("d", "x", "start", effect="level := 2"),
        arrow("x", "a", effect="level := level + 1"),
    )
    text = machine_of(region("r", state("a"), boxed, *ways))
    made, codes, _ = derived(acting(text, "exit", "b", "level := level * 3"))
    assert codes == []
    assert safety(made)[0].endswith("state'=A & level'=7")


def test_an_entry_point_enters_its_state_before_the_effect_that_leaves_it():
    point = 'Pseudostate x "x" subkind="entry-point"\n'
    boxed = state("b", region("s", state("d"), state("e"), arrow("si", "d"))) + f"  {point}"
    ways = (
        arrow("i", "a"),
        arrow("a", "x", "start", effect="level := 2"),
        arrow("x", "e", effect="level := level + 1"),
    )
    text = machine_of(region("r", state("a"), boxed, *ways))
    made, codes, _ = derived(acting(text, "entry", "b", "level := level * 3"))
    assert codes == []
    assert safety(made)[0].endswith("level'=7")
    assert "B_state'=E" in safety(made)[0]


CALLED = """\
Package p "Plant"
  Class c "Gate"
    -> classifier-behavior m
    StateMachine m "Behaviour"
      Region r
        Pseudostate i subkind="initial"
        State a "Left"
          -> calls s
          Pseudostate a.out subkind="connection-point"
            -> references s.out
        State b "Right"
          -> calls s
          Pseudostate b.in subkind="connection-point"
            -> references s.in
          Pseudostate b.out subkind="connection-point"
            -> references s.out
        Transition t0
          -> flow-source i
          -> flow-target a
        Transition t1
          -> flow-source a.out
          -> flow-target b.in
        Transition t2
          -> flow-source b.out
          -> flow-target a
    StateMachine s "Part"
      Pseudostate s.in "in" subkind="entry-point"
      Pseudostate s.out "out" subkind="exit-point"
      Region s.r
        Pseudostate s.i subkind="initial"
        State s.d "D"
        State s.e "E"
        Transition u0
          -> flow-source s.i
          -> flow-target s.d
        Transition u1
          -> flow-source s.in
          -> flow-target s.e
        Transition u2
          -> flow-source s.d
          -> flow-target s.out
          -> trigger u2.t
          Trigger u2.t subkind="signal"
            -> typed-by go
  Signal go "go"
"""


def test_each_submachine_state_has_what_its_submachine_has():
    made, codes, graph = derived(CALLED)
    assert codes == []
    assert [one.name for one in made.variables] == ["event", "state", "Left_state", "Right_state"]
    assert safety(made)[0] == (
        "Left_state=D & event=go -> Left_state'=inactive & state'=Right & Right_state'=E"
    )
    assert {one.origin for one in made.guarantees} <= {one.id for one in graph}


def test_a_machine_in_itself_is_told():
    text = CALLED.replace('State s.e "E"\n', 'State s.e "E"\n          -> calls s\n')
    made, codes, _ = derived(text)
    assert made is None
    assert set(codes) == {"SM420"}


@pytest.mark.parametrize(
    ("outer", "codes"),
    [
        (arrow("b", "a", "stop"), []),
        (arrow("b", "a", after="after 3 s"), ["SM434"]),
    ],
)
def test_a_time_out_that_comes_with_a_transition_further_in_is_lost(outer, codes):
    parts = (state("a"), inner(), arrow("i", "a"), arrow("a", "b", "start"), outer)
    _, found, _ = derived(machine_of(region("r", *parts)))
    assert [one for one in found if one == "SM434"] == codes
