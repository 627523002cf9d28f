"""Class paths, aliases and ids: how a reference finds what it means."""

import pytest
from reading_caex import Read, aml, aml_2, classes, interfaces, plant, roles, types

from sysmlc.diagnostics.renderers import make_report, merge_facts

BRACKETS = classes(
    '<SystemUnitClass Name="B/2"><SystemUnitClass Name="T.1"/></SystemUnitClass>'
    '<SystemUnitClass Name="http://a.b/c"/>'
)


# -- separators and brackets -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "resolved"),
    [
        ("Lib/[B/2]", "Lib::B/2"),
        ("[Lib]/[B/2]", "Lib::B/2"),
        ("[Lib]/[B/2]/[T.1]", "Lib::B/2::T.1"),
        ("Lib/[B/2]/T.1", "Lib::B/2::T.1"),
        ("Lib/[http://a.b/c]", "Lib::http://a.b/c"),
    ],
)
def test_one_name_or_all_names_of_a_path_may_be_in_brackets(path, resolved):
    reading = Read(BRACKETS + plant(f'<InternalElement Name="x" RefBaseSystemUnitPath="{path}"/>'))
    assert reading.targets("Plant::x", "instance-of") == [resolved]
    assert reading.findings == []


def test_without_brackets_a_separator_separates():
    reading = Read(BRACKETS + plant('<InternalElement Name="x" RefBaseSystemUnitPath="Lib/B/2"/>'))
    assert reading.findings == [
        "SM130: 'Plant::x' refers to the class 'Lib/B/2', which does not exist"
    ]


# -- families of classes ---------------------------------------------------------------------------


def test_a_path_resolves_to_a_class_of_its_family_among_several_of_that_path():
    reading = Read(
        classes(
            '<SystemUnitClass Name="Unit">'
            '<InternalElement Name="Valve" ID="inner"/><SystemUnitClass Name="Valve"/>'
            "</SystemUnitClass>"
        )
        + roles('<RoleClass Name="Unit"/>', "Lib")
        + plant(
            '<InternalElement Name="v" RefBaseSystemUnitPath="Lib/Unit/Valve">'
            '<RoleRequirements RefBaseRoleClassPath="Lib/Unit"/></InternalElement>'
        )
    )
    (general,) = reading.graph.targets(reading.find("Plant::v"), "instance-of")
    assert reading.graph.qualified_name(general) == "Lib::Unit::Valve"
    assert "subkind" not in general.attrs
    (role,) = reading.graph.targets(reading.find("Plant::v"), "realizes")
    assert role.attrs["subkind"] == "role-class"
    assert reading.findings == []


def test_a_role_path_does_not_resolve_to_a_system_unit_class():
    reading = Read(
        classes('<SystemUnitClass Name="A"/>')
        + roles('<RoleClass Name="B"/>', "Lib")
        + plant(
            '<InternalElement Name="v"><SupportedRoleClass RefRoleClassPath="Lib/A"/>'
            "</InternalElement>"
        )
    )
    assert reading.findings == [
        "SM130: 'Plant::v::SupportedRoleClass' refers to the class 'Lib/A', which does not exist"
    ]


# -- nesting is no inheritance ---------------------------------------------------------------------


def test_a_nested_class_does_not_inherit_from_the_enclosing_class():
    reading = Read(
        roles('<RoleClass Name="A"><Attribute Name="x"/><RoleClass Name="B"/></RoleClass>')
    )
    assert reading.targets("Roles::A::B", "specializes") == []


def test_the_bare_name_of_the_enclosing_class_means_that_class():
    reading = Read(
        roles('<RoleClass Name="A"><RoleClass Name="B" RefBaseClassPath="A"/></RoleClass>')
    )
    assert reading.targets("Roles::A::B", "specializes") == ["Roles::A"]
    assert reading.findings == []


