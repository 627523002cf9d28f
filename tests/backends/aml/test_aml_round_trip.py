"""A graph that is saved as CAEX is read back as the same graph."""

import pytest
from aml_files import IGNORED, attrs_of, parse_file, read, refine, round_trip, save
from plant_structure import count_structure

from examples.compiling import EXAMPLES, compile_example
from graph_differences import diff
from sysmlc.sources import Source

PLANT = """<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">
<Description>A gate</Description>
<SuperiorStandardVersion>AutomationML 2.10</SuperiorStandardVersion>
<SourceDocumentInformation OriginName="us" OriginID="u" OriginVersion="1"
 LastWritingDateTime="2024-01-01T00:00:00Z"/>
<InstanceHierarchy Name="Plant"><Version>3</Version>
  <InternalElement Name="line" ID="line" RefBaseSystemUnitPath="Lib/Line">
    <Attribute Name="size"><Attribute Name="w"><Value>3</Value></Attribute></Attribute>
    <ExternalInterface Name="in" ID="line-in" RefBaseClassPath="Ports/Port"/>
    <ExternalInterface Name="side" ID="line-side">
      <Attribute Name="width" Unit="mm"><Value>5</Value></Attribute></ExternalInterface>
    <InternalElement Name="belt" ID="belt" RefBaseSystemUnitPath="Lib/Belt">
      <Attribute Name="speed"><Description>measured</Description><Value>2.5</Value></Attribute>
      <ExternalInterface Name="out" ID="belt-out" RefBaseClassPath="Ports/Port"/>
    </InternalElement>
    <InternalElement Name="own" ID="own">
      <Attribute Name="mode" AttributeDataType="xs:string"><Value>auto</Value></Attribute>
      <ExternalInterface Name="p" ID="own-p" RefBaseClassPath="Ports/Port">
        <Attribute Name="Direction"><Value>Out</Value></Attribute>
        <Attribute Name="Cardinality"><Attribute Name="MinOccur"><Value>0</Value></Attribute>
          <Attribute Name="MaxOccur"><Value>2</Value></Attribute></Attribute>
        <Attribute Name="colour"><Value>red</Value></Attribute>
        <Attribute Name="pressure" AttributeDataType="xs:float" Unit="bar">
          <Description>at rest</Description><DefaultValue>5</DefaultValue><Value>6</Value>
          <RefSemantic CorrespondingAttributePath="IRDI:p"/></Attribute>
        <ExternalInterface Name="inner" ID="own-p-inner" RefBaseClassPath="Ports/Port"/>
      </ExternalInterface>
      <RoleRequirements RefBaseRoleClassPath="Roles/Mover">
        <MappingObject><AttributeNameMapping SystemUnitAttributeName="mode"
          RoleAttributeName="operation"/></MappingObject>
      </RoleRequirements>
    </InternalElement>
    <InternalElement Name="again" ID="again" RefBaseSystemUnitPath="belt"/>
    <InternalElement Name="view" ID="view">
      <Attribute Name="seen" RefAttributeType="own/mode"/>
      <ExternalInterface Name="in" ID="view-in" RefBaseClassPath="line-in"/>
      <RoleRequirements RefBaseRoleClassPath="Roles/View"/>
    </InternalElement>
    <InternalElement Name="all" ID="all">
      <Attribute Name="AssociatedFacet"><Value>view</Value></Attribute>
      <InternalElement Name="the belt" ID="all-belt" RefBaseSystemUnitPath="belt"/>
      <RoleRequirements RefBaseRoleClassPath="%s/Group"/>
    </InternalElement>
    <InternalLink Name="l" RefPartnerSideA="line-in" RefPartnerSideB="belt-out"/>
    <InternalLink Name="m" RefPartnerSideA="own-p-inner" RefPartnerSideB="belt-out"/>
    <InternalLink Name="open" RefPartnerSideA="line-in" RefPartnerSideB=""/>
    <InternalLink Name="free" RefPartnerSideA="line-in" RefPartnerSideB="connection A0"/>
  </InternalElement>
  <InternalElement Name="lost" ID="lost" RefBaseSystemUnitPath="Lib/Gone"/>
</InstanceHierarchy>
<InterfaceClassLib Name="Ports"><InterfaceClass Name="Port"/></InterfaceClassLib>
<RoleClassLib Name="Roles"><RoleClass Name="Mover"><Attribute Name="operation"/></RoleClass>
  <RoleClass Name="View" RefBaseClassPath="%s/Facet"/>
</RoleClassLib>
<SystemUnitClassLib Name="Lib">
  <SystemUnitClass Name="A/B"><Attribute Name="x"/></SystemUnitClass>
  <SystemUnitClass Name="Belt" RefBaseClassPath="[Lib]/[A/B]">
    <Attribute Name="speed" AttributeDataType="xs:double" Unit="m/s" RefAttributeType="Types/Speed">
      <DefaultValue>1.0</DefaultValue><RefSemantic CorrespondingAttributePath="IRDI:speed"/>
      <Constraint Name="bounds"><OrdinalScaledType><RequiredMaxValue>5</RequiredMaxValue>
        <RequiredMinValue>0.5</RequiredMinValue></OrdinalScaledType></Constraint>
      <Constraint Name="free"><UnknownType><Requirements>not too fast</Requirements></UnknownType>
      </Constraint>
    </Attribute>
    <ExternalInterface Name="out" ID="b-out" RefBaseClassPath="Ports/Port"/>
  </SystemUnitClass>
  <SystemUnitClass Name="Line">
    <Description>Moves</Description><Copyright>us</Copyright>
    <Revision><RevisionDate>2024-01-01T00:00:00Z</RevisionDate><AuthorName>A</AuthorName></Revision>
    <AdditionalInformation Tool="x"><Inner Key="k">text</Inner></AdditionalInformation>
    <SourceObjectInformation OriginID="u" SourceObjID="7"/>
    <Attribute Name="size"><Attribute Name="w" AttributeDataType="xs:double"><Value>1</Value>
    </Attribute></Attribute>
    <ExternalInterface Name="in" ID="l-in" RefBaseClassPath="Ports/Port"/>
    <ExternalInterface Name="side" ID="l-side" RefBaseClassPath="Ports/Port"/>
    <InternalElement Name="belt" ID="l-belt" RefBaseSystemUnitPath="Lib/Belt">
      <ExternalInterface Name="out" ID="l-belt-out" RefBaseClassPath="Ports/Port"/>
    </InternalElement>
    <SupportedRoleClass RefRoleClassPath="Roles/Mover"/>
    <InternalLink Name="inside" RefPartnerSideA="l-in" RefPartnerSideB="l-belt-out"/>
    <SystemUnitClass Name="Nested" RefBaseClassPath="Line">
      <InternalElement Name="line" ID="n-line" RefBaseSystemUnitPath="Lib/Line">
        <InternalElement Name="belt" ID="n-belt"><Description>slow</Description></InternalElement>
      </InternalElement>
    </SystemUnitClass>
  </SystemUnitClass>
</SystemUnitClassLib>
<AttributeTypeLib Name="Types">
  <AttributeType Name="Speed" AttributeDataType="xs:double" Unit="m/s"/>
  <AttributeType Name="Mode" AttributeDataType="xs:string"><Constraint Name="c"><NominalScaledType>
    <RequiredValue>auto</RequiredValue><RequiredValue>hand</RequiredValue></NominalScaledType>
  </Constraint></AttributeType>
</AttributeTypeLib>
</CAEXFile>""" % (("AutomationMLBaseRoleClassLib/AutomationMLBaseRole",) * 2)


