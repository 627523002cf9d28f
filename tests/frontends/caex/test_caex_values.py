"""Values that are not of their data type, and unknown data types."""

import pytest
from reading_caex import Read, classes, interfaces, plant, types

from sysmlc.frontends.caex.data_types import convert_leniently, find_converter

VALUES = {
    "double": (["1.5", "-2e3", " 7 ", "INF", "NaN"], ["two", "1,5", "1 m", "infinity", "1_0"]),
    "float": (["0"], ["0x1"]),
    "decimal": (["1.50", "-.5", "+3."], ["1e3", "INF"]),
    "integer": (["7", "-3", "+0", str(10**30)], ["7.0", "1_0", "seven"]),
    "nonNegativeInteger": (["0"], ["-1"]),
    "positiveInteger": (["1"], ["0"]),
    "negativeInteger": (["-1"], ["0"]),
    "byte": (["-128", "127"], ["128"]),
    "unsignedByte": (["255"], ["256", "-1"]),
    "int": (["2147483647"], ["2147483648"]),
    "boolean": (["true", "0", " false "], ["True", "yes", "2"]),
    "dateTime": (
        ["2026-11-21T13:00:00", "2026-11-21T24:00:00.0Z", "-0044-03-15T12:00:00+01:00"],
        ["2026-11-21", "2026-11-21 13:00:00", "2026-13-01T00:00:00", "2026-11-21T25:00:00"],
    ),
    "date": (["2026-11-21", "2026-11-21Z"], ["21.11.2026", "2014"]),
    "time": (["13:00:00.5"], ["13:00"]),
    "duration": (["P1Y2M3DT4H5M6.7S", "-PT5S", "P3D"], ["5 s", "P", "PT", "P1S"]),
    "gYear": (["2026"], ["26"]),
    "hexBinary": (["", "0aFF"], ["0a0", "xy"]),
    "base64Binary": (["aGk=", "aGFsbG8="], ["?"]),
    "language": (["de-AT"], ["German (Austria)"]),
}
VALID = [(name, text) for name, (good, _) in VALUES.items() for text in good]
INVALID = [(name, text) for name, (_, bad) in VALUES.items() for text in bad]


@pytest.mark.parametrize(("name", "text"), [pair for pair in VALID if pair[1]])
def test_values_of_the_data_type_are_converted(name, text):
    assert is_value(name, text)


def is_value(name, text):
    try:
        find_converter(f"xs:{name}")(text)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize(("name", "text"), INVALID)
def test_other_texts_are_no_values_of_the_data_type(name, text):
    assert not is_value(name, text)


@pytest.mark.parametrize("name", ["string", "anyURI", "ID", "token", "no such type", ""])
def test_any_text_is_a_value_of_the_other_types(name):
    assert find_converter(f"xs:{name}" if name else "") is None


@pytest.mark.parametrize(
    ("text", "data_type", "value"),
    [("True", "xs:boolean", True), ("300", "xs:byte", 300), ("1e3", "xs:decimal", 1000.0)],
)
def test_other_texts_are_converted_leniently(text, data_type, value):
    assert convert_leniently(text, data_type) == value


def attribute(data_type, text, more="", tag="Value"):
    stated = f' AttributeDataType="{data_type}"' if data_type else ""
    return f'<Attribute Name="a"{stated}{more}><{tag}>{text}</{tag}></Attribute>'


def class_with(body):
    return classes(f'<SystemUnitClass Name="C">{body}</SystemUnitClass>')


def instance_with(body):
    element = f'<InternalElement Name="i" ID="1" RefBaseSystemUnitPath="Lib/C">{body}'
    return class_with(attribute("xs:double", "1")) + plant(f"{element}</InternalElement>")


INVALID_DOUBLE = ["SM631: the value 'two' of 'a' is not a valid xs:double"]
LENGTH = types('<AttributeType Name="L" AttributeDataType="xs:double"/>')


