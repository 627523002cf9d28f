"""Behaviours of state machines are components with readable names, which become names of files."""

from pass_runs import derive_contracts

from machine_samples import arrow, machine, machine_of, region, state
from sysmlc.support.output import assign_file_names

STEPS = """\
Activity {id} "{name}"
  Control {id}-i subkind="initial"
  Action {id}-x "turn" subkind="opaque"
  ControlFlow {id}-f
    -> flow-source {id}-i
    -> flow-target {id}-x
"""


def steps(id, name=""):
    """Return an activity of one action, indented as a part."""
    lines = STEPS.format(id=id, name=name).splitlines()
    return "".join(f"  {line}\n" for line in lines)


def list_file_names(text):
    """Return the names of the contracts' files."""
    _, contracts, _ = derive_contracts(text)
    return [*assign_file_names(contract.component for contract in contracts).values()]


def effect(source, target, name=""):
    """Return a transition whose effect is an activity of one action."""
    return arrow(source, target, "stop") + f"  -> effect e\n{steps('e', name)}"


def test_the_effect_of_a_transition_is_named_by_its_ends():
    assert list_file_names(machine(effect("b", "a"))) == [
        "Plant.Gate",
        "Plant.Gate.Behaviour.B_to_A.effect",
    ]


def test_an_effect_and_a_transition_with_names_keep_them():
    text = machine(effect("b", "a", "close")).replace(
        "Transition b-a-stop", 'Transition b-a-stop "shut"'
    )
    assert list_file_names(text) == ["Plant.Gate", "Plant.Gate.Behaviour.shut.close"]


def test_the_entry_behaviour_of_a_state_is_named_by_its_role():
    entered = state("a").replace("\n", f"\n  -> entry e\n{steps('e')}", 1)
    text = machine_of(region("r", entered, arrow("i", "a")))
    assert list_file_names(text) == ["Plant.Gate", "Plant.Gate.Behaviour.A.entry"]


def test_an_activity_without_name_is_named_by_its_kind():
    text = 'Package p "P"\n' + steps("a")
    assert list_file_names(text) == ["P.activity"]
