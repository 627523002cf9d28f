"""Inheritance, instances, mirrors and links."""

import pytest
from reading_caex import Read, aml_2, classes, interfaces, plant, roles, types

PORTS = interfaces('<InterfaceClass Name="P"/>')


# -- inheritance -----------------------------------------------------------------------------------


def test_a_class_inherits_members_of_its_base_without_copies():
    reading = Read(
        classes(
            '<SystemUnitClass Name="Base"><Attribute Name="x"/><ExternalInterface Name="p" ID="1"/>'
            '<InternalElement Name="e" ID="2"/></SystemUnitClass>'
            '<SystemUnitClass Name="Derived" RefBaseClassPath="Lib/Base"/>'
        )
    )
    assert reading.targets("Lib::Derived", "specializes") == ["Lib::Base"]
    assert reading.list_owned("Lib::Derived") == []


def test_overriding_is_by_name_and_replaces_the_whole_attribute():
    inner = '<Attribute Name="{}"/>'
    reading = Read(
        classes(
            f'<SystemUnitClass Name="Base"><Attribute Name="b">{inner.format("n1")}'
            f"{inner.format('n2')}</Attribute></SystemUnitClass>"
            '<SystemUnitClass Name="Derived" RefBaseClassPath="Lib/Base">'
            f'<Attribute Name="b">{inner.format("n2")}</Attribute></SystemUnitClass>'
        )
    )
    assert reading.targets("Lib::Derived::b", "redefines", "Property") == ["Lib::Base::b"]
    assert reading.list_owned("Lib::Derived::b", "DataType") == ["Property n2"]
    assert reading.targets("Lib::Derived::b", "specializes", "DataType") == []


def test_an_attribute_of_another_name_overrides_nothing():
    reading = Read(
        classes(
            '<SystemUnitClass Name="Base"><Attribute Name="b"/></SystemUnitClass>'
            '<SystemUnitClass Name="Derived" RefBaseClassPath="Lib/Base">'
            '<Attribute Name="B"/></SystemUnitClass>'
        )
    )
    assert reading.targets("Lib::Derived::B", "redefines") == []


@pytest.mark.parametrize(
    ("a", "b", "findings"),
    [
        ("Roles/B", "Roles/A", ["SM134: the class 'A' specialises itself: A -> B -> A"]),
        ("Roles/A", "Roles/A", ["SM134: the class 'A' specialises itself: A -> A"]),
        ("", "Roles/A", []),
    ],
)
def test_a_cycle_of_base_classes_is_cut_and_reported(a, b, findings):
    reading = Read(
        roles(
            f'<RoleClass Name="A" RefBaseClassPath="{a}"/>'
            f'<RoleClass Name="B" RefBaseClassPath="{b}"/>'
        )
    )
    assert reading.findings == findings
    assert reading.targets("Roles::A", "specializes") == []
    assert reading.targets("Roles::B", "specializes") == ["Roles::A"]


def test_a_class_that_specialises_a_cycle_is_no_part_of_it():
    reading = Read(
        roles(
            '<RoleClass Name="X" RefBaseClassPath="Roles/A"/>'
            '<RoleClass Name="A" RefBaseClassPath="Roles/B"/>'
            '<RoleClass Name="B" RefBaseClassPath="Roles/A"/>'
        )
    )
    assert reading.findings == ["SM134: the class 'A' specialises itself: A -> B -> A"]
    assert reading.targets("Roles::X", "specializes") == ["Roles::A"]


def test_interface_classes_and_attribute_types_inherit_in_the_same_way():
    reading = Read(
        interfaces(
            '<InterfaceClass Name="A"/><InterfaceClass Name="B" RefBaseClassPath="Interfaces/A"/>'
        )
        + types(
            '<AttributeType Name="Length"/>'
            '<AttributeType Name="Width" RefAttributeType="Types/Length"/>'
        )
    )
    assert reading.targets("Interfaces::B", "specializes") == ["Interfaces::A"]
    assert reading.targets("Types::Width", "specializes") == ["Types::Length"]


def test_an_attribute_type_types_nested_attributes_too():
    reading = Read(
        types('<AttributeType Name="Length"/>')
        + classes(
            '<SystemUnitClass Name="Box"><Attribute Name="size">'
            '<Attribute Name="w" RefAttributeType="Types/Length"/></Attribute></SystemUnitClass>'
        )
    )
    assert reading.targets("Lib::Box::size::w", "typed-by") == ["Types::Length"]


