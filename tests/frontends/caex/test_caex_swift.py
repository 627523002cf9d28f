"""Rows with a plan are read at once, all others the general way: both give the same."""

import subprocess
import sys
from pathlib import Path

import pytest
from reading_caex import Read, aml, aml_2, classes, interfaces, plant, types

from sysmlc.frontends.caex import members, structures
from sysmlc.frontends.caex.plain import Plain
from sysmlc.frontends.caex.swift import Swift
from sysmlc.sources import load

GENERATOR = Path(__file__).parents[3] / "benchmarks" / "aml_model.py"


@pytest.fixture
def generally(monkeypatch):
    """Reads without plans."""

    def read(*sources):
        with monkeypatch.context() as patch:
            patch.setattr(Swift, "lower", lambda swift, site: members.lower(swift._context, site))
            patch.setattr(Plain, "attribute", lambda *_: False)
            patch.setattr(Plain, "interface", lambda *_: False)
            patch.setattr(structures, "structure", lambda *_: None)
            return Read(*sources)

    return read


def agree(one, other):
    assert one.text == other.text
    assert [(f.rule.code, f.message, f.subject) for f in one.sink] == [
        (f.rule.code, f.message, f.subject) for f in other.sink
    ]
    assert one.coverage.as_json() == other.coverage.as_json()


def test_a_generated_plant_is_read_alike_in_both_ways(generally, tmp_path):
    path = tmp_path / "plant.aml"
    options = ["--megabytes", "0.1", "--seed", "3", str(path)]
    subprocess.run([sys.executable, GENERATOR, *options], check=True, capture_output=True)
    (source,) = load(path, path.name)
    agree(Read(source), generally(source))


OF_CLASS = (
    '<Attribute Name="a" AttributeDataType="xs:double" Unit="m"><Value>1</Value></Attribute>'
    '<Attribute Name="s"><Attribute Name="i" AttributeDataType="xs:integer"/></Attribute>'
    '<ExternalInterface Name="p" ID="cp" RefBaseClassPath="Interfaces/P"/>'
)
REPEATED = [
    '<Attribute Name="a" AttributeDataType="xs:double" Unit="m"><Value>2</Value></Attribute>',
    '<Attribute Name="a" AttributeDataType="xs:double" Unit="m"><Value>1</Value></Attribute>',
    '<Attribute Name="a" ID="own" AttributeDataType="xs:double"><Value>3</Value></Attribute>',
    '<Attribute Name="a" Unit="mm"><Value>3</Value></Attribute>',
    '<Attribute Name="a" RefAttributeType="Types/T"><Value>3</Value></Attribute>',
    '<Attribute Name="a" RefAttributeType="Types/Gone"><Value>3</Value></Attribute>',
    '<Attribute Name="a"><Description>why</Description><Value>many</Value></Attribute>',
    '<Attribute Name="a"><DefaultValue>5</DefaultValue></Attribute>',
    '<Attribute Name="a"><Value>4</Value></Attribute><Attribute Name="a"><Value/></Attribute>',
    '<Attribute Name="a"><Value></Value></Attribute>',
    '<Attribute Name="s"><Attribute Name="i"><Value>7</Value></Attribute></Attribute>',
    '<Attribute Name="s"><Attribute Name="j"><Value>7</Value></Attribute></Attribute>',
    '<Attribute Name="s"><RefSemantic CorrespondingAttributePath="x"/></Attribute>',
    '<Attribute Name="new" AttributeDataType="xs:int"><Value>7</Value></Attribute>',
    '<Attribute Name="new" Unit="foo"/>',
    '<Attribute Name="new" RefAttributeType="1/a"/>',
    '<Attribute Name="new"><Attribute Name="x"/><Attribute Name="y" Unit="m"/></Attribute>',
    '<Attribute Name="new"><Attribute Name="x"><Attribute Name="y"/></Attribute></Attribute>' * 2,
    '<Attribute Name="new" RefAttributeType="Types/T"><Attribute Name="x"/></Attribute>',
    '<Attribute Name="new" RefAttributeType="Types/Gone"><Attribute Name="x"/></Attribute>',
    '<Attribute Name="new" Unit="m"><Attribute Name="x"/></Attribute>',
    '<Attribute Name="new"><Value>7</Value><Attribute Name="x"/></Attribute>',
    '<Attribute Name="new"><DefaultValue>7</DefaultValue><Attribute Name="x"/></Attribute>',
    '<Attribute Name="new"><RefSemantic CorrespondingAttributePath="x"/><Attribute Name="x"/>'
    "</Attribute>",
    '<Attribute Name="new" ID="n"><Attribute Name="x" ID="x"/></Attribute>',
    '<Attribute Name="new"><Description>why</Description><Attribute Name="x"/></Attribute>',
    '<Attribute><Attribute Name="x"/></Attribute>',
    '<Attribute Name="s"><Attribute Name="i"><Attribute Name="x"/></Attribute></Attribute>',
    "<Attribute/>",
    '<ExternalInterface Name="p" ID="ip" RefBaseClassPath="Interfaces/P"/>',
    '<ExternalInterface Name="p" ID="ip" RefBaseClassPath="Interfaces/Gone"/>',
    '<ExternalInterface Name="p"><Attribute Name="Direction"><Value>In</Value></Attribute>'
    "</ExternalInterface>",
    '<ExternalInterface Name="q" ID="iq" RefBaseClassPath="Interfaces/P"/>',
    '<ExternalInterface Name="q"><Attribute Name="Direction"><Value>In</Value></Attribute>'
    "</ExternalInterface>",
    '<ExternalInterface Name="q"><ExternalInterface Name="r"/></ExternalInterface>',
    '<ExternalInterface Name="q" ID="cp"/>',
    '<ExternalInterface Name="p"><Attribute Name="speed" Unit="m/s"><Value>2</Value></Attribute>'
    "</ExternalInterface>",
    '<ExternalInterface Name="q"><Attribute Name="v"><Value>2</Value></Attribute>'
    '</ExternalInterface><ExternalInterface Name="r"><Attribute Name="v"/></ExternalInterface>',
    '<ExternalInterface Name="q"><Attribute Name="speed"><Description>fast</Description>'
    '<Value>2</Value></Attribute><Attribute Name="w"/></ExternalInterface>',
    '<ExternalInterface Name="q" RefBaseClassPath="cp"/>',
]


@pytest.mark.parametrize("form", [aml, aml_2])
@pytest.mark.parametrize("path", ["Lib/C", ""])
@pytest.mark.parametrize("inside", REPEATED)
def test_each_thing_that_an_instance_says_is_read_alike_in_both_ways(inside, path, form, generally):
    elements = "".join(
        f'<InternalElement Name="{n}" ID="{n}" RefBaseSystemUnitPath="{path}">{inside}'
        "</InternalElement>"
        for n in (1, 2)
    )
    source = form(
        interfaces('<InterfaceClass Name="P"/>')
        + types('<AttributeType Name="T" AttributeDataType="xs:double"/>')
        + classes(f'<SystemUnitClass Name="C">{OF_CLASS}</SystemUnitClass>')
        + plant(elements)
    )
    agree(Read(source), generally(source))


@pytest.mark.corpus
def test_real_plants_are_read_alike_in_both_ways(corpus, generally):
    for path in sorted((corpus / "aml" / "dev").glob("*.aml")):
        sources = load(path, path.name)
        agree(Read(*sources), generally(*sources))
