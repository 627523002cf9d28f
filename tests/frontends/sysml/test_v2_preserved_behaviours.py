"""Behaviours, ports and references of UML that the text lost once: they come back, or are reported.

Each model of a fault stands beside its nearest neighbour that was right all along.
"""

import pytest
from test_v2_preserved_facts import graph_of, lines_of, read_back_and_compare
from test_v2_preserved_models import list_losses

ACCEPTANCE = """
Package p "Plant"
  Signal go "Go"
  Activity run "Run"
    {start}
    Action run.a "wait" subkind="accept"
      -> trigger run.a.t
      Trigger run.a.t "" subkind="signal"
        -> typed-by go
    Action run.b "b" subkind="opaque"
    ControlFlow run.f ""
      -> flow-source {source}
      -> flow-target {target}
"""
START = 'Control run.i "start" subkind="initial"'
REPEATED = ACCEPTANCE.format(start="", source="run.a", target="run.b")
ONCE = ACCEPTANCE.format(start=START, source="run.i", target="run.a")


def test_an_accept_action_without_incoming_flows_accepts_again_after_each_event():
    assert read_back_and_compare(REPEATED)[1] == []
    assert "Repeated;" in "".join(lines_of(graph_of(REPEATED)))
    assert list_losses(REPEATED)["run.a"] == ["an accept action without incoming flows"]


def test_an_accept_action_after_a_start_accepts_once():
    assert read_back_and_compare(ONCE)[1] == []
    assert "Repeated" not in "".join(lines_of(graph_of(ONCE)))
    assert "run.a" not in list_losses(ONCE)


CALL = """
Package p "Plant"
  Activity run "Run" {test}
    Operation run.o "test"
      Parameter run.o.x "x" direction="in"
    Action run.a "wait" subkind="accept-call"
      -> trigger run.a.t
      Trigger run.a.t "" subkind="call"
        -> typed-by run.o
    Action run.r "answer" subkind="reply" reply_to_call="run.a.t"
"""
PINS = """
Package p "Plant"
  Activity run "Run"
    Action run.a "a" subkind="read-self"
      Pin run.a.s "self" direction="out" subkind="result"
    Control run.k "split" subkind="fork"
    Action run.b "b" subkind="opaque"
      Pin run.b.x "x" direction="in" subkind="input-value"
    ObjectFlow run.f ""
      -> flow-source run.a.s
      -> flow-target run.k
    ObjectFlow run.g ""
      -> flow-source run.k
      -> flow-target run.b.x
"""
PARAMETERS = """
Package p "Plant"
  Activity run "Run"
    Parameter run.x "x" direction="in"
    ActivityParameter run.n "x" direction="in"
      -> references run.x
    Parameter run.y "y" direction="inout"
    ActivityParameter run.m "given" direction="in"
      -> references run.y
    Parameter run.z "z" direction="in"
"""
CHOICE = """
Package p "Plant"
  Activity run "Run"
    Structured c "s" subkind="conditional" clauses=[[["c.t"], ["c.b"]], [["c.u"],[]]]
      Action c.t "t" subkind="opaque"
      Action c.u "u" subkind="opaque"
      Action c.b "b" subkind="opaque"
"""
ENDS = """
Package p "Plant"
  Class gate "Gate" role="block"
  Association owns "Owns"
    -> end owns.a
    -> end owns.b
    Property owns.a "a"
      -> typed-by gate
    Property owns.b "b" multiplicity="*" {flags}
      -> typed-by gate
"""
VALUES = """
Package p "Plant"
  Class gate "Gate" role="block"
  DataType pair "Pair" role="value type"
    Property pair.x "x" {aggregation}
      -> typed-by gate
"""
EFFECT = """
Package p "Plant"
  StateMachine m "M"
    Region m.r ""
      State m.r.a "A"
      State m.r.b "B"
      Transition m.r.t "t"
        -> flow-source m.r.a
        -> flow-target m.r.b
        -> effect m.r.t.e
        {kind} m.r.t.e ""
"""
LIFELINES = """
Package p "Plant"
  Class socket "Socket" role="{role}"
  Class gate "Gate" role="block"
    Interaction gate.talk "Talk"
      -> classifier-behavior gate.talk
      Property gate.talk.x "" role="reference" visibility="private"
        -> typed-by socket
      Lifeline gate.talk.l "l"
        -> represents gate.talk.x
"""
LINKS = """
Package p "Plant"
  Class gate "Gate" role="block"
  Class belt "Belt" role="block"
  Dependency d "d" subkind="{subkind}"
    -> client gate
    -> supplier belt
"""


@pytest.mark.parametrize(
    "text",
    [
        CALL.format(test=""),
        PINS,
        PINS.replace('"self"', '"mine"'),
        PARAMETERS,
        CHOICE,
        CHOICE.replace(",[]]", ',["c.b"]]'),
        ENDS.format(flags="ordered=true unique=false"),
        ENDS.format(flags=""),
        VALUES.format(aggregation=""),
        VALUES.format(aggregation='aggregation="composite"'),
        EFFECT.format(kind="Interaction"),
        EFFECT.format(kind="Activity"),
        LINKS.format(subkind="ppr"),
        LINKS.format(subkind="usage"),
    ],
)
def test_it_comes_back(text):
    assert read_back_and_compare(text)[1] == []


@pytest.mark.parametrize("role", ["interface block", "block", "constraint block"])
def test_lifelines_of_each_type_stay_lifelines(role):
    graph, _ = read_back_and_compare(LIFELINES.format(role=role))
    kinds = [str(element.kind) for element in graph if element.name in ("l", "")]
    assert sorted(kinds) == ["Lifeline", "Property"]
