"""Physical items and information have lines of their own; ports are on the side of their lines."""

import re

import pytest
from diagrams import draw, emit

from sysmlc.backends.plantuml.connections import Connection, Path, style_arrow
from sysmlc.backends.plantuml.layout import find_port_sides
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.passes import pipeline

CELL = """\
Package cell "Cell"
  Class pallet "Pallet" role="block" {pallet}
  Class tag "Tag" role="block" {tag}
  Class track "Track" role="interface block"
  Class stop "Stop" role="block"
    Port stop.out "out"
      -> typed-by track
    Port stop.tag "tag"
      -> typed-by track
  Class belt "Belt" role="block"
    Port belt.in "in"
      -> typed-by track
    Port belt.tag "tag"
      -> typed-by track
  Class line "Line" role="block"
    Property st "st" aggregation="composite" role="part"
      -> typed-by stop
    Property bt "bt" aggregation="composite" role="part"
      -> typed-by belt
    Connector l1 "l1"
      -> end l1.a l1.b
      ConnectorEnd l1.a
        -> role stop.out
        -> path st
      ConnectorEnd l1.b
        -> role belt.in
        -> path bt
    Connector l2 "l2"
      -> end l2.a l2.b
      ConnectorEnd l2.a
        -> role stop.tag
        -> path st
      ConnectorEnd l2.b
        -> role belt.tag
        -> path bt
  ItemFlow f1
    -> flow-source stop.out
    -> flow-target belt.in
    -> realizing l1
    -> conveys pallet
  ItemFlow f2
    -> flow-source {source}
    -> flow-target {target}
    -> realizing l2
    -> conveys tag
"""
PHYSICAL, INFORMATION = 'domain="physical"', 'domain="information"'


def draw_line(pallet=PHYSICAL, tag=INFORMATION, source="stop.tag", target="belt.tag"):
    """Return the internal block diagram of the line."""
    graph = parse_text(CELL.format(pallet=pallet, tag=tag, source=source, target=target))
    pipeline.run(graph, Sink(), until="flows")
    return find_line_diagram(graph)


def find_line_diagram(graph):
    (text,) = (text for path, text in draw(graph).items() if path.endswith("Line.ibd.puml"))
    return text


def list_arrows(text):
    """Return the arrow of each connector by the label of the connector."""
    matches = re.finditer(r"^\w+ (\S+) \w+ : (l\d)\\n", text, re.MULTILINE)
    return {match[2]: match[1] for match in matches}


def test_each_domain_has_its_line_and_its_colour():
    text = draw_line()
    assert list_arrows(text) == {"l1": "-[$physical_line]->", "l2": "-[$information_line]->"}
    assert r"l1\n<color:$physical>Pallet</color>" in text
    assert r"l2\n<color:$information>Tag</color>" in text


def test_colours_differ_for_the_colour_blind_and_line_styles_without_colour():
    text = draw_line()
    assert '!$physical = "#0072B2"' in text
    assert '!$information = "#D55E00"' in text
    assert '!$information_line = $information + ",dashed,thickness=2"' in text
    assert '!$physical_line = $physical + ",thickness=2"' in text


@pytest.mark.parametrize(
    ("pallet", "tag", "listed"),
    [
        (PHYSICAL, INFORMATION, ["physical", "information"]),
        (INFORMATION, PHYSICAL, ["physical", "information"]),
        (PHYSICAL, "", ["physical"]),
        ("", INFORMATION, ["information"]),
    ],
)
def test_the_legend_lists_the_domains_in_the_diagram(pallet, tag, listed):
    legend = draw_line(pallet, tag).partition("legend bottom right\n")[2].partition("endlegend")[0]
    assert re.findall(r"<color:\$(\w+)>", legend) == listed


def test_a_diagram_without_domains_has_no_colours_and_no_legend():
    text = draw_line("", "")
    assert "legend bottom" not in text
    assert "$" not in text
    assert list_arrows(text) == {"l1": "-->", "l2": "-->"}


