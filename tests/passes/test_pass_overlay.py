"""What overlays add to a model, entry by entry."""

import pytest
from overlay_samples import MODEL, PLANT, apply_overlays
from pass_runs import list_codes, list_diagnostics

from sysmlc.ir import Edge, Kind
from sysmlc.ir.query import component_name
from sysmlc.ir.text import print_element

ITEMS = "overlay: 1\nitems:\n  MiniPallet: {domain: physical}\n"
FLOW = ITEMS + "connectors:\n  Plant/Gate/l1:\n    flows:\n    - "
GATE = "overlay: 1\nblocks:\n  Plant/Gate:\n"
HANDLED = GATE + "    behavior: gate.uml#Gate::Handle\n"
GETS_IN = "  Plant/Switch: {operations: {getIn: }}\n"


def named(graph, name, kind=None):
    return next(one for one in graph if one.name == name and kind in (None, one.kind))


def flow_of(text, model=PLANT + MODEL, until="overlay"):
    graph, sink = apply_overlays(text, model=model, until=until)
    assert list_codes(sink) == []
    flow = graph.of_kind(Kind.ITEM_FLOW)[0]
    sides = [
        [one.id for one in graph.targets(flow, e)] for e in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    ]
    return graph, flow, sides


# -- items -------------------------------------------------------------------------------------


def test_a_new_item_type_is_a_block_in_a_package_of_its_own():
    graph, sink = apply_overlays(
        ITEMS + "  RFID_Tag: {domain: information, description: The id.}\n"
    )
    assert list_codes(sink) == []
    pallet, tag = named(graph, "MiniPallet"), named(graph, "RFID_Tag")
    assert (pallet.kind, pallet.role, pallet.attrs["domain"]) == (Kind.CLASS, "block", "physical")
    assert tag.attrs["domain"] == "information"
    assert graph.qualified_name(pallet) == "Items::MiniPallet"
    assert [one.attrs["body"] for one in graph.owned(tag)] == ["The id."]


def test_item_types_join_a_package_of_the_model():
    graph, _ = apply_overlays(
        "overlay: 1\npackage: Plant\nitems:\n  MiniPallet: {domain: physical}\n"
    )
    assert graph.qualified_name(named(graph, "MiniPallet")) == "Plant::MiniPallet"


def test_an_item_type_of_the_model_gets_its_domain():
    graph, sink = apply_overlays("overlay: 1\nitems:\n  Plant/Tag: {domain: information}\n")
    assert list_codes(sink) == []
    assert graph["tag"].attrs["domain"] == "information"


def test_the_domain_of_a_general_type_is_enough():
    text = ITEMS + "  HeavyPallet: {specializes: [MiniPallet]}\n"
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    heavy = named(graph, "HeavyPallet")
    assert graph.targets(heavy, Edge.SPECIALIZES) == [named(graph, "MiniPallet")]


# -- ports and flows ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    "ends",
    [
        "to: sw",
        "from: st",
        "to: p_swIn",
        "to: sw/p_swIn",
        "to: sw.p_swIn",
        "from: st, to: sw",
        "to: w-in",
        "from: s-out",
        "to: Plant/Gate/sw/p_swIn",
    ],
)
def test_an_end_of_a_flow_has_many_names(ends):
    graph, flow, sides = flow_of(f"{FLOW}{{item: MiniPallet, {ends}}}\n")
    assert sides == [["s-out"], ["w-in"]]
    assert graph.targets(flow, Edge.REALIZING) == [graph["l1"]]
    assert graph.targets(flow, Edge.CONVEYS) == [named(graph, "MiniPallet")]
    assert graph.qualified_name(flow) == "Plant::<ItemFlow>"


def test_a_flow_against_the_connector_runs_back():
    assert flow_of(FLOW.replace("l1", "loop") + "{item: MiniPallet, to: p_sOut}\n")[2] == [
        ["s-in"],
        ["s-out"],
    ]


def test_a_flow_both_ways_has_both_ends_at_each_side():
    _, _, sides = flow_of(f"{FLOW}{{item: MiniPallet, both-ways: true}}\n")
    assert sides == [["s-out", "w-in"], ["s-out", "w-in"]]


def test_between_two_parts_with_the_same_port_the_parts_tell_the_way():
    twins = PLANT.replace("-> role w-in", "-> role s-out")
    text = f"{FLOW}{{item: MiniPallet, to: sw}}\n"
    assert flow_of(text, model=twins + MODEL)[2] == [["st"], ["sw"]]


def test_flows_give_ports_and_connectors_what_they_say():
    graph, sink = apply_overlays(f"{FLOW}{{item: MiniPallet, to: sw}}\n", until="flows")
    assert graph["s-out"].attrs["direction"] == "out"
    assert graph["l1"].attrs["domain"] == "physical"
    assert list_codes(sink) == ["SM300"]


