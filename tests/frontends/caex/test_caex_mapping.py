"""What each element of CAEX becomes: the rows of the table in docs/automationml.md."""

import pytest
from reading_caex import Read, aml, aml_2, classes, interfaces, plant, roles, types

from sysmlc.driver import Request, compile_model
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of
from sysmlc.sources import Source


def value(name, text, data_type="xs:string"):
    start = f'<Attribute Name="{name}" AttributeDataType="{data_type}">'
    return f"{start}<Value>{text}</Value></Attribute>"


# -- files and libraries ---------------------------------------------------------------------------


def test_a_file_is_a_document_with_the_values_of_its_header():
    reading = Read(
        aml(
            "<Description>a gate</Description>"
            "<SuperiorStandardVersion>AutomationML 2.10</SuperiorStandardVersion>"
            '<SourceDocumentInformation OriginName="editor" OriginVersion="5"/>'
            "<Copyright>us</Copyright>"
        )
    )
    document = reading.find("plant.aml")
    assert (document.kind.value, document.subkind) == ("Document", "caex")
    assert document.attrs["version"] == "3.0"
    assert document.attrs["description"] == "a gate"
    assert document.attrs["superior_standard"] == "AutomationML 2.10"
    assert document.attrs["copyright"] == "us"
    origin = reading.find("plant.aml::SourceDocumentInformation")
    assert origin.attrs["origin_name"] == "editor"
    assert reading.totals == {"mapped": 5}


def test_an_external_reference_is_an_import_named_as_its_alias():
    reading = Read('<ExternalReference Path="libs/a.aml" Alias="A"/>')
    alias = reading.find("A")
    assert (alias.kind.value, alias.subkind, alias.attrs["path"]) == (
        "Import",
        "alias",
        "libs/a.aml",
    )


def test_libraries_and_hierarchies_are_packages():
    reading = Read("".join([plant(""), interfaces(""), roles(""), classes(""), types("")]))
    packages = {e.name: e.subkind for e in reading.graph if e.kind.value == "Package"}
    assert packages == {
        "Plant": "instance-hierarchy",
        "Interfaces": "interface-class-lib",
        "Roles": "role-class-lib",
        "Lib": "system-unit-class-lib",
        "Types": "attribute-type-lib",
    }


def test_classes_are_blocks_interface_blocks_and_value_types():
    reading = Read(
        classes('<SystemUnitClass Name="C"><SystemUnitClass Name="N"/></SystemUnitClass>')
        + roles('<RoleClass Name="C"/>')
        + interfaces('<InterfaceClass Name="C"/>')
        + types('<AttributeType Name="C"/>')
    )
    kinds = {
        name: (element.kind.value, element.role, element.attrs.get("abstract"))
        for name in ("Lib::C", "Lib::C::N", "Roles::C", "Interfaces::C", "Types::C")
        for element in [reading.find(name)]
    }
    assert kinds == {
        "Lib::C": ("Class", "block", None),
        "Lib::C::N": ("Class", "block", None),
        "Roles::C": ("Class", "block", True),
        "Interfaces::C": ("Class", "interface block", None),
        "Types::C": ("DataType", "value type", None),
    }


def test_standard_libraries_that_a_file_omits_are_added_as_external():
    path = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole/Resource"
    reading = Read(roles(f'<RoleClass Name="R" RefBaseClassPath="{path}"/>'))
    (general,) = reading.graph.targets(reading.find("Roles::R"), "specializes")
    assert reading.graph.qualified_name(general) == path.replace("/", "::")
    assert general.attrs["external"] is general.attrs["library"] is True
    assert reading.findings == []


def test_elements_of_built_in_libraries_have_no_source():
    path = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole/Port"
    graph = Read(roles(f'<RoleClass Name="R" RefBaseClassPath="{path}"/>')).graph
    library = next(
        element for element in graph.roots() if element.name == "AutomationMLBaseRoleClassLib"
    )
    elements = list(graph.subtree(library))
    assert any(element.kind == "DataType" and element.name == "Cardinality" for element in elements)
    assert {(element.source, element.attrs.get("library")) for element in elements} == {("", True)}


def test_a_standard_library_in_the_file_is_used_and_external():
    reading = Read(
        roles('<RoleClass Name="AutomationMLBaseRole"/>', "AutomationMLBaseRoleClassLib")
        + roles(
            '<RoleClass Name="R" '
            'RefBaseClassPath="AutomationMLBaseRoleClassLib/AutomationMLBaseRole"/>'
        )
    )
    (general,) = reading.graph.targets(reading.find("Roles::R"), "specializes")
    assert (general.source, general.attrs["external"]) == ("plant.aml", True)


@pytest.mark.parametrize(
    ("path", "problem"),
    [
        ("Base@Lib/Role", "'Base', an alias that no ExternalReference declares"),
        ("AutomationMLBaseRoleClassLib/Gone", "'AutomationMLBaseRoleClassLib/Gone', which does"),
    ],
)
def test_a_fault_in_a_standard_library_of_the_file_is_a_located_warning(path, problem, tmp_path):
    held = f'<RoleClass Name="R" RefBaseClassPath="{path}"/>'
    source = aml(roles(held, "AutomationMLBaseRoleClassLib"))
    (tmp_path / "plant.aml").write_bytes(source.data)
    compilation = compile_model(Request((tmp_path / "plant.aml",)))
    (diagnostic,) = [
        diagnostic for diagnostic in compilation.diagnostics if diagnostic.rule.code != "SM158"
    ]
    assert diagnostic.message.startswith(
        "'AutomationMLBaseRoleClassLib::R' of the standard library 'AutomationMLBaseRoleClassLib'"
        f" refers to {problem}"
    )
    assert (diagnostic.rule.code, diagnostic.severity, diagnostic.subject.place.ordinal) == (
        "SM149",
        "warning",
        2,
    )
    assert compilation.exit_code() == 0