@pytest.fixture(scope="module")
def plant():
    return read(Source("plant.aml", PLANT.encode()))


def test_a_plant_is_read_back_without_differences(plant):
    assert len(plant) > 70
    texts, _, changes = round_trip(plant)
    assert list(texts) == ["aml/plant.aml"]
    assert changes == []


def test_a_plant_is_saved_without_losses(plant):
    assert save(plant)[1] == []


def test_saving_twice_gives_the_same_bytes(plant):
    texts, back, _ = round_trip(plant)
    assert save(back)[0] == texts


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('Name="speed"', 'Name="pace"'),
        ('RefPartnerSideB="belt-out"', 'RefPartnerSideB="own-p"'),
        ("<Value>2.5</Value>", "<Value>2.6</Value>"),
        ('RefAttributeType="Types/Speed"', ""),
        ("<Value>Out</Value>", "<Value>In</Value>"),
        (">not too fast<", ">fast<"),
    ],
)
def test_the_comparison_sees_a_difference(plant, old, new):
    (text,) = save(plant)[0].values()
    assert old in text
    back = read(Source("plant.aml", text.replace(old, new).encode()))
    assert diff(plant, back, IGNORED) != []


def test_ids_are_written_unchanged(plant):
    texts, _ = save(plant)
    ids = set(parse_file({"": PLANT}).xpath("//@ID")) - {"view-in", "all-belt"}
    assert ids <= set(parse_file(texts).xpath("//@ID"))
    assert attrs_of(texts, "//InternalLink[@Name='m']") == {
        "Name": "m",
        "RefPartnerSideA": "own-p-inner",
        "RefPartnerSideB": "belt-out",
    }