@pytest.mark.parametrize(
    "body",
    [
        class_with(attribute("xs:double", "two")),
        class_with(attribute("xs:double", "two", tag="DefaultValue")),
        class_with(f'<Attribute Name="b">{attribute("xs:double", "two")}</Attribute>'),
        instance_with(attribute("xs:double", "two")),
        instance_with(attribute("", "two")),
        LENGTH + class_with(attribute("", "two", ' RefAttributeType="Types/L"')),
    ],
    ids=["class", "default", "inner", "instance", "type-of-class", "type-of-attribute-type"],
)
def test_an_invalid_value_is_reported(body):
    assert Read(body).findings == INVALID_DOUBLE
    assert Read(body.replace("two", "2")).findings == []


def test_an_invalid_value_is_reported_at_its_attribute():
    body = instance_with(attribute("", "two"))
    (diagnostic,) = (finding for finding in Read(body).sink if finding.rule.code == "SM631")
    assert diagnostic.subject.place.ordinal == 7
    assert diagnostic.subject.name == "Plant::i::a"


def test_an_invalid_value_is_reported_once_a_file():
    reading = Read(
        class_with(attribute("xs:double", "two"))
        + plant(
            "".join(
                f'<InternalElement Name="i{n}" ID="{n}">{attribute("xs:double", "two")}'
                "</InternalElement>"
                for n in range(3)
            )
        )
    )
    assert reading.findings == ["SM631: the value 'two' of 'a' and 3 more is not a valid xs:double"]
    assert reading.find("Lib::C::a").attrs["default"] == "two"


def test_values_of_attribute_types_are_checked():
    values = "<DefaultValue>1</DefaultValue><Value>two</Value>"
    reading = Read(LENGTH.replace("/>", f">{values}</AttributeType>"))
    assert reading.findings == ["SM631: the value 'two' of 'L' is not a valid xs:double"]
    attrs = reading.find("Types::L").attrs
    assert (attrs["default"], attrs["default_value"]) == ("two", "1")
    reading = Read(LENGTH.replace("/>", "><DefaultValue>1</DefaultValue></AttributeType>"))
    assert reading.find("Types::L").attrs["default"] == 1.0


def test_an_empty_value_is_not_reported():
    assert Read(class_with(attribute("xs:double", ""))).findings == []


def test_values_of_interfaces_and_bounds_are_checked():
    port = f'<InterfaceClass Name="P">{attribute("xs:int", "two")}</InterfaceClass>'
    used = class_with(
        '<ExternalInterface Name="p" RefBaseClassPath="Interfaces/P">'
        f"{attribute('xs:int', '2.5')}</ExternalInterface>"
    )
    assert Read(interfaces(port) + used).findings == [
        "SM631: the value 'two' of 'a' is not a valid xs:int",
        "SM631: the value '2.5' of 'a' is not a valid xs:int",
    ]
    bound = (
        '<Attribute Name="a" AttributeDataType="xs:int"><Constraint Name="few">'
        "<OrdinalScaledType><RequiredMaxValue>many</RequiredMaxValue></OrdinalScaledType>"
        "</Constraint></Attribute>"
    )
    assert Read(class_with(bound)).findings == [
        ("SM631: the value 'many' of 'few' is not a valid xs:int")
    ]


@pytest.mark.parametrize(
    ("data_type", "hint"),
    [
        ("xs:datetime", "did you mean 'xs:dateTime'?"),
        ("xs:complexType", "its values count as text"),
        ("Integer", "did you mean 'xs:integer'?"),
    ],
)
def test_an_unknown_data_type_is_reported(data_type, hint):
    assert Read(class_with(attribute(data_type, "x"))).findings == [
        f"SM632: the data type '{data_type}' of 'a' is not defined by XML Schema; {hint}"
    ]


@pytest.mark.parametrize("data_type", ["xs:dateTime", "xsd:string", "anyURI", "xs:IDREF"])
def test_a_data_type_of_xml_schema_is_known_with_any_prefix(data_type):
    body = class_with(attribute(data_type, "2026-11-21T13:00:00"))
    assert Read(body).findings == []