def test_another_bare_name_means_a_library():
    reading = Read(
        roles('<RoleClass Name="A"><RoleClass Name="B" RefBaseClassPath="C"/></RoleClass>')
    )
    assert reading.targets("Roles::A::B", "specializes") == []
    assert reading.findings == [
        "SM131: the library 'C' is not in the file; 1 element refers to classes of it"
    ]


# -- aliases ---------------------------------------------------------------------------------------

BASE = aml(roles('<RoleClass Name="Base"/>', "Shared"), "libs/base.aml")


def file_with_alias(path, alias="Al", more=""):
    return aml(
        f'<ExternalReference Path="{path}" Alias="{alias}"/>'
        + roles('<RoleClass Name="Gate" RefBaseClassPath="Al@Shared/Base"/>' + more),
        "plant/main.aml",
    )


def test_a_library_in_another_file_needs_an_alias_as_the_advice_says():
    plain = roles('<RoleClass Name="Gate" RefBaseClassPath="Shared/Base"/>')
    reading = Read(aml(plain, "plant/main.aml"), BASE)
    diagnostic = next(found for found in reading.sink if found.rule.code == "SM131")
    assert diagnostic.help.endswith("with an alias and write <alias>@Shared/... in the paths")
    assert Read(file_with_alias("../libs/base.aml"), BASE).findings == []


@pytest.mark.parametrize("path", ["../libs/base.aml", "..%2Flibs/base.aml", "./../libs/./base.aml"])
def test_an_alias_leads_into_another_file_of_the_unit(path):
    reading = Read(file_with_alias(path), BASE)
    assert reading.targets("Roles::Gate", "specializes") == ["Shared::Base"]
    assert reading.targets("Al", "references") == ["plant.aml"]
    assert reading.findings == []


def test_a_missing_file_is_reported_once_with_all_references_to_it():
    door = '<RoleClass Name="Door" RefBaseClassPath="Al@Shared/Base"/>'
    reading = Read(file_with_alias("../libs/gone.aml", more=door), BASE)
    assert reading.findings == [
        "SM132: the file 'libs/gone.aml' is not part of the compile unit; "
        "2 elements refer to classes of it"
    ]
    (diagnostic,) = [diagnostic for diagnostic in reading.sink if diagnostic.rule.code == "SM132"]
    assert diagnostic.notes == (
        "Roles::Gate (plant/main.aml:1:165)",
        "Roles::Door (plant/main.aml:1:223)",
    )
    assert (diagnostic.subject.place.file, diagnostic.subject.place.ordinal) == (
        "plant/main.aml",
        3,
    )


def test_an_alias_without_declaration_is_a_located_error():
    reading = Read(file_with_alias("../libs/base.aml", alias="Other"), BASE)
    assert reading.findings == [
        "SM133: 'Roles::Gate' uses the alias 'Al', which no ExternalReference declares"
    ]


def test_references_to_one_missing_alias_class_or_end_are_one_finding():
    doors = "".join(f'<RoleClass Name="{n}" RefBaseClassPath="Al@Base/Door"/>' for n in "ABC")
    missing = "".join(f'<RoleClass Name="{n}" RefBaseClassPath="Roles/Gone"/>' for n in "DE")
    other = '<RoleClass Name="F" RefBaseClassPath="Bl@Base/X"/>'
    source = aml(roles(doors + missing + other) + plant('<InternalElement Name="i" ID="1"/>'))
    (_, *findings) = merge_facts(make_report(Read(source).sink, [source]).findings)
    assert [finding.diagnostic.message for finding in findings] == [
        "'Roles::A' uses the alias 'Al', which no ExternalReference declares (3 places)",
        "'Roles::D' refers to the class 'Roles/Gone', which does not exist (2 places)",
        "'Roles::F' uses the alias 'Bl', which no ExternalReference declares",
    ]
    assert findings[0].diagnostic.notes[0].startswith("also Roles::B (plant.aml:1:")


def test_unresolved_references_are_stored_in_the_graph():
    reading = Read(file_with_alias("../libs/base.aml", alias="Other"), BASE)
    assert reading.find("Roles::Gate").attrs["unresolved"] == ("specializes",)


