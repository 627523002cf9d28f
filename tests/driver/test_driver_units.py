"""Files of a folder are partitioned into compile units."""

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


def uml(name, *hrefs, root="Model", namespaces=""):
    content = "".join(
        f'<packageImport xmi:type="uml:PackageImport" xmi:id="{name}{number}">'
        f'<importedPackage xmi:type="uml:Package" href="{href}#x"/></packageImport>'
        for number, href in enumerate(hrefs)
    )
    return UML.format(name=name, root=root, content=content, namespaces=namespaces)


def aml(name, path="", content="InstanceHierarchy"):
    reference = f'<ExternalReference Path="{path}" Alias="Lib"/>\n' if path else ""
    return AML.format(name=name, reference=reference, content=content)


def units(folder, files, *named):
    """Write the files; return the source names of each unit by the name of the unit."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    inputs = tuple(folder / name for name in named) or (folder,)
    return {
        opened.name: [source.name for source in opened.reading.sources()]
        for opened in open_units(Request(inputs))
    }


def test_files_that_do_not_refer_to_one_another_are_separate_units(tmp_path):
    files = {"a.uml": uml("A"), "b.uml": uml("B"), "plants/c.aml": aml("C")}
    assert units(tmp_path, files) == {
        "a.uml": ["a.uml"],
        "b.uml": ["b.uml"],
        "plants": ["plants/c.aml"],
    }


def test_files_connected_by_href_are_one_unit(tmp_path):
    files = {"a.uml": uml("A", "parts/b.uml"), "parts/b.uml": uml("B"), "c.uml": uml("C")}
    assert units(tmp_path, files) == {"a.uml": ["a.uml", "parts/b.uml"], "c.uml": ["c.uml"]}


def test_automationml_files_connected_by_an_alias_are_one_unit(tmp_path):
    files = {"cell.aml": aml("Cell", "robot.aml"), "robot.aml": aml("Robot"), "x.aml": aml("X")}
    assert units(tmp_path, files) == {"cell.aml": ["cell.aml", "robot.aml"], "x.aml": ["x.aml"]}


@pytest.mark.parametrize(
    ("library", "use"),
    [
        (uml("P", root="Profile"), lambda name: uml(name, "lib.xml")),
        (
            uml("My Profile", root="Profile"),
            lambda name: uml(
                name, namespaces=' xmlns:p="http://www.magicdraw.com/schemas/My_Profile.xmi"'
            ),
        ),
        (aml("L", content="RoleClassLib"), lambda name: aml(name, "lib.xml")),
    ],
    ids=["profile by href", "profile by namespace", "role class library"],
)
def test_a_library_belongs_to_each_unit_that_uses_it(tmp_path, library, use):
    files = {"lib.xml": library, "one.xml": use("One"), "two.xml": use("Two")}
    assert units(tmp_path, files) == {
        "one.xml": ["lib.xml", "one.xml"],
        "two.xml": ["lib.xml", "two.xml"],
    }


def test_libraries_that_no_model_uses_are_a_unit_of_their_own(tmp_path):
    files = {"a.uml": uml("A"), "p.uml": uml("P", root="Profile")}
    assert units(tmp_path, files) == {"a.uml": ["a.uml"], "p.uml": ["p.uml"]}


def test_files_that_are_named_one_by_one_are_one_unit(tmp_path):
    files = {"a.uml": uml("A"), "b.aml": aml("B")}
    assert list(units(tmp_path, files, "a.uml", "b.aml").values()) == [["a.uml", "b.aml"]]


def test_an_overlay_connects_the_plant_with_the_models_that_it_names(tmp_path):
    shutil.copytree(EXAMPLES / "four-tasks", tmp_path / "tasks")
    found = units(tmp_path, {"other.aml": aml("Other")})
    assert list(found.values()) == [["other.aml"], ["tasks/cell.aml", "tasks/four-tasks.uml"]]


def test_a_folder_of_texts_is_one_unit_with_its_subfolders(tmp_path):
    files = {"01/a.sysml": "package A;", "02/b.sysml": "package B;"}
    assert list(units(tmp_path, files).values()) == [["01/a.sysml", "02/b.sysml"]]


MIXED = {"plant.aml": aml("Plant"), "a/a.sysml": "package A { part def T; }"}


def test_texts_beside_other_models_are_one_unit_for_each_folder(tmp_path):
    files = {**MIXED, "b/b1.sysml": "package B1;", "b/b2.sysml": "package B2 { part T; }"}
    assert units(tmp_path, files) == {
        "a": ["a/a.sysml"],
        "b": ["b/b1.sysml", "b/b2.sysml"],
        tmp_path.name: ["plant.aml"],
    }


@pytest.mark.parametrize(
    "text",
    ["package B { import A::*; }", "package B { part t : A::T; }", "package B { part t : $::A; }"],
)
def test_texts_that_name_a_package_of_another_folder_are_one_unit(tmp_path, text):
    found = units(tmp_path, {**MIXED, "b/b.sysml": text})
    assert sorted(found.values()) == [["a/a.sysml", "b/b.sysml"], ["plant.aml"]]


def test_a_name_that_a_text_defines_itself_connects_nothing(tmp_path):
    found = units(tmp_path, {**MIXED, "b/b.sysml": "package B { part def A; part a : A; }"})
    assert sorted(found.values()) == [["a/a.sysml"], ["b/b.sysml"], ["plant.aml"]]


def test_of_two_packages_of_one_name_the_nearest_is_meant(tmp_path):
    copy = {
        "lib/lib.sysml": "package Lib;",
        "main/main.sysml": "package Main { import Lib::*; }",
        "x.uml": uml("X"),
    }
    files = {f"{top}/{name}": text for top in ("v1", "v2") for name, text in copy.items()}
    assert sorted(units(tmp_path, files).values()) == [
        ["v1/lib/lib.sysml", "v1/main/main.sysml"],
        ["v1/x.uml"],
        ["v2/lib/lib.sysml", "v2/main/main.sysml"],
        ["v2/x.uml"],
    ]


def test_a_text_and_the_uml_of_the_same_model_are_separate_units():
    assert [opened.name for opened in open_units(Request((EXAMPLES / "robots",)))] == [
        "hall.sysml",
        "hall.uml",
    ]


def test_names_of_units_are_unique_where_file_systems_ignore_case(tmp_path):
    found = units(tmp_path, {"A/a.uml": uml("A"), "a/a.uml": uml("B")})
    assert len({name.lower() for name in found}) == 2


def test_findings_about_files_go_with_their_unit(tmp_path):
    files = {"a.uml": uml("A"), "b.uml": uml("B"), "notes.xml": "<notes/>"}
    units(tmp_path, files)
    first, second = open_units(Request((tmp_path,)))
    assert [diagnostic.rule.code for diagnostic in first.sink] == ["SM175"]
    assert not list(second.sink)
