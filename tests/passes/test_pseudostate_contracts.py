"""Contracts of state machines with history, forks, joins, entry and exit points, submachines."""

import pytest
from pass_runs import derive_contracts, list_codes

from machine_samples import arrow, choice, machine_of, region, state
from sysmlc.logic.contract import Class
from sysmlc.logic.printing import print_formula


def derive_gate_contract(text):
    """Return the contract of the gate or None, and the codes of all diagnostics."""
    _, contracts, sink = derive_contracts(text)
    by_component = {contract.component: contract for contract in contracts}
    return by_component.get("Plant::Gate"), list_codes(sink)


def derive_clean_contract(*parts):
    """Return the contract of a machine of one region that has no diagnostics."""
    graph, (contract,), sink = derive_contracts(machine_of(region("r", *parts)))
    assert list_codes(sink) == []
    for conjunct in contract.guarantees:
        assert conjunct.origin in graph
    return contract


def print_safety(contract):
    return [print_formula(c.formula) for c in contract.guarantees if c.class_ is Class.SAFETY]


def composite_state(kind="", *transitions):
    """Return a state B that contains D and E and, if *kind* is given, the pseudostate h."""
    pseudostates = [choice("h", kind)] if kind else []
    vertices = (state("d"), state("e"), *pseudostates)
    return state("b", region("s", *vertices, arrow("si", "d"), *transitions, FROM_D_TO_E))


FROM_D_TO_E = arrow("d", "e", "start")
FROM_B_TO_A = arrow("b", "a", "stop")


def test_shallow_history_leads_to_the_last_active_state_of_its_region():
    contract = derive_clean_contract(
        *(state("a"), composite_state("shallow-history"), arrow("i", "a")),
        *(arrow("a", "h", "start"), FROM_B_TO_A),
    )
    names = [variable.name for variable in contract.variables]
    assert names == ["event", "state", "B_state", "last_B_state"]
    lines = print_safety(contract)
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
    guarantees = [print_formula(conjunct.formula) for conjunct in contract.guarantees]
    assert "last_B_state=inactive" in guarantees


def test_the_default_transition_of_a_history_is_taken_when_its_region_was_never_active():
    history = composite_state("shallow-history", arrow("h", "e"))
    contract = derive_clean_contract(
        *(state("a"), history, arrow("i", "a"), FROM_B_TO_A, arrow("a", "h", "start"))
    )
    assert print_safety(contract)[2].endswith("-> state'=B & B_state'=E")


def test_deep_history_remembers_every_region_below():
    deep = state("d", region("t", state("f"), state("g"), arrow("ti", "f"), arrow("f", "g", "go")))
    outer = state("b", region("s", deep, state("e"), choice("h", "deep-history"), arrow("si", "e")))
    transitions = (arrow("i", "a"), arrow("a", "h", "start"), FROM_B_TO_A)
    text = machine_of(region("r", state("a"), outer, *transitions))
    contract, codes = derive_gate_contract(
        text.replace('Signal stop "stop"', 'Signal stop "stop"\n  Signal go "go"')
    )
    assert codes == []
    names = [variable.name for variable in contract.variables]
    assert names[-2:] == ["last_B_state", "last_D_state"]
    ending = "state'=B & B_state'=D & D_state'=G_"
    assert any(line.endswith(ending) for line in print_safety(contract))


def orthogonal_state():
    """Return a state B with two regions: from D to E, and from F1 to F2."""
    return state(
        "b",
        region("s", state("d"), state("e"), arrow("si", "d"), arrow("d", "e", "start")),
        region("t", state("f1"), state("f2"), arrow("ti", "f1"), arrow("f1", "f2", "stop")),
    )


def test_a_fork_takes_all_its_outgoing_transitions():
    contract = derive_clean_contract(
        *(state("a"), orthogonal_state(), choice("x", "fork"), arrow("i", "a")),
        *(arrow("a", "x", "start"), arrow("x", "e"), arrow("x", "f2")),
    )
    assert (
        print_safety(contract)[0]
        == "state=A & event=start -> state'=B & B_state'=E & B_state_2'=F2"
    )


def test_a_join_waits_for_all_states_that_lead_to_it():
    contract = derive_clean_contract(
        *(state("a"), orthogonal_state(), choice("x", "join"), arrow("i", "b")),
        *(arrow("e", "x"), arrow("f2", "x", effect="level := 1"), arrow("x", "a")),
    )
    (join,) = [c for c in contract.guarantees if "state'=A" in print_formula(c.formula)]
    assert print_formula(join.formula) == (
        "B_state=E & B_state_2=F2 -> B_state'=inactive & B_state_2'=inactive & state'=A & level'=1"
    )
    assert join.text.startswith("In 'E' and 'F2', when 'E' and 'F2' are complete:")


@pytest.mark.parametrize("target", ["d", "a"])
def test_a_fork_that_does_not_lead_into_different_regions_gives_no_contract(target):
    parts = (state("a"), orthogonal_state(), choice("x", "fork"), arrow("i", "a"))
    transitions = (arrow("a", "x", "start"), arrow("x", "e"), arrow("x", target))
    contract, codes = derive_gate_contract(machine_of(region("r", *parts, *transitions)))
    assert contract is None
    assert codes == ["SM504"]


def test_a_state_that_completes_along_another_transition_than_its_join_gives_no_contract():
    parts = (state("a"), orthogonal_state(), choice("x", "join"), arrow("i", "b"))
    transitions = (arrow("e", "x"), arrow("f2", "x"), arrow("x", "a"))
    text = machine_of(region("r", *parts, *transitions, arrow("e", "d")))
    _, contracts, sink = derive_contracts(text)
    assert contracts == []
    assert [diagnostic.message for diagnostic in sink] == [
        "'E' of state machine 'Behaviour' completes along 'E -> D' before its join can wait; the "
        "component gets no contract"
    ]
    assert derive_clean_contract(*parts, *transitions, arrow("e", "d", "stop"))