# -- ids -------------------------------------------------------------------------------------------


def two_linked_elements(side_a, side_b):
    return plant(
        '<InternalElement Name="cell" ID="{AB-0}">'
        '<InternalElement Name="a" ID="{AB-1}"><ExternalInterface Name="out"/></InternalElement>'
        '<InternalElement Name="b" ID="ab-2"><ExternalInterface Name="in"/></InternalElement>'
        f'<InternalLink Name="l" RefPartnerSideA="{side_a}" RefPartnerSideB="{side_b}"/>'
        "</InternalElement>"
    )


def test_ids_are_compared_literally_first():
    reading = Read(aml_2(two_linked_elements("{AB-1}:out", "ab-2:in")))
    assert reading.links() == {"l": ("a.out", "b.in")}
    assert reading.findings == []


def test_ids_that_differ_in_braces_and_case_are_found_with_an_info():
    reading = Read(aml_2(two_linked_elements("ab-1:out", "{AB-2}:in")))
    assert reading.links() == {"l": ("a.out", "b.in")}
    assert reading.infos == [
        "SM145: 'l' refers to 'ab-1', but the ID is written '{AB-1}'",
        "SM145: 'l' refers to '{AB-2}', but the ID is written 'ab-2'",
    ]


def test_an_id_that_differs_otherwise_is_not_found():
    reading = Read(aml_2(two_linked_elements("ab-3:out", "ab-2:in")))
    assert reading.links() == {}
    assert reading.findings == [
        "SM135: link 'l': its side A refers to 'ab-3:out', and it names no interface"
    ]


def test_an_id_may_follow_an_alias():
    other = aml(plant('<InternalElement Name="master" ID="m"/>', "Other"), "other.aml")
    reading = Read(
        aml(
            '<ExternalReference Path="other.aml" Alias="Al"/>'
            + plant(
                '<InternalElement Name="cell" ID="0"><InternalElement Name="mirror" ID="1" '
                'RefBaseSystemUnitPath="Al@m"/></InternalElement>'
            )
        ),
        other,
    )
    assert reading.targets("Plant::cell::mirror", "mirrors", "Property") == ["Other::master"]
    assert reading.findings == []


def test_a_file_refers_to_its_own_elements_if_another_file_has_the_same_ids():
    first, second = (
        aml(two_linked_elements("{AB-1}:out", "ab-2:in"), name) for name in ("a.aml", "b.aml")
    )
    reading = Read(first, second)
    assert reading.findings == [
        "SM341: the ID '{AB-0}' of 'Plant::cell' is that of 'Plant::cell' in 'a.aml' too "
        "(2 more in the file)"
    ]
    ends = [e for e in reading.graph if e.kind.value == "ConnectorEnd"]
    for end in ends:
        (port,) = reading.graph.targets(end, "role")
        assert port.source == end.source
    assert len(ends) == 4


def test_the_order_of_the_files_changes_nothing():
    assert (
        Read(file_with_alias("../libs/base.aml"), BASE).text
        == Read(BASE, file_with_alias("../libs/base.aml")).text
    )


def test_a_repeated_id_is_reported_and_means_the_first_element():
    reading = Read(plant('<InternalElement Name="a" ID="1"/><InternalElement Name="b" ID="1"/>'))
    assert reading.findings == ["SM137: the ID '1' of 'b' is used by another element too"]
    assert (
        len({reading.find("Plant::a", "Instance").id, reading.find("Plant::b", "Instance").id}) == 2
    )


def test_elements_without_id_are_reported_once_a_file():
    reading = Read(
        plant('<InternalElement Name="a"/><InternalElement Name="b"/>')
        + classes('<SystemUnitClass Name="C"/>')
    )
    assert reading.infos == ["SM146: 'Plant::a' has no ID, nor have 1 more elements of the file"]


# -- role requirements -----------------------------------------------------------------------------

THREE_ROLES = roles('<RoleClass Name="A"/><RoleClass Name="B"/><RoleClass Name="C"/>')


