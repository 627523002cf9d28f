"""What AutomationML (IEC 62714-1) requires beyond the schema of CAEX."""

import pytest
from reading_caex import Read, aml, aml_2, classes, interfaces, plant, roles

INTERFACE = "AutomationMLInterfaceClassLib/AutomationMLBaseInterface"
ROLE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"


def robot(content):
    return plant(f'<InternalElement Name="robot" ID="1">{content}</InternalElement>')


def interface(path, content="", name="i"):
    names = f'Name="{name}" ID="{name}" RefBaseClassPath="{path}"'
    return f"<ExternalInterface {names}>{content}</ExternalInterface>"


def attribute(name, value):
    return f'<Attribute Name="{name}"><Value>{value}</Value></Attribute>'


# -- IDs -------------------------------------------------------------------------------------------


def test_an_id_that_two_files_have_is_reported_once_a_file():
    cell = '<InternalElement Name="{}" ID="7"/><InternalElement Name="belt" ID="8"/>'
    first, second = (
        aml(plant(cell.format("a"), "P1"), "a.aml"),
        aml('<ExternalReference Path="a.aml" Alias="A"/>' + plant(cell.format("b"), "P2"), "b.aml"),
    )
    reading = Read(first, second)
    assert reading.findings == [
        "SM341: the ID '7' of 'P2::b' is that of 'P1::a' in 'a.aml' too (1 more in the file)"
    ]
    assert {e.source for e in reading.find_all("P2::b")} == {"b.aml"}


def test_an_interface_of_caex_3_has_an_id_because_links_need_it():
    body = robot('<ExternalInterface Name="i"/>')
    assert Read(aml(body)).infos == ["SM146: 'Plant::robot::i' has no ID"]
    assert Read(aml_2(body)).infos == []


# -- base classes ----------------------------------------------------------------------------------


def test_a_role_class_specialises_the_base_role():
    gripper = '<RoleClass Name="Gripper"/><RoleClass Name="Vacuum" RefBaseClassPath="R/Gripper"/>'
    assert Read(roles(gripper + '<RoleClass Name="Axis"/>', "R") + robot("")).infos == [
        "SM342: the role class 'R::Gripper' does not specialise 'AutomationMLBaseRole' "
        "(1 more in the file)"
    ]
    derived = gripper.replace('"Gripper"/>', f'"Gripper" RefBaseClassPath="{ROLE}/Resource"/>', 1)
    assert Read(roles(derived, "R") + robot("")).infos == []


def test_an_interface_class_specialises_the_base_interface():
    plug = '<InterfaceClass Name="Plug"><InterfaceClass Name="Pin" {}/></InterfaceClass>'
    assert Read(interfaces(plug.format('RefBaseClassPath="Plug"')) + robot("")).infos == [
        "SM342: the interface class 'Interfaces::Plug' does not specialise "
        "'AutomationMLBaseInterface'"
    ]


def test_a_missing_base_class_is_reported_as_missing_only():
    gripper = '<RoleClass Name="Gripper" RefBaseClassPath="Gone/Base"/>'
    reading = Read(roles(gripper) + robot(""))
    assert [finding[:5] for finding in reading.findings] == ["SM131"]
    assert reading.infos == []


# -- interfaces to external data -------------------------------------------------------------------

DATA = f"{INTERFACE}/ExternalDataConnector"


@pytest.mark.parametrize("kind", ["", "/COLLADAInterface", "/PLCopenXMLInterface"])
def test_an_interface_to_external_data_has_an_address(kind):
    no_address = interface(DATA + kind)
    message = (
        "SM343: 'Plant::robot::i' is an interface to external data, but its attribute 'refURI' "
        "has no value"
    )
    assert Read(robot(no_address)).findings == [message]
    empty = interface(DATA + kind, '<Attribute Name="refURI"/>')
    assert Read(robot(empty)).findings == [message]
    right = interface(DATA + kind, attribute("refURI", "file:///robot.dae"))
    assert Read(robot(right)).findings == []