def add_behaviour(text, edge, vertex, body):
    """Return *text* with an entry or exit behaviour of a state."""
    line = f'State {vertex} "{vertex.upper()}"\n'
    before, _, after = text.partition(line)
    pad = " " * (len(before) - len(before.rstrip(" ")) + 2)
    behaviour = (
        f'{pad}-> {edge} {vertex}x\n{pad}Activity {vertex}x subkind="opaque" body="{body}"\n'
    )
    return before + line + behaviour + after


def test_the_effect_that_leads_to_an_exit_point_precedes_the_exit_behaviour():
    point = 'Pseudostate x "x" subkind="exit-point"\n'
    with_point = state("b", region("s", state("d"), arrow("si", "d"))) + f"  {point}"
    transitions = (
        arrow("i", "b"),
        arrow("d", "x", "start", effect="level := 2"),
        arrow("x", "a", effect="level := level + 1"),
    )
    text = machine_of(region("r", state("a"), with_point, *transitions))
    contract, codes = derive_gate_contract(add_behaviour(text, "exit", "b", "level := level * 3"))
    assert codes == []
    assert print_safety(contract)[0].endswith("state'=A & level'=7")


def test_the_entry_behaviour_precedes_the_effect_that_leaves_an_entry_point():
    point = 'Pseudostate x "x" subkind="entry-point"\n'
    with_point = state("b", region("s", state("d"), state("e"), arrow("si", "d"))) + f"  {point}"
    transitions = (
        arrow("i", "a"),
        arrow("a", "x", "start", effect="level := 2"),
        arrow("x", "e", effect="level := level + 1"),
    )
    text = machine_of(region("r", state("a"), with_point, *transitions))
    contract, codes = derive_gate_contract(add_behaviour(text, "entry", "b", "level := level * 3"))
    assert codes == []
    assert print_safety(contract)[0].endswith("level'=7")
    assert "B_state'=E" in print_safety(contract)[0]


SUBMACHINE = """\
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


def test_each_submachine_state_has_the_states_of_its_submachine():
    graph, (contract,), sink = derive_contracts(SUBMACHINE)
    assert list_codes(sink) == []
    names = [variable.name for variable in contract.variables]
    assert names == ["event", "state", "Left_state", "Right_state"]
    assert print_safety(contract)[0] == (
        "Left_state=D & event=go -> Left_state'=inactive & state'=Right & Right_state'=E"
    )
    assert {c.origin for c in contract.guarantees} <= {element.id for element in graph}


def test_a_machine_that_contains_itself_is_reported():
    text = SUBMACHINE.replace('State s.e "E"\n', 'State s.e "E"\n          -> calls s\n')
    contract, codes = derive_gate_contract(text)
    assert contract is None
    assert set(codes) == {"SM420"}


@pytest.mark.parametrize(
    ("outer", "codes"),
    [
        (arrow("b", "a", "stop"), []),
        (arrow("b", "a", after="after 3 s"), ["SM434"]),
    ],
)
def test_a_timeout_that_an_inner_transition_can_hide_is_reported(outer, codes):
    parts = (state("a"), composite_state(), arrow("i", "a"), arrow("a", "b", "start"), outer)
    _, reported = derive_gate_contract(machine_of(region("r", *parts)))
    assert [code for code in reported if code == "SM434"] == codes


# -- entry and exit points (UML 2.5.1, 14.2.3.7) ---------------------------------------------------


def derive_with_exit(*second):
    """Derive a machine whose state B has two regions, the first of which leads to an exit point.

    The region with E has the transitions of *second* besides its first one.
    """
    left = region("s", state("d"), arrow("si", "d"), arrow("d", "out"))
    right = region("t", state("e"), state("w"), arrow("ti", "e"), *second)
    both = state("b", left, right, choice("out", "exit-point"))
    transitions = (arrow("i", "a"), arrow("a", "b", "start"), arrow("out", "a"))
    return derive_gate_contract(machine_of(region("r", state("a"), both, *transitions)))


def test_an_exit_point_joins_transitions_from_several_regions():
    contract, codes = derive_with_exit(arrow("e", "w", "stop"), arrow("w", "out"))
    assert codes == []
    assert print_safety(contract)[1] == (
        "B_state=D & B_state_2=W_ -> B_state'=inactive & B_state_2'=inactive & state'=A"
    )


def test_an_exit_point_of_one_region_leaves_the_others_at_once():
    contract, codes = derive_with_exit(arrow("e", "w"))
    assert (contract, codes) == (None, ["SM427"])


def test_points_that_no_transition_uses_need_no_transition():
    points = (choice("in", "entry-point"), choice("out", "exit-point"))
    inside = region("s", state("d"), arrow("si", "d"))
    composite = state("b", inside, *points)
    transitions = (arrow("i", "a"), arrow("a", "b", "start"), FROM_B_TO_A)
    contract, codes = derive_gate_contract(
        machine_of(region("r", state("a"), composite, *transitions))
    )
    assert (contract is not None, codes) == (True, [])
    used = (*transitions, arrow("a", "in", "stop"))
    contract, codes = derive_gate_contract(machine_of(region("r", state("a"), composite, *used)))
    assert (contract, codes) == (None, ["SM420"])


def test_a_choice_that_leads_nowhere_is_an_error():
    transitions = (arrow("i", "a"), arrow("a", "x", "start"))
    text = machine_of(region("r", state("a"), choice(), *transitions))
    assert derive_gate_contract(text) == (None, ["SM425"])
