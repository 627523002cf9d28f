"""The reader of XMI bytes: namespaces, faults in prefixes, and skipped drawings of MagicDraw."""

import pytest
from reading_xmi import MAGICDRAW, magicdraw, read, source

from sysmlc.frontends.xmi.document import read_document
from sysmlc.sources import DEFAULT_LIMITS, SourceError

XMI = "xmlns:xmi='http://schema.omg.org/spec/XMI/2.1'"
UML = "xmlns:uml='http://www.eclipse.org/uml2/5.0.0/UML'"
DRAWING = "<diagramRepresentation><x><y/></x>%s</diagramRepresentation>"
CLASS = "<packagedElement xmi:type='uml:Class' xmi:id='%s' name='%s'/>"


def test_a_namespace_may_be_declared_at_any_element():
    text = f"<xmi:XMI {XMI}><uml:Model {UML} xmi:id='m' name='M'/></xmi:XMI>"
    assert read(source(text)).graph["m"].name == "M"


@pytest.mark.parametrize(
    "text",
    [
        f"<xmi:XMI {XMI} {UML}><uml:Model><a b:c=''/></uml:Model></xmi:XMI>",
        f"<xmi:XMI {XMI} {UML}><uml:Model><b:c/></uml:Model></xmi:XMI>",
        f"<xmi:XMI {XMI} {UML}><diagramRepresentation><b:c/></diagramRepresentation></xmi:XMI>",
    ],
)
def test_an_undeclared_prefix_is_a_located_fault(text):
    with pytest.raises(SourceError, match="unbound prefix") as fault:
        read_document(source(text))
    assert fault.value.offset > 0


def test_elements_nested_too_deeply_exceed_the_limit():
    depth = DEFAULT_LIMITS.depth
    with pytest.raises(SourceError, match=f"nested more than {depth} deep"):
        read_document(source(f"<xmi:XMI {XMI}>" + "<a>" * depth))


def read_with_drawing(content):
    inside = f"<xmi:Extension><modelExtension>{DRAWING % content}</modelExtension></xmi:Extension>"
    return read(magicdraw(inside + CLASS % ("a", "A")))


def test_elements_of_a_drawing_are_counted_so_that_later_elements_keep_their_ordinals():
    reading = read_with_drawing("<z/>")
    assert reading.totals["ignored_notation"] == 2 + 3 + 3
    assert reading.graph["a"].ordinal == reading.graph["m"].ordinal + 1 + 3 + 3


def test_a_drawing_inside_a_drawing_is_counted_too():
    reading, nested = read_with_drawing("<z/>"), read_with_drawing(DRAWING % "<z/>")
    assert nested.graph["a"].ordinal == reading.graph["a"].ordinal + 3
    assert nested.totals["ignored_notation"] == reading.totals["ignored_notation"] + 3


def test_a_drawing_may_declare_its_own_prefixes():
    drawing = "<diagramRepresentation><d:o xmlns:d='urn:d' a='b'/></diagramRepresentation>"
    assert read(magicdraw(f"<xmi:Extension>{drawing}</xmi:Extension>")).totals[
        "ignored_notation"
    ] == (2 + 3)


def test_a_file_that_ends_inside_a_drawing_is_malformed():
    cut = (MAGICDRAW % (DRAWING % "<z/>")).partition("<z/>")[0]
    (finding,) = read(source(cut, "m.xml")).findings
    assert finding.startswith("malformed")
