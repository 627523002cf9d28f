"""Transitions whose text stands only in their name, and events that come at several ports."""

import pytest
from pass_runs import derive_contracts, list_diagnostics

from sysmlc.logic.printing import print_formula

MODEL = """\
Package p "Plant"
  Signal start "start"
  Class c "Lift"
    -> classifier-behavior m
    Port left "left"
    Port right "right"
    Property load "load" default=0
      -> typed-by int
    Constraint k body="0 <= load <= 9"
    StateMachine m "Control"
      Region r
        Pseudostate i subkind="initial"
        State a "Down"
        State b "Up"
        Transition t0
          -> flow-source i
          -> flow-target a
        Transition t1 {transition}
          -> flow-source a
          -> flow-target b
{trigger}
        Transition t2
          -> flow-source b
          -> flow-target a
          -> trigger back
          Trigger back subkind="signal" port="right"
            -> typed-by start
  DataType int "Integer"
"""
AT_THE_LEFT = """\
          -> trigger tr
          Trigger tr subkind="signal" port="left"
            -> typed-by start"""


def derive(transition="", trigger=""):
    """Return the moves of the machine and the findings, except the assumptions about ranges."""
    text = MODEL.replace("{transition}", transition).replace("{trigger}", trigger)
    _, contracts, sink = derive_contracts(text)
    (contract,) = contracts
    formulas = [print_formula(conjunct.formula) for conjunct in contract.guarantees]
    moves = [formula for formula in formulas if formula.startswith("state=")]
    return moves, list_diagnostics(sink)


@pytest.mark.parametrize(
    ("name", "move", "parts"),
    [
        (
            "press [load < 3]",
            "state=Down & event=press & load<3 -> state'=Up",
            "the trigger 'press' and the guard 'load < 3'",
        ),
        ("[load < 3]", "state=Down & load<3 -> state'=Up", "the guard 'load < 3'"),
        (
            "raise [load < 3] / load := load + 1",
            "state=Down & event=raise & load<3 -> state'=Up & load'=load + 1",
            "the trigger 'raise' and the guard 'load < 3' and the effect 'load := load + 1'",
        ),
    ],
)
def test_a_name_in_the_notation_of_diagrams_is_read(name, move, parts):
    moves, findings = derive(f'"{name}"')
    assert move in moves
    assert f"SM487 info: the name of transition '{name}' is read as {parts}" in findings


@pytest.mark.parametrize("name", ["start", "on/off", "list[]", "move to [b"])
def test_other_names_mean_nothing(name):
    moves, findings = derive(f'"{name}"')
    assert "state=Down -> state'=Up" in moves
    assert not [finding for finding in findings if finding.startswith("SM487")]


def test_a_written_guard_counts_and_not_the_name():
    moves, findings = derive('"press [load < 3]" guard="load < 5"')
    assert "state=Down & load<5 -> state'=Up" in moves
    assert not [finding for finding in findings if finding.startswith("SM487")]


def test_a_name_that_names_nothing_is_a_condition_in_words():
    moves, findings = derive('"press [weight < 3]"')
    assert "state=Down & event=press & weight_3 -> state'=Up" in moves
    assert (
        "SM411 warning: guard 'weight < 3' has no formula: 'weight' is not known, and only the "
        "name of the transition has this text; the contract treats it as the input 'weight_3'"
    ) in findings


def test_one_signal_at_two_ports_is_two_events():
    moves, _ = derive(trigger=AT_THE_LEFT)
    assert moves[1:] == [
        "state=Down & event=start_via_left -> state'=Up",
        "state=Up & event=start_via_right -> state'=Down",
    ]


def test_a_trigger_without_port_takes_the_signal_at_each_port():
    moves, _ = derive(trigger=AT_THE_LEFT.replace(' port="left"', ""))
    assert moves[1] == "state=Down & (event=start | event=start_via_right) -> state'=Up"
