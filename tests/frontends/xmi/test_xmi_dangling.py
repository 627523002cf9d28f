"""Every reference that a file writes has a target or is reported, also if no edge follows it."""

import pytest
from reading_xmi import magicdraw, papyrus, read

from sysmlc.diagnostics.renderers import make_report, merge_facts
from sysmlc.passes import pipeline

ACTIVITY = '<packagedElement xmi:type="uml:Activity" xmi:id="a" name="Open">{}</packagedElement>'
FLOW = '<edge xmi:type="uml:ControlFlow" xmi:id="e" source="i" target="j"/>'
START = '<node xmi:type="uml:InitialNode" xmi:id="i" outgoing="e"/>'


def findings(*sources):
    """What the front end and ``resolve`` find."""
    reading = read(*sources)
    pipeline.load("resolve").run(reading.graph, reading.sink)
    return [f"{item.rule.code} {item.severity}: {item.message}" for item in reading.sink]


def node(incoming):
    merge = f'<node xmi:type="uml:MergeNode" xmi:id="j" name="again" incoming="{incoming}"/>'
    return papyrus(ACTIVITY.format(START + merge + FLOW))


def test_a_missing_target_of_a_redundant_feature_is_one_warning_for_each_element_and_feature():
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


def test_a_missing_target_of_another_feature_is_an_error_and_the_other_targets_remain():
    region = (
        '<node xmi:type="uml:ExpansionRegion" xmi:id="r" name="each" inputElement="n gone"/>'
        '<node xmi:type="uml:ExpansionNode" xmi:id="n" name="all" regionAsInput="{}"/>'
    )
    reading = read(papyrus(ACTIVITY.format(region.format("r"))))
    assert reading.graph["r"].attrs["input_element"] == ("n",)
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
def test_rows_that_become_no_elements_are_checked_too(what):
    model, expected = INSIDE[what]
    assert [item for item in findings(papyrus(model)) if item[:5] in ("SM116", "SM120")] == [
        f"{expected} 'gone', which does not exist"
    ]


SLOTS = (
    '<packagedElement xmi:type="uml:InstanceSpecification" xmi:id="i" name="i">'
    '<slot xmi:id="s"><value xmi:type="uml:InstanceValue" xmi:id="v" instance="{}"/></slot>'
    '<slot xmi:id="t"><value xmi:type="uml:InstanceValue" xmi:id="w" instance="{}"/></slot>'
    "</packagedElement>"
)


def test_a_missing_element_is_one_fact_and_not_a_missing_file():
    source = papyrus(SLOTS.format("gone", "gone"))
    assert not any(line.startswith("SM152") for line in findings(source))
    reading = read(source)
    pipeline.load("resolve").run(reading.graph, reading.sink)
    (finding,) = merge_facts(make_report(reading.sink, [source]).findings)
    assert finding.diagnostic.message.endswith("'gone', which does not exist (2 places)")
    outside = SLOTS.replace(' instance="{}"/>', '><instance href="other.uml#o"/></value>')
    other = papyrus(outside)
    assert [line[:5] for line in findings(other)] == ["SM152"]


def test_a_target_in_another_file_of_the_unit_exists():
    other = papyrus('<packagedElement xmi:type="uml:Class" xmi:id="gone"/>', name="other.uml")
    assert not [item for item in findings(node("gone"), other) if item.startswith("SM116")]


def test_the_location_is_that_of_the_element_with_the_feature():
    reading = read(node("gone"))
    (diagnostic,) = reading.sink
    assert (diagnostic.subject.id, diagnostic.subject.place.ordinal) == ("j", 4)
