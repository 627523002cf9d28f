"""Whatever is done to a file, reading it ends in a graph and findings, never in a traceback."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reading_xmi import magicdraw, papyrus, read

from long_runs import examples
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.sources import Source, SourceError

MODELS = (
    papyrus(
        """
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="K">
    <generalization xmi:id="g" general="l"/>
    <ownedAttribute xmi:type="uml:Port" xmi:id="p" type="k">
      <lowerValue xmi:type="uml:LiteralInteger" xmi:id="lo" value="2"/></ownedAttribute>
    <ownedConnector xmi:id="x"><end xmi:id="e" role="p" partWithPort="p"/></ownedConnector>
    <ownedRule xmi:id="r"><specification xmi:type="uml:OpaqueExpression"><body>a</body>
      </specification></ownedRule></packagedElement>
  <packagedElement xmi:type="uml:StateMachine" xmi:id="l"><region xmi:id="re">
    <subvertex xmi:type="uml:State" xmi:id="s"/><transition xmi:id="t" source="s" target="s"
      guard="r"><trigger xmi:id="tr" event="ev"/></transition></region></packagedElement>
  <packagedElement xmi:type="uml:SignalEvent" xmi:id="ev" signal="k"/>""",
        '<Blocks:Block xmi:id="a" base_Class="k"/><Blocks:NestedConnectorEnd xmi:id="n"'
        ' base_ConnectorEnd="e" propertyPath="p"/>',
    ),
    magicdraw(
        """
  <packagedElement xmi:type='uml:Activity' xmi:id='k'><ownedParameter xmi:type='uml:Parameter'
    xmi:id='pa'/><node xmi:type='uml:OpaqueAction' xmi:id='n'><inputValue xmi:type='uml:InputPin'
    xmi:id='p'><type href='x.mdzip#y'/><xmi:Extension><modelExtension><lowerValue
    xmi:type='uml:LiteralInteger' value='1'/></modelExtension></xmi:Extension></inputValue></node>
    <edge xmi:type='uml:ObjectFlow' xmi:id='f'><source xmi:idref='n'/><target xmi:idref='p'/>
    <guard xmi:type='uml:LiteralBoolean'/></edge></packagedElement>""",
        "<sysml:Block xmi:id='b'><base_Class xmi:idref='k'/></sysml:Block>",
    ),
)
TYPES = ("Class", "State", "Slot", "Region", "Transition", "InputPin", "Generalization")
MORE_TYPES = ("LiteralInteger", "Trigger", "Extension", "Property", "Constraint", "Activity")
WORDS = (*(f"uml:{name}" for name in TYPES + MORE_TYPES), *"kpnmlexrst")


@settings(max_examples=examples(150), deadline=None)
@given(st.sampled_from(MODELS), st.data())
def test_damaged_bytes(model, data):
    start = data.draw(st.integers(0, len(model.data)))
    length = data.draw(st.integers(0, 40))
    patch = data.draw(st.binary(max_size=8))
    check(model.data[:start] + patch + model.data[start + length :])


@pytest.mark.long
@settings(max_examples=examples(150), deadline=None)
@given(st.sampled_from(MODELS), st.data())
def test_exchanged_words(model, data):
    """Well-formed files in which types, ids and references are anything."""
    text = model.data.decode()
    for _ in range(data.draw(st.integers(1, 4))):
        old, new = data.draw(st.sampled_from(WORDS)), data.draw(st.sampled_from(WORDS))
        quote = "'" if "'uml" in text else '"'
        text = text.replace(f"{quote}{old}{quote}", f"{quote}{new}{quote}")
    check(text.encode())


def check(data):
    damaged = Source("m.uml", data)
    assert 0 <= FRONTEND.detect(damaged) <= 1
    try:
        reading = read(damaged)
    except SourceError:
        return
    assert len(reading.graph) == 0 or reading.totals["elements"] > 0
