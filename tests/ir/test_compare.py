"""The changes that a comparison of two small models reports."""

import pytest
from change_texts import print_changes

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


def list_changes(old, new, *ignore):
    return print_changes(compare(parse_text(old), parse_text(new), ignore))


def list_changes_after(model, *replacements):
    """Return the changes when each first text of *replacements* is replaced by the second."""
    new = model
    for before, after in replacements:
        assert before in new
        new = new.replace(before, after)
    return list_changes(model, new)


# -- kinds of changes ----------------------------------------------------------------------------


def test_a_model_does_not_differ_from_itself():
    assert list_changes(PLANT, PLANT) == []


def test_an_added_or_removed_element_is_one_change_with_the_number_of_its_contents():
    larger_plant = PLANT + '  Class more "More"\n    Port more.a "a"\n    Port more.b "b"\n'
    added = compare(parse_text(PLANT), parse_text(larger_plant))
    removed = compare(parse_text(larger_plant), parse_text(PLANT))
    assert [(c.what, c.name, c.contents, c.old) for c in added] == [("added", "More", 2, None)]
    assert [(c.what, c.name, c.contents, c.new) for c in removed] == [("removed", "More", 2, None)]


def test_a_renamed_block_is_one_change_wherever_it_is_used():
    assert list_changes_after(PLANT, ('"Stopper"', '"Halt"')) == [
        "Plant: renamed block Halt, name: Stopper => Halt"
    ]


def test_a_part_of_another_type_is_retyped():
    assert list_changes_after(PLANT, ("-> typed-by stopper", "-> typed-by pallet")) == [
        "Plant::Gate: retyped part stop, type: Stopper => Pallet"
    ]


def test_a_rewired_connector_names_its_ends():
    assert list_changes_after(
        PLANT, ("ConnectorEnd c1\n        -> role in", "ConnectorEnd c1\n        -> role out")
    ) == [
        "Plant::Gate: rewired connector p_out -- stop.p_stop, "
        "ends: p_in -- stop.p_stop => p_out -- stop.p_stop"
    ]


def test_the_order_of_ends_matters_for_transitions_and_not_for_connectors():
    assert list_changes_after(PLANT, ("-> end c1 c2", "-> end c2 c1")) == []
    swapped = (("flow-source idle", "flow-source x"), ("flow-target busy", "flow-target idle"))
    assert list_changes_after(MACHINE, *swapped, ("flow-source x", "flow-source busy")) == [
        "Machine::main: rewired transition Busy -> Idle, ends: Idle -> Busy => Busy -> Idle"
    ]


def test_a_changed_value_or_guard_is_reported_with_both_texts():
    assert list_changes_after(PLANT, ("default=1.5", "default=2")) == [
        "Plant::Stopper: changed property speed, default: 1.5 => 2"
    ]
    assert list_changes_after(MACHINE, ('guard="ready"', 'guard="ready && safe"')) == [
        "Machine::main: changed transition Idle -> Busy, guard: ready => ready && safe"
    ]


def test_a_changed_trigger_is_reported_at_its_transition():
    assert list_changes_after(MACHINE, ("-> typed-by start", "-> typed-by stop")) == [
        "Machine::main: changed transition Idle -> Busy, trigger: signal Start => signal Stop"
    ]


def test_a_block_with_another_owner_is_moved():
    new = PLANT.replace(
        '  Class pallet "Pallet"\n', '  Package lib "Lib"\n    Class pallet "Pallet"\n'
    )
    assert list_changes(PLANT, new) == [
        "Plant: added package Lib",
        "Plant::Lib: moved class Pallet, owner: Plant => Plant::Lib",
    ]


def test_the_order_of_parameters_matters_and_that_of_ports_does_not():
    old = 'Class c "C"\n  Operation o "go"\n    Parameter a "a"\n    Parameter b "b"\n'
    new = 'Class c "C"\n  Operation o "go"\n    Parameter b "b"\n    Parameter a "a"\n'
    assert list_changes(old, new) == ["C: reordered operation go, order: a, b => b, a"]
    assert list_changes(old.replace("Parameter", "Port"), new.replace("Parameter", "Port")) == []


@pytest.mark.parametrize(
    ("owner", "owned"),
    [
        ("Operation", "Parameter"),
        ("Reception", "Parameter"),
        ("Activity", "Parameter"),
        ("StateMachine", "Parameter"),
        ("Action", "Pin"),
        ("Enumeration", "EnumerationLiteral"),
        *(("Interaction", owned) for owned in ("Occurrence", "Execution", "Fragment")),
        *(("Operand", owned) for owned in ("Occurrence", "Execution", "Fragment")),
        ("Fragment", "Operand"),
    ],
)
def test_the_order_of_what_has_a_sequence_matters(owner, owned):
    first, second = f'    {owned} a "a"\n', f'    {owned} b "b"\n'
    head = f'Package p "P"\n  {owner} o "go"\n'
    (change,) = compare(parse_text(head + first + second), parse_text(head + second + first))
    assert (str(change.what), change.aspect) == ("reordered", "order")