def test_the_author_directs_and_types_ports():
    text = "overlay: 1\nports:\n  s-in: {direction: in, type: Plant/Track}\n"
    graph, _ = apply_overlays(text, until="ports")
    assert graph["s-in"].attrs["direction"] == "in"
    assert graph.targets(graph["s-in"], Edge.TYPED_BY) == [graph["track"]]


def test_a_flow_against_the_direction_of_a_port_is_reported_where_the_overlay_says_it():
    text = f"{FLOW}{{item: MiniPallet, from: sw}}\n"
    _, sink = apply_overlays(text, until="flows")
    found = next(diagnostic for diagnostic in sink if diagnostic.rule.code == "SM310")
    assert found.message == (
        "item flow 'Plant::Switch::p_swIn - Plant::Stopper::p_sOut' leaves port "
        "'Plant::Switch::p_swIn', whose direction is in"
    )
    assert found.subject.place.file == "0.overlay.yaml"
    assert text[found.subject.place.ordinal :].startswith("MiniPallet, from: sw")


def test_mixed_domains_on_one_connector_are_reported():
    items = ITEMS + "  Tag2: {domain: information}\n" + FLOW.removeprefix(ITEMS)
    text = items + "{item: MiniPallet, to: sw}\n    - {item: Tag2, to: sw}\n"
    _, sink = apply_overlays(text, until="flows")
    (found,) = (diagnostic for diagnostic in sink if diagnostic.rule.code == "SM317")
    assert found.subject.place.file == "0.overlay.yaml"
    assert text[found.subject.place.ordinal :].startswith("MiniPallet, to: sw")


def test_different_items_over_ports_of_one_interface_block_are_no_fault():
    items = ITEMS + "  Tag2: {domain: information}\n" + FLOW.removeprefix(ITEMS)
    text = (
        items
        + "{item: MiniPallet, to: sw}\n  Plant/Gate/loop:\n    flows: [{item: Tag2, to: p_sIn}]\n"
    )
    assert {"SM311", "SM316", "SM317"}.isdisjoint(
        list_codes(apply_overlays(text, until="flows")[1])
    )


# -- operations and behaviours -----------------------------------------------------------------


def test_an_operation_has_its_parameters_in_order():
    text = GATE + (
        "    operations:\n      readId:\n        description: Reads.\n        parameters:\n"
        "        - {name: tag, type: Plant/Tag}\n"
        "        - {name: id, type: String, direction: return}\n"
    )
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    operation = named(graph, "readId")
    assert graph.owner(operation) is graph["gate"]
    shown = [(one.name, one.attrs.get("direction")) for one in graph.owned(operation)]
    assert shown == [("", None), ("tag", None), ("id", "return")]
    types = [graph.target(one, Edge.TYPED_BY) for one in graph.owned(operation)[1:]]
    assert types == [graph["tag"], named(graph, "String")]


def test_a_method_gives_its_parameters_to_an_operation_without():
    text = GATE + "    operations:\n      handle: {method: gate.uml#Gate::Handle}\n"
    text += GETS_IN
    graph, sink = apply_overlays(text, until="behaviours")
    assert "SM404" not in list_codes(sink)
    operation = named(graph, "handle", Kind.OPERATION)
    assert graph.targets(operation, Edge.METHOD) == [graph["handle"]]
    assert [one.name for one in graph.owned(operation)] == ["pallet"]
    assert graph.owner(graph["handle"]) is graph["gate"]


def test_a_behaviour_becomes_the_classifier_behaviour_of_the_block():
    graph, sink = apply_overlays(HANDLED + GETS_IN)
    assert list_codes(sink) == []
    assert graph.targets(graph["gate"], Edge.CLASSIFIER_BEHAVIOR) == [graph["handle"]]
    assert component_name(graph, graph["handle"]) == "Plant::Gate"


def test_a_state_machine_is_a_behaviour_too():
    machine = 'Package m "M" @gate.uml:9\n  StateMachine states "States" @gate.uml:10\n'
    text = GATE + "    behavior: gate.uml#M::States\n"
    graph, sink = apply_overlays(text, model=PLANT + machine)
    assert list_codes(sink) == []
    assert graph.targets(graph["gate"], Edge.CLASSIFIER_BEHAVIOR) == [graph["states"]]


def test_an_activity_that_lost_its_file_is_told_so():
    (found,) = apply_overlays(GATE + "    behavior: gone.uml#Gate::Handle\n")[1]
    assert found.rule.code == "SM324"
    assert found.help == "the file 'gone.uml' is not part of the compile unit"


