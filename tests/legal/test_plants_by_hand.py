"""Plants that AutomationML allows and that were once judged wrongly, with faulty neighbours."""

import pytest

from examples.compiling import compile_text

ROLE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"
PORT = "AutomationMLInterfaceClassLib/AutomationMLBaseInterface/Port"
DOCUMENT = """\
<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">
  <SuperiorStandardVersion>AutomationML 2.10</SuperiorStandardVersion>
  <SourceDocumentInformation OriginName="us" OriginID="1" OriginVersion="1"
    LastWritingDateTime="2024-01-01T00:00:00Z"/>
  <InstanceHierarchy Name="Plant">{plant}</InstanceHierarchy>
  <RoleClassLib Name="Roles">
    <RoleClass Name="Sensor" RefBaseClassPath="{role}">
      <Attribute Name="range" AttributeDataType="xs:double"/>
      <ExternalInterface Name="signal" ID="role-port" RefBaseClassPath="{port}"/>
    </RoleClass>
    <RoleClass Name="Other" RefBaseClassPath="{role}">
      <ExternalInterface Name="signal" ID="other-port" RefBaseClassPath="{port}"/>
    </RoleClass>
  </RoleClassLib>
  <SystemUnitClassLib Name="Units">{units}</SystemUnitClassLib>
</CAEXFile>
"""


def list_findings(folder, plant, units=""):
    """Return errors and warnings about a plant with the role Sensor and the given classes."""
    text = DOCUMENT.format(plant=plant, units=units, role=ROLE, port=PORT)
    compilation = compile_text(folder, "plant.aml", text.encode())
    return [
        f"{diagnostic.rule.code}: {diagnostic.message}"
        for diagnostic in compilation.diagnostics
        if diagnostic.severity != "info"
    ]


# -- mapping objects ---------------------------------------------------------------------------


def map_attribute(own, offered="range"):
    return f"""\
      <MappingObject>
        <AttributeNameMapping SystemUnitAttributeName="{own}" RoleAttributeName="{offered}"/>
      </MappingObject>
"""


PROBE = """\
<SystemUnitClass Name="Probe">
  <Attribute Name="span" AttributeDataType="xs:double"><Value>1</Value></Attribute>
</SystemUnitClass>
<SystemUnitClass Name="Long probe" RefBaseClassPath="Units/Probe">{role}</SystemUnitClass>
"""


@pytest.mark.parametrize("unit", ["Probe", "Long probe"])
@pytest.mark.parametrize("depth", [0, 1])
def test_an_instance_maps_an_attribute_of_its_class(unit, depth, tmp_path):
    plant = f"""\
<InternalElement Name="p" ID="p" RefBaseSystemUnitPath="Units/{unit}">
  <RoleRequirements RefBaseRoleClassPath="Roles/Sensor">{map_attribute("span")}</RoleRequirements>
</InternalElement>
"""
    if depth:
        plant = f'<InternalElement Name="cell" ID="cell">{plant}</InternalElement>'
    assert list_findings(tmp_path, plant, PROBE.format(role="")) == []


def test_a_class_maps_an_attribute_that_it_inherits(tmp_path):
    role = f"""\
<SupportedRoleClass RefRoleClassPath="Roles/Sensor">{map_attribute("span")}</SupportedRoleClass>
"""
    assert list_findings(tmp_path, "", PROBE.format(role=role)) == []


def test_an_element_maps_a_nested_attribute(tmp_path):
    plant = f"""\
<InternalElement Name="p" ID="p">
  <Attribute Name="data"><Attribute Name="span" AttributeDataType="xs:double"/></Attribute>
  <RoleRequirements RefBaseRoleClassPath="Roles/Sensor">
    {map_attribute("data.span")}
  </RoleRequirements>
</InternalElement>
"""
    assert list_findings(tmp_path, plant) == []


