"""The pass ``overlay``: its rules, and the items, ports and flows that overlays add."""

import pytest
from overlay_samples import FLOW, ITEMS, MODEL, PLANT, apply_overlays, find_element
from pass_runs import list_codes, list_diagnostics

from sysmlc.driver import load_full_catalogue
from sysmlc.ir import Edge, Kind
from sysmlc.ir.text import print_element

# -- rules -------------------------------------------------------------------------------------

CODES = {*range(320, 341), 637}
RULES = [rule for rule in load_full_catalogue().values() if int(rule.code[-3:]) in CODES]


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_rule_reports_its_wrong_example_and_not_its_right_one(rule):
    assert rule.code in list_codes(apply_overlays(rule.read_page().wrong)[1])
    assert rule.code not in list_codes(apply_overlays(rule.read_page().right)[1])


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_the_right_example_has_no_warnings_at_all(rule):
    _, sink = apply_overlays(rule.read_page().right)
    assert {diagnostic.severity for diagnostic in sink} <= {"info"}


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_the_diagnostic_has_file_line_and_column(rule):
    _, sink = apply_overlays(rule.read_page().wrong)
    place = next(d.subject.place for d in sink if d.rule is rule)
    is_of_model = rule.name.startswith("call-")
    assert place.file == ("gate.uml" if is_of_model else "0.overlay.yaml")
    assert is_of_model or (place.line > 0 and place.column > 0)


def test_every_code_has_a_rule():
    assert len(RULES) == len(CODES)


# -- items -------------------------------------------------------------------------------------


def test_a_new_item_type_is_a_block_in_a_package_of_its_own():
    graph, sink = apply_overlays(
        ITEMS + "  RFID_Tag: {domain: information, description: The id.}\n"
    )
    assert list_codes(sink) == []
    pallet, tag = find_element(graph, "MiniPallet"), find_element(graph, "RFID_Tag")
    assert (pallet.kind, pallet.role, pallet.attrs["domain"]) == (Kind.CLASS, "block", "physical")
    assert tag.attrs["domain"] == "information"
    assert graph.qualified_name(pallet) == "Items::MiniPallet"
    assert [comment.attrs["body"] for comment in graph.owned(tag)] == ["The id."]


def test_new_item_types_may_be_added_to_a_package_of_the_model():
    graph, _ = apply_overlays(
        "overlay: 1\npackage: Plant\nitems:\n  MiniPallet: {domain: physical}\n"
    )
    assert graph.qualified_name(find_element(graph, "MiniPallet")) == "Plant::MiniPallet"


def test_an_item_type_of_the_model_gets_its_domain():
    graph, sink = apply_overlays("overlay: 1\nitems:\n  Plant/Tag: {domain: information}\n")
    assert list_codes(sink) == []
    assert graph["tag"].attrs["domain"] == "information"


def test_a_type_inherits_the_domain_of_its_general_type():
    text = ITEMS + "  HeavyPallet: {specializes: [MiniPallet]}\n"
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    heavy = find_element(graph, "HeavyPallet")
    assert graph.targets(heavy, Edge.SPECIALIZES) == [find_element(graph, "MiniPallet")]


# -- ports and flows ---------------------------------------------------------------------------


def apply_flow(text, model=PLANT + MODEL):
    """Apply an overlay with an item flow; return the graph, the flow, its sources and targets."""
    graph, sink = apply_overlays(text, model=model)
    assert list_codes(sink) == []
    flow = graph.of_kind(Kind.ITEM_FLOW)[0]
    ends = [
        [port.id for port in graph.targets(flow, edge)]
        for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    ]
    return graph, flow, ends


