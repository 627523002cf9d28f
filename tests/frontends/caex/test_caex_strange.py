"""What no schema of CAEX has: attributes of elements, and text between elements."""

import pytest
from reading_caex import CAEX_2, Read, aml, classes, plant, types

from sysmlc.frontends.caex import conformance

ELEMENT = '<InternalElement Name="i" ID="1">%s</InternalElement>'


def inside(body):
    return plant(ELEMENT % body)


def in_both_ways(body):
    """Read as a plain file, and by the general way."""
    yield Read(body)
    yield Read(aml(f"<?tool?>{body}"))


UNKNOWN = [
    (
        inside("").replace('ID="1"', 'ID="1" RefBaseClassPath="Lib/C"'),
        "'Plant::i' has an attribute 'RefBaseClassPath', which CAEX does not have at "
        "'InternalElement'; did you mean 'RefBaseSystemUnitPath'?",
    ),
    (
        inside('<Attribute Name="a" Value="5"/><Attribute Name="b" Value="5"/>'),
        "'Plant::i::a' has an attribute 'Value', which CAEX does not have at 'Attribute' "
        "(2 elements); known: AttributeDataType, ChangeMode, ID, Name, RefAttributeType, Unit",
    ),
    (
        classes('<SystemUnitClass Name="C" colour="red"/>'),
        "'Lib::C' has an attribute 'colour', which CAEX does not have at 'SystemUnitClass'; "
        "known: ChangeMode, ID, Name, RefBaseClassPath",
    ),
]


@pytest.mark.parametrize(("body", "told"), UNKNOWN)
def test_an_attribute_that_caex_does_not_have_is_told_once(body, told):
    for reading in in_both_ways(body):
        assert reading.findings == [f"SM633: {told}"]


def test_an_element_with_such_an_attribute_is_read_in_part():
    assert Read(inside('<Attribute Name="a" Value="5"/>')).totals == {
        "mapped": 3,
        "approximated": 1,
    }


def test_an_attribute_of_another_language_and_one_that_is_at_home_are_nothing_to_tell():
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:type="T"'
    assert Read(inside("").replace('ID="1"', f'ID="1" {xsi}')).findings == []
    assert Read(classes('<SystemUnitClass Name="C" ID="1" ChangeMode="state"/>')).findings == []
    free = '<AdditionalInformation Tool="t"><Attribute Key="k"/></AdditionalInformation>'
    assert Read(inside(free)).findings == []


def test_an_unknown_attribute_beside_a_namespace_is_told():
    body = inside("").replace('ID="1"', 'ID="1" xmlns="" colour="red"')
    for reading in in_both_ways(body):
        assert [finding[:5] for finding in reading.findings] == ["SM633"]


TEXTS = [
    ("oops", "'Plant::i' holds the text 'oops'; CAEX has none at 'InternalElement'"),
    (
        '<Attribute Name="a">2.5</Attribute>',
        "'Plant::i::a' holds the text '2.5'; CAEX has none at 'Attribute'",
    ),
    (
        '<Attribute Name="a"/> and  more\n<Attribute Name="b"/>',
        "'Plant::i' holds the text 'and more'; CAEX has none at 'InternalElement'",
    ),
    (
        '<Attribute Name="a"><Constraint Name="c">x<UnknownType/></Constraint></Attribute>',
        "'Plant::i::a::c' holds the text 'x'; CAEX has none at 'Constraint'",
    ),
    (
        '<Attribute Name="a">1</Attribute><Attribute Name="b">2</Attribute>',
        "'Plant::i::a' holds the text '1' and 1 more like it; CAEX has none at 'Attribute'",
    ),
]


@pytest.mark.parametrize(("body", "told"), TEXTS)
def test_text_where_caex_has_none_is_told(body, told):
    for reading in in_both_ways(inside(body)):
        assert reading.findings == [f"SM634: {told}"]


@pytest.mark.parametrize(
    "body",
    [
        "\n  <Description>text</Description>\n",
        "<AdditionalInformation>text <b>and</b> more</AdditionalInformation>",
        "<!-- text -->",
        "<SourceObjectInformation OriginID='o'>text</SourceObjectInformation>",
    ],
)
def test_text_that_is_at_home_is_nothing_to_tell(body):
    for reading in in_both_ways(inside(body)):
        assert reading.findings == []


def test_text_below_what_any_xml_may_stand_in_costs_no_second_look(monkeypatch):
    looks = []
    monkeypatch.setattr(conformance, "parse", lambda source, _: looks.append(source.name))
    header = "<WriterHeader><WriterName>us</WriterName><Constraint>c</Constraint></WriterHeader>"
    for reading in in_both_ways(inside(f"<AdditionalInformation>{header}</AdditionalInformation>")):
        assert (reading.findings, looks) == ([], [])
    Read(inside("oops"))
    assert looks == ["plant.aml"]


def test_text_in_the_file_itself_is_told_at_the_file():
    reading = Read(aml("text" + types(""), form=CAEX_2))
    assert reading.findings == [
        "SM634: 'plant.aml' holds the text 'text'; CAEX has none at 'CAEXFile'"
    ]
