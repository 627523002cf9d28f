"""The pass ``flows``: connectors and item flows between ports."""

import pytest
from pass_runs import list_codes, run_until

from sysmlc.driver import Request, compile_model
from sysmlc.ir import Edge

LINE = """\
Class pallet "Pallet"
Class gate "Gate"
  Port in "in" direction="in"
    -> typed-by pallet
  Port out "out" direction="out"
    -> typed-by pallet
Class line "Line"
  Property a "a" aggregation="composite"
    -> typed-by gate
  Property b "b" aggregation="composite"
    -> typed-by gate
  Port feed "feed" direction="in"
    -> typed-by pallet
"""


def print_connector(id: str, *ends: str) -> str:
    text = f'  Connector {id} "{id}"\n    -> end {id}.0 {id}.1\n'
    for number, end in enumerate(ends):
        part, _, role = end.rpartition(".")
        text += f"    ConnectorEnd {id}.{number}\n      -> role {role}\n"
        text += f"      -> path {part}\n" if part else ""
    return text


def print_item_flow(source: str, target: str) -> str:
    ends = f"  -> flow-source {source}\n  -> flow-target {target}\n"
    return f'ItemFlow f "f"\n{ends}  -> conveys pallet\n'


@pytest.mark.parametrize(
    ("ends", "codes"),
    [
        (("a.out", "b.in"), []),
        (("a.in", "b.in"), ["SM315"]),
        (("feed", "a.in"), []),
        (("feed", "a.out"), ["SM315"]),
    ],
)
def test_connectors_whose_ends_have_wrong_directions_are_reported(ends, codes):
    assert list_codes(run_until(LINE + print_connector("c", *ends), "flows")[1]) == codes


def test_a_connector_to_a_port_of_another_block_has_no_side():
    text = LINE + print_connector("c", "a.out", "in")
    assert list_codes(run_until(text, "flows")[1]) == []


@pytest.mark.parametrize(("ends", "codes"), [(("feed", "in"), []), (("in", "feed"), ["SM310"] * 2)])
def test_an_item_flow_from_a_part_to_an_input_of_its_block_is_reported(ends, codes):
    text = LINE + print_connector("c", "feed", "a.in") + print_item_flow(*ends)
    assert list_codes(run_until(text, "flows")[1]) == codes


def test_a_flow_through_the_border_of_a_block_is_described_from_the_block():
    text = LINE + print_connector("c", "feed", "a.in") + print_item_flow("in", "feed")
    messages = [diagnostic.message for diagnostic in run_until(text, "flows")[1]]
    assert "leaves its block through port 'Line::feed', whose direction is in" in messages[1]


def test_a_flow_against_a_port_and_its_connector_are_one_finding():
    text = LINE + print_connector("c", "a.in", "b.in")
    assert list_codes(run_until(text, "flows")[1]) == ["SM315"]
    assert list_codes(run_until(text + print_item_flow("in", "in"), "flows")[1]) == ["SM310"]


def test_an_item_flow_is_realised_by_a_connector_unless_there_are_two_candidates():
    text = LINE + print_connector("c", "a.out", "b.in") + print_connector("d", "b.out", "a.in")
    graph, _ = run_until(text + print_item_flow("out", "in"), "flows")
    assert graph.targets(graph["f"], Edge.REALIZING) == []
    text = LINE + print_connector("c", "a.out", "b.in")
    graph, _ = run_until(text + print_item_flow("out", "in"), "flows")
    assert graph.targets(graph["f"], Edge.REALIZING) == [graph["c"]]


def test_a_tag_of_a_general_classifier_may_give_the_domain():
    text = LINE + print_connector("c", "a.out", "b.in") + print_item_flow("out", "in")
    text += 'Class solid "Solid"\n  Application t stereotype="Stuff" tag.domain="physical"\n'
    text += "    -> subject solid\n"
    text = text.replace(
        'Class pallet "Pallet"\n', 'Class pallet "Pallet"\n  -> specializes solid\n'
    )
    graph, _ = run_until(text, "flows")
    assert [graph[id].attrs["domain"] for id in ("f", "c")] == ["physical"] * 2


