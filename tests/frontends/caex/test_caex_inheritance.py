"""What instances have from their classes: directions of interfaces, scales, mapped attributes."""

import pytest
from reading_caex import Read, classes, interfaces, plant, roles, types

from sysmlc.driver import Request, compile_model
from sysmlc.ir import Edge, Kind

BASE = "AutomationMLInterfaceClassLib/AutomationMLBaseInterface/Port"


def direction(value):
    return f'<Attribute Name="Direction"><Value>{value}</Value></Attribute>'


def interface(name, path, content="", id=""):
    head = f'<ExternalInterface Name="{name}" ID="{id or name}" RefBaseClassPath="{path}"'
    return f"{head}>{content}</ExternalInterface>"


TERMINALS = interfaces(
    f'<InterfaceClass Name="Input" RefBaseClassPath="{BASE}">{direction("In")}</InterfaceClass>'
    f'<InterfaceClass Name="Output" RefBaseClassPath="{BASE}">{direction("Out")}</InterfaceClass>'
    '<InterfaceClass Name="Fast" RefBaseClassPath="Terminals/Input"/>',
    "Terminals",
)


# -- directions ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "own", "expected"),
    [
        ("Terminals/Input", "", "in"),
        ("Terminals/Output", "", "out"),
        ("Terminals/Fast", "", "in"),
        ("Terminals/Input", direction("InOut"), "inout"),
    ],
)
def test_an_interface_has_the_direction_of_its_class(path, own, expected):
    block = f'<SystemUnitClass Name="Valve">{interface("X", path, own)}</SystemUnitClass>'
    reading = Read(classes(block) + TERMINALS)
    assert reading.find("Lib::Valve::X").attrs["direction"] == expected


def test_an_overriding_interface_has_the_direction_of_the_one_it_overrides():
    nested = interface("Inner", BASE)
    valve = interface("X", "Terminals/Input", direction("Out"))
    fast = interface("X", "Terminals/Input", nested, "X2")
    reading = Read(
        classes(
            f'<SystemUnitClass Name="Valve">{valve}</SystemUnitClass>'
            f'<SystemUnitClass Name="Fast" RefBaseClassPath="Lib/Valve">{fast}</SystemUnitClass>'
        )
        + TERMINALS
    )
    assert reading.find("Lib::Fast::X", Kind.PORT).attrs["direction"] == "out"


def test_a_link_against_the_directions_names_the_instances(tmp_path):
    block = (
        f'<SystemUnitClass Name="Valve">{interface("X", "Terminals/Input", id="C")}'
        "</SystemUnitClass>"
    )
    elements = "".join(
        f'<InternalElement Name="{name}" ID="{name}" RefBaseSystemUnitPath="Lib/Valve">'
        f"{interface('X', 'Terminals/Input', id=f'{name}X')}</InternalElement>"
        for name in ("V1", "V2")
    )
    link = '<InternalLink Name="L" RefPartnerSideA="V1X" RefPartnerSideB="V2X"/>'
    sheet = f'<InternalElement Name="Sheet" ID="S">{elements}{link}</InternalElement>'
    model = tmp_path / "plant.aml"
    model.write_text(
        '<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">'
        f"{plant(sheet)}{classes(block)}{TERMINALS}</CAEXFile>"
    )
    messages = [d.message for d in compile_model(Request((model,), backends=())).diagnostics]
    assert (
        "connector 'Plant::Sheet::L' joins in 'Plant::Sheet::V1::X' with in 'Plant::Sheet::V2::X'"
        in messages
    )


# -- scales ----------------------------------------------------------------------------------------


def attribute(value, scale="", type=""):
    constraint = f'<Constraint Name="range">{scale}</Constraint>' if scale else ""
    path = f' RefAttributeType="{type}"' if type else ""
    return (
        f'<Attribute Name="level" AttributeDataType="xs:double"{path}>'
        f"<Value>{value}</Value>{constraint}</Attribute>"
    )