def test_changes_of_stereotypes_and_tags_are_reported_at_the_stereotyped_element():
    old = (
        'Class c "Robot"\n'
        '  Application a "Machine" stereotype="Machine" tag.endpoint="x" namespace="v1"\n'
        "    -> subject c\n"
    )
    assert list_changes_after(old, ('tag.endpoint="x"', 'tag.Endpoint="y"')) == [
        ": changed machine Robot, «Machine» endpoint: x => y"
    ]
    assert list_changes_after(old, ('namespace="v1"', 'namespace="v2"')) == []
    assert list_changes(old, 'Class c "Robot"\n') == [
        ": changed class Robot, «Machine» endpoint: x => None",
        ": retyped class Robot, stereotype: «Machine» => None",
    ]


def test_a_value_of_an_instance_is_reported_with_its_feature():
    old = (
        'Class b "Belt"\n  Property v "velocity"\n'
        'Instance i "belt1"\n  -> instance-of b\n  Slot s value=1\n    -> instance-of v\n'
    )
    assert list_changes_after(old, ("value=1", "value=2")) == [
        ": changed instance belt1, value of velocity: 1 => 2"
    ]


def test_a_changed_role_is_reported_only_if_no_other_change_explains_it():
    assert list_changes_after(
        PLANT, (' aggregation="composite" role="part"', ' role="reference"')
    ) == ["Plant::Gate: changed reference stop, aggregation: composite => None"]
    assert list_changes_after(PLANT, (' role="part"', ' role="reference"')) == [
        "Plant::Gate: retyped reference stop, role: part => reference"
    ]


def test_values_with_the_same_text_are_shown_unambiguously():
    old = (
        'Class a "A"\n  Class x "X"\n  Property p "p"\n    -> typed-by x\n'
        'Class b "B"\n  Class y "X"\n'
    )
    assert list_changes_after(old, ("typed-by x", "typed-by y")) == [
        "A: retyped property p, type: A::X => B::X"
    ]
    assert list_changes('Class c "C" ready=true\n', 'Class c "C" ready="true"\n') == [
        ": changed class C, ready: True => 'true'"
    ]


def test_ends_of_the_same_name_are_shown_with_their_owners():
    old = PLANT + '  Class other "Other"\n    Port otherIn "p_stop"\n'
    assert list_changes_after(old, ("-> role stopIn", "-> role otherIn")) == [
        "Plant::Gate: rewired connector p_in -- stop.p_stop, "
        "ends: p_in of Plant::Gate -- stop.p_stop of Plant::Stopper"
        " => p_in of Plant::Gate -- stop.p_stop of Plant::Other"
    ]


# -- matching of elements ------------------------------------------------------------------------


def renumber(model):
    """Return the same model with ids that do not resemble the names."""
    ids = ("gate", "in", "out", "stop", "c", "c1", "c2", "stopper", "stopIn", "speed", "pallet")
    words = {id: f"n{number}" for number, id in enumerate(ids)}
    lines = []
    for line in model.splitlines():
        head, quote, rest = line.partition(' "')
        lines.append(" ".join(words.get(word, word) for word in head.split(" ")) + quote + rest)
    return "\n".join(lines) + "\n"


def test_new_ids_are_no_difference():
    assert renumber(PLANT) != PLANT
    assert list_changes(PLANT, renumber(PLANT)) == []


def test_with_new_ids_a_renamed_block_is_matched_by_its_contents():
    new = renumber(PLANT).replace('"Stopper"', '"Halt"')
    assert list_changes(PLANT, new) == ["Plant: renamed block Halt, name: Stopper => Halt"]


def test_with_new_ids_a_part_of_another_name_and_type_is_another_part():
    new = renumber(PLANT).replace('"stop"', '"halt"').replace("typed-by n7", "typed-by n10")
    ends = "ends: p_in -- stop.p_stop => p_in -- halt.p_stop"
    assert list_changes(PLANT, new) == [
        "Plant::Gate: added part halt",
        f"Plant::Gate: rewired connector p_in -- halt.p_stop, {ends}",
        "Plant::Gate: removed part stop",
    ]


