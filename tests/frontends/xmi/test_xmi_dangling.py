"""Every reference that a file writes leads somewhere or is told, whoever follows it."""

import pytest
from reading_xmi import magicdraw, papyrus, read

from sysmlc.passes import pipeline

ACTIVITY = '<packagedElement xmi:type="uml:Activity" xmi:id="a" name="Open">{}</packagedElement>'
FLOW = '<edge xmi:type="uml:ControlFlow" xmi:id="e" source="i" target="j"/>'
START = '<node xmi:type="uml:InitialNode" xmi:id="i" outgoing="e"/>'


def findings(*sources):
    """What the front end and ``resolve`` find."""
    reading = read(*sources)
    pipeline.load("resolve").run(reading.graph, reading.sink)
    return [f"{one.rule.code} {one.severity}: {one.message}" for one in reading.sink]


def node(incoming):
    merge = f'<node xmi:type="uml:MergeNode" xmi:id="j" name="again" incoming="{incoming}"/>'
    return papyrus(ACTIVITY.format(START + merge + FLOW))


def test_what_the_other_end_says_is_a_warning_once_for_element_and_feature():
    assert findings(node("e gone lost")) == [
        "SM116 warning: 'incoming' of 'M::Open::again' names 'gone' and 1 more that do not exist"
    ]
    assert findings(node("gone"))[0].endswith("names 'gone', which does not exist")
    assert findings(node("e")) == []


def test_references_as_children_are_one_list():
    merge = (
        "<node xmi:type='uml:MergeNode' xmi:id='j' name='again'><incoming xmi:idref='e'/>"
        "<incoming xmi:idref='gone'/><incoming xmi:idref='lost'/></node>"
    )
    assert findings(magicdraw(ACTIVITY.format(START + merge + FLOW))) == [
        "SM116 warning: 'incoming' of 'M::Open::again' names 'gone' and 1 more that do not exist"
    ]


def test_what_nothing_else_says_is_an_error_and_what_is_there_stays():
    region = (
        '<node xmi:type="uml:ExpansionRegion" xmi:id="r" name="each" inputElement="n gone"/>'
        '<node xmi:type="uml:ExpansionNode" xmi:id="n" name="all" regionAsInput="{}"/>'
    )
    found = read(papyrus(ACTIVITY.format(region.format("r"))))
    assert found.graph["r"].attrs["input_element"] == ("n",)
    assert findings(papyrus(ACTIVITY.format(region.format("lost")))) == [
        "SM120 error: 'input_element' of 'M::Open::each' names 'gone', which does not exist",
        "SM120 error: 'region_as_input' of 'M::Open::all' names 'lost', which does not exist",
    ]
    assert findings(papyrus(ACTIVITY.format(region.format("r").replace(" gone", "")))) == []


INSIDE = {
    "the other end of a generalization": (
        '<packagedElement xmi:type="uml:Class" xmi:id="k" name="K">'
        '<generalization xmi:id="g" specific="gone" general="k2"/></packagedElement>'
        '<packagedElement xmi:type="uml:Class" xmi:id="k2" name="K2"/>',
        "SM116 warning: 'specific' of 'M::K' names",
    ),
    "the instance that is a value": (
        '<packagedElement xmi:type="uml:Class" xmi:id="k" name="K"><ownedAttribute xmi:id="p"'
        ' name="p"><defaultValue xmi:type="uml:InstanceValue" instance="gone"/></ownedAttribute>'
        "</packagedElement>",
        "SM120 error: 'instance' of 'M::K::p' names",
    ),
    "a part of a clause": (
        ACTIVITY.format(
            '<node xmi:type="uml:ConditionalNode" xmi:id="c" name="c"><clause xmi:id="l"'
            ' test="gone"/></node>'
        ),
        "SM120 error: 'test' of 'M::Open::c' names",
    ),
    "the signal of an event that no trigger names": (
        '<packagedElement xmi:type="uml:SignalEvent" xmi:id="s" signal="gone"/>',
        "SM120 error: 'signal' of 'M' names",
    ),
}


@pytest.mark.parametrize("what", INSIDE)
def test_what_becomes_no_element_is_looked_at_too(what):
    model, told = INSIDE[what]
    assert [one for one in findings(papyrus(model)) if one[:5] in ("SM116", "SM120")] == [
        f"{told} 'gone', which does not exist"
    ]


def test_an_element_of_another_file_of_the_unit_is_there():
    other = papyrus('<packagedElement xmi:type="uml:Class" xmi:id="gone"/>', name="other.uml")
    assert not [one for one in findings(node("gone"), other) if one.startswith("SM116")]


def test_the_place_is_that_of_the_element_that_has_the_feature():
    reading = read(node("gone"))
    (found,) = reading.sink
    assert (found.subject.id, found.subject.place.ordinal) == ("j", 4)
