"""The pass ``ports``: directions by type, flow ports of SysML 1.1, conjugation, nested ports."""

import pytest
from pass_runs import list_codes, list_diagnostics, run_until

from sysmlc.ir.query import end_direction, flow_directions, is_boundary

SYSML = "http://www.omg.org/spec/SysML/20120401/SysML"


def print_application(stereotype: str, id: str, tags: str = "", indent: int = 4) -> str:
    space = " " * indent
    return (
        f'{space}Application {id}.a stereotype="{stereotype}" namespace="{SYSML}" {tags}\n'
        f"{space}  -> subject {id}\n"
    )


# -- directions by type -----------------------------------------------------------------------

TRACK = """\
Class track "Track" role="interface block"
  Property track.p "p" role="flow property" direction="{direction}"
Class gate "Gate"
  Port port "port" {attributes}
    -> typed-by track
"""


@pytest.mark.parametrize(
    ("direction", "attributes", "expected"),
    [
        ("in", "", "in"),
        ("out", "", "out"),
        ("inout", "", "inout"),
        ("in", "conjugated=true", "out"),
        ("out", "conjugated=true", "in"),
        ("inout", "conjugated=true", "inout"),
        ("in", 'direction="out"', "out"),
        ("in", 'role="flow port"', "in"),
    ],
)
def test_a_port_has_the_direction_of_the_flow_properties_of_its_type(
    direction, attributes, expected
):
    graph, _ = run_until(TRACK.format(direction=direction, attributes=attributes), "ports")
    assert graph["port"].attrs["direction"] == expected


@pytest.mark.parametrize(
    ("parameters", "tag", "expected"),
    [
        (["in"], "", "in"),
        (["return"], "", "out"),
        (["in", "return"], "", "inout"),
        (["in"], 'featureDirection="required"', "out"),
        ([], "", None),
    ],
)
def test_a_port_has_the_direction_of_the_parameters_of_its_type(parameters, tag, expected):
    text = 'Interface i "I"\n  Operation op "op"\n'
    for number, direction in enumerate(parameters):
        text += f'    Parameter p{number} "p" direction="{direction}"\n'
    text += (
        f'    Application a stereotype="DirectedFeature" tag.{tag or "x=1"}\n      -> subject op\n'
    )
    text += 'Class gate "Gate"\n  Port port "port"\n    -> typed-by i\n'
    graph, sink = run_until(text, "ports")
    assert graph["port"].attrs.get("direction") == expected
    assert ("SM300" in list_codes(sink)) is (expected is None)


def test_inherited_flow_properties_give_a_port_its_direction():
    graph, _ = run_until(
        """\
Class base "Base"
  FlowProperty base.p "p" direction="out"
Class track "Track"
  -> specializes base
Class gate "Gate"
  Port port "port"
    -> typed-by track
""",
        "ports",
    )
    assert graph["port"].attrs["direction"] == "out"


@pytest.mark.parametrize(("direction", "expected"), [("", "out"), ("in", "in")])
def test_a_conjugated_interface_block_without_flow_properties_reverses_its_original(
    direction, expected
):
    text = TRACK.format(direction="in", attributes="")
    text = text.replace("-> typed-by track", "-> typed-by back") + 'Class back "~Track"\n'
    text += f'  FlowProperty back.p "p" direction="{direction}"\n' if direction else ""
    text += '  Application a stereotype="ConjugatedInterfaceBlock" tag.original="track"\n'
    graph, _ = run_until(text + "    -> subject back\n", "ports")
    assert graph["port"].attrs["direction"] == expected


def test_ports_without_a_direction_are_reported_once_for_each_block():
    text = "Class t\n" + "".join(
        f'Class {block} "{block}"\n'
        + "".join(f'  Port {block}{n} "p{n}"\n    -> typed-by t\n' for n in range(count))
        for block, count in (("A", 1), ("B", 10))
    )
    listed = ", ".join(f"'p{n}'" for n in range(8))
    assert list_diagnostics(run_until(text, "ports")[1]) == [
        "SM300 info: ports of 'A' without a direction (1): 'p0'",
        f"SM300 info: ports of 'B' without a direction (10): {listed} and 2 more",
    ]


@pytest.mark.parametrize(
    ("type_", "is_reported"),
    [
        ('Class t "T"\n', True),
        ('Class t "T"\n  -> specializes g\nClass g external=true href="lib.uml#g"\n', False),
        ('Class t external=true href="lib.uml#t"\n', False),
        ('Class t "T"\n  Port inner "inner" direction="in"\n    -> typed-by i\nClass i\n', False),
        ('DataType t "Real" subkind="primitive" external=true href="PrimitiveTypes#Real"\n', True),
    ],
)
def test_a_port_whose_type_is_in_a_missing_file_is_not_called_undirected(type_, is_reported):
    sink = run_until('Class b "B"\n  Port p "p"\n    -> typed-by t\n' + type_, "ports")[1]
    assert ("SM300" in [diagnostic.rule.code for diagnostic in sink]) is is_reported