COUPLING = """\
Class valve "Valve"
Class gate "Gate"
  -> specializes valve
Class motor "Motor"
Association coupling "Coupling"
  -> end coupling.v coupling.m
  Property coupling.v "valve"
    -> typed-by valve
  Property coupling.m "motor"
    -> typed-by motor
Class line "Line"
  Property v "v"
    -> typed-by valve
  Property g "g"
    -> typed-by gate
  Property m "m"
    -> typed-by motor
  Property untyped "untyped"
  Connector c "c"
    -> typed-by coupling
    -> end c.0 c.1
    ConnectorEnd c.0
      -> role {}
    ConnectorEnd c.1
      -> role {}
"""


@pytest.mark.parametrize("ends", [("v", "m"), ("m", "v"), ("g", "m"), ("untyped", "v")])
def test_a_connector_joins_what_its_association_joins(ends):
    assert list_codes(run_until(COUPLING.format(*ends), "flows")[1]) == []


@pytest.mark.parametrize("ends", [("v", "v"), ("g", "v"), ("m", "m")])
def test_a_connector_of_unrelated_types_is_reported(ends):
    _, sink = run_until(COUPLING.format(*ends), "flows")
    assert [str(finding.message) for finding in sink] == [
        f"connector 'Line::c' joins 'Line::{ends[0]}' with 'Line::{ends[1]}', but its association "
        "'Coupling' joins 'Valve' with 'Motor'"
    ]


PROPERTIES = """\
Class water "Water"
Class hot "Hot"
  -> specializes water
Class pallet "Pallet"
Class tank "Tank"
  Property out "out" direction="out" role="flow property"
    -> typed-by water
Class press "Press"
  Property in "in" direction="in" role="flow property"
    -> typed-by hot
ItemFlow f "f"
  -> flow-source out
  -> flow-target in
  -> conveys {}
"""


def test_an_item_flow_conveys_what_the_flow_properties_at_its_ends_pass():
    for item in ("water", "hot"):
        assert list_codes(run_until(PROPERTIES.format(item), "flows")[1]) == []
    _, sink = run_until(PROPERTIES.format("pallet"), "flows")
    assert [finding.message for finding in sink] == [
        "item flow 'f' conveys 'Pallet', but its end 'Tank::out' has the type 'Water'",
        "item flow 'f' conveys 'Pallet', but its end 'Press::in' has the type 'Hot'",
    ]


BUSES = """package P {{
    item def Command; item def Status; item def FastCommand :> Command;
    port def Bus {{ in item command : Command; out item status : Status; }}
    port def Peer {{ in item received : Command; out item sent : FastCommand; }}
    port def Served :> Bus {{ port extra; }}
    port def Outer {{ port bus : Bus; }}
    part def S {{
        part a {{ port p : {0}; }}
        part b {{ port p : {1}; }}
        {2}
    }}
}}"""


@pytest.mark.parametrize(
    ("first", "second", "connection", "codes"),
    [
        pytest.param("Bus", "Bus", "connect a.p to b.p;", ["SM347"], id="inputs meet inputs"),
        pytest.param("~Bus", "~Bus", "connect a.p to b.p;", ["SM347"], id="both conjugated"),
        pytest.param("Bus", "Bus", "interface a.p to b.p;", ["SM347"], id="interface"),
        pytest.param("Bus", "~Bus", "connect a.p to b.p;", [], id="one conjugated"),
        pytest.param("Peer", "Peer", "connect a.p to b.p;", [], id="each sends to the other"),
        pytest.param("Served", "Served", "connect a.p to b.p;", [], id="nested ports"),
        pytest.param("Outer", "Outer", "connect a.p.bus to b.p.bus;", ["SM347"], id="nested"),
        pytest.param("~Outer", "Outer", "connect a.p.bus to b.p.bus;", [], id="outer conjugated"),
        pytest.param("Bus", "Bus", "port q : Bus; connect q to a.p;", [], id="delegation"),
    ],
)
def test_a_connector_needs_an_output_that_an_input_can_take(
    tmp_path, first, second, connection, codes
):
    path = tmp_path / "bus.sysml"
    path.write_text(BUSES.format(first, second, connection))
    reported = {diagnostic.rule.code for diagnostic in compile_model(Request((path,))).diagnostics}
    assert sorted(reported & {"SM315", "SM316", "SM347"}) == codes