def test_a_flow_to_the_first_end_has_its_arrow_head_there():
    assert (
        list_arrows(draw_line(source="belt.tag", target="stop.tag"))["l2"]
        == "<-[$information_line]-"
    )


def test_a_flow_in_both_directions_has_two_arrow_heads_and_one_label():
    text = draw_line(source="stop.tag belt.tag", target="belt.tag stop.tag")
    assert list_arrows(text)["l2"] == "<-[$information_line]->"
    assert text.count(">Tag<") == 1


def test_two_domains_over_one_connector_keep_their_colours_and_the_line_has_none():
    graph = parse_text(
        CELL.format(pallet=PHYSICAL, tag=INFORMATION, source="stop.out", target="belt.in").replace(
            "-> realizing l2", "-> realizing l1"
        )
    )
    pipeline.run(graph, Sink(), until="flows")
    text = find_line_diagram(graph)
    assert list_arrows(text)["l1"] == "-->"
    assert r"l1\n<color:$physical>Pallet</color>\n<color:$information>Tag</color>" in text


@pytest.mark.parametrize(
    ("arrow", "domain", "expected"),
    [
        ("--", "physical", "-[$physical_line]-"),
        ("..>", "information", ".[$information_line].>"),
        ("-[dashed]-", "physical", "-[dashed]-"),
        ("-->", "", "-->"),
        ("-->", "digital", "-->"),
    ],
)
def test_arrows_are_styled_by_domain(arrow, domain, expected):
    assert style_arrow(arrow, domain) == expected


HALL = """\
Package hall "Hall" subkind="instance-hierarchy"
  Class press "Press" role="block"
    Port press.out "out"
  Class rack "Rack" role="block"
    Port rack.in "in"
    Property rack.size "size" role="value"
  Instance p1 "p1"
    -> instance-of press
  Instance r1 "r1"
    -> instance-of rack
    Slot r1.size "size" value=4
      -> instance-of rack.size
  Connector across "across"
    -> end across.a across.b
    ConnectorEnd across.a
      -> role press.out
      -> path p1
    ConnectorEnd across.b
      -> role rack.in
      -> path r1
"""


def test_links_between_the_instances_of_a_hierarchy_are_drawn_in_its_diagram():
    files, diagnostics = emit(parse_text(HALL))
    (text,) = (file.text for file in files if file.path == "diagrams/Hall.ibd.puml")
    assert 'rectangle "**p1 : Press**" as p1_1 <<part>> {\nportout ' in text
    assert r'rectangle "**r1 : Rack**\n<size:10>size = 4</size>" as r1_1 <<part>> {' in text
    assert "out_1 -- in_1 : across\n" in text
    assert not any("Connector" in diagnostic.message for diagnostic in diagnostics)


# -- sides -------------------------------------------------------------------------------------


def link(first, second, arrow="--"):
    """Return a connection between two ports, each with the path to it."""
    paths = [end.split(".") for end in (first, second)]
    return Connection(*(Path(tuple(path[:-1]), (), path[-1]) for path in paths), arrow)


@pytest.mark.parametrize(
    ("links", "right"),
    [
        ([link("a.p", "b.q")], {"a.p"}),
        ([link("a.p", "b.q", "<--")], {"b.q"}),
        ([link("in", "a.p"), link("a.q", "out")], {"a.q", "out"}),
        (
            [link("in", "a.i", "-->"), link("a.o", "b.i", "-->"), link("b.x", "x")],
            {"a.o", "b.x", "x"},
        ),
        ([link("a.p", "b.q"), link("b.r", "a.s")], {"a.p", "b.r"}),
        ([link("a.p", "a.q")], {"a.p"}),
    ],
)
def test_ports_are_on_the_side_to_which_their_lines_lead(links, right):
    sides = find_port_sides(links)
    assert {".".join(path) for path, side in sides.items() if side == "portout"} == right


def test_ports_of_nested_parts_are_not_moved():
    assert find_port_sides([link("a.b.p", "c.q")]) == {}


@pytest.mark.plantuml
def test_plantuml_renders_the_diagram(plantuml):
    assert len(plantuml.render({"line": draw_line()})) == 1