@pytest.mark.parametrize("relation", ["redefines", "subsets"])
def test_an_undirected_port_is_reported_where_it_is_declared_first(relation):
    general = 'Class g "G"\n  Port p "p"\n    -> typed-by t\nClass t\n'
    special = (
        f'Class s "S"\n  -> specializes g\n  Port q "q"\n    -> typed-by t\n    -> {relation} p\n'
    )
    assert list_diagnostics(run_until(general + special, "ports")[1]) == [
        "SM300 info: ports of 'G' without a direction (1): 'p'"
    ]


# -- flow ports of SysML 1.1 -------------------------------------------------------------------


SPECIFICATION = (
    'Interface spec "Spec"\n'
    + print_application("FlowSpecification", "spec", indent=2)
    + '  Property spec.in "order"\n'
    + print_application("FlowProperty", "spec.in", 'tag.direction="in"')
    + 'DataType pallet "Pallet"\n'
)


@pytest.mark.parametrize(
    ("type_", "tags", "expected"),
    [
        ("pallet", 'tag.direction="out"', "out"),
        ("pallet", 'tag.direction="out" tag.isAtomic="true"', "out"),
        ("pallet", "", "inout"),
        ("pallet", 'tag.isConjugated="true" tag.direction="in"', "in"),
        ("spec", 'tag.isAtomic="false"', "in"),
        ("spec", 'tag.isConjugated="true"', "out"),
        ("spec", 'tag.IsConjugated="true"', "out"),
        ("spec", 'tag.isConjugated="false"', "in"),
    ],
)
def test_a_flow_port_has_the_direction_of_its_stereotype_or_its_specification(
    type_, tags, expected
):
    port = f'Class gate "Gate"\n  Port port "port"\n    -> typed-by {type_}\n'
    flow_port = print_application("FlowPort", "port", tags)
    graph, _ = run_until(SPECIFICATION + port + flow_port, "ports")
    assert graph["port"].role == "flow port"
    assert graph["port"].attrs["direction"] == expected


# -- stereotypes of vendors --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("namespace", "stereotype", "tags", "expected"),
    [
        ("http://www.eclipse.org/papyrus/GCM/1", "FlowPort", 'tag.direction="in"', "in"),
        ("http://Papyrus/RobotML/1", "DataFlowPort", 'tag.direction="out"', "out"),
        ("http://www.eclipse.org/papyrus/FMIProfile", "Port", 'tag.direction="out"', "out"),
        # The default of the tag is in the vendor's profile, which is not at hand.
        ("http://Papyrus/RobotML/1", "DataFlowPort", "", None),
        ("http://Papyrus/RobotML/1", "DataFlowPort", 'tag.direction="upwards"', None),
        ("http://plant/drawings", "Arrow", 'tag.direction="out"', None),
    ],
)
def test_a_stereotype_of_a_vendor_states_the_direction_of_a_port(
    namespace, stereotype, tags, expected
):
    text = (
        'Class t "T"\nClass gate "Gate"\n  Port port "port"\n    -> typed-by t\n'
        f'    Application a stereotype="{stereotype}" namespace="{namespace}" {tags}\n'
        "      -> subject port\n"
    )
    graph, sink = run_until(text, "ports")
    assert graph["port"].attrs.get("direction") == expected
    # Without a tag the profile may have a default value.
    assert ("SM300" in list_codes(sink)) is (expected is None and bool(tags))


# -- conjugation -------------------------------------------------------------------------------


TYPES = (
    'Class data "Data"\n'
    '  FlowProperty data.id "id" direction="in"\n'
    '  FlowProperty data.ok "ok" direction="out"\n'
    'Class door "Door"\n'
    '  Port door.data "data"\n    -> typed-by one\n'
    'Class one "One"\n  FlowProperty one.x "x" direction="in"\n'
)


@pytest.mark.parametrize("conjugated", [False, True])
def test_a_conjugated_port_reverses_each_flow_property(conjugated):
    attribute = " conjugated=true" * conjugated
    port = f'Class gate "Gate"\n  Port port "port"{attribute}\n    -> typed-by data\n'
    graph, _ = run_until(TYPES + port, "ports")
    directions = flow_directions(graph, graph["port"])
    assert {element.name: direction for element, direction in directions} == (
        {"id": "out", "ok": "in"} if conjugated else {"id": "in", "ok": "out"}
    )