# -- instances -------------------------------------------------------------------------------------

SWITCH = classes(
    '<SystemUnitClass Name="Motor"><Attribute Name="power" AttributeDataType="xs:double"/>'
    "</SystemUnitClass>"
    '<SystemUnitClass Name="Switch">'
    '<Attribute Name="length" AttributeDataType="xs:double"><Value>1.0</Value></Attribute>'
    '<ExternalInterface Name="p" ID="c-p"/>'
    '<InternalElement Name="m" ID="c-m" RefBaseSystemUnitPath="Lib/Motor"/>'
    "</SystemUnitClass>"
)


def plant_with_switch(inside, path="Lib/Switch"):
    return SWITCH + plant(
        f'<InternalElement Name="sw" ID="sw" RefBaseSystemUnitPath="{path}">{inside}'
        "</InternalElement>"
    )


def test_an_instance_that_repeats_its_class_adds_no_members():
    reading = Read(
        plant_with_switch(
            '<Attribute Name="length" AttributeDataType="xs:double"><Value>1.0</Value></Attribute>'
            '<ExternalInterface Name="p" ID="i-p"/>'
            '<InternalElement Name="m" ID="i-m" RefBaseSystemUnitPath="Lib/Motor"/>'
        )
    )
    assert reading.targets("Plant::sw", "instance-of") == ["Lib::Switch"]
    assert reading.list_owned("Plant::sw") == ["Instance m"]
    assert reading.targets("Plant::sw::m", "represents") == ["Lib::Switch::m"]
    assert reading.find("Plant::sw").attrs["interface_ids"] == (("c-p", "i-p"),)
    assert reading.findings == reading.infos == []


def test_a_value_of_an_instance_is_a_slot_and_no_default_of_the_class():
    reading = Read(
        plant_with_switch(
            '<Attribute Name="length" AttributeDataType="xs:double"><Value>1.2</Value></Attribute>'
            '<InternalElement Name="m" ID="i-m"><Attribute Name="power" '
            'AttributeDataType="xs:double"><Value>5</Value></Attribute></InternalElement>'
        )
    )
    assert reading.find("Plant::sw::length").attrs["value"] == 1.2
    assert reading.targets("Plant::sw::length", "instance-of") == ["Lib::Switch::length"]
    assert reading.find("Plant::sw::m::power").attrs["value"] == 5.0
    assert reading.targets("Plant::sw::m::power", "instance-of") == ["Lib::Motor::power"]
    assert reading.find("Lib::Switch::length").attrs["default"] == 1.0


def test_added_members_make_a_specialised_block():
    reading = Read(
        plant_with_switch('<Attribute Name="colour"/><ExternalInterface Name="q" ID="i-q"/>')
    )
    assert reading.targets("Plant::sw", "instance-of", "Instance") == ["Plant::sw"]
    assert reading.targets("Plant::sw", "specializes", "Class") == ["Lib::Switch"]
    assert reading.list_owned("Plant::sw", "Class") == ["Property colour", "Port q"]


def test_members_that_an_instance_omits_are_not_reported():
    reading = Read(plant_with_switch(""))
    assert reading.list_owned("Plant::sw") == []
    assert reading.targets("Plant::sw", "instance-of") == ["Lib::Switch"]
    assert reading.findings == []


def test_an_element_without_class_has_a_block_of_its_own():
    reading = Read(plant_with_switch('<Attribute Name="colour"/>', path=""))
    assert reading.targets("Plant::sw", "instance-of", "Instance") == ["Plant::sw"]
    block = reading.find("Plant::sw", "Class")
    assert (block.role, block.attrs["subkind"]) == ("block", "internal-element")
    assert reading.list_owned("Plant::sw", "Class") == ["Property colour"]


def test_an_attribute_that_extends_that_of_its_class_redefines_it():
    reading = Read(
        plant_with_switch(
            '<Attribute Name="length" AttributeDataType="xs:double" Unit="m"><Value>1.0</Value>'
            '<Constraint Name="c"><OrdinalScaledType><RequiredMaxValue>2</RequiredMaxValue>'
            "</OrdinalScaledType></Constraint></Attribute>"
        )
    )
    assert reading.list_owned("Plant::sw", "Class") == ["Property length", "Constraint c"]
    assert reading.targets("Plant::sw::length", "redefines") == ["Lib::Switch::length"]
    assert reading.find("Plant::sw::c").attrs["body"] == "length <= 2.0"
    assert reading.totals == {"mapped": 16}


