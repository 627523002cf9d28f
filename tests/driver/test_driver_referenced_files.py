"""Files that a model refers to join its compile unit if they are inside its folder or project."""

import zipfile

import pytest
from driver_helpers import compile_files, list_codes, list_inputs

from sysmlc.config import Config
from sysmlc.ir import Edge

MODEL = """\
<?xml version="1.0" encoding="UTF-8"?>
<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="{id}" name="{name}">
  <packagedElement xmi:type="uml:Class" xmi:id="{id}_class" name="{name}Block">{content}
  </packagedElement>
</uml:Model>
"""
GENERAL = """
    <generalization xmi:type="uml:Generalization" xmi:id="g">
      <general xmi:type="uml:Class" href="{file}#lib_class"/>
    </generalization>"""


def write_model(path, id, name, target=""):
    path.parent.mkdir(parents=True, exist_ok=True)
    content = GENERAL.format(file=target) if target else ""
    path.write_text(MODEL.format(id=id, name=name, content=content))
    return path


@pytest.fixture
def library(tmp_path):
    return write_model(tmp_path / "lib/my library.uml", "lib", "Library")


def test_a_referenced_file_is_read(tmp_path, library):
    plant = write_model(tmp_path / "plant.uml", "plant", "Plant", "lib/my%20library.uml")
    compilation = compile_files(plant, passes=None)
    assert list_inputs(compilation) == ["lib/my library.uml", "plant.uml"]
    general = compilation.graph.target(compilation.graph["plant_class"], Edge.SPECIALIZES)
    assert general is compilation.graph["lib_class"]


def test_references_are_followed_transitively_and_in_cycles(tmp_path):
    first = write_model(tmp_path / "one.uml", "one", "One", "two.uml")
    write_model(tmp_path / "two.uml", "two", "Two", "three.uml")
    write_model(tmp_path / "three.uml", "three", "Three", "one.uml")
    assert list_inputs(compile_files(first, passes=())) == ["one.uml", "three.uml", "two.uml"]


@pytest.mark.parametrize(
    "href",
    ["../lib/my%20library.uml", "http://example.org/a.uml", "pathmap://UML/a.uml", "no.uml"],
)
def test_a_file_outside_of_the_folder_stays_external(tmp_path, library, href):
    plant = write_model(tmp_path / "plants/plant.uml", "plant", "Plant", href)
    compilation = compile_files(plant, passes=None)
    assert list_inputs(compilation) == ["plant.uml"]
    general = compilation.graph.target(compilation.graph["plant_class"], Edge.SPECIALIZES)
    assert general.attrs["external"]


def test_all_files_of_a_project_with_a_configuration_can_be_referenced(tmp_path, library):
    plant = write_model(tmp_path / "plants/plant.uml", "plant", "Plant", "../lib/my%20library.uml")
    (tmp_path / "sysmlc.toml").touch()
    compilation = compile_files(plant, passes=(), config=Config(folder=tmp_path))
    assert list_inputs(compilation) == ["lib/my library.uml", "plants/plant.uml"]


def test_a_referenced_file_that_is_not_a_model_is_ignored(tmp_path):
    (tmp_path / "notes.uml").write_text("<notes/>")
    plant = write_model(tmp_path / "plant.uml", "plant", "Plant", "notes.uml")
    compilation = compile_files(plant, passes=())
    assert list_inputs(compilation) == ["plant.uml"]
    assert compilation.diagnostics == ()


def test_an_entry_of_an_archive_is_an_input(tmp_path):
    entry = "com.nomagic.magicdraw.uml_model.model"
    with zipfile.ZipFile(tmp_path / "plant.mdzip", "w") as archive:
        archive.writestr(entry, MODEL.format(id="p", name="P", content=""))
        archive.writestr("diagrams/one.png", b"")
    assert list_inputs(compile_files(tmp_path / "plant.mdzip", passes=())) == [
        f"plant.mdzip!{entry}"
    ]


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"PK\x03\x04 and then nothing", "SM172"),
        (b"", "SM171"),
        (b"\xff\xfe\x00\x00\xff", "SM171"),
    ],
)
def test_a_damaged_archive_is_reported_and_the_compilation_incomplete(tmp_path, content, code):
    (tmp_path / "plant.mdzip").write_bytes(content)
    compilation = compile_files(tmp_path / "plant.mdzip", passes=())
    assert list_codes(compilation) == [code]
    assert (compilation.exit_code(), compilation.is_complete) == (1, False)