def test_paths_have_brackets_only_where_a_name_needs_them(plant):
    texts, _ = save(plant)
    assert attrs_of(texts, "//SystemUnitClass[@Name='Belt']")["RefBaseClassPath"] == "[Lib]/[A/B]"
    element = attrs_of(texts, "//InternalElement[@ID='belt']")
    assert element["RefBaseSystemUnitPath"] == "Lib/Belt"


def test_unresolved_references_are_written_unchanged(plant):
    texts, _ = save(plant)
    assert attrs_of(texts, "//InternalElement[@Name='lost']")["RefBaseSystemUnitPath"] == "Lib/Gone"
    assert attrs_of(texts, "//InternalLink[@Name='free']")["RefPartnerSideB"] == "connection A0"


def test_aliases_refer_to_the_written_files():
    plant = """<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="p.aml">
    <ExternalReference Path="libs/r.xml" Alias="R"/>
    <SystemUnitClassLib Name="L"><SystemUnitClass Name="C">
    <SupportedRoleClass RefRoleClassPath="R@Roles/Mover"/></SystemUnitClass></SystemUnitClassLib>
    </CAEXFile>"""
    roles = """<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="r.xml">
    <RoleClassLib Name="Roles"><RoleClass Name="Mover"/></RoleClassLib></CAEXFile>"""
    graph = read(Source("p.aml", plant.encode()), Source("libs/r.xml", roles.encode()))
    texts, back, _ = round_trip(graph)
    assert list(texts) == ["aml/libs/r.aml", "aml/p.aml"]
    assert 'Path="libs/r.aml" Alias="R"' in texts["aml/p.aml"]
    assert 'RefRoleClassPath="R@Roles/Mover"' in texts["aml/p.aml"]
    assert [element for element in back if "unresolved" in element.attrs] == []


def test_an_element_repeats_the_attributes_of_its_class(plant):
    texts, _ = save(plant)
    (speed,) = parse_file(texts).xpath("//InternalElement[@ID='belt']/Attribute[@Name='speed']")
    assert dict(speed.attrib) == {
        "Name": "speed",
        "AttributeDataType": "xs:double",
        "Unit": "m/s",
        "RefAttributeType": "Types/Speed",
    }
    assert [child.tag for child in speed] == [
        "Description",
        "DefaultValue",
        "Value",
        "RefSemantic",
        "Constraint",
        "Constraint",
    ]
    assert speed.xpath("Value/text()") == ["2.5"]


# -- models of other languages -----------------------------------------------------------------

LOST = {"baygate-behaviour": [("b_palletId", ("palletId", "rf.lastId"))]}
"""Links of an example that CAEX cannot express: a binding joins values, not interfaces."""


STRUCTURED = [path for path in EXAMPLES if path.parent.name != "baygate"]
"""The examples with structure; the model of baygate has only behaviour."""


@pytest.mark.parametrize("model", STRUCTURED, ids=lambda path: path.parent.name)
def test_the_structure_of_an_example_is_read_back(model):
    graph = compile_example(model, "aml").graph
    _, back, _ = round_trip(graph)
    before, after = count_structure(graph), count_structure(back)
    assert sum(counts.total() for counts in before.values()) > 20
    lost = LOST.get(model.parent.name, [])
    assert list((before["links"] - after["links"]).elements()) == lost
    for subject in before.keys() - {"links"}:
        assert before[subject] == after[subject], subject


BLOCKS = """
Package p "Plant"
  Class passage "Passage" role="interface block"
  Class belt "Belt" role="block"
    Port belt.out "out" direction="out" multiplicity="2"
      -> typed-by passage
    Property belt.v "speed" role="value" default=1.5
      -> typed-by real
  Class fast "Fast" role="block"
    -> specializes belt
  Class moves "Moves" role="block"
  Class line "Line" role="block"
    -> realizes moves
    Port line.in "in" direction="in"
      -> typed-by passage
    Property line.b "belt" role="part" aggregation="composite"
      -> typed-by fast
    Connector line.c "wire"
      -> end line.c.1
      -> end line.c.2
      ConnectorEnd line.c.1 ""
        -> role line.in
      ConnectorEnd line.c.2 ""
        -> role belt.out
        -> path line.b
  Instance one "Line 1"
    -> instance-of line
DataType real "Real" subkind="primitive" external=true
"""