@pytest.mark.parametrize(
    ("outer", "inner", "expected"),
    [
        ("", "", "in"),
        (" conjugated=true", "", "out"),
        ("", " conjugated=true", "out"),
        (" conjugated=true", " conjugated=true", "in"),
    ],
)
def test_a_conjugated_port_reverses_the_ports_nested_in_it(outer, inner, expected):
    model = TYPES.replace('"data"\n    -> typed-by one', f'"data"{inner}\n    -> typed-by one')
    model += (
        f'Class gate "Gate"\n  Port port "port"{outer}\n    -> typed-by door\n'
        '  Connector k "k"\n    -> end k.1\n    ConnectorEnd k.1\n'
        "      -> path port\n      -> role door.data\n"
    )
    graph, _ = run_until(model, "ports")
    assert end_direction(graph, graph["k.1"]) == expected
    assert is_boundary(graph, graph["k.1"])


def connect_nested_ports(outer: str) -> str:
    """Return two parts connected at nested ports; *outer* is an attribute of one outer port."""
    return TYPES + (
        'Class left "Left" role="block"\n  Port left.p "p"\n    -> typed-by door\n'
        f'Class right "Right" role="block"\n  Port right.p "p"{outer}\n    -> typed-by door\n'
        'Class line "Line" role="block"\n'
        '  Property l "l" aggregation="composite"\n    -> typed-by left\n'
        '  Property r "r" aggregation="composite"\n    -> typed-by right\n'
        '  Connector k "k"\n    -> end k.1 k.2\n'
        "    ConnectorEnd k.1\n      -> path l left.p\n      -> role door.data\n"
        "    ConnectorEnd k.2\n      -> path r right.p\n      -> role door.data\n"
    )


def test_nested_ports_of_opposite_direction_may_be_connected():
    assert "SM315" not in list_codes(
        run_until(connect_nested_ports(" conjugated=true"), "flows")[1]
    )
    assert "SM315" in list_codes(run_until(connect_nested_ports(""), "flows")[1])


def test_a_connector_end_in_a_part_is_not_at_the_boundary():
    graph, _ = run_until(connect_nested_ports(""), "flows")
    assert not is_boundary(graph, graph["k.1"])
    assert graph.targets(graph["k.1"], "path") == [graph["l"], graph["left.p"]]


# -- the type of a conjugated port ---------------------------------------------------------------


@pytest.mark.parametrize("name", ["~InterfaceBlock", "ConjugatedInterfaceBlock"])
def test_an_empty_conjugated_interface_block_has_the_directions_of_its_original(name):
    model = (
        'Class one "One"\n  FlowProperty one.x "x" direction="in"\n'
        'Class two "~One"\n'
        + print_application(name, "two", 'tag.original="one"', indent=2)
        + 'Class gate "Gate"\n  Port port "port"\n    -> typed-by two\n'
    )
    graph, _ = run_until(model, "ports")
    assert graph["port"].attrs["direction"] == "out"
    assert graph["two"].role == "interface block"


# -- ports of plants --------------------------------------------------------------------------


def run_on_plants(port, first_class='Class c "C"'):
    """Run the pass on a class with ports of two AutomationML files; return codes and subjects."""
    ports = "".join(port.format(n=n, file=file) for n, file in enumerate("a" * 10 + "b"))
    documents = "".join(f'Document {f} "{f}" subkind="caex" @{f}.aml:0\n' for f in "ab")
    directed = 'Class d "D" @a.aml:98\n  Port d.p "p" direction="in" @a.aml:99\n    -> typed-by c\n'
    _, sink = run_until(f"{documents}{first_class} @a.aml:97\n{ports}{directed}", "ports")
    messages = [f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in sink]
    return messages, [diagnostic.subject.id for diagnostic in sink]


FIRST_PORTS = ", ".join(f"'C::p{n}'" for n in range(8))


def test_ports_of_plants_without_a_type_are_reported_once_for_each_file():
    assert run_on_plants('  Port p{n} "p{n}" direction="in" @{file}.aml:{n}\n') == (
        [
            f"SM122: 10 of 11 ports of 'a.aml' without type: {FIRST_PORTS} and 2 more",
            "SM122: 1 of 1 port of 'b.aml' without type: 'C::p10'",
        ],
        ["p0", "p10"],
    )


def test_ports_of_plants_without_a_direction_are_reported_if_another_port_has_one():
    port = '  Port p{n} "p{n}" @{file}.aml:{n}\n    -> typed-by c\n'
    assert run_on_plants(port) == (
        [f"SM121: 10 of 11 ports of 'a.aml' without direction: {FIRST_PORTS} and 2 more"],
        ["p0"],
    )


def test_connectors_of_products_processes_and_resources_need_no_direction():
    connector = 'Class PPRConnector "PPRConnector" @a.aml:96\nClass c "C"'
    port = '  Port p{n} "p{n}" @{file}.aml:{n}\n    -> typed-by PPRConnector\n'
    assert run_on_plants(port, connector) == ([], [])