@pytest.mark.parametrize(
    ("form", "inside"),
    [
        (
            aml_2,
            '<SupportedRoleClass RefRoleClassPath="Roles/A"/>'
            '<SupportedRoleClass RefRoleClassPath="Roles/B"/>'
            '<RoleRequirements RefBaseRoleClassPath="Roles/A"/>',
        ),
        (
            aml,
            '<RoleRequirements RefBaseRoleClassPath="Roles/A"/>'
            '<RoleRequirements RefBaseRoleClassPath="Roles/B"/>',
        ),
    ],
)
def test_an_element_realizes_each_of_its_roles_once(form, inside):
    body = THREE_ROLES + plant(f'<InternalElement Name="x" ID="1">{inside}</InternalElement>')
    reading = Read(form(body))
    assert reading.targets("Plant::x", "realizes", "Class") == ["Roles::A", "Roles::B"]
    assert reading.findings == []


def test_role_requirements_without_a_path_are_no_role():
    body = THREE_ROLES + plant(
        '<InternalElement Name="x" ID="1"><RoleRequirements/></InternalElement>'
    )
    reading = Read(aml_2(body))
    assert reading.targets("Plant::x", "realizes", "Class") == []
    assert reading.findings == []


# -- classes that instances name -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("port", "attribute", "findings"),
    [
        ("Interfaces/P", "Types/T", []),
        ("Interfaces/P", "", []),
        ("Interfaces/Q", "Types/T", ["'Plant::x::p' refers to the class 'Interfaces/Q'"]),
        ("Interfaces/P", "Types/U", ["'Plant::x::a' refers to the class 'Types/U'"]),
    ],
)
def test_a_missing_class_that_only_an_instance_names_is_reported_at_the_instance(
    port, attribute, findings
):
    """And nothing is missing to the class, which names the right one."""
    reading = Read(
        interfaces('<InterfaceClass Name="P"/>')
        + types('<AttributeType Name="T"/>')
        + classes(
            '<SystemUnitClass Name="C"><Attribute Name="a" RefAttributeType="Types/T"/>'
            '<ExternalInterface Name="p" RefBaseClassPath="Interfaces/P"/></SystemUnitClass>'
        )
        + plant(
            '<InternalElement Name="x" ID="1" RefBaseSystemUnitPath="Lib/C">'
            f'<Attribute Name="a" RefAttributeType="{attribute}"/>'
            f'<ExternalInterface Name="p" RefBaseClassPath="{port}"/></InternalElement>'
        )
    )
    assert reading.findings == [f"SM130: {text}, which does not exist" for text in findings]
    assert "unresolved" not in reading.find("Lib::C::p").attrs
    assert reading.targets("Plant::x", "instance-of", "Instance") == ["Lib::C"]


def test_of_two_declarations_of_an_alias_the_first_counts():
    reading = Read(
        aml(
            '<ExternalReference Path="../libs/base.aml" Alias="Al"/>'
            '<ExternalReference Path="../libs/other.aml" Alias="Al"/>'
            + roles('<RoleClass Name="Gate" RefBaseClassPath="Al@Shared/Base"/>'),
            "plant/main.aml",
        ),
        BASE,
    )
    assert reading.targets("Roles::Gate", "specializes") == ["Shared::Base"]
    assert len(reading.find_all("Al", "Import")) == 2
    assert reading.findings == [
        "SM636: the alias 'Al' is declared for '../libs/other.aml', but already stands for "
        "'../libs/base.aml'"
    ]


def test_an_alias_that_is_declared_twice_for_one_file_is_not_reported():
    reading = Read(
        aml(
            '<ExternalReference Path="../libs/base.aml" Alias="Al"/>'
            '<ExternalReference Path="../libs/./base.aml" Alias="Al"/>'
            + roles('<RoleClass Name="Gate" RefBaseClassPath="Al@Shared/Base"/>'),
            "plant/main.aml",
        ),
        BASE,
    )
    assert reading.findings == []
