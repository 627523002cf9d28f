"""IR text: its form, and that parsing the printed text gives the same graph."""

import pytest
from hypothesis import given
from random_graphs import graphs

from sysmlc.ir import IrSyntaxError, parse_text, print_text

PLANT = """\
Package pkg "Plant"
  Class gate "Gate" abstract=true @plant.uml:3
    -> specializes device
    ?> typed-by "x.uml#a b" DataType "foo"
    Port gate.in "in" direction="in" multiplicity="0..1" "odd key"=true tags=["a", 1]
      -> typed-by pallet
  Class device "Device" @"my file.uml":7
  Class pallet
"""


def test_printing_a_parsed_text_gives_the_same_text():
    assert print_text(parse_text(PLANT)) == PLANT


def test_comments_and_blank_lines_are_skipped():
    assert len(parse_text("// a plant\n\nPackage p\n")) == 1


@given(graphs())
def test_parsing_a_printed_graph_gives_the_same_graph(graph):
    text = print_text(graph)
    reparsed = parse_text(text)
    assert print_text(reparsed) == text
    for element in graph:
        twin = reparsed[element.id]
        assert (twin.kind, twin.name, twin.owner) == (element.kind, element.name, element.owner)
        assert twin.attrs == element.attrs


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Block b", "line 1: no Kind 'Block'"),
        ("Class a\n\nClass a", "line 3: id 'a' is empty or taken"),
        ("Class a\n  -> typed-by b", "line 2: 'b'"),
        ("-> typed-by b", "line 1: an edge without an element above it"),
        ("Class a\n  -> likes a", "line 2: no Edge 'likes'"),
        ('Class a x={"b": 1}', "cannot be an attribute"),
        ('Class a "b', "line 1: Unterminated string"),
        ("Class a b", "line 1: expected ="),
        ('Class a "\\ud800"', r"line 1: an escape such as \ud800 is only half of a character"),
        ('Class a x="\\udc00"', "is only half of a character"),
    ],
)
def test_syntax_errors_name_their_line(text, message):
    with pytest.raises(IrSyntaxError) as caught:
        parse_text(text)
    assert message in str(caught.value)