# -- mirrors ---------------------------------------------------------------------------------------


def test_a_mirror_is_a_reference_to_its_master():
    reading = Read(
        plant(
            '<InternalElement Name="cell" ID="0">'
            '<InternalElement Name="a" ID="1"><Attribute Name="x"/></InternalElement>'
            '<InternalElement Name="m" ID="2" RefBaseSystemUnitPath="1"/>'
            '<InternalElement Name="n" ID="3" RefBaseSystemUnitPath="2"/></InternalElement>'
        )
    )
    for name in ("m", "n"):
        mirror = reading.find(f"Plant::cell::{name}", "Property")
        assert (mirror.role, mirror.attrs.get("aggregation")) == ("reference", None)
        assert reading.targets(f"Plant::cell::{name}", "mirrors", "Property") == ["Plant::cell::a"]
        (type_,) = reading.graph.targets(mirror, "typed-by")
        assert type_ is reading.find("Plant::cell::a", "Class")
    assert reading.findings == []


def test_interfaces_and_attributes_are_mirrored_by_the_id_of_an_interface_or_owner():
    reading = Read(
        PORTS
        + plant(
            '<InternalElement Name="cell" ID="0"><InternalElement Name="a" ID="1">'
            '<Attribute Name="x"/>'
            '<ExternalInterface Name="p" ID="2" RefBaseClassPath="Interfaces/P"/>'
            '</InternalElement><InternalElement Name="b" ID="3">'
            '<Attribute Name="y" RefAttributeType="1/x"/>'
            '<ExternalInterface Name="q" ID="4" RefBaseClassPath="2"/></InternalElement>'
            "</InternalElement>"
        )
    )
    assert reading.targets("Plant::cell::b::y", "mirrors") == ["Plant::cell::a::x"]
    assert reading.targets("Plant::cell::b::q", "mirrors") == ["Plant::cell::a::p"]
    assert reading.targets("Plant::cell::b::q", "typed-by") == ["Interfaces::P"]
    assert reading.findings == []


def test_a_mirror_of_caex_2_may_have_content_which_is_its_own():
    """CAEX 3.0 forbids it; files of 2.15 have it."""
    reading = Read(
        aml_2(
            plant(
                '<InternalElement Name="cell" ID="0">'
                '<InternalElement Name="a" ID="1"><Attribute Name="x"/></InternalElement>'
                '<InternalElement Name="m" ID="2" RefBaseSystemUnitPath="1">'
                '<Attribute Name="y"/></InternalElement></InternalElement>'
            )
        )
    )
    assert reading.targets("Plant::cell::m", "mirrors", "Property") == ["Plant::cell::a"]
    assert reading.list_owned("Plant::cell::m", "Class") == ["Property y"]
    assert reading.targets("Plant::cell::m", "specializes", "Class") == ["Plant::cell::a"]
    assert reading.findings == []


GONE = "1ac5c9b2-45f8-4a4c-8d6a-6d2f5f3b8a01"


@pytest.mark.parametrize(
    ("a", "findings"),
    [
        (
            "2",
            [
                "SM143: 'a' is a mirror of itself, through '2'",
                "SM143: 'b' is a mirror of itself, through '1'",
            ],
        ),
        (
            GONE,
            [
                f"SM138: 'a' is a mirror of '{GONE}', which does not exist",
                f"SM138: 'b' is a mirror of '{GONE}', which does not exist",
            ],
        ),
        ("", []),
    ],
)
def test_mirror_cycles_and_mirrors_without_master_are_errors(a, findings):
    reading = Read(
        plant(
            '<InternalElement Name="cell" ID="0">'
            f'<InternalElement Name="a" ID="1" RefBaseSystemUnitPath="{a}"/>'
            '<InternalElement Name="b" ID="2" RefBaseSystemUnitPath="1"/></InternalElement>'
        )
    )
    assert reading.findings == findings


@pytest.mark.parametrize(
    ("reference", "findings"),
    [
        ("1/x", []),
        ("1/y", ["SM138: 'm' is a mirror of '1/y', which does not exist"]),
        ("1.x", ["SM138: 'm' is a mirror of '1.x', which does not exist"]),
        (f"{GONE}.x", [f"SM138: 'm' is a mirror of '{GONE}.x', which does not exist"]),
        ("L.x", ["SM131: the library 'L.x' is not in the file; 1 element refers to classes of it"]),
    ],
)
def test_a_mirror_names_an_attribute_behind_a_slash(reference, findings):
    """``ID.name`` is meant as a mirror, but no tool resolves it."""
    reading = Read(
        plant(
            '<InternalElement Name="cell" ID="0">'
            f'<Attribute Name="m" RefAttributeType="{reference}"/>'
            '<InternalElement Name="a" ID="1"><Attribute Name="x"/></InternalElement>'
            "</InternalElement>"
        )
    )
    assert reading.findings == findings
    assert len(reading.targets("Plant::cell::m", "mirrors")) == (not findings)