def test_a_fault_in_a_library_of_the_plant_is_an_error():
    reading = Read(roles('<RoleClass Name="R" RefBaseClassPath="Base@Lib/Role"/>'))
    assert [finding[:5] for finding in reading.findings] == ["SM133"]


# -- internal elements -----------------------------------------------------------------------------


def test_an_internal_element_is_a_part_of_its_class_or_of_a_block_of_its_own():
    reading = Read(
        classes(
            '<SystemUnitClass Name="M"/><SystemUnitClass Name="C">'
            '<InternalElement Name="a" ID="1" RefBaseSystemUnitPath="Lib/M"/>'
            '<InternalElement Name="b" ID="2"/>'
            '<InternalElement Name="c" ID="3" RefBaseSystemUnitPath="Lib/M">'
            '<Attribute Name="x"/></InternalElement></SystemUnitClass>'
        )
    )
    for name in "abc":
        part = reading.find(f"Lib::C::{name}", "Property")
        assert (part.role, part.attrs["aggregation"]) == ("part", "composite")
    assert reading.targets("Lib::C::a", "typed-by") == ["Lib::M"]
    assert reading.targets("Lib::C::b", "typed-by", "Property") == ["Lib::C::b"]
    assert reading.find("Lib::C::b", "Class").subkind == "internal-element"
    assert reading.targets("Lib::C::c", "specializes", "Class") == ["Lib::M"]
    assert reading.list_owned("Lib::C::c", "Class") == ["Property x"]


def test_a_part_that_an_instance_extends_is_redefined():
    reading = Read(
        classes(
            '<SystemUnitClass Name="M"/><SystemUnitClass Name="C">'
            '<InternalElement Name="m" ID="1" RefBaseSystemUnitPath="Lib/M"/></SystemUnitClass>'
        )
        + plant(
            '<InternalElement Name="top" ID="2" RefBaseSystemUnitPath="Lib/C">'
            '<InternalElement Name="m" ID="3" RefBaseSystemUnitPath="Lib/M">'
            '<InternalElement Name="new" ID="4"/></InternalElement></InternalElement>'
        )
    )
    assert reading.targets("Plant::top::m", "redefines", "Property") == ["Lib::C::m"]
    (type_,) = reading.graph.targets(reading.find("Plant::top::m", "Property"), "typed-by")
    assert type_ is reading.find("Plant::top::m", "Class")
    assert reading.targets("Plant::top::m", "specializes", "Class") == ["Lib::M"]


def test_a_part_to_which_an_instance_gives_another_class_is_redefined():
    def read_part(by):
        return Read(
            classes(
                '<SystemUnitClass Name="M"/><SystemUnitClass Name="N"/>'
                '<SystemUnitClass Name="Fine" RefBaseClassPath="Lib/M"/><SystemUnitClass Name="C">'
                '<InternalElement Name="m" ID="1" RefBaseSystemUnitPath="Lib/M"/></SystemUnitClass>'
            )
            + plant(
                '<InternalElement Name="top" ID="2" RefBaseSystemUnitPath="Lib/C">'
                f'<InternalElement Name="m" ID="3" RefBaseSystemUnitPath="Lib/{by}"/>'
                "</InternalElement>"
            )
        )

    assert read_part("N").targets("Plant::top::m", "redefines", "Property") == ["Lib::C::m"]
    assert read_part("N").targets("Plant::top::m", "typed-by", "Property") == ["Lib::N"]
    assert read_part("Fine").targets("Plant::top", "instance-of") == ["Lib::C"]
    assert read_part("Fine").targets("Plant::top::m", "instance-of") == ["Lib::Fine"]


# -- attributes ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("data_type", "text", "read", "primitive"),
    [
        ("xs:double", "1.5", 1.5, "Real"),
        ("xs:int", "3", 3, "Integer"),
        ("xs:boolean", "true", True, "Boolean"),
        ("xs:string", "x", "x", "String"),
        ("", "x", "x", "String"),
        ("xs:double", "lambda: 1", "lambda: 1", "Real"),
    ],
)
def test_an_attribute_is_a_value_property_with_default_and_type(data_type, text, read, primitive):
    reading = Read(
        classes(f'<SystemUnitClass Name="C">{value("v", text, data_type)}</SystemUnitClass>')
    )
    value_property = reading.find("Lib::C::v")
    assert (value_property.role, value_property.attrs["default"]) == ("value", read)
    assert [r.name for r in reading.graph.pending if r.source == value_property.id] == [primitive]


def test_value_and_default_are_both_stored_if_they_differ():
    reading = Read(
        classes(
            '<SystemUnitClass Name="C"><Attribute Name="v"><DefaultValue>a</DefaultValue>'
            '<Value>b</Value></Attribute><Attribute Name="w"><DefaultValue>a</DefaultValue>'
            "</Attribute></SystemUnitClass>"
        )
    )
    v, w = reading.find("Lib::C::v").attrs, reading.find("Lib::C::w").attrs
    assert (v["default"], v["default_value"]) == ("b", "a")
    assert (w["default"], w.get("default_value")) == ("a", "a")


def test_an_attribute_with_attributes_has_a_data_type_of_its_own():
    reading = Read(
        classes(
            f'<SystemUnitClass Name="C"><Attribute Name="s">{value("x", "1")}</Attribute>'
            "</SystemUnitClass>"
        )
    )
    assert reading.targets("Lib::C::s", "typed-by", "Property") == ["Lib::C::s"]
    assert reading.list_owned("Lib::C::s", "DataType") == ["Property x"]


@pytest.mark.parametrize(
    ("list_type", "ordered"), [("ListType", None), ("OrderedListType", True), ("Direction", None)]
)
def test_lists_have_any_number_of_values(list_type, ordered):
    path = f"AutomationMLBaseAttributeTypeLib/{list_type}"
    reading = Read(
        classes(
            f'<SystemUnitClass Name="C"><Attribute Name="v" RefAttributeType="{path}"/>'
            "</SystemUnitClass>"
        )
    )
    attrs = reading.find("Lib::C::v").attrs
    assert attrs.get("multiplicity") == (None if list_type == "Direction" else "*")
    assert attrs.get("ordered") is ordered


