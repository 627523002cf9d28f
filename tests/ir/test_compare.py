"""What a comparison of two models tells, on small models."""

import pytest

from sysmlc.ir import parse_text
from sysmlc.ir.compare import compare

PLANT = """\
Package plant "Plant"
  Class gate "Gate" role="block"
    Port in "p_in"
      -> typed-by pallet
    Port out "p_out"
    Property stop "stop" aggregation="composite" role="part"
      -> typed-by stopper
    Connector c
      -> end c1 c2
      ConnectorEnd c1
        -> role in
      ConnectorEnd c2
        -> role stopIn
        -> path stop
  Class stopper "Stopper" role="block"
    Port stopIn "p_stop"
    Property speed "speed" default=1.5 unit="m/s"
  Class pallet "Pallet"
"""

MACHINE = """\
StateMachine m "Machine"
  Region r "main"
    State idle "Idle"
    State busy "Busy"
    Transition go guard="ready"
      -> flow-source idle
      -> flow-target busy
      Trigger t subkind="signal"
        -> typed-by start
Signal start "Start"
Signal stop "Stop"
"""


def told(old, new, *ignore):
    changes = compare(parse_text(old), parse_text(new), ignore)
    return [
        f"{c.owner}: {c.what} {c.kind} {c.name}"
        + (f", {c.aspect}: {c.before or None} => {c.after or None}" if c.aspect else "")
        for c in changes
    ]


def changed(model, *replacements):
    new = model
    for before, after in replacements:
        assert before in new
        new = new.replace(before, after)
    return told(model, new)


# -- what each kind of change is called ----------------------------------------------------------


def test_a_model_does_not_differ_from_itself():
    assert told(PLANT, PLANT) == []


def test_added_and_removed_with_all_that_is_below():
    more = PLANT + '  Class more "More"\n    Port more.a "a"\n    Port more.b "b"\n'
    added = compare(parse_text(PLANT), parse_text(more))
    removed = compare(parse_text(more), parse_text(PLANT))
    assert [(c.what, c.name, c.contents, c.old) for c in added] == [("added", "More", 2, None)]
    assert [(c.what, c.name, c.contents, c.new) for c in removed] == [("removed", "More", 2, None)]


def test_a_renamed_block_is_one_change_wherever_it_is_used():
    assert changed(PLANT, ('"Stopper"', '"Halt"')) == [
        "Plant: renamed block Halt, name: Stopper => Halt"
    ]


def test_a_retyped_part():
    assert changed(PLANT, ("-> typed-by stopper", "-> typed-by pallet")) == [
        "Plant::Gate: retyped part stop, type: Stopper => Pallet"
    ]


def test_a_rewired_connector_names_its_ends():
    assert changed(
        PLANT, ("ConnectorEnd c1\n        -> role in", "ConnectorEnd c1\n        -> role out")
    ) == [
        "Plant::Gate: rewired connector p_out -- stop.p_stop, "
        "ends: p_in -- stop.p_stop => p_out -- stop.p_stop"
    ]


def test_the_ends_of_a_connector_have_no_order_those_of_a_transition_have():
    assert changed(PLANT, ("-> end c1 c2", "-> end c2 c1")) == []
    swapped = (("flow-source idle", "flow-source x"), ("flow-target busy", "flow-target idle"))
    assert changed(MACHINE, *swapped, ("flow-source x", "flow-source busy")) == [
        "Machine::main: rewired transition Busy -> Idle, ends: Idle -> Busy => Busy -> Idle"
    ]


def test_a_changed_value_and_a_changed_guard():
    assert changed(PLANT, ("default=1.5", "default=2")) == [
        "Plant::Stopper: changed property speed, default: 1.5 => 2"
    ]
    assert changed(MACHINE, ('guard="ready"', 'guard="ready && safe"')) == [
        "Machine::main: changed transition Idle -> Busy, guard: ready => ready && safe"
    ]


def test_what_a_trigger_waits_for_is_told_of_its_transition():
    assert changed(MACHINE, ("-> typed-by start", "-> typed-by stop")) == [
        "Machine::main: changed transition Idle -> Busy, trigger: signal Start => signal Stop"
    ]


def test_a_moved_block():
    new = PLANT.replace(
        '  Class pallet "Pallet"\n', '  Package lib "Lib"\n    Class pallet "Pallet"\n'
    )
    assert told(PLANT, new) == [
        "Plant: added package Lib",
        "Plant::Lib: moved class Pallet, owner: Plant => Plant::Lib",
    ]