@pytest.mark.parametrize(
    "ends_text",
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
def test_an_end_of_a_flow_may_be_named_by_part_port_path_or_id(ends_text):
    graph, flow, ends = apply_flow(f"{FLOW}{{item: MiniPallet, {ends_text}}}\n")
    assert ends == [["s-out"], ["w-in"]]
    assert graph.targets(flow, Edge.REALIZING) == [graph["l1"]]
    assert graph.targets(flow, Edge.CONVEYS) == [find_element(graph, "MiniPallet")]
    assert graph.qualified_name(flow) == "Plant::<ItemFlow>"


def test_a_flow_may_run_against_the_order_of_the_connector_ends():
    _, _, ends = apply_flow(FLOW.replace("l1", "loop") + "{item: MiniPallet, to: p_sOut}\n")
    assert ends == [["s-in"], ["s-out"]]


def test_a_flow_both_ways_has_both_ports_as_source_and_as_target():
    _, _, ends = apply_flow(f"{FLOW}{{item: MiniPallet, both-ways: true}}\n")
    assert ends == [["s-out", "w-in"], ["s-out", "w-in"]]


def test_a_flow_between_parts_with_the_same_port_has_the_parts_as_ends():
    twins = PLANT.replace("-> role w-in", "-> role s-out")
    text = f"{FLOW}{{item: MiniPallet, to: sw}}\n"
    assert apply_flow(text, model=twins + MODEL)[2] == [["st"], ["sw"]]


def test_flows_give_directions_to_ports_and_domains_to_connectors():
    graph, sink = apply_overlays(f"{FLOW}{{item: MiniPallet, to: sw}}\n", until="flows")
    assert graph["s-out"].attrs["direction"] == "out"
    assert graph["l1"].attrs["domain"] == "physical"
    assert list_codes(sink) == ["SM300"]


def test_an_overlay_may_give_a_port_its_direction_and_type():
    text = "overlay: 1\nports:\n  s-in: {direction: in, type: Plant/Track}\n"
    graph, _ = apply_overlays(text, until="ports")
    assert graph["s-in"].attrs["direction"] == "in"
    assert graph.targets(graph["s-in"], Edge.TYPED_BY) == [graph["track"]]


def test_a_flow_against_the_direction_of_a_port_is_reported_at_the_overlay():
    text = f"{FLOW}{{item: MiniPallet, from: sw}}\n"
    _, sink = apply_overlays(text, until="flows")
    diagnostic = next(d for d in sink if d.rule.code == "SM310")
    assert diagnostic.message == (
        "item flow 'Plant::Switch::p_swIn - Plant::Stopper::p_sOut' leaves port "
        "'Plant::Switch::p_swIn', whose direction is in"
    )
    assert diagnostic.subject.place.file == "0.overlay.yaml"
    assert text[diagnostic.subject.place.ordinal :].startswith("MiniPallet, from: sw")


def test_mixed_domains_on_one_connector_are_reported():
    items = ITEMS + "  Tag2: {domain: information}\n" + FLOW.removeprefix(ITEMS)
    text = items + "{item: MiniPallet, to: sw}\n    - {item: Tag2, to: sw}\n"
    _, sink = apply_overlays(text, until="flows")
    (diagnostic,) = (d for d in sink if d.rule.code == "SM317")
    assert diagnostic.subject.place.file == "0.overlay.yaml"
    assert text[diagnostic.subject.place.ordinal :].startswith("MiniPallet, to: sw")


def test_different_items_may_flow_through_ports_of_one_interface_block():
    items = ITEMS + "  Tag2: {domain: information}\n" + FLOW.removeprefix(ITEMS)
    text = (
        items
        + "{item: MiniPallet, to: sw}\n  Plant/Gate/loop:\n    flows: [{item: Tag2, to: p_sIn}]\n"
    )
    assert {"SM311", "SM316", "SM317"}.isdisjoint(
        list_codes(apply_overlays(text, until="flows")[1])
    )


# -- several overlays --------------------------------------------------------------------------


def test_an_item_that_two_overlays_name_is_added_once():
    graph, sink = apply_overlays(f"{FLOW}{{item: MiniPallet, to: sw}}\n", ITEMS)
    assert list_codes(sink) == []
    assert [element.name for element in graph].count("MiniPallet") == 1


def test_overlays_that_contradict_each_other_are_reported():
    _, sink = apply_overlays(ITEMS, ITEMS.replace("physical", "information"))
    assert list_diagnostics(sink) == [
        "SM339 warning: the overlay gives 'MiniPallet' the domain information, the model physical"
    ]


def test_an_element_from_an_overlay_has_an_origin_and_the_location_in_the_overlay():
    graph, flow, _ = apply_flow(f"{FLOW}{{item: MiniPallet, to: sw}}\n")
    text = print_element(graph, flow)
    assert 'origin="l1"' in text
    assert "@0.overlay.yaml:" in text