def test_blocks_become_classes_and_parts_internal_elements():
    texts, messages = save(refine(BLOCKS))
    assert messages == []
    assert attrs_of(texts, "//SystemUnitClass[@Name='Fast']")["RefBaseClassPath"] == "Plant/Belt"
    assert attrs_of(texts, "//InterfaceClass") == {"Name": "Passage"}
    assert attrs_of(texts, "//RoleClassLib/RoleClass") == {"Name": "Moves"}
    assert attrs_of(texts, "//SystemUnitClass/SupportedRoleClass") == {
        "RefRoleClassPath": "Plant/Moves"
    }
    element = attrs_of(texts, "//SystemUnitClass/InternalElement")
    assert (element["Name"], element["RefBaseSystemUnitPath"]) == ("belt", "Plant/Fast")
    assert (
        attrs_of(texts, "//InstanceHierarchy/InternalElement")["RefBaseSystemUnitPath"]
        == "Plant/Line"
    )
    speed = attrs_of(texts, "//SystemUnitClass/Attribute[@Name='speed']")
    assert speed == {"Name": "speed", "AttributeDataType": "xs:double"}
    (port,) = parse_file(texts).xpath("//SystemUnitClass[@Name='Belt']/ExternalInterface")
    assert port.xpath("Attribute[@Name='Direction']/Value/text()") == ["Out"]
    assert port.xpath("Attribute[@Name='Cardinality']//Value/text()") == ["2", "2"]


def test_a_connector_ends_at_the_interface_of_the_part():
    texts, _ = save(refine(BLOCKS))
    link = attrs_of(texts, "//InternalLink")
    part_interface = attrs_of(texts, "//InternalElement[@Name='belt']/ExternalInterface")
    line_interface = attrs_of(texts, "//SystemUnitClass[@Name='Line']/ExternalInterface")
    assert (link["RefPartnerSideA"], link["RefPartnerSideB"]) == (
        line_interface["ID"],
        part_interface["ID"],
    )


def test_ids_of_other_languages_are_derived_and_unique():
    texts, _ = save(refine(BLOCKS))
    ids = parse_file(texts).xpath("//@ID")
    assert len(ids) == len(set(ids)) == 5
    assert all(len(id) == 36 for id in ids)
    assert save(refine(BLOCKS))[0] == texts


def test_an_empty_graph_is_an_empty_file():
    (text,) = save(refine(""))[0].values()
    assert [child.tag for child in parse_file({"": text})] == ["SourceDocumentInformation"]


def test_information_of_a_vendor_is_preserved_at_any_depth():
    deep = f"{'<x>' * 400}{'</x>' * 400}"
    text = (
        '<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">'
        f"<AdditionalInformation>{deep}</AdditionalInformation></CAEXFile>"
    )
    texts, _, _ = round_trip(read(Source("plant.aml", text.encode())))
    (copy,) = texts.values()
    assert copy.count("<x>") + copy.count("<x/>") == 400


STANDARD = "AutomationMLInterfaceClassLib/AutomationMLBaseInterface"
ROLE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"
LINKED = """<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="a.aml">
<InstanceHierarchy Name="Plant"><InternalElement Name="line" ID="9">
{elements}
<InternalLink Name="l" RefPartnerSideA="0p" RefPartnerSideB="1p"/>
</InternalElement></InstanceHierarchy></CAEXFile>"""


@pytest.mark.parametrize(
    ("interface", "roles", "directions"),
    [
        ("PPRConnector", ("Process", "Resource"), ("", "")),
        ("Order", ("Process", "Process"), ("Out", "In")),
    ],
)
def test_links_of_products_processes_and_resources_are_written_again(interface, roles, directions):
    """They are dependencies, not connectors."""
    ways = [
        f'<Attribute Name="Direction"><Value>{way}</Value></Attribute>' if way else ""
        for way in directions
    ]
    elements = "".join(
        f'<InternalElement Name="e{n}" ID="{n}"><ExternalInterface Name="c" ID="{n}p" '
        f'RefBaseClassPath="{STANDARD}/{interface}">{ways[n]}</ExternalInterface>'
        f'<RoleRequirements RefBaseRoleClassPath="{ROLE}/{role}"/></InternalElement>'
        for n, role in enumerate(roles)
    )
    graph = read(Source("a.aml", LINKED.format(elements=elements).encode()))
    link = attrs_of(save(graph)[0], "//InternalLink")
    assert (link["RefPartnerSideA"], link["RefPartnerSideB"]) == ("0p", "1p")
