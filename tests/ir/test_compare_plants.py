"""What a new export of a plant differs in is told once, in the words of the plant."""

import pytest

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


def changed(*replacements):
    new = LINE
    for before, after in replacements:
        assert new.count(before) == 1
        new = new.replace(before, after)
    for one, other in ((LINE, new), (LINE, anew(new))):
        changes = compare(read(one), read(other))
        yield [
            f"{c.owner}: {c.what} {c.kind} {c.name}"
            + (f", {c.aspect}: {c.before or None} => {c.after or None}" if c.aspect else "")
            + (f" ({c.contents})" if c.contents else "")
            for c in changes
        ]


def anew(text):
    """The same plant with other ids."""
    for id in ("line", "cell", "arm", "oven", "a", "tool"):
        text = text.replace(f'ID="{id}"', f'ID="new-{id}"')
    return text


TOOL = '<InternalElement Name="tool" ID="tool"/>'


@pytest.mark.parametrize(
    ("replacement", "told"),
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
def test_one_change_of_a_plant_is_told_once(replacement, told):
    for found in changed(replacement):
        assert found == [told]


def test_another_system_unit_class_is_another_type():
    for found in changed((ARM, ARM.replace("Lib/Arm", "Lib/BigArm"))):
        assert "Plant::Line::Cell: retyped instance arm, type: Arm => BigArm" in found