def test_ids_that_a_tool_renumbers_do_not_match_elements():
    old = "".join(f'Class n{i} "Class {i}"\n' for i in range(20))
    new = 'Class n0 "First"\n' + "".join(f'Class n{i + 1} "Class {i}"\n' for i in range(20))
    assert list_changes(old, new) == [": added class First"]


def test_ids_may_be_ignored():
    new = PLANT.replace("p_in", "p_x").replace("p_out", "p_in").replace("p_x", "p_out")
    assert list_changes(PLANT, new) == [
        "Plant::Gate: renamed port p_in, name: p_out => p_in",
        "Plant::Gate: renamed port p_out, name: p_in => p_out",
    ]
    assert list_changes(PLANT, new, "id") == [
        "Plant::Gate: retyped port p_in, type: Pallet => None",
        "Plant::Gate: retyped port p_out, type: None => Pallet",
        "Plant::Gate: rewired connector p_out -- stop.p_stop, "
        "ends: p_in -- stop.p_stop => p_out -- stop.p_stop",
    ]


def test_attributes_may_be_ignored():
    new = PLANT.replace("default=1.5", "default=2")
    assert list_changes(PLANT, new, "default") == []


@pytest.mark.parametrize(
    "noise",
    [
        ('Class pallet "Pallet"', 'Class pallet "Pallet" @other.uml:77'),
        ('Class pallet "Pallet"', 'Class pallet "Pallet" unresolved=["typed-by"]'),
        ('Class pallet "Pallet"', 'Class pallet "Pallet" origin="gate"'),
        ('unit="m/s"', 'unit="m/s" interface_ids=[["a", "b"]]'),
    ],
)
def test_locations_and_traces_of_tools_are_no_difference(noise):
    assert list_changes_after(PLANT, noise) == []


def test_elements_outside_the_unit_are_compared_by_name():
    outside = 'DataType real "Real" external=true href="a.uml#_1"\n'
    old = outside + 'Class c "C"\n  Property p "p"\n    -> typed-by real\n'
    new = old.replace("real", "real2").replace("a.uml#_1", "b.xmi#Real")
    assert list_changes(old, new) == []
    assert list_changes(old, outside.replace("Real", "Integer") + old[len(outside) :]) == [
        "C: retyped property p, type: Real => Integer"
    ]


def test_the_header_of_an_automationml_file_is_no_difference():
    old = 'Document d "a.aml" subkind="caex" version="2.15"\nPackage p "P"\n'
    new = 'Document e "b.aml" subkind="caex" version="3.0"\nPackage p "P"\n'
    assert list_changes(old, new) == []


def test_an_instance_of_a_new_part_is_no_change_of_its_own():
    old = 'Class g "Gate"\nInstance i "gate"\n  -> instance-of g\n'
    new = (
        'Class g "Gate"\n  Property s "st"\n'
        'Instance i "gate"\n  -> instance-of g\n'
        '  Instance is "st" subkind="part"\n    -> represents s\n'
    )
    assert list_changes(old, new) == ["Gate: added property st"]


TWINS = """\
DataType m "Mix"
  Property a ""
  Property b ""
  Constraint x "" body="A <= 100"
    -> references {}
  Constraint y "" body="B <= 50"
    -> references {}
"""


def test_unnamed_elements_are_distinguished_by_the_constraints_that_refer_to_them():
    assert list_changes(TWINS.format("a", "b"), TWINS.format("b", "a"), "id") == []
    assert list_changes(TWINS.format("a", "b"), TWINS.format("b", "b"), "id") != []


def test_unnamed_elements_are_distinguished_by_the_attributes_that_refer_to_them():
    links = """\
Class k "Cell"
  Property a ""
  Property b ""
  Property c "" opposite="{}"
  Property d "" opposite="{}" default=1
"""
    assert list_changes(links.format("a", "b"), links.format("b", "a"), "id") == []
    assert list_changes(links.format("a", "b"), links.format("b", "b"), "id") != []


def test_unnamed_elements_are_distinguished_by_the_connector_ends_that_refer_to_them():
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
    assert list_changes(wires.format("a", "b"), wires.format("b", "a"), "id") == []
    assert list_changes(wires.format("a", "b"), wires.format("b", "b"), "id") != []


def test_another_subject_of_a_requirement_is_reported():
    model = """\
Class gate "Gate" role="block"
Class belt "Belt" role="block"
Class fast "Fast" role="requirement"
  -> subject gate
"""
    assert list_changes_after(model, ("subject gate", "subject belt")) == [
        ": changed requirement Fast, subject: Gate => Belt"
    ]


