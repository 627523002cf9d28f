"""The pass ``behaviours``: pins of calls, and the names of components."""

import pytest
from pass_runs import list_codes, run_until

from sysmlc.ir.query import component_name


@pytest.mark.parametrize(
    ("pins", "codes"),
    [
        ([("in", "argument"), ("out", "result")], []),
        ([("in", "argument"), ("out", "result"), ("in", "target")], []),
        ([("in", "target"), ("out", "result")], ["SM401"]),
        ([], ["SM401"]),
    ],
)
def test_pins_of_a_call_that_do_not_match_the_parameters_are_reported(pins, codes):
    text = """\
Class gate "Gate"
  Operation op "turn"
    Parameter p "angle" direction="in"
    Parameter q "done" direction="return"
Activity act "Act"
  Action call "call" subkind="call-operation"
    -> calls op
"""
    for number, (direction, subkind) in enumerate(pins):
        text += f'    Pin pin{number} direction="{direction}" subkind="{subkind}"\n'
    assert list_codes(run_until(text, "behaviours")[1]) == codes


def test_the_pins_of_a_call_of_an_unresolved_behaviour_are_not_checked():
    text = """\
Activity act "Act"
  Action call "call" subkind="call-behavior"
    ?> calls lib.uml#run Activity "Run"
  Action lost "lost" subkind="call-operation"
    ?> calls gone Operation
"""
    assert list_codes(run_until(text, "behaviours")[1]) == ["SM150", "SM152"]


def test_components_are_named_by_their_block_and_their_behaviour():
    graph, _ = run_until(
        """\
Package line "Line"
  Class gate "Gate"
    -> classifier-behavior sm
    -> satisfies req
    StateMachine sm "states"
    Activity pull "pull in"
  Activity alone "Alone"
  Class req "No jam" role="requirement"
  Class other "Other" role="requirement"
  Class quick "Quick" role="requirement"
    -> subject pull
""",
        "behaviours",
    )
    expected = {
        "sm": "Line::Gate",
        "pull": "Line::Gate.pull in",
        "alone": "Line::Alone",
        "req": "Line::Gate",
        "other": "Line::Other",
        "quick": "Line::Gate.pull in",
    }
    assert {id: component_name(graph, graph[id]) for id in expected} == expected