def test_an_id_that_is_gone_is_not_answered_with_names():
    id = "1ac5c9b2-45f8-4a4c-8d6a-6d2f5f3b8a01"
    (found,) = apply_overlays(f"overlay: 1\nports:\n  {id}: {{direction: in}}\n")[1]
    assert (found.rule.code, found.help) == ("SM324", "'sysmlc show MODEL' prints all ids")


def test_many_names_of_which_none_is_near_are_not_listed():
    ports = "".join(f'    Port s{n} "p{n}"\n' for n in range(20))
    model = f'Package plant "Plant"\n  Class gate "Gate" role="block"\n{ports}'
    (found,) = apply_overlays("overlay: 1\nports:\n  Xyz: {direction: in}\n", model=model)[1]
    assert (found.rule.code, found.help) == ("SM324", "'sysmlc show MODEL' prints all names")


def test_a_value_that_a_general_block_has_is_there_already():
    model = PLANT + 'Class base "Base" role="block"\n  Property base.v "v" role="value"\n'
    text = "overlay: 1\nblocks:\n  Plant/Switch: {specializes: [Base], values: {v: }}\n"
    (found,) = apply_overlays(text, model=model)[1]
    assert found.rule.code == "SM334"
    assert found.message == "block 'Plant::Switch' has 'v' already, inherited from 'Base'"


ENUMERATION = 'Enumeration e "Bay"\n  EnumerationLiteral e.f "free"\n'


@pytest.mark.parametrize(
    ("type_", "good", "bad"),
    [
        ("Boolean", "true", "1"),
        ("Integer", "7", "7.5"),
        ("Integer", "0", "true"),
        ("Real", "7", '"7"'),
        ("String", '"7"', "7"),
        ("Bay", "free", "fre"),
    ],
)
def test_a_default_is_a_value_of_its_type(type_, good, bad):
    for default, expected in ((good, []), (bad, ["SM637"])):
        value = f"{{type: {type_}, default: {default}}}"
        text = f"overlay: 1\nblocks:\n  Plant/Switch: {{values: {{v: {value}}}}}\n"
        assert list_codes(apply_overlays(text, model=PLANT + ENUMERATION)[1]) == expected


def test_of_many_lost_entries_the_first_are_answered_with_the_nearest_name():
    rows = "".join(f"  Plant/Switch/p_swl{n}: {{direction: in}}\n" for n in range(30))
    found = list(apply_overlays("overlay: 1\nports:\n" + rows)[1])
    assert [diagnostic.rule.code for diagnostic in found] == ["SM324"] * 30
    assert sum(one.help == "did you mean 'Plant/Switch/p_swIn'?" for one in found) == 20


def test_a_call_means_an_operation_of_the_block_or_of_a_part():
    graph, sink = apply_overlays(
        HANDLED + "  Plant/Switch: {operations: {getIn: }}\n", until="behaviours"
    )
    assert "SM400" not in list_codes(sink)
    assert graph.targets(graph["call"], Edge.CALLS) == [named(graph, "getIn", Kind.OPERATION)]


def test_a_part_that_inherits_the_operation_has_it_too():
    text = (
        HANDLED
        + GETS_IN.replace("Switch", "Stopper")
        + "  Plant/Switch: {specializes: [Plant/Stopper]}\n"
    )
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    assert graph.targets(graph["call"], Edge.CALLS) == [named(graph, "getIn", Kind.OPERATION)]


def test_a_call_that_nothing_answers_is_reported_once_with_the_nearest_name():
    _, sink = apply_overlays(
        HANDLED + "  Plant/Switch: {operations: {getInn: }}\n", until="behaviours"
    )
    found = [one for one in sink if one.severity == "error"]
    assert [one.message for one in found] == [
        "action 'getIn' calls no operation: neither 'Plant::Gate' nor a part of it has one of "
        "this name"
    ]
    assert found[0].help.endswith("did you mean 'getInn'?")
    assert "SM400" not in list_codes(sink)


def test_calls_of_the_overlay_count_before_names():
    text = HANDLED + (
        "    calls: {getIn: sw/open}\n  Plant/Switch: {operations: {open: , getIn: }}\n"
    )
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    called = graph.targets(graph["call"], Edge.CALLS)
    assert [graph.qualified_name(one) for one in called] == ["Plant::Switch::open"]


def test_values_are_what_guards_can_name():
    text = GATE + "    values: {bayIsFree: {type: Boolean, default: true}}\n"
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    value = named(graph, "bayIsFree")
    assert (value.role, value.attrs["default"], graph.owner(value)) == (
        "value",
        True,
        graph["gate"],
    )


def test_an_allocation_is_drawn_from_one_element_to_the_other():
    text = "overlay: 1\nallocations:\n- {from: Gate/Handle, to: Plant/Gate/sw}\n"
    graph, sink = apply_overlays(text, until="classify")
    assert list_codes(sink) == []
    assert graph.targets(graph["handle"], Edge.ALLOCATED_TO) == [graph["sw"]]