def test_the_order_of_parameters_matters_that_of_ports_does_not():
    old = 'Class c "C"\n  Operation o "go"\n    Parameter a "a"\n    Parameter b "b"\n'
    new = 'Class c "C"\n  Operation o "go"\n    Parameter b "b"\n    Parameter a "a"\n'
    assert told(old, new) == ["C: reordered operation go, order: a, b => b, a"]
    assert told(old.replace("Parameter", "Port"), new.replace("Parameter", "Port")) == []


def test_stereotypes_and_their_tags_are_told_of_what_they_are_applied_to():
    old = (
        'Class c "Robot"\n'
        '  Application a "Machine" stereotype="Machine" tag.endpoint="x" namespace="v1"\n'
        "    -> subject c\n"
    )
    assert changed(old, ('tag.endpoint="x"', 'tag.Endpoint="y"')) == [
        ": changed machine Robot, «Machine» endpoint: x => y"
    ]
    assert changed(old, ('namespace="v1"', 'namespace="v2"')) == []
    assert told(old, 'Class c "Robot"\n') == [
        ": changed class Robot, «Machine» endpoint: x => None",
        ": retyped class Robot, stereotype: «Machine» => None",
    ]


def test_a_value_of_an_instance_is_told_with_its_feature():
    old = (
        'Class b "Belt"\n  Property v "velocity"\n'
        'Instance i "belt1"\n  -> instance-of b\n  Slot s value=1\n    -> instance-of v\n'
    )
    assert changed(old, ("value=1", "value=2")) == [
        ": changed instance belt1, value of velocity: 1 => 2"
    ]


def test_a_role_is_told_only_when_nothing_else_says_why_it_is_another():
    assert changed(PLANT, (' aggregation="composite" role="part"', ' role="reference"')) == [
        "Plant::Gate: changed reference stop, aggregation: composite => None"
    ]
    assert changed(PLANT, (' role="part"', ' role="reference"')) == [
        "Plant::Gate: retyped reference stop, role: part => reference"
    ]


def test_texts_that_look_alike_are_told_exactly():
    old = (
        'Class a "A"\n  Class x "X"\n  Property p "p"\n    -> typed-by x\n'
        'Class b "B"\n  Class y "X"\n'
    )
    assert changed(old, ("typed-by x", "typed-by y")) == [
        "A: retyped property p, type: A::X => B::X"
    ]
    assert told('Class c "C" ready=true\n', 'Class c "C" ready="true"\n') == [
        ": changed class C, ready: True => 'true'"
    ]


def test_ends_that_are_called_alike_are_told_with_their_owners():
    old = PLANT + '  Class other "Other"\n    Port otherIn "p_stop"\n'
    assert changed(old, ("-> role stopIn", "-> role otherIn")) == [
        "Plant::Gate: rewired connector p_in -- stop.p_stop, "
        "ends: p_in of Plant::Gate -- stop.p_stop of Plant::Stopper"
        " => p_in of Plant::Gate -- stop.p_stop of Plant::Other"
    ]


# -- who is who ----------------------------------------------------------------------------------


def renumbered(model):
    """The same model with ids that say nothing."""
    ids = ("gate", "in", "out", "stop", "c", "c1", "c2", "stopper", "stopIn", "speed", "pallet")
    words = {id: f"n{number}" for number, id in enumerate(ids)}
    lines = []
    for line in model.splitlines():
        head, quote, rest = line.partition(' "')
        lines.append(" ".join(words.get(word, word) for word in head.split(" ")) + quote + rest)
    return "\n".join(lines) + "\n"


def test_new_ids_are_no_difference():
    assert renumbered(PLANT) != PLANT
    assert told(PLANT, renumbered(PLANT)) == []


def test_with_new_ids_a_renamed_block_is_known_by_what_it_owns():
    new = renumbered(PLANT).replace('"Stopper"', '"Halt"')
    assert told(PLANT, new) == ["Plant: renamed block Halt, name: Stopper => Halt"]


def test_with_new_ids_another_name_and_another_type_are_another_part():
    new = renumbered(PLANT).replace('"stop"', '"halt"').replace("typed-by n7", "typed-by n10")
    ends = "ends: p_in -- stop.p_stop => p_in -- halt.p_stop"
    assert told(PLANT, new) == [
        "Plant::Gate: added part halt",
        f"Plant::Gate: rewired connector p_in -- halt.p_stop, {ends}",
        "Plant::Gate: removed part stop",
    ]


def test_ids_that_tools_count_anew_mean_nothing():
    old = "".join(f'Class n{i} "Class {i}"\n' for i in range(20))
    new = 'Class n0 "First"\n' + "".join(f'Class n{i + 1} "Class {i}"\n' for i in range(20))
    assert told(old, new) == [": added class First"]


