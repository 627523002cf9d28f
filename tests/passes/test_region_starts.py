"""A region needs an initial pseudostate only where it is entered by default (SM421)."""

import pytest
from pass_runs import derive_contracts

from machine_samples import arrow, choice, machine_of, region, state
from sysmlc.logic.printing import print_formula


def list_faults(text):
    """Return the messages about regions that cannot start."""
    _, _, sink = derive_contracts(text)
    return [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM421"]


def list_codes(text):
    """Return the codes of the findings about the machine."""
    return [diagnostic.rule.code for diagnostic in derive_contracts(text)[2]]


def region_without_initial(id, *parts):
    """Return a region without initial pseudostate."""
    initial = "i" if id == "r" else f"{id}i"
    return region(id, *parts).replace(f'  Pseudostate {initial} subkind="initial"\n', "")


def machine_with_composite(*transitions, vertices=()):
    """Return a machine with the state A, and B with D and E in a region without initial."""
    composite = state("b", region_without_initial("s", state("d"), state("e"), *vertices))
    return machine_of(region("r", state("a"), composite, arrow("i", "a"), *transitions))


def machine_with_two_regions(*parts):
    """Return a machine with the state A, and B with D in one region and E in another."""
    regions = (region_without_initial("s", state("d")), region_without_initial("t", state("e")))
    return machine_of(region("r", state("a"), state("b", *regions), arrow("i", "a"), *parts))


def test_the_region_of_a_machine_is_entered_when_the_machine_starts():
    assert list_faults(machine_of(region_without_initial("r", state("a")))) == [
        "region '<Region>' of 'Behaviour' has no initial pseudostate, but the machine starts there"
    ]


def test_an_initial_pseudostate_that_leads_nowhere_does_not_start_the_machine():
    assert list_faults(machine_of(region("r", state("a")))) == [
        "region '<Region>' of 'Behaviour' has an initial pseudostate without outgoing transition, "
        "but the machine starts there"
    ]


def test_a_second_initial_pseudostate_of_a_region_that_cannot_start_is_not_reported_again():
    second = 'Pseudostate again subkind="initial"\n'
    text = machine_of(region("r", state("a"), second))
    assert list_faults(text) == [
        "region '<Region>' of 'Behaviour' has 2 initial pseudostates, the first without outgoing "
        "transition, but the machine starts there"
    ]
    assert list_codes(text) == ["SM421"]
    assert list_codes(machine_of(region("r", state("a"), arrow("i", "a"), second))) == ["SM420"]


def test_uml_allows_one_transition_from_an_initial_pseudostate():
    transitions = (arrow("i", "a"), arrow("i", "b"))
    assert list_faults(machine_of(region("r", state("a"), state("b"), *transitions))) == [
        "region '<Region>' of 'Behaviour' has an initial pseudostate with 2 outgoing transitions; "
        "UML allows one"
    ]


def test_a_region_that_transitions_enter_at_its_states_needs_no_initial_pseudostate():
    text = machine_with_composite(arrow("a", "d", "start"), arrow("b", "a", "stop"))
    _, (contract,), sink = derive_contracts(text)
    assert [diagnostic.rule.code for diagnostic in sink] == []
    formulas = [print_formula(conjunct.formula) for conjunct in contract.guarantees]
    assert "state=A & event=start -> state'=B & B_state'=D" in formulas
    assert "state=B & event=stop -> B_state'=inactive & state'=A" in formulas


def test_a_transition_to_the_composite_state_enters_its_region_by_default():
    text = machine_with_composite(arrow("a", "d", "start"), arrow("a", "b", "stop"))
    assert list_faults(text) == [
        "region '<Region>' of 'B' has no initial pseudostate, but transition 'A to B' enters it by "
        "default"
    ]


def test_a_state_that_no_transition_enters_is_not_entered_by_default():
    assert list_faults(machine_with_composite()) == []


def test_an_internal_transition_does_not_enter_its_state():
    internal = arrow("b", "b", "stop").replace(
        "Transition b-b-stop", 'Transition b-b-stop subkind="internal"'
    )
    assert list_faults(machine_with_composite(arrow("a", "d", "start"), internal)) == []
    external = arrow("b", "b", "stop")
    assert len(list_faults(machine_with_composite(arrow("a", "d", "start"), external))) == 1


def test_a_fork_enters_both_regions_at_their_states():
    transitions = (arrow("a", "x", "start"), arrow("x", "d"), arrow("x", "e"))
    text = machine_with_two_regions(choice("x", "fork"), *transitions)
    _, (contract,), sink = derive_contracts(text)
    assert [diagnostic.rule.code for diagnostic in sink] == []
    formulas = [print_formula(conjunct.formula) for conjunct in contract.guarantees]
    assert any("state'=B" in formula for formula in formulas)


def test_a_transition_into_one_region_enters_the_region_beside_it_by_default():
    (fault,) = list_faults(machine_with_two_regions(arrow("a", "d", "start")))
    assert fault.endswith("but transition 'A to D' enters it by default")


def test_an_entry_point_enters_the_region_at_the_state_behind_it():
    text = machine_with_composite(arrow("a", "x", "start"), arrow("x", "d"))
    point = 'Pseudostate x "x" subkind="entry-point"\n'
    lines = text.splitlines(keepends=True)
    at = next(number for number, line in enumerate(lines) if 'State b "B"' in line)
    indent = " " * (len(lines[at]) - len(lines[at].lstrip()) + 2)
    assert list_faults("".join([*lines[: at + 1], indent + point, *lines[at + 1 :]])) == []


@pytest.mark.parametrize("kind", ["shallow-history", "deep-history"])
def test_a_history_without_transition_enters_its_region_by_default(kind):
    history = (choice("h", kind),)
    (fault,) = list_faults(machine_with_composite(arrow("a", "h", "start"), vertices=history))
    name = kind.replace("-", " ")
    assert fault.endswith(f"but a {name} pseudostate enters it by default")
    transitions = (arrow("a", "h", "start"), arrow("h", "e"))
    assert list_faults(machine_with_composite(*transitions, vertices=history)) == []


def test_a_shallow_history_enters_the_states_that_it_restores_by_default():
    inner = state("d", region_without_initial("t", state("f")))
    history = (choice("h", "shallow-history"), arrow("h", "f"), arrow("a", "h", "start"))
    outer = state("b", region_without_initial("s", inner, *history))
    (fault,) = list_faults(machine_of(region("r", state("a"), outer, arrow("i", "a"))))
    assert fault.startswith("region '<Region>' of 'D' has no initial pseudostate, but a shallow")
    deep = machine_of(region("r", state("a"), outer, arrow("i", "a"))).replace("shallow", "deep")
    assert list_faults(deep) == []


# -- machines that extend another one (UML 2.5.1, 14.3.3.1) ----------------------------------------

EXTENSION = """\
Class g "General"
  StateMachine gm "Life"
    Region gr
      Pseudostate gi subkind="initial"
      State ga "A"
      Transition g0
        -> flow-source gi
        -> flow-target ga
Class s "Special"
  -> specializes g
  StateMachine sm "Life"
    -> redefines gm
    Region sr
      -> redefines gr
      State sb "B"
      Transition s0
        -> flow-source ga
        -> flow-target sb
"""


def test_a_region_inherits_the_initial_pseudostate_of_the_region_that_it_extends():
    _, contracts, sink = derive_contracts(EXTENSION)
    assert [diagnostic.message for diagnostic in sink] == [
        "the redefinition or extension by 'Life' of state machine 'Life' is not derived; the "
        "component gets no contract"
    ]
    assert [contract.component for contract in contracts] == ["General.Life"]


def test_a_region_that_an_extending_machine_adds_has_no_initial_pseudostate_to_inherit():
    text = EXTENSION.replace("      -> redefines gr\n", "").replace("source ga", "source sb")
    assert list_faults(text) == [
        "region '<Region>' of 'Life' has no initial pseudostate, but the machine starts there"
    ]


# -- entry points of machines ----------------------------------------------------------------------


def machine_with_points(*points):
    """Return a machine with the states A and B, entry points, and a transition from each to B."""
    entries = "".join(f'Pseudostate {point} subkind="entry-point"\n' for point in points)
    arrows = [arrow(point, "b") for point in points]
    body = region_without_initial("r", state("a"), state("b"), *arrows)
    return machine_of(entries, body)


def test_a_machine_without_initial_pseudostate_starts_at_its_entry_point():
    _, (contract,), sink = derive_contracts(machine_with_points("start_here"))
    assert "SM421" not in [diagnostic.rule.code for diagnostic in sink]
    assert "state=B" in [print_formula(conjunct.formula) for conjunct in contract.guarantees]


def test_a_machine_with_several_entry_points_does_not_choose_one():
    assert list_faults(machine_with_points("first", "second")) == [
        "region '<Region>' of 'Behaviour' has no initial pseudostate, but the machine starts there"
    ]