def test_a_list_of_caex_2_is_recognised_by_its_semantics():
    reading = Read(
        aml_2(
            classes(
                '<SystemUnitClass Name="C"><Attribute Name="v">'
                '<RefSemantic CorrespondingAttributePath="OrderedListType"/></Attribute>'
                "</SystemUnitClass>"
            )
        )
    )
    attrs = reading.find("Lib::C::v").attrs
    assert (attrs["multiplicity"], attrs["ordered"]) == ("*", True)
    assert attrs["semantics"] == ("OrderedListType",)


def test_semantics_of_classes_and_attributes_are_stored():
    reference = '<RefSemantic CorrespondingAttributePath="ECLASS:0173-1#02-AAB"/>'
    reading = Read(
        types(f'<AttributeType Name="T">{reference}</AttributeType>')
        + classes(
            f'<SystemUnitClass Name="C"><Attribute Name="v">{reference}{reference}</Attribute>'
            "</SystemUnitClass>"
        )
    )
    assert reading.find("Types::T").attrs["semantics"] == ("ECLASS:0173-1#02-AAB",)
    assert len(reading.find("Lib::C::v").attrs["semantics"]) == 2


# -- units -----------------------------------------------------------------------------------------


def read_with_unit(unit, more="", of_type=""):
    return Read(
        types(f'<AttributeType Name="Length" AttributeDataType="xs:double"{of_type}/>')
        + classes(
            '<SystemUnitClass Name="C">'
            f'<Attribute Name="v" AttributeDataType="xs:double" Unit="{unit}"{more}/>'
            "</SystemUnitClass>"
        )
    )


@pytest.mark.parametrize(
    ("unit", "symbol", "quantity"),
    [
        ("m", "m", "length"),
        ("m/s", "m/s", "speed"),
        ("m^3/h", "m³/h", "volume flow rate"),
        ("SEC", "s", "time"),
        ("C62", "1", "dimensionless"),
        ("Celsius", "°C", "thermodynamic temperature"),
        ("mbps", "Mbit/s", "transfer rate"),
    ],
)
def test_a_unit_is_recognised_by_symbol_spelling_and_code(unit, symbol, quantity):
    reading = read_with_unit(unit)
    value_property = reading.find("Lib::C::v")
    assert value_property.attrs["unit"] == unit
    assert unit_of(reading.graph, value_property).attrs["symbol"] == symbol
    assert quantity_kind_of(reading.graph, value_property).name == quantity
    assert reading.findings == []


@pytest.mark.parametrize("of_type", [' Unit="m"', ""])
def test_an_attribute_has_the_unit_of_its_type_or_its_own(of_type):
    reading = read_with_unit("mm", ' RefAttributeType="Types/Length"', of_type)
    value_property = reading.find("Lib::C::v")
    assert unit_of(reading.graph, value_property).attrs["symbol"] == "mm"
    plain = read_with_unit("m", ' RefAttributeType="Types/Length"', ' Unit="m"')
    assert plain.targets("Lib::C::v", "typed-by") == ["Types::Length"]
    assert unit_of(plain.graph, plain.find("Lib::C::v")).attrs["symbol"] == "m"


def test_value_types_of_one_unit_have_a_name_for_each_primitive():
    reading = Read(
        classes(
            '<SystemUnitClass Name="C">'
            '<Attribute Name="r" AttributeDataType="xs:double" Unit="m"/>'
            '<Attribute Name="i" AttributeDataType="xs:int" Unit="m"/>'
            '<Attribute Name="s" Unit="m"/><Attribute Name="f" Unit="furlong"/></SystemUnitClass>'
        )
    )
    assert {name: reading.targets(f"Lib::C::{name}", "typed-by") for name in "risf"} == {
        "r": ["Values::length[m]"],
        "i": ["Values::Integer length[m]"],
        "s": ["Values::String length[m]"],
        "f": ["Values::String[furlong]"],
    }


def test_an_unknown_unit_is_reported_once_a_file_and_stored_as_written():
    reading = read_with_unit("furlong")
    assert reading.findings == ["SM147: the unit 'furlong' of 'v' is not known"]
    value_property = reading.find("Lib::C::v")
    assert unit_of(reading.graph, value_property).attrs["symbol"] == "furlong"
    assert quantity_kind_of(reading.graph, value_property) is None


@pytest.mark.parametrize("text", ["string", "xs:anyUnit"])
def test_the_name_of_a_type_in_place_of_a_unit_is_dropped(text):
    reading = read_with_unit(text)
    assert reading.findings == [f"SM147: the unit '{text}' of 'v' is the name of a type"]
    assert unit_of(reading.graph, reading.find("Lib::C::v")) is None


def test_an_attribute_without_unit_is_not_reported():
    reading = read_with_unit("")
    assert reading.findings == []
    assert unit_of(reading.graph, reading.find("Lib::C::v")) is None


# -- constraints -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scale", "data_type", "body", "language"),
    [
        (
            "<OrdinalScaledType><RequiredMaxValue>5</RequiredMaxValue>"
            "<RequiredMinValue>1</RequiredMinValue></OrdinalScaledType>",
            "xs:double",
            "v >= 1.0 && v <= 5.0",
            "sysmlc",
        ),
        (
            "<NominalScaledType><RequiredValue>a</RequiredValue>"
            "<RequiredValue>b</RequiredValue></NominalScaledType>",
            "xs:string",
            'v == "a" || v == "b"',
            "sysmlc",
        ),
        ("<UnknownType><Requirements>be kind</Requirements></UnknownType>", "", "be kind", ""),
    ],
)
def test_a_constraint_is_an_expression_or_a_text(scale, data_type, body, language):
    reading = Read(
        classes(
            f'<SystemUnitClass Name="C"><Attribute Name="v" AttributeDataType="{data_type}">'
            f'<Constraint Name="c">{scale}</Constraint></Attribute></SystemUnitClass>'
        )
    )
    constraint = reading.find("Lib::C::c")
    assert (constraint.attrs["body"], constraint.attrs.get("language", "")) == (body, language)
    assert reading.targets("Lib::C::c", "references") == ["Lib::C::v"]


