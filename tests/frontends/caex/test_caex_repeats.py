"""Repeated names, interfaces of another class than that of the class, chains of mirrors."""

import pytest
from reading_caex import Read, classes, interfaces, plant, types

ONE = '<Attribute Name="a"><Value>1</Value></Attribute>'
TWO = '<Attribute Name="a"><Value>2</Value></Attribute>'
THREE = '<Attribute Name="a"><Value>3</Value></Attribute>'


def class_with(body, name="C"):
    return f'<SystemUnitClass Name="{name}">{body}</SystemUnitClass>'


def instance_with(body, path="Lib/C"):
    return plant(
        f'<InternalElement Name="i" ID="1" RefBaseSystemUnitPath="{path}">{body}</InternalElement>'
    )


PORT = f'<ExternalInterface Name="p" ID="2">{ONE}{TWO}</ExternalInterface>'
REPEATS = [
    (classes(class_with("") * 2), "'Lib' has two 'SystemUnitClass' elements named 'C'"),
    (classes("") * 2, "'plant.aml' has two 'SystemUnitClassLib' elements named 'Lib'"),
    (classes(class_with(ONE + TWO)), "'Lib::C' has two 'Attribute' elements named 'a'"),
    (
        classes(class_with(f'<Attribute Name="b">{ONE}{TWO}</Attribute>')),
        "'Lib::C::b' has two 'Attribute' elements named 'a'",
    ),
    (
        types(f'<AttributeType Name="T">{ONE}{TWO}</AttributeType>'),
        "'Types::T' has two 'Attribute' elements named 'a'",
    ),
    (
        classes(class_with(ONE)) + instance_with(TWO + THREE),
        "'Plant::i' has two 'Attribute' elements named 'a'",
    ),
    (
        classes(class_with(ONE)) + instance_with(ONE + ONE),
        "'Plant::i' has two 'Attribute' elements named 'a'",
    ),
    (
        classes(class_with(ONE.replace(">", ' ID="3">', 1) + TWO)),
        "'Lib::C' has two 'Attribute' elements named 'a'",
    ),
    (
        classes(class_with("", "C") + class_with("", 'C" ID="3')),
        "'Lib' has two 'SystemUnitClass' elements named 'C'",
    ),
    (instance_with(ONE + TWO, ""), "'Plant::i' has two 'Attribute' elements named 'a'"),
    (instance_with(PORT, ""), "'Plant::i::p' has two 'Attribute' elements named 'a'"),
]


@pytest.mark.parametrize(("body", "message"), REPEATS)
def test_a_repeated_name_is_reported(body, message):
    assert Read(body).findings == [f"SM635: {message}"]


ALONE = [
    classes(class_with(class_with("", "D")) + class_with("", "D")),
    classes(class_with(ONE) + class_with(ONE, "D")) + instance_with(TWO),
    classes(class_with("<Attribute Name='a'><Attribute Name='a'/></Attribute>")),
    plant('<InternalElement Name="i" ID="1"/><InternalElement Name="i" ID="2"/>'),
    classes("") + interfaces("", "Lib"),
    classes(class_with(ONE + class_with("", "a"))),
    instance_with(f"<AdditionalInformation><X>{ONE}{TWO}</X></AdditionalInformation>", ""),
]


@pytest.mark.parametrize("body", ALONE)
def test_a_name_in_two_scopes_is_not_reported(body):
    assert Read(body).findings == []


# -- interfaces of another class than that of the class --------------------------------------------

CLASSES = interfaces(
    '<InterfaceClass Name="Plug"/><InterfaceClass Name="Socket"/>'
    '<InterfaceClass Name="Safe plug" RefBaseClassPath="Interfaces/Plug"/>'
)


def interface(path, id, inside=""):
    stated = f' RefBaseClassPath="Interfaces/{path}"' if path else ""
    return f'<ExternalInterface Name="p" ID="{id}"{stated}>{inside}</ExternalInterface>'


@pytest.mark.parametrize("path", ["Socket", "Safe plug"])
@pytest.mark.parametrize("inside", ["", ONE], ids=["plain", "with values"])
def test_an_interface_of_another_class_is_a_port_of_its_own(path, inside):
    body = classes(class_with(interface("Plug", "c"))) + instance_with(interface(path, "i", inside))
    reading = Read(CLASSES + body)
    assert reading.findings == []
    assert reading.find("Plant::i::p").id == "i"
    assert reading.targets("Plant::i::p", "typed-by") == [f"Interfaces::{path}"]
    assert reading.targets("Plant::i::p", "redefines") == ["Lib::C::p"]


@pytest.mark.parametrize("path", ["Plug", "Safe plug", ""])
def test_an_interface_with_the_inherited_class_or_a_more_general_one_is_inherited(path):
    body = classes(class_with(interface("Safe plug", "c"))) + instance_with(interface(path, "i"))
    reading = Read(CLASSES + body)
    assert reading.findings == []
    assert reading.find_all("Plant::i::p") == []
    assert reading.find("Plant::i").attrs["interface_ids"] == (("c", "i"),)


def test_a_link_to_an_interface_of_another_class_leads_to_its_own_port():
    link = '<InternalLink Name="l" RefPartnerSideA="i" RefPartnerSideB="j"/>'
    other = interface("Plug", "j").replace('"p"', '"q"')
    body = classes(class_with(interface("Plug", "c")))
    reading = Read(CLASSES + body + instance_with(interface("Socket", "i") + other + link))
    assert reading.links() == {"l": ("p", "q")}
    assert [port.id for port in reading.find_all("Plant::i::p")] == ["i"]


def mirror(id, master):
    return f'<InternalElement Name="{id}" ID="{id}" RefBaseSystemUnitPath="{master}"/>'


@pytest.mark.parametrize("ids", ["abcd", "dcba", "cbad"])
def test_each_mirror_that_leads_into_a_cycle_is_reported_with_its_master(ids):
    """In any order of the mirrors; b and c are the cycle."""
    masters = {"a": "b", "b": "c", "c": "b", "d": "a"}
    reading = Read(plant("".join(mirror(id, masters[id]) for id in ids)))
    assert reading.findings == [
        f"SM143: '{id}' is a mirror of itself, through '{masters[id]}'" for id in ids
    ]


@pytest.mark.parametrize("ids", ["abcd", "dcba", "bdac"])
def test_each_mirror_of_a_chain_without_end_is_reported_with_the_missing_master(ids):
    masters = {"a": "b", "b": "c", "c": "gone", "d": "e"}
    gone = f"{'0' * 8}-{'0' * 4}-{'0' * 4}-{'0' * 4}-{'0' * 12}"
    chain = "".join(mirror(id, masters[id].replace("gone", gone)) for id in ids)
    reading = Read(plant(chain + '<InternalElement Name="e" ID="e"/>'))
    unresolved = [id for id in ids if id != "d"]
    assert reading.findings == [
        f"SM138: '{id}' is a mirror of '{gone}', which does not exist" for id in unresolved
    ]
    assert reading.targets("Plant::d", "mirrors") == ["Plant::e"]
