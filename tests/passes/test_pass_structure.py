"""Passes ``inherit``, ``ports``, ``flows`` and ``behaviours``: cases beside the golden models."""

import sys

import pytest
from pass_runs import list_codes, list_diagnostics, run_until

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import component_name
from sysmlc.passes import pipeline

# -- inherit -----------------------------------------------------------------------------------


def names(graph, id):
    return [one.name for one in graph.targets(graph[id], Edge.FEATURE)]


def test_circle_with_a_general_outside_still_inherits_from_there():
    graph, sink = run_until(
        """\
Class base "Base"
  Property base.id "id"
Class a "A"
  -> specializes b base
Class b "B"
  -> specializes a
  Property b.x "x"
""",
        "inherit",
    )
    assert (names(graph, "a"), names(graph, "b")) == (["id"], ["x"])
    assert list_diagnostics(sink) == ["SM200 error: 'A' specialises itself: 'A', 'B', 'A'"]


def test_classifier_that_specialises_itself_is_a_circle():
    _, sink = run_until('Class a "A"\n  -> specializes a\n', "inherit")
    assert list_codes(sink) == ["SM200"]


def test_redefinition_of_a_stranger_hides_nothing():
    graph, sink = run_until(
        """\
Class a "A"
  Property a.x "x"
Class b "B"
  -> specializes c
  Property b.y "y"
    -> redefines a.x
Class c "C"
  -> specializes a
    Property c.z "z"
Class d "D"
  -> specializes a
  Property d.y "y"
    -> redefines b.y
""",
        "inherit",
    )
    assert names(graph, "b") == ["y", "z"]
    assert names(graph, "d") == ["y", "x"]
    assert list_codes(sink) == ["SM202"]


def test_type_from_outside_the_unit_may_be_narrower():
    _, sink = run_until(
        """\
Class out "Out" external=true href="lib.uml#out"
Class in "In"
Class a "A"
  Property a.x "x"
    -> typed-by in
Class b "B"
  -> specializes a
  Property b.x "x"
    -> typed-by out
    -> redefines a.x
""",
        "inherit",
    )
    assert list_codes(sink) == []


def test_ends_that_an_association_owns_are_not_its_features():
    graph, _ = run_until(
        """\
Association a "A"
  -> end e
  Property e "e"
  Property p "p"
""",
        "inherit",
    )
    assert names(graph, "a") == ["p"]


def chain(number):
    """Classes that each specialise the one before; the first has a feature."""
    graph = Graph()
    for one in range(number):
        graph.add(Element(f"c{one}", Kind.CLASS, f"C{one}"))
        if one:
            graph.connect(Edge.SPECIALIZES, f"c{one}", f"c{one - 1}")
    graph.add(Element("x", Kind.PROPERTY, "x", "c0"))
    return graph


def calls_of(run):
    """How many functions the run calls."""
    calls = 0

    def count(frame, event, arg):
        nonlocal calls
        calls += event in ("call", "c_call")

    sys.setprofile(count)
    try:
        run()
    finally:
        sys.setprofile(None)
    return calls


def test_long_chain_of_classes_is_no_burden():
    inherit = pipeline.load("inherit")
    short, long = chain(250), chain(1000)
    calls = [calls_of(lambda g=graph: inherit.run(g, Sink())) for graph in (short, long)]
    assert names(long, "c999") == ["x"]
    assert calls[1] < 5 * calls[0]


# -- ports -------------------------------------------------------------------------------------

TRACK = """\
Class track "Track" role="interface block"
  Property track.p "p" role="flow property" direction="{direction}"
Class gate "Gate"
  Port port "port" {more}
    -> typed-by track
"""