# -- interfaces ------------------------------------------------------------------------------------

STANDARD = "AutomationMLInterfaceClassLib/AutomationMLBaseInterface"


def test_an_interface_is_a_port_with_direction_cardinality_and_category():
    cardinality = f'<Attribute Name="Cardinality">{value("MinOccur", "1")}{value("MaxOccur", "4")}'
    reading = Read(
        classes(
            '<SystemUnitClass Name="C"><ExternalInterface Name="p" ID="1" '
            f'RefBaseClassPath="{STANDARD}/Port">{value("Direction", "InOut")}{cardinality}'
            f"</Attribute>{value('Category', 'energy')}{value('voltage', '24')}"
            "</ExternalInterface></SystemUnitClass>"
        )
    )
    attrs = reading.find("Lib::C::p").attrs
    assert (attrs["direction"], attrs["multiplicity"]) == ("inout", "1..4")
    assert (attrs["category"], attrs["value.voltage"]) == ("energy", "24")
    assert reading.targets("Lib::C::p", "typed-by") == [f"{STANDARD}/Port".replace("/", "::")]


def test_a_value_that_an_instance_gives_to_an_interface_is_a_slot():
    reading = Read(
        classes('<SystemUnitClass Name="C"><ExternalInterface Name="p" ID="1"/></SystemUnitClass>')
        + plant(
            '<InternalElement Name="i" ID="2" RefBaseSystemUnitPath="Lib/C">'
            f'<ExternalInterface Name="p" ID="3">{value("tag", "A1")}</ExternalInterface>'
            "</InternalElement>"
        )
    )
    assert reading.find("Plant::i::p").attrs["value.tag"] == "A1"
    assert reading.targets("Plant::i::p", "instance-of") == ["Lib::C::p"]


CONSTRAINED = (
    '<Constraint Name="c"><OrdinalScaledType><RequiredMaxValue>9</RequiredMaxValue>'
    "</OrdinalScaledType></Constraint>"
)
REFERRING = '<RefSemantic CorrespondingAttributePath="x"/>'
SPEED = '<Attribute Name="speed" AttributeDataType="xs:double" Unit="m/s"/>'


def port_of_class(attribute):
    return (
        interfaces(f'<InterfaceClass Name="P">{SPEED}</InterfaceClass>')
        + '<SystemUnitClassLib Name="Lib"><SystemUnitClass Name="C">'
        f'<ExternalInterface Name="p" ID="1" RefBaseClassPath="Interfaces/P">{attribute}'
        "</ExternalInterface></SystemUnitClass></SystemUnitClassLib>"
    )


@pytest.mark.parametrize(
    ("attribute", "kinds"),
    [
        ('<Attribute Name="level"/>', ["Property"]),
        ('<Attribute Name="level" Unit="m"><Value>1</Value></Attribute>', ["Property"]),
        (
            '<Attribute Name="level" AttributeDataType="xs:anyURI"><Value/></Attribute>',
            ["Property"],
        ),
        (f'<Attribute Name="level"><Value>1</Value>{REFERRING}</Attribute>', ["Property"]),
        (
            f'<Attribute Name="level"><Value>1</Value>{CONSTRAINED}</Attribute>',
            ["Property", "Constraint"],
        ),
        (
            '<Attribute Name="level"><Description>why</Description><Value>1</Value></Attribute>',
            ["Property"],
        ),
        ('<Attribute Name="level"><DefaultValue>1</DefaultValue></Attribute>', ["Property"]),
        (
            '<Attribute Name="level"><Attribute Name="low" Unit="m"/></Attribute>',
            ["Property", "DataType"],
        ),
        ('<Attribute Name="speed" Unit="km/h"><Value>1</Value></Attribute>', ["Property"]),
        (f'<Attribute Name="speed"><Value>1</Value>{CONSTRAINED}</Attribute>', ["Property"]),
        ('<Attribute Name="speed"><Description>why</Description></Attribute>', ["Property"]),
        (f'<Attribute Name="Direction">{CONSTRAINED}<Value>In</Value></Attribute>', ["Property"]),
    ],
)
def test_an_interface_whose_attributes_define_more_than_values_has_a_class_of_its_own(
    attribute, kinds
):
    reading = Read(port_of_class(attribute))
    (block,) = reading.graph.targets(reading.find("Lib::C::p", "Port"), "typed-by")
    assert (block.role, block.subkind) == ("interface block", "external-interface")
    assert [g.name for g in reading.graph.targets(block, "specializes")] == ["P"]
    assert {e.kind.value for e in reading.graph.owned(block)} >= set(kinds)
    assert "unsupported" not in reading.totals


@pytest.mark.parametrize(
    "attribute",
    [
        '<Attribute Name="level" AttributeDataType="xs:double"><Value>1</Value></Attribute>',
        '<Attribute Name="level"><Attribute Name="low"><Value>1</Value></Attribute></Attribute>',
        SPEED,
        '<Attribute Name="speed"><Value>2</Value></Attribute>',
        '<Attribute Name="Direction" RefAttributeType="AutomationMLBaseAttributeTypeLib/Direction"'
        ' AttributeDataType="xs:string"><Value>In</Value></Attribute>',
    ],
)
def test_an_interface_with_values_only_has_the_class_that_it_names(attribute):
    reading = Read(port_of_class(attribute))
    assert reading.targets("Lib::C::p", "typed-by", "Port") == ["Interfaces::P"]
    assert reading.findings == []