def test_ids_may_be_ignored():
    new = PLANT.replace("p_in", "p_x").replace("p_out", "p_in").replace("p_x", "p_out")
    assert told(PLANT, new) == [
        "Plant::Gate: renamed port p_in, name: p_out => p_in",
        "Plant::Gate: renamed port p_out, name: p_in => p_out",
    ]
    assert told(PLANT, new, "id") == [
        "Plant::Gate: retyped port p_in, type: Pallet => None",
        "Plant::Gate: retyped port p_out, type: None => Pallet",
        "Plant::Gate: rewired connector p_out -- stop.p_stop, "
        "ends: p_in -- stop.p_stop => p_out -- stop.p_stop",
    ]


def test_attributes_may_be_ignored():
    new = PLANT.replace("default=1.5", "default=2")
    assert told(PLANT, new, "default") == []


@pytest.mark.parametrize(
    "noise",
    [
        ('Class pallet "Pallet"', 'Class pallet "Pallet" @other.uml:77'),
        ('Class pallet "Pallet"', 'Class pallet "Pallet" unresolved=["typed-by"]'),
        ('Class pallet "Pallet"', 'Class pallet "Pallet" origin="gate"'),
        ('unit="m/s"', 'unit="m/s" interface_ids=[["a", "b"]]'),
    ],
)
def test_places_and_what_tools_leave_behind_are_no_difference(noise):
    assert changed(PLANT, noise) == []


def test_what_lies_outside_is_no_difference_of_the_model():
    outside = 'DataType real "Real" external=true href="a.uml#_1"\n'
    old = outside + 'Class c "C"\n  Property p "p"\n    -> typed-by real\n'
    other = old.replace("real", "real2").replace("a.uml#_1", "b.xmi#Real")
    assert told(old, other) == []
    assert told(old, outside.replace("Real", "Integer") + old[len(outside) :]) == [
        "C: retyped property p, type: Real => Integer"
    ]


def test_the_header_of_an_automationml_file_is_no_difference():
    old = 'Document d "a.aml" subkind="caex" version="2.15"\nPackage p "P"\n'
    new = 'Document e "b.aml" subkind="caex" version="3.0"\nPackage p "P"\n'
    assert told(old, new) == []


def test_values_of_a_part_come_with_the_part():
    old = 'Class g "Gate"\nInstance i "gate"\n  -> instance-of g\n'
    new = (
        'Class g "Gate"\n  Property s "st"\n'
        'Instance i "gate"\n  -> instance-of g\n'
        '  Instance is "st" subkind="part"\n    -> represents s\n'
    )
    assert told(old, new) == ["Gate: added property st"]


TWINS = """\
DataType m "Mix"
  Property a ""
  Property b ""
  Constraint x "" body="A <= 100"
    -> references {}
  Constraint y "" body="B <= 50"
    -> references {}
"""


def test_twins_are_told_apart_by_the_constraints_that_speak_of_them():
    assert told(TWINS.format("a", "b"), TWINS.format("b", "a"), "id") == []
    assert told(TWINS.format("a", "b"), TWINS.format("b", "b"), "id") != []


def test_twins_are_told_apart_by_the_attributes_that_name_them():
    links = """\
Class k "Cell"
  Property a ""
  Property b ""
  Property c "" opposite="{}"
  Property d "" opposite="{}" default=1
"""
    assert told(links.format("a", "b"), links.format("b", "a"), "id") == []
    assert told(links.format("a", "b"), links.format("b", "b"), "id") != []


def test_twins_are_told_apart_by_the_ends_of_connectors_that_lead_to_them():
    wires = """\
Class k "Cell"
  Port a ""
  Port b ""
  Connector c
    ConnectorEnd c.1
      -> role {}
    ConnectorEnd c.2 multiplicity="2"
      -> role {}
"""
    assert told(wires.format("a", "b"), wires.format("b", "a"), "id") == []
    assert told(wires.format("a", "b"), wires.format("b", "b"), "id") != []


def test_another_subject_of_a_requirement_is_told():
    model = """\
Class gate "Gate" role="block"
Class belt "Belt" role="block"
Class fast "Fast" role="requirement"
  -> subject gate
"""
    assert changed(model, ("subject gate", "subject belt")) == [
        ": changed requirement Fast, subject: Gate => Belt"
    ]


def test_an_import_is_told_by_what_it_imports():
    model = """\
Package plant "Plant"
  Import i visibility="private"
    -> references pumps
Package pumps "Pumps"
Package valves "Valves"
"""
    imported = "Pumps; visibility: private", "Valves; visibility: private"
    assert changed(model, ("references pumps", "references valves")) == [
        ": changed package Plant, import: {} => {}".format(*imported)
    ]
