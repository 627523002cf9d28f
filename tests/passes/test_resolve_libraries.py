"""External stubs for the libraries of UML, SysML and MagicDraw are the same in every dialect."""

import json

import pytest
from jsonschema import Draft202012Validator
from pass_runs import list_codes, run_until

from sysmlc.ir import Edge, Kind
from sysmlc.passes.resolve.libraries import Libraries, load_libraries, read_names
from sysmlc.support import resources

BLOCK = (
    "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_Blocks"
    ".stereotype_packagedElement_Block",
    "pathmap://SysML14_PROFILES/SysML.profile.uml#SysML.package_packagedElement_Blocks"
    ".stereotype_packagedElement_Block",
    "pathmap://SysML_PROFILES/SysML.profile.uml#_8J2A8LVAEdu2ieF4ON8UjA",
    "http://www.eclipse.org/papyrus/sysml/1.6/SysML#//blocks/Block",
    "https://www.omg.org/spec/SysML/20240101/SysML.xmi#SysML.Block",
    "http://www.omg.org/spec/SysML/20150709/SysML.xmi#_SysML_Blocks_PackageableElement-Block_PackageableElement",
    "SysML%20Profile.mdzip#_11_5EAPbeta_be00301_1147424179914_458922_958",
    "../exported/SysML.profile.uml#_11_5EAPbeta_be00301_1147424179914_458922_958",
)


def print_profile(*generals: str) -> str:
    """Return a profile whose stereotype specialises *generals* and is applied to a class."""
    lines = "".join(f'    ?> specializes "{general}" Stereotype\n' for general in generals)
    return (
        'Class gate "Gate" @m/a.uml:1\n'
        '  Application app "Station" stereotype="Station" namespace="http://plant"\n'
        "    -> subject gate\n"
        'Profile plant "plant" uri="http://plant" @m/p.uml:1\n'
        '  Stereotype station "Station" @m/p.uml:2\n' + lines
    )


@pytest.mark.parametrize("href", BLOCK)
def test_block_is_the_same_element_in_every_dialect(href):
    graph, sink = run_until(print_profile(href), "resolve")
    block = graph.target(graph["station"], Edge.SPECIALIZES)
    assert (block.kind, graph.qualified_name(block)) == (Kind.STEREOTYPE, "SysML::Blocks::Block")
    assert block.attrs["href"] == "http://www.omg.org/spec/SysML/20181001/SysML.xmi#Blocks.Block"
    assert block.attrs["external"]
    assert block.attrs["library"]
    assert [graph.qualified_name(c) for c in graph.targets(block, Edge.EXTENDS)] == ["UML::Class"]
    assert list_codes(sink) == []


@pytest.mark.parametrize("href", BLOCK)
def test_a_stereotype_that_specialises_block_makes_a_class_a_block(href):
    graph, sink = run_until(print_profile(href), "classify")
    assert graph["gate"].role == "block"
    assert graph["app"].attrs["lineage"] == ("Station", "Block")
    assert list_codes(sink) == []


def test_generals_within_the_library_give_role_and_lineage():
    interface_block = "SysML%20Profile.mdzip#_17_0_3_17530432_1320213059640_259248_2362"
    graph, _ = run_until(print_profile(interface_block), "classify")
    assert graph["gate"].role == "interface block"
    assert graph["app"].attrs["lineage"] == ("Station", "InterfaceBlock", "Block")
    part_property = "MD_customization_for_SysML.mdzip#_15_0_be00301_1199377756297_348405_2678"
    graph, _ = run_until(print_profile(part_property), "classify")
    assert graph["app"].attrs["lineage"] == ("Station", "PartProperty", "BlockProperty")


def test_a_foreign_stereotype_named_block_gives_no_role():
    graph, _ = run_until(
        print_profile("company.profile.uml#_companys_own_Block_000001"), "classify"
    )
    assert graph["gate"].role == ""


def test_dialects_in_one_unit_share_the_stub():
    graph, _ = run_until(print_profile(*BLOCK), "resolve")
    assert len(graph.targets(graph["station"], Edge.SPECIALIZES)) == 1
    assert [e.name for e in graph.of_kind(Kind.STEREOTYPE)] == ["Station", "Block"]


