"""Each change in a new export of a plant is reported once, in the terms of the plant."""

import pytest
from change_texts import print_changes

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.caex import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.compare import compare
from sysmlc.passes import pipeline
from sysmlc.sources import Source

LINE = """\
<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">
  <SuperiorStandardVersion>AutomationML 2.10</SuperiorStandardVersion>
  <SourceDocumentInformation OriginName="x" OriginID="x" OriginVersion="1"/>
  <InstanceHierarchy Name="Plant">
    <InternalElement Name="Line" ID="line">
      <InternalElement Name="Cell" ID="cell" RefBaseSystemUnitPath="Lib/Cell">
        <InternalElement Name="arm" ID="arm" RefBaseSystemUnitPath="Lib/Arm">
          <Attribute Name="reach"><Value>3</Value></Attribute>
        </InternalElement>
      </InternalElement>
      <InternalElement Name="Oven" ID="oven"/>
    </InternalElement>
  </InstanceHierarchy>
  <SystemUnitClassLib Name="Lib">
    <SystemUnitClass Name="Arm"><Attribute Name="reach"/></SystemUnitClass>
    <SystemUnitClass Name="BigArm" RefBaseClassPath="Lib/Arm"/>
    <SystemUnitClass Name="Cell">
      <InternalElement Name="arm" ID="a" RefBaseSystemUnitPath="Lib/Arm"/>
    </SystemUnitClass>
  </SystemUnitClassLib>
</CAEXFile>
"""
ARM = 'ID="arm" RefBaseSystemUnitPath="Lib/Arm">'


def read(text):
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source("plant.aml", text.encode())], graph, sink, Coverage())
    pipeline.build_pipeline(["resolve"]).run(graph, sink)
    return graph


def compare_exports(before, after):
    """Return the changes when *after* replaces *before*, with the same ids and with new ids."""
    assert LINE.count(before) == 1
    changed_line = LINE.replace(before, after)
    return [
        print_changes(compare(read(LINE), read(text)))
        for text in (changed_line, replace_ids(changed_line))
    ]


def replace_ids(text):
    """Return the same plant with other ids."""
    for id in ("line", "cell", "arm", "oven", "a", "tool"):
        text = text.replace(f'ID="{id}"', f'ID="new-{id}"')
    return text


TOOL = '<InternalElement Name="tool" ID="tool"/>'


@pytest.mark.parametrize(
    ("replacement", "change"),
    [
        (
            ("<Value>3<", "<Value>4<"),
            "Plant::Line::Cell: changed instance arm, value of reach: 3 => 4",
        ),
        (('Name="Oven"', 'Name="Kiln"'), "Plant::Line: renamed part Kiln, name: Oven => Kiln"),
        ((ARM, ARM + TOOL), "Plant::Line::Cell::arm: added part tool"),
        (
            ('ID="oven"/>', f'ID="oven">{TOOL}</InternalElement>'),
            "Plant::Line::Oven: added part tool",
        ),
        (
            ('<InternalElement Name="Oven" ID="oven"/>', ""),
            "Plant::Line: removed part Oven",
        ),
        (
            (
                'ID="oven"/>',
                f'ID="oven"/><InternalElement Name="Press" ID="press">{TOOL}</InternalElement>',
            ),
            "Plant::Line: added part Press (2)",
        ),
    ],
)
def test_a_change_of_a_plant_is_reported_once(replacement, change):
    for changes in compare_exports(*replacement):
        assert changes == [change]


def test_another_system_unit_class_is_another_type():
    for changes in compare_exports(ARM, ARM.replace("Lib/Arm", "Lib/BigArm")):
        assert "Plant::Line::Cell: retyped instance arm, type: Arm => BigArm" in changes