@pytest.mark.parametrize(
    "inside", ['<Attribute Name="speed" Unit="km/h"/>', '<ExternalInterface Name="r"/>']
)
def test_an_interface_that_an_instance_extends_is_redefined(inside):
    reading = Read(
        port_of_class("")
        + plant(
            '<InternalElement Name="c" ID="c" RefBaseSystemUnitPath="Lib/C">'
            f'<ExternalInterface Name="p" ID="2">{inside}</ExternalInterface></InternalElement>'
        )
    )
    assert reading.targets("Plant::c::p", "redefines", "Port") == ["Lib::C::p"]
    (block,) = reading.graph.targets(reading.find("Plant::c::p", "Port"), "typed-by")
    assert [g.name for g in reading.graph.targets(block, "specializes")] == ["P"]
    assert [e.name for e in reading.graph.owned(block)] == ["speed" if "speed" in inside else "r"]
    assert "unsupported" not in reading.totals


@pytest.mark.parametrize("of_class", ["", "<Description>in the class</Description>"])
def test_a_description_that_an_instance_gives_to_an_interface_is_a_comment(of_class):
    reading = Read(
        port_of_class(of_class)
        + plant(
            '<InternalElement Name="c" ID="c" RefBaseSystemUnitPath="Lib/C">'
            '<ExternalInterface Name="p" ID="2"><Description>here</Description>'
            "</ExternalInterface></InternalElement>"
        )
    )
    comments = {e.attrs["body"]: e.owner for e in reading.graph if e.kind.value == "Comment"}
    assert comments == {"here": "c", **({"in the class": "1"} if of_class else {})}
    sources = reading.graph.sources(reading.find("Lib::C::p", "Port"), "references")
    assert "c" in [e.owner for e in sources]


def test_nested_interfaces_are_ports_of_a_class_of_their_own():
    reading = Read(
        classes(
            '<SystemUnitClass Name="C"><ExternalInterface Name="p" ID="1">'
            '<ExternalInterface Name="pin" ID="2"/></ExternalInterface></SystemUnitClass>'
        )
    )
    assert reading.targets("Lib::C::p", "typed-by", "Port") == ["Lib::C::p"]
    assert reading.list_owned("Lib::C::p", "Class") == ["Port pin"]


# -- roles -----------------------------------------------------------------------------------------


def test_members_that_a_role_requires_and_an_element_lacks_are_added():
    reading = Read(
        roles('<RoleClass Name="R"><Attribute Name="load"/></RoleClass>')
        + plant(
            '<InternalElement Name="i" ID="1"><Attribute Name="mass"><Value>2</Value></Attribute>'
            '<RoleRequirements RefBaseRoleClassPath="Roles/R">'
            f"{value('load', '5')}{value('mass', '3')}"
            '<ExternalInterface Name="grip" ID="2"/></RoleRequirements></InternalElement>'
        )
    )
    assert reading.list_owned("Plant::i", "Class") == [
        "Property mass",
        "Property load",
        "Metadata RoleRequirements",
        "Port grip",
    ]
    assert reading.find("Plant::i::RoleRequirements").attrs["required"] == "3"
    assert reading.totals == {"mapped": 14}


def test_instances_do_not_repeat_the_realizations_of_their_class():
    role = '<SupportedRoleClass RefRoleClassPath="Roles/A"/>'
    reading = Read(
        roles('<RoleClass Name="A"/><RoleClass Name="B"/>')
        + classes(f'<SystemUnitClass Name="C">{role}</SystemUnitClass>')
        + plant(
            f'<InternalElement Name="i" ID="1" RefBaseSystemUnitPath="Lib/C">{role}'
            '<SupportedRoleClass RefRoleClassPath="Roles/B"/></InternalElement>'
        )
    )
    assert reading.targets("Lib::C", "realizes") == ["Roles::A"]
    assert reading.targets("Plant::i", "realizes") == ["Roles::B"]


def read_mapping(attribute, interface="p"):
    return Read(
        interfaces('<InterfaceClass Name="P"/>')
        + roles(
            '<RoleClass Name="R"><Attribute Name="length"/>'
            '<ExternalInterface Name="plug" ID="r1"/></RoleClass>'
        )
        + plant(
            '<InternalElement Name="i" ID="1"><Attribute Name="len"/>'
            '<ExternalInterface Name="p" ID="2"/>'
            '<RoleRequirements RefBaseRoleClassPath="Roles/R"><MappingObject>'
            f'<AttributeNameMapping SystemUnitAttributeName="{attribute}" '
            'RoleAttributeName="length"/><InterfaceNameMapping '
            f'SystemUnitInterfaceName="{interface}" RoleInterfaceName="plug"/>'
            "</MappingObject></RoleRequirements></InternalElement>"
        )
    )


def test_a_mapping_object_redefines_a_feature_of_the_role():
    reading = read_mapping("len")
    assert reading.targets("Plant::i::len", "redefines") == ["Roles::R::length"]
    assert reading.targets("Plant::i::p", "redefines") == ["Roles::R::plug"]
    assert reading.findings == []


def test_a_mapping_of_an_unknown_feature_is_an_error():
    assert read_mapping("l").findings == [
        "SM144: a mapping object of 'i' names 'l', which does not exist"
    ]


def test_a_mapping_leads_to_inner_attributes():
    deep = (
        '<Attribute Name="{}"><Attribute Name="{}"><Attribute Name="{}"/></Attribute></Attribute>'
    )
    reading = Read(
        roles(f'<RoleClass Name="R">{deep.format("a", "x.y", "z")}</RoleClass>')
        + plant(
            f'<InternalElement Name="m" ID="m">{deep.format("b", "c", "d")}'
            '<RoleRequirements RefBaseRoleClassPath="Roles/R"><MappingObject>'
            '<AttributeNameMapping SystemUnitAttributeName="b.c.d" RoleAttributeName="a.x.y.z"/>'
            "</MappingObject></RoleRequirements></InternalElement>"
        )
    )
    (inner,) = (e for e in reading.graph if e.name == "d" and e.kind.value == "Property")
    assert [t.name for t in reading.graph.targets(inner, "redefines")] == ["z"]
    assert reading.findings == []