@pytest.mark.parametrize(
    ("href", "kind", "name"),
    [
        ("pathmap://UML_METAMODELS/UML.metamodel.uml#Port", "Class", "UML::Port"),
        ("http://www.eclipse.org/uml2/5.0.0/UML#//Port", "Class", "UML::Port"),
        ("http://www.omg.org/spec/UML/20131001/UML.xmi#Port", "Class", "UML::Port"),
        ("pathmap://UML_PROFILES/Standard.profile.uml#Trace", "Stereotype",
         "StandardProfile::Trace"),
        ("UML_Standard_Profile.mdzip#magicdraw_1046861421246_733231_63", "Stereotype",
         "StandardProfile::Trace"),
        ("http://www.omg.org/spec/SysML/20150709/SysML.xmi#_SysML__0", "Profile", "SysML"),
        ("pathmap://SysML16_PROFILES/SysML.profile.uml#SysML", "Profile", "SysML"),
        ("pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_Ports_u0026Flows",
         "Profile", "SysML::Ports&Flows"),
        ("http://www.eclipse.org/papyrus/0.7.0/SysML#//portandflows", "Profile",
         "SysML::Ports&Flows"),
        ("pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML.package_packagedElement_"
         "Libraries.package_packagedElement_PrimitiveValueTypes.dataType_packagedElement_Complex",
         "DataType", "SysML::Libraries::PrimitiveValueTypes::Complex"),
        ("ISO-80000.mdzip#_18_0beta_903028d_1388650184197_68200_89010", "DataType",
         "ISO-80000::ISO80000-3 Space and Time::Quantities::length::length[metre]"),
        ("MTIP:not-exported#_11_5EAPbeta_be00301_1147937861492_957324_2636", "EnumerationLiteral",
         "SysML::Libraries::Verdicts::VerdictKind::pass"),
    ],
)  # fmt: skip
def test_stubs_have_kind_and_qualified_name(href, kind, name):
    text = f'Property p "p" @m/a.uml:1\n  ?> references "{href}" Class\n'
    graph, sink = run_until(text, "resolve")
    stub = graph.target(graph["p"], Edge.REFERENCES)
    assert (stub.kind, graph.qualified_name(stub)) == (kind, name)
    assert list_codes(sink) == []


def test_an_applied_package_of_sysml_is_a_profile():
    href = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_Blocks"
    graph, _ = run_until(f'Package m "M"\n  ?> applies "{href}" Profile\n', "resolve")
    assert graph.target(graph["m"], Edge.APPLIES).kind is Kind.PROFILE


def test_the_qualified_name_in_a_reference_finds_elements_with_unknown_ids():
    entry = load_libraries().find(
        "SysML Profile.mdzip", "_2024x_1", "SysML::Ports&Flows::ProxyPort", {Kind.STEREOTYPE}
    )
    assert entry.qualified_name == "SysML::Ports&Flows::ProxyPort"
    assert load_libraries().find("plant.mdzip", "_2024x_1", "SysML::Blocks::Block", ()) is None
    assert load_libraries().find("SysML Profile.mdzip", "_2024x_1", "", ()) is None


def test_kind_and_owner_select_among_elements_of_the_same_name():
    find = load_libraries().find
    profile = "SysML Profile.mdzip"
    assert find(profile, "Block", "", {Kind.STEREOTYPE}).qualified_name == "SysML::Blocks::Block"
    package = find(profile, "Block", "", {Kind.PACKAGE}).qualified_name
    assert package == "SysML::Non-Normative Extensions::Block"
    unit = find(profile, "x", "SysML::Libraries::UnitAndQuantityKind::Unit", {Kind.CLASS})
    assert unit.qualified_name == "SysML::Libraries::UnitAndQuantityKind::Unit"


@pytest.mark.parametrize(
    ("fragment", "names"),
    [
        ("SysML.package_packagedElement_Ports_u0026Flows.stereotype_packagedElement_FullPort",
         ["SysML", "Ports&Flows", "FullPort"]),
        ("//blocks/Block", ["blocks", "Block"]),
        ("_SysML_Libraries_PackageableElement-Verdicts_PackageableElement",
         ["Libraries", "Verdicts"]),
        ("_0", []),
        ("/", []),
        ("", []),
    ],
)  # fmt: skip
def test_names_are_read_from_fragments(fragment, names):
    assert read_names(fragment) == names


def test_the_data_file_is_valid_against_its_schema():
    schema = json.loads(resources.read_text("metamodels", "sysmlc-libraries.schema.json"))
    Draft202012Validator.check_schema(schema)
    data = json.loads(resources.read_text("metamodels", "libraries.json"))
    Draft202012Validator(schema).validate(data)
    assert list(Draft202012Validator(schema).iter_errors({**data, "elements": {"x": {}}}))


def test_the_data_file_is_closed_and_its_ids_are_unique():
    data = json.loads(resources.read_text("metamodels", "libraries.json"))["elements"]
    ids = [id for entry in data.values() for id in entry.get("ids", ())]
    assert len(ids) == len(set(ids))
    for name, entry in data.items():
        assert name.rpartition("::")[0] in {"", *data}, name
        assert set(entry.get("specializes", ())) <= set(data), name


def test_an_empty_library_finds_nothing():
    empty = Libraries('{"format": "sysmlc-libraries/1", "libraries": [], "elements": {}}')
    assert empty.find("SysML Profile.mdzip", "Block", "", ()) is None
    assert empty.get("SysML::Blocks::Block") is None