def test_the_class_may_give_the_address_and_need_none_itself():
    library = interfaces(
        f'<InterfaceClass Name="Shape" RefBaseClassPath="{DATA}/COLLADAInterface">'
        f"{attribute('refURI', 'file:///shape.dae')}</InterfaceClass>"
        f'<InterfaceClass Name="Open" RefBaseClassPath="{DATA}/COLLADAInterface"/>'
    )
    assert Read(library + robot(interface("Interfaces/Shape"))).findings == []
    unit = classes(f'<SystemUnitClass Name="C">{interface(DATA)}</SystemUnitClass>')
    assert Read(unit + robot("")).findings == []
    assert [f[:5] for f in Read(library + robot(interface("Interfaces/Open"))).findings] == [
        "SM343"
    ]


def test_an_interface_to_a_variable_of_a_program_needs_no_address():
    library = interfaces(
        '<InterfaceClass Name="AutomationMLBaseInterface"><InterfaceClass '
        'Name="ExternalDataConnector" RefBaseClassPath="AutomationMLBaseInterface">'
        '<InterfaceClass Name="PLCopenXMLInterface" RefBaseClassPath="ExternalDataConnector">'
        '<InterfaceClass Name="VariableInterface" RefBaseClassPath="PLCopenXMLInterface"/>'
        "</InterfaceClass></InterfaceClass></InterfaceClass>",
        "AutomationMLInterfaceClassLib",
    )
    tag = interface(f"{DATA}/PLCopenXMLInterface/VariableInterface")
    assert Read(library + robot(tag)).findings == []


# -- directions ------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["Port", "Order"])
def test_a_direction_is_in_out_or_inout(kind):
    wrong = interface(f"{INTERFACE}/{kind}", attribute("Direction", "left"))
    reading = Read(robot(wrong))
    assert reading.findings == [
        "SM344: the direction 'left' of 'Plant::robot::i' is none of In, Out and InOut, so it has "
        "no direction"
    ]
    assert reading.infos == []
    for value in ("In", "Out", "InOut", "in"):
        right = interface(f"{INTERFACE}/{kind}", attribute("Direction", value))
        assert Read(robot(right)).findings == []


def test_interfaces_without_direction_are_one_info_a_file():
    order = f"{INTERFACE}/Order"
    assert Read(robot(interface(order, name="i") + interface(order, name="j"))).infos == [
        "SM345: 'Plant::robot::i' is an interface of class 'Order', but its attribute 'Direction' "
        "has no value (1 more in the file)"
    ]


def test_an_interface_may_have_the_direction_of_its_class():
    library = interfaces(
        f'<InterfaceClass Name="Inlet" RefBaseClassPath="{INTERFACE}/Port">'
        f"{attribute('Direction', 'In')}</InterfaceClass>"
    )
    assert Read(library + robot(interface("Interfaces/Inlet"))).infos == []


def test_directions_of_other_interfaces_are_free():
    wind = interfaces(f'<InterfaceClass Name="Wind" RefBaseClassPath="{INTERFACE}"/>')
    vane = interface("Interfaces/Wind", attribute("Direction", "north"))
    assert Read(wind + robot(vane)).findings == []


# -- elements with the role Port -------------------------------------------------------------------

PORT_ROLE = f'<RoleRequirements RefBaseRoleClassPath="{ROLE}/Port"/>'


def test_a_port_has_an_interface():
    message = "SM346: 'Plant::robot' has the role 'Port', but no interface that a link can join"
    assert Read(aml_2(robot(PORT_ROLE))).findings == [message]
    joined = interface(f"{INTERFACE}/PortConnector") + PORT_ROLE
    assert Read(aml_2(robot(joined))).findings == []


def test_a_port_may_have_the_interface_of_its_class():
    unit = classes(
        f'<SystemUnitClass Name="C">{interface(f"{INTERFACE}/PortConnector")}</SystemUnitClass>'
    )
    port = robot(PORT_ROLE).replace('ID="1"', 'ID="1" RefBaseSystemUnitPath="Lib/C"')
    assert Read(aml_2(unit + port)).findings == []


def test_the_direction_of_a_port_element_is_checked_too():
    port = attribute("Direction", "up") + interface(f"{INTERFACE}/PortConnector") + PORT_ROLE
    assert [finding[:5] for finding in Read(aml_2(robot(port))).findings] == ["SM344"]
