"""The swift way through a file and the general way give the same graph, findings and coverage."""

from random import Random

import pytest
from reading_xmi import MAGICDRAW, magicdraw, papyrus, read, source

from dialects.magicdraw import write_xml
from dialects.random_models import random_model
from sysmlc.frontends.xmi import applications, swift


def everything(*sources):
    reading = read(*sources)
    references = [tuple(one) for one in reading.graph.pending]
    owned = [element.id for element in reading.graph]
    return reading.text, reading.findings, references, owned, reading.coverage.as_json()


def generally(monkeypatch, *sources):
    """What comes out when no row and no application has a short cut."""
    with monkeypatch.context() as patch:
        patch.setattr(swift, "plan_of", lambda *_: None)
        patch.setattr(swift, "reader_of", lambda *_: None)
        patch.setattr(applications, "_plain_bases", lambda *_: {})
        return everything(*sources)


@pytest.mark.parametrize("seed", range(6))
def test_both_ways_give_the_same_for_random_models(seed, monkeypatch):
    model = random_model(Random(seed))
    for text, name in ((model, "m.uml"), (write_xml(model), "m.xml")):
        one = source(text, name)
        assert everything(one) == generally(monkeypatch, one)


def test_both_ways_give_the_same_for_two_files_with_the_same_ids(monkeypatch):
    model = random_model(Random(7))
    files = source(model, "a.uml"), source(model, "b.uml")
    assert everything(*files) == generally(monkeypatch, *files)


ODDITIES = """
<packagedElement xmi:type="uml:Class" xmi:id="a" name="A" isAbstract="true" visibility="public"/>
<packagedElement xmi:type="uml:Class" xmi:id="a" name="Again"/>
<packagedElement xmi:type="uml:Class" xmi:id="" name="Empty"/>
<packagedElement xmi:type="uml:Class" name="None"/>
<packagedElement xmi:type="uml:State" xmi:id="s" name="astray"/>
<packagedElement xmi:type="uml:Unheard" xmi:id="u" name="U" type="a"/>
<packagedElement xmi:type="uml:Stereotype" xmi:id="st" name="St">
  <ownedAttribute xmi:type="uml:Property" xmi:id="b" name="base_Class" type="a"/>
</packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="c" name="C">
  <ownedAttribute xmi:type="uml:Property" xmi:id="p" name="base_Class" type="a nowhere"/>
  <ownedAttribute xmi:id="q" name="q" type="nowhere" aggregation="none"/>
  <ownedAttribute xmi:id="r" name="r" type="u" subsettedProperty="p q"/>
  <ownedOperation xmi:id="o" name="o" method="a" precondition="k"/>
  <ownedRule xmi:id="k" constrainedElement="c a"/>
  <ownedRule xmi:id="l"><constrainedElement xmi:idref="a" href="x.uml#b"/>
    <constrainedElement xmi:idref="c"><x/></constrainedElement>
    <constrainedElement xmi:idref="gone"/><constraint xmi:idref="k"/></ownedRule>
</packagedElement>
<packagedElement xmi:type="uml:Activity" xmi:id="y" name="Y" node="n" partition="z">
  <group xmi:type="uml:ActivityPartition" xmi:id="z" node="n n2"/>
  <node xmi:type="uml:OpaqueAction" xmi:id="n" inPartition="z" incoming="e nowhere"/>
  <edge xmi:type="uml:ControlFlow" xmi:id="e" source="n" target="n n2" guard="k"/>
  <node xmi:type="uml:ValueSpecificationAction" xmi:id="n2">
    <value xmi:id="v" value="1"/>
  </node>
</packagedElement>
"""


def test_both_ways_give_the_same_for_oddities(monkeypatch):
    applied = '<Blocks:Block xmi:id="x" base_Class="c a"/><Blocks:Block base_Class="c" tag="p q"/>'
    for one in (papyrus(ODDITIES, applied), magicdraw(ODDITIES)):
        assert everything(one) == generally(monkeypatch, one)


DRAWING = "<diagramRepresentation><x><y/></x>%s</diagramRepresentation>"
CLASS = "<packagedElement xmi:type='uml:Class' xmi:id='%s' name='%s'/>"


def drawn(content):
    inside = f"<xmi:Extension><modelExtension>{DRAWING % content}</modelExtension></xmi:Extension>"
    return read(magicdraw(inside + CLASS % ("a", "A")))


def test_content_of_a_drawing_is_counted_and_keeps_its_places():
    reading = drawn("<z/>")
    assert reading.totals["ignored_notation"] == 2 + 3 + 3
    assert reading.graph["a"].ordinal == reading.graph["m"].ordinal + 1 + 3 + 3


def test_a_drawing_inside_a_drawing_is_counted_too():
    reading, nested = drawn("<z/>"), drawn(DRAWING % "<z/>")
    assert nested.graph["a"].ordinal == reading.graph["a"].ordinal + 3
    assert nested.totals["ignored_notation"] == reading.totals["ignored_notation"] + 3


def test_a_file_that_ends_inside_a_drawing_is_malformed():
    cut = (MAGICDRAW % (DRAWING % "<z/>")).partition("<z/>")[0]
    (found,) = read(source(cut, "m.xml")).findings
    assert found.startswith("malformed")