def read_requirements(inside):
    return Read(
        roles('<RoleClass Name="R"><Attribute Name="a"/></RoleClass>')
        + plant(
            '<InternalElement Name="m" ID="m"><Attribute Name="a" Unit="m"><Value>1</Value>'
            '</Attribute><ExternalInterface Name="i" ID="i"/>'
            f'<RoleRequirements RefBaseRoleClassPath="Roles/R">{inside}</RoleRequirements>'
            "</InternalElement>"
        )
    )


def test_an_interface_that_the_role_requires_is_not_added_a_second_time():
    reading = read_requirements('<ExternalInterface Name="i" ID="i2"/>')
    assert [e.id for e in reading.graph if e.kind.value == "Port"] == ["i"]
    assert reading.findings == []


def test_a_required_value_is_stored_with_its_unit_and_other_requirements_are_reported():
    reading = read_requirements(
        f'<Attribute Name="a" Unit="km"><Value>5</Value>{CONSTRAINED}</Attribute>'
    )
    (metadata,) = (e for e in reading.graph if e.name == "RoleRequirements")
    assert (metadata.attrs["required"], metadata.attrs["unit"]) == ("5", "km")
    assert "SM139: 1 element 'Constraint' not read" in reading.findings


# -- facets and groups -----------------------------------------------------------------------------

BASE_ROLE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"


def role_use(role):
    return f'<RoleRequirements RefBaseRoleClassPath="{role}"/>'


def test_a_facet_shows_features_of_its_element_and_a_group_the_masters_of_its_mirrors():
    reading = Read(
        roles(f'<RoleClass Name="MyFacet" RefBaseClassPath="{BASE_ROLE}/Facet"/>')
        + plant(
            '<InternalElement Name="cell" ID="0"><InternalElement Name="a" ID="1">'
            '<Attribute Name="x"/><Attribute Name="y"/>'
            f'<InternalElement Name="plc" ID="2"><Attribute Name="x"/>{role_use("Roles/MyFacet")}'
            '</InternalElement></InternalElement><InternalElement Name="g" ID="3">'
            f"{value('AssociatedFacet', 'plc')}"
            '<InternalElement Name="m" ID="4" RefBaseSystemUnitPath="1"/>'
            f"{role_use(BASE_ROLE + '/Group')}</InternalElement></InternalElement>"
        )
    )
    assert reading.targets("Plant::cell::a::plc", "references", "Facet") == ["Plant::cell::a::x"]
    assert reading.targets("Plant::cell::g", "references", "Group") == ["Plant::cell::a"]
    assert reading.find("Plant::cell::g").attrs["associated_facet"] == "plc"
    assert reading.findings == []


def test_a_facet_or_group_realizes_the_role_that_specialises_the_standard():
    body = "".join(
        f'<InternalElement Name="{name}" ID="{name}">{role_use(role)}</InternalElement>'
        for name, role in {"v": "Roles/View", "s": "Roles/Set", "g": f"{BASE_ROLE}/Group"}.items()
    )
    reading = Read(
        roles(
            f'<RoleClass Name="View" RefBaseClassPath="{BASE_ROLE}/Facet"/>'
            f'<RoleClass Name="Set" RefBaseClassPath="{BASE_ROLE}/Group"/>'
        )
        + plant(f'<InternalElement Name="cell" ID="0">{body}</InternalElement>')
    )
    realized = [reading.targets(f"Plant::cell::{name}", "realizes") for name in "vsg"]
    assert realized == [["Roles::View"], ["Roles::Set"], []]


def test_each_role_of_a_facet_or_group_is_read():
    view, base = role_use("Roles/View"), role_use(f"{BASE_ROLE}/Facet")
    reading = Read(
        roles(f'<RoleClass Name="View" RefBaseClassPath="{BASE_ROLE}/Facet"/>')
        + plant(f'<InternalElement Name="v" ID="v">{base}{view}</InternalElement>')
    )
    assert reading.targets("Plant::v", "realizes") == ["Roles::View"]
    assert reading.findings == []


def read_group(role, inside, siblings=""):
    return Read(
        plant(
            '<InternalElement Name="cell" ID="0"><Attribute Name="x"><Value>1</Value></Attribute>'
            f'<ExternalInterface Name="i" ID="i"/>{siblings}'
            f'<InternalElement Name="s" ID="s">{inside}{role_use(f"{BASE_ROLE}/{role}")}'
            "</InternalElement></InternalElement>"
        )
    )


def test_a_group_may_contain_groups():
    inner = (
        f'<InternalElement Name="g" ID="g">{value("AssociatedFacet", "f")}'
        '<InternalElement Name="m" ID="m" RefBaseSystemUnitPath="a"/>'
        f"{role_use(BASE_ROLE + '/Group')}</InternalElement>"
    )
    facet = f'<InternalElement Name="f" ID="f">{role_use(BASE_ROLE + "/Facet")}</InternalElement>'
    reading = read_group("Group", inner, f'<InternalElement Name="a" ID="a"/>{facet}')
    assert reading.list_owned("Plant::cell::s") == ["Group g"]
    assert reading.targets("Plant::cell::s::g", "references") == ["Plant::cell::a"]
    assert reading.find("Plant::cell::s::g").attrs["associated_facet"] == "f"
    assert reading.findings == []


@pytest.mark.parametrize(
    ("facet", "findings"),
    [
        ("plc", []),
        (" plc\n", []),
        (
            "plcs",
            [
                "SM639: the group 'Plant::cell::s' refers to facets named 'plcs', but no "
                "facet has that name; "
                "did you mean 'plc'?"
            ],
        ),
    ],
)
def test_a_group_for_an_unknown_facet_is_reported(facet, findings):
    role = role_use(f"{BASE_ROLE}/Facet")
    sibling = f'<InternalElement Name="plc" ID="f">{role}</InternalElement>'
    reading = read_group("Group", value("AssociatedFacet", facet), sibling)
    assert reading.findings == findings


