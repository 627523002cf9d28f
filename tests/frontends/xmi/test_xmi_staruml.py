"""StarUML: texts in percent-encoded attributes, guards without values, any-receive events."""

import pytest
from reading_xmi import read, source

from sysmlc.ir import Edge

STARUML = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="2.1" xmlns:uml="http://schema.omg.org/spec/UML/2.0"
 xmlns:xmi="http://schema.omg.org/spec/XMI/2.1">
<xmi:Documentation exporter="{exporter}" exporterVersion="2.0"/>
<uml:Model xmi:id="m" xmi:type="uml:Model" name="Packing%20Line">
<packagedElement xmi:id="c" name="Lift%20Table" xmi:type="uml:Class">
<ownedBehavior xmi:id="s" name="Control" xmi:type="uml:StateMachine">
<region xmi:id="r" xmi:type="uml:Region">
<subvertex xmi:id="a" name="Down" xmi:type="uml:State"/>
<subvertex xmi:id="b" name="Up" xmi:type="uml:State"/>
<transition xmi:id="t" xmi:type="uml:Transition" source="a" target="b">
<guard xmi:id="g" xmi:type="uml:Constraint" specification="load%20%3C%203"/>
<trigger xmi:id="tr" xmi:type="uml:Trigger" name="raise" event="e"/>
<trigger xmi:id="e" name="{event}" xmi:type="uml:AnyReceiveEvent"/>
<effect xmi:id="f" name="load%20:=%20load%20+%201" xmi:type="uml:OpaqueBehavior"/>
</transition></region></ownedBehavior></packagedElement></uml:Model></xmi:XMI>"""


def read_model(exporter="StarUML", event="raise"):
    return read(source(STARUML.format(exporter=exporter, event=event)))


def test_attributes_of_staruml_are_decoded():
    reading = read_model()
    assert reading.graph["c"].name == "Lift Table"
    assert reading.graph["t"].attrs["guard"] == "load < 3"
    assert reading.graph["f"].attrs["body"] == "load := load + 1"


def test_attributes_of_other_tools_are_not_decoded():
    assert read_model(exporter="Another").graph["c"].name == "Lift%20Table"


def test_a_named_any_receive_event_is_the_event_of_that_name():
    reading = read_model()
    (trigger,) = reading.graph.targets(reading.graph["t"], Edge.TRIGGER)
    assert (trigger.name, trigger.subkind) == ("raise", "")
    assert reading.findings == [
        "any-event-with-name: the any-receive event 'raise' is read as the event of that name"
    ]


@pytest.mark.parametrize("name", ["any", "All", "*", "else", "AnyReceiveEvent1", ""])
def test_an_event_of_any_message_stays_one(name):
    text = STARUML.format(exporter="StarUML", event=name).replace('name="raise"', f'name="{name}"')
    reading = read(source(text))
    assert reading.graph["tr"].subkind == "any"
    assert reading.findings == []