# -- keys --------------------------------------------------------------------------------------

PLANT_OF_AML = """\
Package h "Hall"
  Class own "Press / 1" role="block"
  Instance 9c1f3a52-5d8e-4a3b-9f00-2b7d9a3c1e11 "Press / 1" interface_ids=[["own.p", "REPEATED"]]
    -> instance-of own
  Class other "Feeder" role="block"
    Port own.p "p"
""".replace("REPEATED", "7b0c9d64-0000-4a3b-9f00-2b7d9a3c1e11")


@pytest.mark.parametrize(
    "key",
    [
        "own",
        "Hall/[Press / 1]",
        "'[Hall]/[Press / 1]'",
        "9c1f3a52-5d8e-4a3b-9f00-2b7d9a3c1e11",
        "'{9C1F3A52-5D8E-4A3B-9F00-2B7D9A3C1E11}'",
        "Hall::Press / 1",
    ],
)
def test_a_block_is_named_by_id_path_or_qualified_name_of_it_or_its_instance(key):
    graph, sink = apply_overlays(
        f"overlay: 1\nblocks:\n  {key}: {{operations: {{stamp: }}}}\n", model=PLANT_OF_AML
    )
    assert list_codes(sink) == []
    assert graph.owner(named(graph, "stamp")) is graph["own"]


def test_an_interface_that_an_instance_repeats_is_the_port_of_the_class():
    key = "'{7B0C9D64-0000-4A3B-9F00-2B7D9A3C1E11}'"
    graph, sink = apply_overlays(
        f"overlay: 1\nports:\n  {key}: {{direction: in}}\n", model=PLANT_OF_AML
    )
    assert list_codes(sink) == []
    assert graph["own.p"].attrs["direction"] == "in"


def test_a_key_whose_id_is_gone_falls_back_to_its_path_and_says_so():
    text = "overlay: 1\nports:\n  old-id: {path: Plant/Switch/p_swIn, direction: in}\n"
    _, sink = apply_overlays(text)
    assert list_diagnostics(sink) == [
        "SM325 info: no element has the id 'old-id' any more; 'Plant/Switch/p_swIn' is used instead"
    ]
    assert next(iter(sink)).help == "if that is the intended element, write 'w-in' as the key"


def test_the_id_counts_when_the_path_leads_elsewhere():
    text = "overlay: 1\nports:\n  s-in: {path: Plant/Stopper/p_sOut, direction: in}\n"
    graph, sink = apply_overlays(text)
    assert list_diagnostics(sink) == [
        "SM340 warning: the id 's-in' now belongs to 'Plant/Stopper/p_sIn', not to "
        "'Plant/Stopper/p_sOut'"
    ]
    assert "direction" not in graph["s-out"].attrs


@pytest.mark.parametrize("path", ["Plant/Stopper/p_sIn", "Plant/Stopper/gone"])
def test_a_path_that_leads_to_the_same_or_nowhere_is_fine_beside_an_id(path):
    _, sink = apply_overlays(f"overlay: 1\nports:\n  s-in: {{path: {path}, direction: in}}\n")
    assert list_codes(sink) == []


def test_an_entry_that_matches_nothing_is_told_with_its_place_and_the_nearest_name():
    text = "overlay: 1\nports:\n  Plant/Switch/p_swln: {direction: in}\n"
    _, sink = apply_overlays(text)
    (found,) = sink
    assert found.message == "the model has no port 'Plant/Switch/p_swln'"
    assert found.help == "did you mean 'Plant/Switch/p_swIn'?"
    assert (found.subject.place.line, found.subject.place.column) == (3, 3)


# -- several overlays --------------------------------------------------------------------------


def test_overlays_share_the_items_that_both_name():
    graph, sink = apply_overlays(f"{FLOW}{{item: MiniPallet, to: sw}}\n", ITEMS)
    assert list_codes(sink) == []
    assert len([one for one in graph if one.name == "MiniPallet"]) == 1


def test_overlays_that_disagree_are_told():
    _, sink = apply_overlays(ITEMS, ITEMS.replace("physical", "information"))
    assert list_diagnostics(sink) == [
        "SM339 warning: the overlay gives 'MiniPallet' the domain information, the model physical"
    ]


def test_what_an_overlay_adds_is_printed_with_its_origin():
    graph, _, _ = flow_of(f"{FLOW}{{item: MiniPallet, to: sw}}\n")
    shown = print_element(graph, graph.of_kind(Kind.ITEM_FLOW)[0])
    assert 'origin="l1"' in shown
    assert "@0.overlay.yaml:" in shown