# -- links -----------------------------------------------------------------------------------------


def cell_with_link(side_a, side_b, more=""):
    return PORTS + plant(
        '<InternalElement Name="cell" ID="0"><ExternalInterface Name="f" ID="9"/>'
        '<InternalElement Name="a" ID="1"><ExternalInterface Name="out" ID="10">'
        '<ExternalInterface Name="pin" ID="11"/></ExternalInterface></InternalElement>'
        '<InternalElement Name="b" ID="2"><ExternalInterface Name="Ch. 1^In:x" ID="20"/>'
        f"</InternalElement>{more}"
        f'<InternalLink Name="l" RefPartnerSideA="{side_a}" RefPartnerSideB="{side_b}"/>'
        "</InternalElement>"
    )


@pytest.mark.parametrize(
    ("side", "end"),
    [
        ("10", "a.out"),
        ("11", "a.out.pin"),
        ("9", "f"),
        ("1:out", "a.out"),
        ("{1}:out", "a.out"),
        ("Plant/cell/a:out", "a.out"),
        ("[Plant]/[cell]/[a]:out", "a.out"),
        ("2:Ch. 1^In:x", "b.Ch. 1^In:x"),
    ],
)
def test_every_style_of_link_sides_leads_to_the_port(side, end):
    reading = Read(aml_2(cell_with_link(side, "20")))
    assert reading.links() == {"l": (end, "b.Ch. 1^In:x")}
    assert reading.findings == []


@pytest.mark.parametrize("side", ["c:io", "Plant/cell/[c/1]:io"])
def test_a_side_may_name_an_interface_that_only_the_class_holds(side):
    held = classes(
        '<SystemUnitClass Name="C"><ExternalInterface Name="io" ID="io"/></SystemUnitClass>'
    )
    instance = '<InternalElement Name="c/1" ID="c" RefBaseSystemUnitPath="Lib/C"/>'
    reading = Read(aml_2(cell_with_link(side, "20", instance) + held))
    assert reading.links() == {"l": ("c/1.io", "b.Ch. 1^In:x")}


@pytest.mark.parametrize(
    ("side", "problem"),
    [
        ("connection A0", "it names no interface"),
        ("7f1c1f6e-45f8-4a4c-8d6a-6d2f5f3b8a01", "no element has that id"),
        ("1:in", "'a' has no interface 'in'"),
        ("1", "that is not an interface but 'a'"),
    ],
)
def test_an_unresolved_side_is_reported_and_the_link_becomes_a_dependency(side, problem):
    reading = Read(aml_2(cell_with_link(side, "20")))
    assert reading.links() == {}
    assert reading.findings == [f"SM135: link 'l': its side A refers to '{side}', and {problem}"]
    link = reading.find("Plant::cell::l", "Dependency")
    assert link.attrs["subkind"] == "internal-link"
    ends = [*reading.graph.targets(link, "client"), *reading.graph.targets(link, "supplier")]
    assert "20" in [element.id for element in ends]


def test_an_open_side_is_an_info():
    reading = Read(cell_with_link("10", ""))
    assert reading.findings == []
    assert "SM136: link 'l' has no side B" in reading.infos
    assert reading.targets("Plant::cell::l", "client") == ["Plant::cell::a::out"]


@pytest.mark.parametrize("is_class_first", [True, False])
def test_links_of_a_class_are_its_own_and_are_not_repeated_by_its_instances(is_class_first):
    inside = (
        '<InternalElement Name="a" ID="{0}a"><ExternalInterface Name="p" ID="{0}p"/>'
        '</InternalElement><InternalElement Name="b" ID="{0}b"><ExternalInterface Name="q" '
        'ID="{0}q"/></InternalElement>'
        '<InternalLink Name="l" RefPartnerSideA="{0}p" RefPartnerSideB="{0}q"/>'
    )
    of_class = classes(f'<SystemUnitClass Name="C">{inside.format("c")}</SystemUnitClass>')
    of_plant = plant(
        '<InternalElement Name="x" ID="x" RefBaseSystemUnitPath="Lib/C">'
        f"{inside.format('x')}</InternalElement>"
    )
    reading = Read(of_class + of_plant if is_class_first else of_plant + of_class)
    connectors = [c for c in reading.graph if c.kind.value == "Connector"]
    assert [reading.graph.qualified_name(c) for c in connectors] == ["Lib::C::l"]


