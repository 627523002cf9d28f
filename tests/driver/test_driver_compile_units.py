"""The files of a folder are partitioned into compile units by their references."""

import shutil
from pathlib import Path

import pytest

from sysmlc.driver import Request, open_units

EXAMPLES = Path(__file__).parents[2] / "examples"
UML = """\
<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"{namespaces}>
<uml:{root} xmi:id="{name}" name="{name}">{content}</uml:{root}>
</xmi:XMI>
"""
AML = """\
<CAEXFile FileName="{name}" SchemaVersion="2.15">
{reference}<{content} Name="{name}"/>
</CAEXFile>
"""


def format_uml(name, *hrefs, root="Model", namespaces=""):
    content = "".join(
        f'<packageImport xmi:type="uml:PackageImport" xmi:id="{name}{number}">'
        f'<importedPackage xmi:type="uml:Package" href="{href}#x"/></packageImport>'
        for number, href in enumerate(hrefs)
    )
    return UML.format(name=name, root=root, content=content, namespaces=namespaces)


def format_aml(name, path="", content="InstanceHierarchy"):
    reference = f'<ExternalReference Path="{path}" Alias="Lib"/>\n' if path else ""
    return AML.format(name=name, reference=reference, content=content)


def list_units(folder, files, *inputs):
    """Write the files; return the source names of each unit by the name of the unit."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    paths = tuple(folder / name for name in inputs) or (folder,)
    return {
        unit.name: [source.name for source in unit.reading.sources()]
        for unit in open_units(Request(paths))
    }


def test_files_that_do_not_refer_to_one_another_are_separate_units(tmp_path):
    files = {"a.uml": format_uml("A"), "b.uml": format_uml("B"), "plants/c.aml": format_aml("C")}
    assert list_units(tmp_path, files) == {
        "a.uml": ["a.uml"],
        "b.uml": ["b.uml"],
        "plants": ["plants/c.aml"],
    }


def test_files_connected_by_href_are_one_unit(tmp_path):
    files = {
        "a.uml": format_uml("A", "parts/b.uml"),
        "parts/b.uml": format_uml("B"),
        "c.uml": format_uml("C"),
    }
    assert list_units(tmp_path, files) == {"a.uml": ["a.uml", "parts/b.uml"], "c.uml": ["c.uml"]}


def test_automationml_files_connected_by_an_alias_are_one_unit(tmp_path):
    files = {
        "cell.aml": format_aml("Cell", "robot.aml"),
        "robot.aml": format_aml("Robot"),
        "x.aml": format_aml("X"),
    }
    assert list_units(tmp_path, files) == {
        "cell.aml": ["cell.aml", "robot.aml"],
        "x.aml": ["x.aml"],
    }


@pytest.mark.parametrize(
    ("library", "format_user"),
    [
        (format_uml("P", root="Profile"), lambda name: format_uml(name, "lib.xml")),
        (
            format_uml("My Profile", root="Profile"),
            lambda name: format_uml(
                name, namespaces=' xmlns:p="http://www.magicdraw.com/schemas/My_Profile.xmi"'
            ),
        ),
        (format_aml("L", content="RoleClassLib"), lambda name: format_aml(name, "lib.xml")),
    ],
    ids=["profile by href", "profile by namespace", "role class library"],
)
def test_a_library_belongs_to_each_unit_that_uses_it(tmp_path, library, format_user):
    files = {"lib.xml": library, "one.xml": format_user("One"), "two.xml": format_user("Two")}
    assert list_units(tmp_path, files) == {
        "one.xml": ["lib.xml", "one.xml"],
        "two.xml": ["lib.xml", "two.xml"],
    }


def test_libraries_that_no_model_uses_are_a_unit_of_their_own(tmp_path):
    files = {"a.uml": format_uml("A"), "p.uml": format_uml("P", root="Profile")}
    assert list_units(tmp_path, files) == {"a.uml": ["a.uml"], "p.uml": ["p.uml"]}


def test_files_given_by_name_are_one_unit(tmp_path):
    files = {"a.uml": format_uml("A"), "b.aml": format_aml("B")}
    assert list(list_units(tmp_path, files, "a.uml", "b.aml").values()) == [["a.uml", "b.aml"]]


def test_an_overlay_connects_its_plant_with_the_models_that_it_names(tmp_path):
    shutil.copytree(EXAMPLES / "four-tasks", tmp_path / "tasks")
    units = list_units(tmp_path, {"other.aml": format_aml("Other")})
    assert list(units.values()) == [["other.aml"], ["tasks/cell.aml", "tasks/four-tasks.uml"]]


def test_a_folder_of_texts_is_one_unit_with_its_subfolders(tmp_path):
    files = {"01/a.sysml": "package A;", "02/b.sysml": "package B;"}
    assert list(list_units(tmp_path, files).values()) == [["01/a.sysml", "02/b.sysml"]]


MIXED = {"plant.aml": format_aml("Plant"), "a/a.sysml": "package A { part def T; }"}


def test_texts_beside_other_models_are_one_unit_for_each_folder(tmp_path):
    files = {**MIXED, "b/b1.sysml": "package B1;", "b/b2.sysml": "package B2 { part T; }"}
    assert list_units(tmp_path, files) == {
        "a": ["a/a.sysml"],
        "b": ["b/b1.sysml", "b/b2.sysml"],
        tmp_path.name: ["plant.aml"],
    }


@pytest.mark.parametrize(
    "text",
    ["package B { import A::*; }", "package B { part t : A::T; }", "package B { part t : $::A; }"],
)
def test_texts_that_name_a_package_of_another_folder_are_one_unit(tmp_path, text):
    units = list_units(tmp_path, {**MIXED, "b/b.sysml": text})
    assert sorted(units.values()) == [["a/a.sysml", "b/b.sysml"], ["plant.aml"]]


def test_a_name_that_a_text_defines_itself_connects_nothing(tmp_path):
    units = list_units(tmp_path, {**MIXED, "b/b.sysml": "package B { part def A; part a : A; }"})
    assert sorted(units.values()) == [["a/a.sysml"], ["b/b.sysml"], ["plant.aml"]]


def test_a_name_of_two_packages_means_the_nearest(tmp_path):
    copy = {
        "lib/lib.sysml": "package Lib;",
        "main/main.sysml": "package Main { import Lib::*; }",
        "x.uml": format_uml("X"),
    }
    files = {f"{top}/{name}": text for top in ("v1", "v2") for name, text in copy.items()}
    assert sorted(list_units(tmp_path, files).values()) == [
        ["v1/lib/lib.sysml", "v1/main/main.sysml"],
        ["v1/x.uml"],
        ["v2/lib/lib.sysml", "v2/main/main.sysml"],
        ["v2/x.uml"],
    ]


def test_a_text_and_the_uml_of_the_same_model_are_separate_units():
    assert [unit.name for unit in open_units(Request((EXAMPLES / "robots",)))] == [
        "hall.sysml",
        "hall.uml",
    ]


def test_names_of_units_are_unique_where_file_systems_ignore_case(tmp_path):
    units = list_units(tmp_path, {"A/a.uml": format_uml("A"), "a/a.uml": format_uml("B")})
    assert len({name.lower() for name in units}) == 2


def test_diagnostics_about_skipped_files_belong_to_one_unit(tmp_path):
    files = {"a.uml": format_uml("A"), "b.uml": format_uml("B"), "notes.xml": "<notes/>"}
    list_units(tmp_path, files)
    first, second = open_units(Request((tmp_path,)))
    assert [diagnostic.rule.code for diagnostic in first.sink] == ["SM175"]
    assert not list(second.sink)
