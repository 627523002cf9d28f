"""Content that no schema of CAEX allows: unknown attributes, and text between elements."""

import pytest
from reading_caex import CAEX_2, Read, aml, classes, interfaces, plant, types

from sysmlc.frontends.caex import conformance

ELEMENT = '<InternalElement Name="i" ID="1">%s</InternalElement>'


def element_with(body):
    return plant(ELEMENT % body)


UNKNOWN = [
    (
        element_with("").replace('ID="1"', 'ID="1" RefBaseClassPath="Lib/C"'),
        "'Plant::i' has an attribute 'RefBaseClassPath', which CAEX does not define for "
        "'InternalElement'; known: ChangeMode, ID, Name, RefBaseSystemUnitPath",
    ),
    (
        element_with('<Attribute Name="a" Value="5"/><Attribute Name="b" Value="5"/>'),
        "'Plant::i::a' has an attribute 'Value', which CAEX does not define for 'Attribute' "
        "(2 elements); known: AttributeDataType, ChangeMode, ID, Name, RefAttributeType, Unit",
    ),
    (
        classes('<SystemUnitClass Name="C" colour="red"/>'),
        "'Lib::C' has an attribute 'colour', which CAEX does not define for 'SystemUnitClass'; "
        "known: ChangeMode, ID, Name, RefBaseClassPath",
    ),
]


@pytest.mark.parametrize(("body", "message"), UNKNOWN)
def test_an_unknown_attribute_is_reported_once(body, message):
    reading = Read(body)
    assert reading.findings == [f"SM633: {message}"]


def test_the_class_of_an_interface_is_read_from_a_wrong_attribute_too():
    wrong = '<ExternalInterface Name="p" ID="2" RefBaseSystemUnitPath="Interfaces/Power"/>'
    reading = Read(interfaces('<InterfaceClass Name="Power"/>') + element_with(wrong))
    assert reading.targets("Plant::i::p", "typed-by") == ["Interfaces::Power"]
    assert reading.findings == [
        "SM633: 'Plant::i::p' has an attribute 'RefBaseSystemUnitPath', which CAEX does not define "
        "for 'ExternalInterface'; it is read as 'RefBaseClassPath'"
    ]
    right = wrong.replace("RefBaseSystemUnitPath", "RefBaseClassPath")
    reading = Read(interfaces('<InterfaceClass Name="Power"/>') + element_with(right))
    assert reading.targets("Plant::i::p", "typed-by") == ["Interfaces::Power"]
    assert reading.findings == []


def test_an_element_with_an_unknown_attribute_is_approximated():
    assert Read(element_with('<Attribute Name="a" Value="5"/>')).totals == {
        "mapped": 3,
        "approximated": 1,
    }


def test_attributes_of_other_namespaces_and_of_caex_are_not_reported():
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:type="T"'
    assert Read(element_with("").replace('ID="1"', f'ID="1" {xsi}')).findings == []
    assert Read(classes('<SystemUnitClass Name="C" ID="1" ChangeMode="state"/>')).findings == []
    any_xml = '<AdditionalInformation Tool="t"><Attribute Key="k"/></AdditionalInformation>'
    assert Read(element_with(any_xml)).findings == []


def test_an_unknown_attribute_after_a_namespace_declaration_is_reported():
    body = element_with("").replace('ID="1"', 'ID="1" xmlns="" colour="red"')
    reading = Read(body)
    assert [finding[:5] for finding in reading.findings] == ["SM633"]


TEXTS = [
    ("oops", "'Plant::i' contains the text 'oops'; CAEX allows no text in 'InternalElement'"),
    (
        '<Attribute Name="a">2.5</Attribute>',
        "'Plant::i::a' contains the text '2.5'; CAEX allows no text in 'Attribute'",
    ),
    (
        '<Attribute Name="a"/> and  more\n<Attribute Name="b"/>',
        "'Plant::i' contains the text 'and more'; CAEX allows no text in 'InternalElement'",
    ),
    (
        '<Attribute Name="a"><Constraint Name="c">x<UnknownType/></Constraint></Attribute>',
        "'Plant::i::a::c' contains the text 'x'; CAEX allows no text in 'Constraint'",
    ),
    (
        '<Attribute Name="a">1</Attribute><Attribute Name="b">2</Attribute>',
        "'Plant::i::a' contains the text '1' and 1 more like it; CAEX allows no text in "
        "'Attribute'",
    ),
]


@pytest.mark.parametrize(("body", "message"), TEXTS)
def test_text_in_an_element_without_text_is_reported(body, message):
    reading = Read(element_with(body))
    assert reading.findings == [f"SM634: {message}"]


@pytest.mark.parametrize(
    "body",
    [
        "\n  <Description>text</Description>\n",
        "<AdditionalInformation>text <b>and</b> more</AdditionalInformation>",
        "<!-- text -->",
        "<SourceObjectInformation OriginID='o'>text</SourceObjectInformation>",
    ],
)
def test_text_that_caex_allows_is_not_reported(body):
    reading = Read(element_with(body))
    assert reading.findings == []


def test_text_below_elements_that_hold_any_xml_needs_no_second_parse(monkeypatch):
    parsed = []
    monkeypatch.setattr(conformance, "parse", lambda source, _: parsed.append(source.name))
    header = "<WriterHeader><WriterName>us</WriterName><Constraint>c</Constraint></WriterHeader>"
    reading = Read(element_with(f"<AdditionalInformation>{header}</AdditionalInformation>"))
    assert (reading.findings, parsed) == ([], [])
    Read(element_with("oops"))
    assert parsed == ["plant.aml"]


def test_text_in_the_root_element_is_reported_at_the_file():
    reading = Read(aml("text" + types(""), form=CAEX_2))
    assert reading.findings == [
        "SM634: 'plant.aml' contains the text 'text'; CAEX allows no text in 'CAEXFile'"
    ]