@pytest.mark.parametrize(
    "feature",
    [
        '<Attribute Name="x"/>',
        '<Attribute Name="x"><Value>1</Value></Attribute>',
        '<Attribute Name="other" RefAttributeType="0/x"/>',
        '<ExternalInterface Name="i" ID="j"/>',
        '<ExternalInterface Name="other" ID="j" RefBaseClassPath="i"/>',
    ],
)
def test_a_facet_shows_mirrors_and_copies(feature):
    reading = read_group("Facet", feature)
    shown = "i" if feature.startswith("<E") else "x"
    assert reading.targets("Plant::cell::s", "references", "Facet") == [f"Plant::cell::{shown}"]
    assert reading.findings == []


MIRROR = '<InternalElement Name="%s" ID="m" RefBaseSystemUnitPath="a">%s</InternalElement>'


@pytest.mark.parametrize(
    ("role", "inside", "stored"),
    [
        ("Group", MIRROR % ("left", ""), ("a", "left", "m")),
        ("Group", MIRROR % ("a", ""), ("a", "a", "m")),
        ("Facet", '<ExternalInterface Name="i" ID="m"/>', ("i", "i", "m")),
        ("Facet", '<Attribute Name="o" RefAttributeType="0/x"/>', ("0#class/x", "o", "")),
    ],
)
def test_names_and_ids_of_mirrors_in_facets_and_groups_are_stored(role, inside, stored):
    reading = read_group(role, inside, '<InternalElement Name="a" ID="a"/>')
    assert reading.find("Plant::cell::s").attrs["mirrors"] == (stored,)
    assert reading.findings == []


def test_a_mirror_without_id_that_has_the_name_of_its_master_is_not_stored():
    reading = read_group("Facet", '<Attribute Name="x"/>')
    assert "mirrors" not in reading.find("Plant::cell::s").attrs


@pytest.mark.parametrize(
    ("text", "findings"),
    [
        ("a robot", []),
        (
            "the left one",
            [
                "SM638: the description of 'Plant::cell::s::left' is omitted: in 's' it is a "
                "mirror of another element"
            ],
        ),
    ],
)
def test_a_description_of_a_mirror_alone_is_reported(text, findings):
    description = "<Description>%s</Description>"
    master = f'<InternalElement Name="a" ID="a">{description % "a robot"}</InternalElement>'
    reading = read_group("Group", MIRROR % ("left", description % text), master)
    assert reading.findings == findings
    assert reading.totals.get("approximated", 0) == 2 * len(findings)


@pytest.mark.parametrize(
    ("role", "inside", "tag"),
    [
        ("Group", '<Attribute Name="size" Unit="m"/>', "Attribute"),
        ("Group", '<InternalElement Name="own" ID="own"/>', "InternalElement"),
        ("Group", '<ExternalInterface Name="p" ID="p"/>', "ExternalInterface"),
        ("Group", role_use(f"{BASE_ROLE}/Resource"), "RoleRequirements"),
        ("Facet", '<Attribute Name="new"/>', "Attribute"),
        ("Facet", '<Attribute Name="x"><Value>2</Value></Attribute>', "Attribute"),
        ("Facet", '<Attribute Name="x" Unit="m"/>', "Attribute"),
        ("Facet", '<ExternalInterface Name="new" ID="p"/>', "ExternalInterface"),
        ("Facet", '<InternalElement Name="own" ID="own"/>', "InternalElement"),
    ],
)
def test_other_content_of_a_facet_or_group_is_reported(role, inside, tag):
    reading = read_group(role, inside)
    assert reading.findings == [f"SM139: 1 element '{tag}' not read"]
    assert reading.totals["unsupported"] == 1 + inside.count("<Value>")


def test_a_role_is_no_facet_by_its_name_alone():
    reading = Read(
        roles('<RoleClass Name="Facet"/>')
        + plant(f'<InternalElement Name="a" ID="1">{role_use("Roles/Facet")}</InternalElement>')
    )
    assert [e.kind.value for e in reading.find_all("Plant::a")] == ["Instance", "Class"]


# -- products, processes, resources, orders --------------------------------------------------------


def read_linked_roles(interface, *elements, direction=""):
    ids = [f"{number}p" for number in range(len(elements))]
    inside = "".join(
        f'<InternalElement Name="{role}{n}" ID="{n}"><ExternalInterface Name="c" ID="{n}p" '
        f'RefBaseClassPath="{STANDARD}/{interface}">{value("Direction", way) if way else ""}'
        f"</ExternalInterface>{role_use(f'{BASE_ROLE}/{role}')}</InternalElement>"
        for n, (role, way) in enumerate(elements)
    )
    link = f'<InternalLink Name="l" RefPartnerSideA="{ids[0]}" RefPartnerSideB="{ids[1]}"/>'
    return Read(plant(f'<InternalElement Name="line" ID="9">{inside}{link}</InternalElement>'))


@pytest.mark.parametrize("first", ["Process", "Resource"])
def test_a_process_is_allocated_to_its_resource(first):
    second = {"Process": "Resource", "Resource": "Process"}[first]
    reading = read_linked_roles("PPRConnector", (first, ""), (second, ""))
    link = reading.find("Plant::line::l")
    assert (link.kind.value, link.role, link.subkind) == ("Dependency", "allocate", "ppr")
    (client,) = reading.graph.targets(link, "client")
    assert client.name.startswith("Process")
    assert reading.find(f"Plant::line::{first}0", "Class").attrs["ppr"] == first.lower()
    assert reading.links() == {}


def test_process_and_resource_depend_on_their_product():
    reading = read_linked_roles("PPRConnector", ("Product", ""), ("Process", ""))
    link = reading.find("Plant::line::l")
    assert (link.kind.value, link.role) == ("Dependency", "")
    assert [e.name for e in reading.graph.targets(link, "supplier")] == ["Product0"]


@pytest.mark.parametrize(("ways", "later"), [(("Out", "In"), 1), (("In", "Out"), 0)])
def test_an_order_is_a_succession_from_direction_out_to_direction_in(ways, later):
    reading = read_linked_roles("Order", ("Process", ways[0]), ("Process", ways[1]))
    link = reading.find("Plant::line::l")
    assert (link.kind.value, link.subkind) == ("Dependency", "succession")
    assert [e.name for e in reading.graph.targets(link, "client")] == [f"Process{later}"]


