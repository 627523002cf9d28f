"""Scenarios of state machines, and sequence diagrams of their runs."""

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source

STOPPER = """
Class stopper "Stopper"
  -> classifier-behavior sm
  Property count "count" default=0
    -> typed-by int
  Constraint c body="0 <= count and count <= 3"
  StateMachine sm "stop"
    Region r "r"
      Pseudostate i "" subkind="initial"
      State up "up"
      State down "down"
      Transition t0 ""
        -> flow-source i
        -> flow-target up
      Transition t1 ""
        -> flow-source up
        -> flow-target down
        -> trigger tr1
        Trigger tr1 "" subkind="signal"
          -> typed-by go
      Transition t2 "" guard="count > 1"
        -> flow-source down
        -> flow-target up
        -> trigger tr2
        Trigger tr2 "" subkind="signal"
          -> typed-by back
DataType int "Integer"
Signal go "Go"
Signal back "Back"
"""

SCENARIO = """component: Stopper
steps:
  - expect: {state: up}
  - inputs: {event: Go, count: 2}
  - expect: {state: down, event: none}
  - inputs: {event: Back}
  - expect: {state: up, count: 2}
"""


def simulate(text: str):
    sink = Sink()
    report = run_scenarios(parse_text(STOPPER), Source("s.yaml", text.encode()), sink)
    assert list(sink) == []
    return report


def test_a_state_machine_is_simulated_with_one_event_a_step():
    assert simulate(SCENARIO).passed


def test_a_guard_that_does_not_hold_keeps_the_state():
    report = simulate(
        SCENARIO.replace("count: 2}\n  - expect: {state: d", "}\n  - expect: {state: d")
    )
    assert str(report.results[0].difference) == "step 5: state is down, expected up"


def test_the_run_is_drawn_message_by_message():
    lines = simulate(SCENARIO).sequence_diagram().splitlines()
    assert lines[lines.index("== step 2 ==") :] == [
        "== step 2 ==",
        "environment -> component : event = Go",
        "environment -> component : count = 2",
        "== step 3 ==",
        "environment -> component : event = none",
        "component -> environment : state = down",
        "== step 4 ==",
        "environment -> component : event = Back",
        "== step 5 ==",
        "environment -> component : event = none",
        "component -> environment : state = up",
        "@enduml",
    ]


@pytest.mark.plantuml
def test_plantuml_draws_passing_and_failing_runs_with_odd_names(plantuml):
    odd = 'name: "<b>*odd* \\"name\\" ~~ \\\\n - Ä"\n'
    passing = simulate(odd + SCENARIO).sequence_diagram()
    failing = simulate(odd + SCENARIO.replace("state: down", "state: up")).sequence_diagram()
    pictures = plantuml.render({"passing": passing, "failing": failing})
    assert b"state is down" in pictures["failing"].replace(b"&#160;", b" ")