def test_a_mapping_of_an_attribute_that_the_role_lacks_is_an_error(tmp_path):
    plant = f"""\
<InternalElement Name="p" ID="p" RefBaseSystemUnitPath="Units/Probe">
  <RoleRequirements RefBaseRoleClassPath="Roles/Sensor">
    {map_attribute("span", "reach")}
  </RoleRequirements>
</InternalElement>
"""
    assert list_findings(tmp_path, plant, PROBE.format(role="")) == [
        "SM144: a mapping object of 'p' names 'reach', which does not exist"
    ]


# -- interfaces --------------------------------------------------------------------------------

CARDINALITY = """\
<Attribute Name="Cardinality">
  <Attribute Name="MinOccur" AttributeDataType="xs:unsignedInt"><Value>0</Value></Attribute>
  <Attribute Name="MaxOccur" AttributeDataType="xs:unsignedInt"><Value>{upper}</Value></Attribute>
</Attribute>
"""


def mapped_port(offered):
    """Return an element with an interface of cardinality 0..3 that maps one of a role."""
    return f"""\
<InternalElement Name="p" ID="p">
  <ExternalInterface Name="s" ID="s" RefBaseClassPath="{PORT}">
    {CARDINALITY.format(upper=3)}
  </ExternalInterface>
  <RoleRequirements RefBaseRoleClassPath="Roles/Sensor">
    <MappingObject>
      <InterfaceIDMapping SystemUnitInterfaceID="s" RoleInterfaceID="{offered}"/>
    </MappingObject>
  </RoleRequirements>
</InternalElement>
"""


def test_an_interface_without_cardinality_limits_no_interface_that_maps_it(tmp_path):
    assert list_findings(tmp_path, mapped_port("role-port")) == []


def test_a_mapping_to_an_interface_of_another_role_is_reported(tmp_path):
    assert list_findings(tmp_path, mapped_port("other-port")) == [
        "SM202: 'Plant::p::s' redefines 'Roles::Other::signal', but 'p' does not inherit from "
        "'Other'"
    ]


@pytest.mark.parametrize(
    ("general", "findings"),
    [
        ("", []),
        (
            CARDINALITY.format(upper=2),
            [
                "SM204: 'Units::Special::s' with multiplicity 0..3 redefines 'Units::General::s' "
                "with 0..2"
            ],
        ),
    ],
)
def test_a_class_narrows_only_a_cardinality_that_is_stated(general, findings, tmp_path):
    interface = '<ExternalInterface Name="s" ID="{id}" RefBaseClassPath="{port}">{inner}'
    units = "".join(
        f'<SystemUnitClass Name="{name}"{base}>'
        f"{interface.format(id=name, port=PORT, inner=inner)}</ExternalInterface></SystemUnitClass>"
        for name, base, inner in (
            ("General", "", general),
            ("Special", ' RefBaseClassPath="Units/General"', CARDINALITY.format(upper=3)),
        )
    )
    assert list_findings(tmp_path, "", units) == findings


NESTED = f"""\
<InternalElement Name="cell" ID="cell">
  <InternalElement Name="a" ID="a">
    <ExternalInterface Name="plug" ID="plug-a" RefBaseClassPath="{PORT}">
      <ExternalInterface Name="pin" ID="pin-a" RefBaseClassPath="{PORT}"/>
    </ExternalInterface>
  </InternalElement>
  <InternalElement Name="b" ID="b">
    <ExternalInterface Name="plug" ID="plug-b" RefBaseClassPath="{PORT}">
      <ExternalInterface Name="pin" ID="pin-b" RefBaseClassPath="{PORT}"/>
    </ExternalInterface>
  </InternalElement>
  <InternalLink Name="wire" RefPartnerSideA="pin-a" RefPartnerSideB="pin-b"/>
</InternalElement>
"""


def test_a_link_joins_nested_interfaces(tmp_path):
    assert list_findings(tmp_path, NESTED) == []


def test_a_link_to_a_nested_interface_that_does_not_exist_is_an_error(tmp_path):
    assert list_findings(tmp_path, NESTED.replace('"pin-b"/>\n</I', '"pin-c"/>\n</I')) == [
        "SM135: link 'wire': its side B refers to 'pin-c', and it names no interface"
    ]