def test_other_interfaces_of_processes_are_connected():
    assert list(read_linked_roles("Port", ("Process", ""), ("Resource", "")).links()) == ["l"]


def test_a_port_object_of_caex_2_is_a_part_with_the_properties_of_a_port():
    inside = value("Direction", "In") + value("Category", "energy")
    reading = Read(
        roles('<RoleClass Name="Port"/>')
        + plant(
            '<InternalElement Name="cell" ID="0">'
            f'<InternalElement Name="p" ID="1">{inside}{role_use(BASE_ROLE + "/Port")}'
            f'</InternalElement><InternalElement Name="q" ID="2">{inside}{role_use("Roles/Port")}'
            "</InternalElement></InternalElement>"
        )
    )
    p, q = (reading.find(f"Plant::cell::{name}", "Property") for name in "pq")
    assert (p.subkind, p.attrs["direction"], p.attrs["category"]) == ("port-object", "in", "energy")
    assert (q.subkind, q.attrs.get("direction")) == ("", None)


# -- external data ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("interface", "subkind"),
    [
        ("COLLADAInterface", "collada"),
        ("PLCopenXMLInterface", "plcopen"),
        ("ExternalDataReference", "external-data"),
    ],
)
def test_external_data_is_a_document_that_is_not_loaded(interface, subkind):
    path = f"{STANDARD}/ExternalDataConnector/{interface}"
    reading = Read(
        plant(
            f'<InternalElement Name="i" ID="1"><ExternalInterface Name="d" ID="2" '
            f'RefBaseClassPath="{path}">{value("refURI", "file:///g/a.dae#n")}'
            f"{value('MIMEType', 'model/x')}</ExternalInterface></InternalElement>"
        )
    )
    document = reading.find("Plant::i::d", "Document")
    assert (document.subkind, document.attrs["href"]) == (subkind, "file:///g/a.dae#n")
    assert document.attrs["media_type"] == "model/x"
    assert reading.targets("Plant::i::d", "references", "Document") == ["Plant::i::d"]


# -- descriptions and other metadata ---------------------------------------------------------------


def test_descriptions_revisions_and_additional_information_are_stored():
    reading = Read(
        classes(
            '<SystemUnitClass Name="C" ChangeMode="create"><Description>moves</Description>'
            "<Version>1.1</Version><Revision><RevisionDate>2024-01-01</RevisionDate>"
            "<AuthorName>ada</AuthorName></Revision><Copyright>us</Copyright>"
            '<AdditionalInformation><x:y xmlns:x="u">z</x:y></AdditionalInformation>'
            "</SystemUnitClass>"
        )
    )
    block = reading.find("Lib::C")
    assert (block.attrs["change_mode"], block.attrs["copyright"]) == ("create", "us")
    assert block.attrs["version"] == "1.1"
    assert reading.list_owned("Lib::C") == [
        "Comment",
        "Metadata Revision",
        "Metadata AdditionalInformation",
    ]
    assert reading.find("Lib::C::Revision").attrs["author_name"] == "ada"
    assert reading.totals == {"mapped": 11}


@pytest.mark.parametrize(("mode", "stored"), [("delete", "delete"), ("state", None)])
def test_a_change_mode_is_stored_without_other_metadata(mode, stored):
    reading = Read(classes(f'<SystemUnitClass Name="C" ChangeMode="{mode}"/>'))
    assert reading.find("Lib::C").attrs.get("change_mode") == stored


def test_a_document_without_file_name_has_the_name_of_its_source():
    reading = Read(Source("cell.aml", b'<CAEXFile SchemaVersion="2.15"/>'))
    assert [e.name for e in reading.graph if e.subkind == "caex"] == ["cell.aml"]


def test_ids_of_automationml_are_ids_of_the_graph():
    reading = Read(plant('<InternalElement Name="i" ID="{AB}"/>'))
    assert reading.find("Plant::i", "Instance").id == "{AB}"


# -- rules about files -----------------------------------------------------------------------------


def test_elements_that_caex_does_not_have_are_reported_and_counted():
    reading = Read(plant('<InternalElement Name="i" ID="1"><Conveyor/></InternalElement>'))
    assert reading.findings == ["SM139: 1 element 'Conveyor' not read"]
    assert reading.totals == {"mapped": 3, "unsupported": 1}


@pytest.mark.parametrize(
    ("inside", "order"),
    [
        (
            '<RoleRequirements/><InternalLink Name="l" RefPartnerSideA="" RefPartnerSideB=""/>',
            [
                "SM140: 'InternalLink' of 'Plant::i' comes after 'RoleRequirements', against "
                "the schema of CAEX (1 place)"
            ],
        ),
        ('<InternalLink Name="l" RefPartnerSideA="" RefPartnerSideB=""/><RoleRequirements/>', []),
        (
            "<SourceObjectInformation OriginID='a'/><AdditionalInformation/>",
            [
                "SM140: 'AdditionalInformation' of 'Plant::i' comes after "
                "'SourceObjectInformation', against the schema of CAEX (1 place)"
            ],
        ),
        ("<AdditionalInformation/><SourceObjectInformation OriginID='a'/>", []),
    ],
)
def test_elements_in_another_order_than_in_the_schema_are_reported_once(inside, order):
    reading = Read(plant(f'<InternalElement Name="i" ID="1">{inside}</InternalElement>'))
    assert reading.order == order


@pytest.mark.parametrize(
    ("body", "findings"),
    [("", ["SM141: 'plant.aml' contains no library and no hierarchy"]), (plant(""), [])],
)
def test_a_file_without_content_is_reported(body, findings):
    assert Read(body).findings == findings


def test_a_damaged_file_is_one_located_error():
    reading = Read(aml(b"<CAEXFile><InstanceHierarchy></CAEXFile>"))
    (diagnostic,) = reading.sink
    assert diagnostic.rule.code == "SM142"
    assert diagnostic.subject.place.offset == 31
    assert len(reading.graph) == 0