def test_strict_input_makes_unsupported_content_an_error(tmp_path):
    unsupported_element = '\n    <ownedWhatever xmi:type="uml:Whatever" xmi:id="d"/>'
    file = tmp_path / "plant.uml"
    file.write_text(MODEL.format(id="p", name="P", content=unsupported_element))
    assert compile_files(file, passes=()).exit_code() == 0
    compilation = compile_files(file, passes=(), strict_input=True)
    assert compilation.exit_code() == 1
    unsupported = compilation.coverage.as_json()["total"]["unsupported"]
    (diagnostic,) = [
        reported
        for reported in compilation.diagnostics
        if reported.rule.name == "unsupported-content"
    ]
    assert unsupported == 1
    assert diagnostic.message.startswith("not supported: 1 of ")


@pytest.mark.parametrize(
    "location", ["work/Drives/lib/drives.uml", "work/Plant/Drives/lib/drives.uml"]
)
def test_platform_uris_are_resolved_by_the_names_of_eclipse_projects(tmp_path, location):
    write_model(tmp_path / location, "lib", "Library")
    href = "platform:/resource/Drives/lib/drives.uml"
    plant = write_model(tmp_path / "work/Plant/models/plant.uml", "plant", "Plant", href)
    (tmp_path / "work/sysmlc.toml").touch()
    compilation = compile_files(plant, passes=None, config=Config(folder=tmp_path / "work"))
    assert len(list_inputs(compilation)) == 2
    general = compilation.graph.target(compilation.graph["plant_class"], Edge.SPECIALIZES)
    assert general is compilation.graph["lib_class"]


def test_the_name_of_the_folder_is_the_name_of_the_project(tmp_path):
    write_model(tmp_path / "Plant/lib.uml", "lib", "Library")
    href = "platform:/resource/Plant/lib.uml"
    plant = write_model(tmp_path / "Plant/plant.uml", "plant", "Plant", href)
    assert list_inputs(compile_files(plant, passes=None)) == ["lib.uml", "plant.uml"]


@pytest.mark.parametrize(
    "href", ["platform:/plugin/Plant/lib.uml", "platform:/resource/../lib.uml"]
)
def test_other_platform_uris_are_not_followed(tmp_path, href):
    write_model(tmp_path / "lib.uml", "lib", "Library")
    plant = write_model(tmp_path / "Plant/plant.uml", "plant", "Plant", href)
    assert list_inputs(compile_files(plant, passes=None)) == ["plant.uml"]


def test_models_of_a_folder_that_refer_to_one_another_are_one_unit(tmp_path):
    write_model(tmp_path / "lib/library.uml", "lib", "Library")
    write_model(tmp_path / "cells/cell.uml", "cell", "Cell", "../lib/library.uml")
    write_model(tmp_path / "line.uml", "line", "Line", "lib/library.uml")
    compilation = compile_files(tmp_path, passes=None)
    assert list_inputs(compilation) == ["cells/cell.uml", "lib/library.uml", "line.uml"]
    users = compilation.graph.sources(compilation.graph["lib_class"], Edge.SPECIALIZES)
    assert sorted(user.id for user in users) == ["cell_class", "line_class"]
    assert compilation.diagnostics == ()


def test_a_symbolic_link_out_of_the_folder_is_not_followed(tmp_path):
    write_model(tmp_path / "secret/lib.uml", "lib", "Library")
    plant = write_model(tmp_path / "plant/plant.uml", "plant", "Plant", "linked.uml")
    (tmp_path / "plant/linked.uml").symlink_to(tmp_path / "secret/lib.uml")
    assert list_inputs(compile_files(plant, passes=None)) == ["plant.uml"]
    content = write_model(tmp_path / "plant/real.uml", "lib", "Library")
    (tmp_path / "plant/linked.uml").unlink()
    (tmp_path / "plant/linked.uml").symlink_to(content)
    assert list_inputs(compile_files(plant, passes=None)) == ["plant.uml", "real.uml"]