@pytest.mark.parametrize(
    ("flowing", "more", "expected"),
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
def test_direction_from_flow_properties(flowing, more, expected):
    graph, _ = run_until(TRACK.format(direction=flowing, more=more), "ports")
    assert graph["port"].attrs["direction"] == expected


@pytest.mark.parametrize(
    ("parameters", "more", "expected"),
    [
        (["in"], "", "in"),
        (["return"], "", "out"),
        (["in", "return"], "", "inout"),
        (["in"], 'featureDirection="required"', "out"),
        ([], "", None),
    ],
)
def test_direction_from_parameters(parameters, more, expected):
    text = 'Interface i "I"\n  Operation op "op"\n'
    for number, direction in enumerate(parameters):
        text += f'    Parameter p{number} "p" direction="{direction}"\n'
    text += (
        f'    Application a stereotype="DirectedFeature" tag.{more or "x=1"}\n      -> subject op\n'
    )
    text += 'Class gate "Gate"\n  Port port "port"\n    -> typed-by i\n'
    graph, sink = run_until(text, "ports")
    assert graph["port"].attrs.get("direction") == expected
    assert ("SM300" in list_codes(sink)) is (expected is None)


def test_inherited_flow_properties_count():
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


@pytest.mark.parametrize(("own", "expected"), [("", "out"), ("in", "in")])
def test_conjugated_interface_block_turns_its_original_round_unless_it_says_more(own, expected):
    text = TRACK.format(direction="in", more="").replace("-> typed-by track", "-> typed-by back")
    text += 'Class back "~Track"\n'
    text += f'  FlowProperty back.p "p" direction="{own}"\n' if own else ""
    text += '  Application a stereotype="ConjugatedInterfaceBlock" tag.original="track"\n'
    graph, _ = run_until(text + "    -> subject back\n", "ports")
    assert graph["port"].attrs["direction"] == expected


def test_undirected_ports_are_counted_for_each_block():
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


# -- flows -------------------------------------------------------------------------------------

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


def connector(id: str, *ends: str) -> str:
    text = f'  Connector {id} "{id}"\n    -> end {id}.0 {id}.1\n'
    for number, end in enumerate(ends):
        part, _, role = end.rpartition(".")
        text += f"    ConnectorEnd {id}.{number}\n      -> role {role}\n"
        text += f"      -> path {part}\n" if part else ""
    return text


def flow(source: str, target: str) -> str:
    ends = f"  -> flow-source {source}\n  -> flow-target {target}\n"
    return f'ItemFlow f "f"\n{ends}  -> conveys pallet\n'


@pytest.mark.parametrize(
    ("ends", "found"),
    [
        (("a.out", "b.in"), []),
        (("a.in", "b.in"), ["SM315"]),
        (("feed", "a.in"), []),
        (("feed", "a.out"), ["SM315"]),
    ],
)
def test_directions_of_assembly_and_delegation_connectors(ends, found):
    assert list_codes(run_until(LINE + connector("c", *ends), "flows")[1]) == found


@pytest.mark.parametrize(("ends", "found"), [(("feed", "in"), []), (("in", "feed"), ["SM310"] * 2)])
def test_what_enters_a_block_goes_on_to_its_part(ends, found):
    text = LINE + connector("c", "feed", "a.in") + flow(*ends)
    assert list_codes(run_until(text, "flows")[1]) == found


def test_item_flow_that_two_connectors_could_realise_is_left_alone():
    text = LINE + connector("c", "a.out", "b.in") + connector("d", "b.out", "a.in")
    graph, _ = run_until(text + flow("out", "in"), "flows")
    assert graph.targets(graph["f"], Edge.REALIZING) == []
    one, _ = run_until(LINE + connector("c", "a.out", "b.in") + flow("out", "in"), "flows")
    assert [found.id for found in one.targets(one["f"], Edge.REALIZING)] == ["c"]


def test_domain_may_be_a_tagged_value_of_a_general_classifier():
    text = LINE + connector("c", "a.out", "b.in") + flow("out", "in")
    text += 'Class solid "Solid"\n  Application t stereotype="Stuff" tag.domain="physical"\n'
    text += "    -> subject solid\n"
    text = text.replace(
        'Class pallet "Pallet"\n', 'Class pallet "Pallet"\n  -> specializes solid\n'
    )
    graph, _ = run_until(text, "flows")
    assert [graph[id].attrs["domain"] for id in ("f", "c")] == ["physical"] * 2


# -- behaviours --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("pins", "found"),
    [
        ([("in", "argument"), ("out", "result")], []),
        ([("in", "argument"), ("out", "result"), ("in", "target")], []),
        ([("in", "target"), ("out", "result")], ["SM401"]),
        ([], ["SM401", "SM401"]),
    ],
)
def test_pins_of_a_call_against_parameters(pins, found):
    text = """\
Class gate "Gate"
  Operation op "turn"
    Parameter p "angle" direction="in"
    Parameter q "done" direction="return"
Activity act "Act"
  Action call "call" subkind="call-operation"
    -> calls op
"""
    for number, (direction, subkind) in enumerate(pins):
        text += f'    Pin pin{number} direction="{direction}" subkind="{subkind}"\n'
    assert list_codes(run_until(text, "behaviours")[1]) == found


def test_call_that_leaves_the_unit_is_not_judged():
    text = """\
Activity act "Act"
  Action call "call" subkind="call-behavior"
    ?> calls lib.uml#run Activity "Run"
  Action lost "lost" subkind="call-operation"
    ?> calls gone Operation
"""
    assert list_codes(run_until(text, "behaviours")[1]) == ["SM150", "SM152"]


def test_components_have_the_names_of_the_design():
    graph, _ = run_until(
        """\
Package line "Line"
  Class gate "Gate"
    -> classifier-behavior sm
    -> satisfies req
    StateMachine sm "states"
    Activity pull "pull in"
  Activity alone "Alone"
  Class req "No jam" role="requirement"
  Class other "Other" role="requirement"
  Class quick "Quick" role="requirement"
    -> subject pull
""",
        "behaviours",
    )
    expected = {
        "sm": "Line::Gate",
        "pull": "Line::Gate.pull in",
        "alone": "Line::Alone",
        "req": "Line::Gate",
        "other": "Line::Other",
        "quick": "Line::Gate.pull in",
    }
    assert {id: component_name(graph, graph[id]) for id in expected} == expected


def plants(port):
    ports = "".join(port.format(n=n, file=file) for n, file in enumerate("a" * 10 + "b"))
    documents = "".join(f'Document {f} "{f}" subkind="caex" @{f}.aml:0\n' for f in "ab")
    directed = 'Class d "D" @a.aml:98\n  Port d.p "p" direction="in" @a.aml:99\n    -> typed-by c\n'
    _, sink = run_until(f'{documents}Class c "C" @a.aml:97\n{ports}{directed}', "ports")
    return [f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in sink], [
        one.subject.id for one in sink
    ]


LISTED = ", ".join(f"'C::p{n}'" for n in range(8))


def test_ports_of_plants_without_types_are_gathered_file_by_file():
    assert plants('  Port p{n} "p{n}" direction="in" @{file}.aml:{n}\n') == (
        [
            f"SM122: 10 of 11 ports of 'a.aml' have no type: {LISTED} and 2 more",
            "SM122: 1 of 1 ports of 'b.aml' have no type: 'C::p10'",
        ],
        ["p0", "p10"],
    )


def test_ports_of_plants_without_direction_are_told_where_others_have_one():
    port = '  Port p{n} "p{n}" @{file}.aml:{n}\n    -> typed-by c\n'
    assert plants(port) == (
        [f"SM121: 10 of 11 ports of 'a.aml' have no direction: {LISTED} and 2 more"],
        ["p0"],
    )