PERCENT = (
    "<OrdinalScaledType><RequiredMaxValue>100</RequiredMaxValue>"
    "<RequiredMinValue>0</RequiredMinValue></OrdinalScaledType>"
)
STEPS = (
    "<NominalScaledType><RequiredValue>1</RequiredValue><RequiredValue>2.5</RequiredValue>"
    "</NominalScaledType>"
)


def list_scale_findings(attributes, *libraries, reference=""):
    element = f'<InternalElement Name="Tank" ID="T"{reference}>{attributes}</InternalElement>'
    reading = Read(plant(element) + "".join(libraries))
    return [d.message for d in reading.sink if d.rule.code == "SM491"]


@pytest.mark.parametrize(("scale", "value"), [(PERCENT, "0"), (PERCENT, "1e2"), (STEPS, "2.50")])
def test_a_value_on_its_scale_is_no_finding(scale, value):
    assert list_scale_findings(attribute(value, scale)) == []


@pytest.mark.parametrize(
    ("scale", "value", "fault"),
    [
        (PERCENT, "120.0", "not at most 100"),
        (PERCENT, "-1", "not at least 0"),
        (STEPS, "2", "none of 1, 2.5"),
    ],
)
def test_a_value_outside_its_scale_is_a_finding(scale, value, fault):
    assert list_scale_findings(attribute(value, scale)) == [
        f"the value '{value}' of 'level' is {fault}, which its constraint 'range' requires"
    ]


def test_the_scale_of_an_attribute_type_counts():
    scale = f'<Constraint Name="range">{PERCENT}</Constraint>'
    library = types(f'<AttributeType Name="Percent">{scale}</AttributeType>')
    assert len(list_scale_findings(attribute("120", type="Types/Percent"), library)) == 1


def test_the_scale_in_the_class_of_an_instance_counts():
    library = classes(f'<SystemUnitClass Name="Tank">{attribute("50", PERCENT)}</SystemUnitClass>')
    reference = ' RefBaseSystemUnitPath="Lib/Tank"'
    assert len(list_scale_findings(attribute("120"), library, reference=reference)) == 1
    assert list_scale_findings(attribute("70"), library, reference=reference) == []


# -- property sets ---------------------------------------------------------------------------------

SETS = roles(
    '<RoleClass Name="Electric" RefBaseClassPath="AutomationMLBaseRoleClassLib/'
    'AutomationMLBaseRole/PropertySet"><Attribute Name="Power"/></RoleClass>'
    '<RoleClass Name="Drive"><Attribute Name="Power"/></RoleClass>',
    "Sets",
)


def motor(role, name="Leistung"):
    mapping = f'<AttributeNameMapping SystemUnitAttributeName="{name}" RoleAttributeName="Power"/>'
    return plant(
        '<InternalElement Name="Motor" ID="M"><Attribute Name="Leistung"/>'
        '<InternalElement Name="Electrics" ID="E">'
        f'<RoleRequirements RefBaseRoleClassPath="Sets/{role}"><MappingObject>{mapping}'
        "</MappingObject></RoleRequirements></InternalElement></InternalElement>"
    )


def test_a_property_set_maps_attributes_of_the_element_around_it(tmp_path):
    reading = Read(motor("Electric") + SETS)
    own_attribute = reading.find("Plant::Motor::Leistung", Kind.PROPERTY)
    targets = reading.graph.targets(own_attribute, Edge.REDEFINES)
    assert [reading.graph.qualified_name(target) for target in targets] == ["Sets::Electric::Power"]
    assert reading.findings == []


@pytest.mark.parametrize(("role", "name"), [("Electric", "Missing"), ("Drive", "Leistung")])
def test_other_mappings_of_attributes_that_the_element_lacks_are_errors(role, name):
    (finding,) = Read(motor(role, name) + SETS).findings
    assert finding.startswith(f"SM144: a mapping object of 'Electrics' names '{name}'")