def test_a_changed_import_is_reported_with_the_imported_elements():
    model = """\
Package plant "Plant"
  Import i visibility="private"
    -> references pumps
Package pumps "Pumps"
Package valves "Valves"
"""
    imported = "Pumps; visibility: private", "Valves; visibility: private"
    assert list_changes_after(model, ("references pumps", "references valves")) == [
        ": changed package Plant, import: {} => {}".format(*imported)
    ]


def test_a_value_that_is_an_id_of_automationml_leads_to_the_element_in_both_notations():
    plant = """\
Class gate "Gate" role="block"
  Property id-1 "belt" role="part"
  Property target "target" default="id-1"
"""
    same = plant.replace("Property id-1", 'Property belt caex_id="id-1"').replace(
        'belt caex_id="id-1" "belt"', 'belt "belt" caex_id="id-1"'
    )
    assert list_changes(plant, same, "id") == []
    other = same.replace('default="id-1"', 'default="id-2"')
    assert list_changes(plant, other, "id") == [
        "Gate: changed property target, default: belt => id-2"
    ]


def test_a_comment_without_an_annotated_element_is_about_its_owner():
    about_nothing = """\
Class gate "Gate" role="block"
  Comment c body="slow"
Class belt "Belt" role="block"
"""
    about_owner = about_nothing.replace("Class belt", "  -> references gate\nClass belt")
    about_owner = about_owner.replace("  -> references", "    -> references")
    assert list_changes(about_nothing, about_owner) == []
    assert list_changes(about_nothing, about_owner.replace("references gate", "references belt"))


def test_a_first_node_without_a_name_is_called_start():
    model = """\
Activity a "Fill"
  Control first "" subkind="initial"
  Action pump "pump" subkind="opaque"
  ControlFlow f
    -> flow-source first
    -> flow-target pump
"""
    assert list_changes(model, model.replace('first ""', 'first "start"'), "id") == []
    renamed = list_changes(model, model.replace('first ""', 'first "begin"'))
    assert [change for change in renamed if "renamed" in change]


NAMESAKES = """\
Package p "Plant"
  Class gate "Gate" role="block"
    Property a1 "stop" multiplicity="2"
      -> typed-by {type}
    Property a2 "stop" multiplicity="3"
      -> typed-by {type}
  Class x "X"
  Class y "Y"
"""


def test_namesakes_are_paired_although_their_types_have_changed():
    old, new = NAMESAKES.format(type="x"), NAMESAKES.format(type="y")
    change = "Plant::Gate: retyped property stop, type: X => Y"
    assert list_changes(old, new, "id") == [change, change]


REQUIREMENTS = """\
Package p "Plant"
  Class r1 "" role="requirement" req_id="1" text="{first}"
  Class r2 "" role="requirement" req_id="2" text="{second}" {facts}
    Comment r2.c body="{second}"
"""


def test_requirements_without_names_are_the_same_if_their_ids_are():
    old = REQUIREMENTS.format(first="soft", second="fast", facts="")
    new = REQUIREMENTS.format(first="loud", second="slow", facts='risk="high" rank="1"')
    changed = [line.partition(", ")[2] for line in list_changes(old, new, "id")]
    assert sorted(changed) == [
        "comment: fast => slow",
        "rank: None => 1",
        "risk: None => high",
        "text: fast => slow",
        "text: soft => loud",
    ]


STUB = """\
Package p "Plant"
  Stereotype s "Cell" external={external}
    {member}
"""


@pytest.mark.parametrize(("external", "count"), [("true", 0), ("false", 1)])
def test_what_an_element_outside_the_model_owns_is_no_difference(external, count):
    old = STUB.format(external=external, member="")
    new = STUB.format(external=external, member='Property s.a "speed"')
    assert len(list_changes(old, new, "id")) == count


MERGES = """\
Activity a "Sort"
  Action x "left"
  Action y "right"
  Control {first} "" subkind="merge"
  Control {second} "" subkind="merge"
  ControlFlow f1{note}
    -> flow-source m1
    -> flow-target x
  ControlFlow f2{note}
    -> flow-source m2
    -> flow-target y
"""


@pytest.mark.parametrize(
    ("note", "expected"),
    [
        ("", []),
        (
            ' guard="free"',
            [
                "Sort: changed control flow merge -> left, guard: None => free",
                "Sort: changed control flow merge -> right, guard: None => free",
            ],
        ),
    ],
)
def test_nodes_without_names_are_paired_by_their_flows_although_the_flows_have_changed(
    note, expected
):
    old = MERGES.format(first="m1", second="m2", note="")
    new = MERGES.format(first="m2", second="m1", note=note)
    assert list_changes(old, new, "id") == expected
