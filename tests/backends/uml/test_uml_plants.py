"""AutomationML saved as UML: a comment in the file stores facts that UML cannot express."""

import json
from random import Random

import jsonschema
import pytest
from lxml import etree
from uml_files import PASSES, read, refine, round_trip, save

from dialects.papyrus import XMI
from dialects.random_plants import random_plant
from sysmlc.backends.uml import write_document
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.caex import FRONTEND
from sysmlc.frontends.xmi import FRONTEND as XMI_FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.round_trip import PREFIX
from sysmlc.passes import pipeline
from sysmlc.sources import Source
from sysmlc.support import resources

PLANT = """<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">
<SourceDocumentInformation OriginName="us" OriginID="u" OriginVersion="1"
 LastWritingDateTime="2024-01-01T00:00:00Z"/>
<InstanceHierarchy Name="Plant"><Version>3</Version>
  <InternalElement Name="line" ID="1line" RefBaseSystemUnitPath="Lib/Line">
    <ExternalInterface Name="in" ID="line-in" RefBaseClassPath="Ports/Port"/>
    <InternalElement Name="belt" ID="belt" RefBaseSystemUnitPath="Lib/Belt">
      <Attribute Name="speed"><Value>2.5</Value></Attribute>
      <ExternalInterface Name="out" ID="belt-out" RefBaseClassPath="Ports/Port"/>
    </InternalElement>
    <InternalElement Name="again" ID="again" RefBaseSystemUnitPath="belt"/>
    <InternalLink Name="l" RefPartnerSideA="line-in" RefPartnerSideB="belt-out"/>
    <InternalLink Name="open" RefPartnerSideA="line-in" RefPartnerSideB=""/>
  </InternalElement>
</InstanceHierarchy>
<InterfaceClassLib Name="Ports"><InterfaceClass Name="Port"
 RefBaseClassPath="AutomationMLInterfaceClassLib/AutomationMLBaseInterface"/></InterfaceClassLib>
<RoleClassLib Name="Roles"><RoleClass Name="Mover"
 RefBaseClassPath="AutomationMLBaseRoleClassLib/AutomationMLBaseRole/Resource"/></RoleClassLib>
<SystemUnitClassLib Name="Lib">
  <SystemUnitClass Name="Belt">
    <Attribute Name="speed" AttributeDataType="xs:double" Unit="m/s">
      <RefSemantic CorrespondingAttributePath="IRDI:speed"/></Attribute>
    <ExternalInterface Name="out" ID="b-out" RefBaseClassPath="Ports/Port"/>
    <SupportedRoleClass RefRoleClassPath="Roles/Mover"/>
  </SystemUnitClass>
  <SystemUnitClass Name="Line">
    <ExternalInterface Name="in" ID="l-in" RefBaseClassPath="Ports/Port"/>
    <InternalElement Name="belt" ID="l-belt" RefBaseSystemUnitPath="Lib/Belt"/>
  </SystemUnitClass>
</SystemUnitClassLib>
</CAEXFile>"""


@pytest.fixture(scope="module")
def plant():
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source("plant.aml", PLANT.encode())], graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    return graph


def test_a_plant_is_read_back_without_differences(plant):
    assert len(plant) > 40
    _, back, changes = round_trip(plant)
    assert changes == []
    belt = next(e for e in back if e.name == "speed" and "data_type" in e.attrs)
    assert (belt.attrs["unit"], belt.attrs["semantics"]) == ("m/s", ("IRDI:speed",))


def test_the_comment_is_reported_once_with_its_facts(plant):
    sink = Sink()
    write_document(plant, sink)
    (loss,) = [diagnostic for diagnostic in sink if diagnostic.rule.code == "SM726"]
    assert "UML cannot express document (1)" in loss.notes
    assert {diagnostic.rule.code for diagnostic in sink} <= {"SM723", "SM724", "SM726"}


def find_comment(text):
    bodies = [body.text for body in etree.fromstring(text.encode()).iter("body")]
    (body,) = [body for body in bodies if body.startswith(PREFIX)]
    return body.removeprefix(PREFIX)


def test_the_comment_follows_its_schema(plant):
    record = json.loads(find_comment(save(plant)[0]))
    schema = json.loads(resources.read_text("metamodels", "sysmlc-kept.schema.json"))
    jsonschema.validate(record, schema)
    assert record["elements"] and record["edges"] and record["made"]  # noqa: PT018
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(record | {"elements": [["a"]]}, schema)


def test_changes_by_another_tool_are_preserved(plant):
    text, _ = save(plant)
    assert ' name="Belt"' in text
    back = read(text.replace(' name="Belt"', ' name="Conveyor"').encode())
    names = {element.name for element in back}
    assert "Conveyor" in names
    assert "Belt" not in names
    assert len(back) == len(plant)


def test_facts_about_removed_elements_are_skipped(plant):
    text, _ = save(plant)
    tree = etree.fromstring(text.encode())
    (belt,) = tree.xpath("//packagedElement[@name='Belt']")
    id = belt.get(f"{{{XMI}}}id")
    belt.getparent().remove(belt)
    for user in tree.xpath(f"//*[@client='{id}' or @type='{id}' or @classifier='{id}']"):
        user.getparent().remove(user)
    back = read(etree.tostring(tree))
    assert [element for element in back if element.name == "Belt"] == []
    assert [e for e in back if e.attrs.get("body", "").startswith(PREFIX)] == []


def test_a_model_from_uml_has_no_comment():
    text, messages = save(refine('Package p "Plant"\n  Facet f "Control"\n'))
    assert PREFIX not in text
    assert [message[:5] for message in messages] == ["SM720"]


@pytest.mark.parametrize(
    "body", ["{", "[]", '{"elements": 1}', '{"elements": [["a", "Gone", "", null, null]]}']
)
def test_a_damaged_comment_is_reported_and_preserved(body, plant):
    text, _ = save(plant)
    old = find_comment(text)
    escaped = old.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    assert escaped in text
    graph, sink = Graph(), Sink()
    data = text.replace(escaped, body).encode()
    XMI_FRONTEND.read([Source("model.uml", data)], graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    assert "SM189" in [diagnostic.rule.code for diagnostic in sink]
    assert any(str(element.attrs.get("body", "")).startswith(PREFIX) for element in graph)


def test_relations_keep_their_order(plant):
    _, back, _ = round_trip(plant)
    for connector in back.of_kind(Kind.CONNECTOR):
        if connector.name == "l":
            paths = [back.targets(end, Edge.PATH) for end in back.targets(connector, Edge.END)]
            assert [[step.name for step in path] for path in paths] == [[], ["belt"]]


@pytest.mark.parametrize("seed", range(15))
def test_a_random_plant_is_read_back(seed):
    graph, sink = Graph(), Sink()
    source = Source("plant.aml", random_plant(Random(seed)))
    FRONTEND.read([source], graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    assert round_trip(graph)[2] == []