def test_two_instances_of_a_class_are_wired_differently():
    parts = "".join(
        f'<InternalElement Name="{n}" ID="c{n}"><ExternalInterface Name="p" ID="c{n}p"/>'
        "</InternalElement>"
        for n in "abc"
    )
    tops = "".join(
        f'<InternalElement Name="{top}" ID="{top}" RefBaseSystemUnitPath="Lib/C">'
        + "".join(
            f'<InternalElement Name="{n}" ID="{top}{n}"><ExternalInterface Name="p" '
            f'ID="{top}{n}p"/></InternalElement>'
            for n in "abc"
        )
        + f'<InternalLink Name="l{top}" RefPartnerSideA="{top}ap" RefPartnerSideB="{top}{to}p"/>'
        "</InternalElement>"
        for top, to in (("x", "b"), ("y", "c"))
    )
    reading = Read(classes(f'<SystemUnitClass Name="C">{parts}</SystemUnitClass>') + plant(tops))
    assert reading.links() == {"lx": ("a.p", "b.p"), "ly": ("a.p", "c.p")}
    assert reading.list_owned("Plant::x", "Instance")[-1] == "Connector lx"
    assert reading.list_owned("Plant::y", "Instance")[-1] == "Connector ly"


def test_a_group_at_the_top_of_a_hierarchy_is_owned_by_it():
    group = (
        '<InternalElement Name="g" ID="g"><InternalElement Name="m" ID="m" '
        'RefBaseSystemUnitPath="a"/><RoleRequirements RefBaseRoleClassPath="'
        'AutomationMLBaseRoleClassLib/AutomationMLBaseRole/Group"/></InternalElement>'
    )
    reading = Read(plant(f'<InternalElement Name="a" ID="a"/>{group}'))
    assert reading.list_owned("Plant") == ["Instance a", "Class a", "Group g"]
    assert reading.targets("Plant::g", "references") == ["Plant::a"]


def test_an_element_in_a_class_that_only_repeats_a_part_keeps_its_id_and_description():
    """As in a plant: an Instance with its ID, which represents the part and may be mirrored."""
    reading = Read(
        classes(
            '<SystemUnitClass Name="A"><InternalElement Name="m" ID="m"/></SystemUnitClass>'
            '<SystemUnitClass Name="B"><InternalElement Name="a" ID="a" '
            'RefBaseSystemUnitPath="Lib/A"><InternalElement Name="m" ID="again">'
            "<Description>the left one</Description><Version>2</Version></InternalElement>"
            '</InternalElement><InternalElement Name="x" ID="x" RefBaseSystemUnitPath="again"/>'
            "</SystemUnitClass>"
        )
    )
    again = reading.graph["again"]
    assert (again.kind, again.attrs["version"]) == ("Instance", "2")
    assert reading.graph["again/Description"].attrs["body"] == "the left one"
    assert reading.targets("Lib::B::a::m", "represents") == ["Lib::A::m"]
    assert reading.targets("Lib::B::x", "mirrors") == ["Lib::B::a::m"]
    assert reading.findings == []


@pytest.mark.parametrize(
    ("path", "kinds"),
    [
        ("", ["Slot"]),
        ("Types/Width", ["Slot"]),
        ("Types/Length", ["Slot"]),
        ("Types/Colour", ["Property"]),
    ],
)
def test_an_attribute_of_an_instance_overrides_with_a_type_that_its_own_is_not(path, kinds):
    reading = Read(
        types(
            '<AttributeType Name="Length"/><AttributeType Name="Colour"/>'
            '<AttributeType Name="Width" RefAttributeType="Types/Length"/>'
        )
        + classes(
            '<SystemUnitClass Name="Box"><Attribute Name="w" RefAttributeType="Types/Width"/>'
            "</SystemUnitClass>"
        )
        + plant(
            '<InternalElement Name="box" ID="1" RefBaseSystemUnitPath="Lib/Box">'
            f'<Attribute Name="w" RefAttributeType="{path}"><Value>1</Value></Attribute>'
            "</InternalElement>"
        )
    )
    assert [str(element.kind) for element in reading.find_all("Plant::box::w")] == kinds
