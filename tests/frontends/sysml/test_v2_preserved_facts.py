"""Facts that SysML v2 cannot express are written as metadata and read back."""

from test_v2_roundtrip import read_back

from sysmlc.backends.sysml import print_document
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Kind
from sysmlc.ir.compare import compare
from sysmlc.ir.text import parse_text
from sysmlc.passes import pipeline


def graph_of(text):
    graph = parse_text(text)
    pipeline.build_pipeline(("resolve", "inherit", "classify", "ports", "flows")).run(graph, Sink())
    return graph


def lines_of(graph):
    return [line.strip() for line in print_document(graph, Sink())[0].splitlines()]


def read_back_and_compare(text):
    """The model that is read of the text of a model, and the differences."""
    graph = graph_of(text)
    again, _ = read_back(graph)
    return again, [
        f"{difference.name} {difference.aspect}" for difference in compare(graph, again, ("id",))
    ]


KEPT = """
Package p "Plant" subkind="model"
  Class gate "Gate" role="block" active=true size="7" note="a=b" odd=["x", 1]
    Port gate.p "p" role="port" aggregation="composite" value.id=3
    Operation gate.go "go" concurrency="guarded"
      Parameter gate.go.r "ok" direction="return"
  Stereotype mark "Mark"
    -> extends metaclass
Class metaclass "Class" external=true qualified_name="UML::Class"
"""


def test_attributes_of_every_sort_come_back():
    graph, differences = read_back_and_compare(KEPT)
    assert differences == []
    (gate,) = [element for element in graph if element.name == "Gate"]
    assert (gate.attrs["size"], gate.attrs["odd"], gate.attrs["active"]) == ("7", ("x", 1), True)
    (result,) = list(graph.of_kind(Kind.PARAMETER))
    assert result.attrs["direction"] == "return"


def test_edges_to_what_is_outside_come_back():
    assert '@Kept { attributes = ("extends=>UML::Class"); }' in " ".join(lines_of(graph_of(KEPT)))
    graph, _ = read_back_and_compare(KEPT)
    (mark,) = list(graph.of_kind(Kind.STEREOTYPE))
    assert [target.name for target in graph.targets(mark, Edge.EXTENDS)] == ["Class"]


NAMELESS = """
Package p "Plant"
  Class a "A" role="block"
    Property a.1 "" role="part" aggregation="composite"
      -> typed-by b
  Class b "B" role="block"
"""


def test_what_has_no_name_has_none_again():
    assert "part part1 : B { @Named; }" in lines_of(graph_of(NAMELESS))
    assert read_back_and_compare(NAMELESS)[1] == []


HIDING = """
Package p "Plant"
  Class a "A" role="block"
    Property a.x "x" role="value"
  Class b "B" role="block"
    -> specializes a
    Property b.x "x" role="value"
  Class c "C" role="block"
    -> specializes a
    Property c.x "x" role="value"
      -> redefines a.x
"""


def test_a_member_that_would_hide_an_inherited_one_has_another_name_in_the_text():
    lines = lines_of(graph_of(HIDING))
    assert 'attribute x_2 { @Named { name = "x"; } }' in lines
    assert "attribute :>> x;" in lines
    assert read_back_and_compare(HIDING)[1] == []


FLOW = """
Package p "Plant"
  Class pallet "Pallet" role="block"
  Class line "Line" role="block"
    Property line.a "a" role="part" aggregation="composite"
      -> typed-by pallet
    Property line.b "b" role="part" aggregation="composite"
      -> typed-by pallet
    Connector line.c ""
      -> end c.1 c.2
      ConnectorEnd c.1 ""
        -> role line.a
      ConnectorEnd c.2 ""
        -> role line.b
    ItemFlow line.f "f" role="item flow"
      -> conveys pallet
      -> flow-source line.a
      -> flow-target line.b
      -> realizing line.c
"""


def test_a_flow_between_parts_is_a_message():
    assert "message f of Pallet from a to b;" in lines_of(graph_of(FLOW))
    assert read_back_and_compare(FLOW)[1] == []
