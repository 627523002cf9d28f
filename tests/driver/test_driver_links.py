"""Files that a model refers to join its compile unit, as far as they lie in its folder."""

import zipfile

import pytest
from driver_fakes import compiled

from sysmlc.config import Config
from sysmlc.ir import Edge

MODEL = """\
<?xml version="1.0" encoding="UTF-8"?>
<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="{id}" name="{name}">
  <packagedElement xmi:type="uml:Class" xmi:id="{id}_class" name="{name}Block">{inside}
  </packagedElement>
</uml:Model>
"""
GENERAL = """
    <generalization xmi:type="uml:Generalization" xmi:id="g">
      <general xmi:type="uml:Class" href="{file}#lib_class"/>
    </generalization>"""


def model(path, id, name, refers_to=""):
    path.parent.mkdir(parents=True, exist_ok=True)
    inside = GENERAL.format(file=refers_to) if refers_to else ""
    path.write_text(MODEL.format(id=id, name=name, inside=inside))
    return path


def inputs(made):
    return [file.path for file in made.inputs]


@pytest.fixture
def library(tmp_path):
    return model(tmp_path / "lib/my library.uml", "lib", "Library")


def test_a_file_that_is_referred_to_is_read_too(tmp_path, library):
    plant = model(tmp_path / "plant.uml", "plant", "Plant", "lib/my%20library.uml")
    made = compiled(plant, passes=None)
    assert inputs(made) == ["lib/my library.uml", "plant.uml"]
    general = made.graph.target(made.graph["plant_class"], Edge.SPECIALIZES)
    assert general is made.graph["lib_class"]


def test_references_are_followed_further_and_round_in_circles(tmp_path):
    one = model(tmp_path / "one.uml", "one", "One", "two.uml")
    model(tmp_path / "two.uml", "two", "Two", "three.uml")
    model(tmp_path / "three.uml", "three", "Three", "one.uml")
    assert inputs(compiled(one, passes=())) == ["one.uml", "three.uml", "two.uml"]


@pytest.mark.parametrize(
    "href",
    ["../lib/my%20library.uml", "http://example.org/a.uml", "pathmap://UML/a.uml", "no.uml"],
)
def test_what_is_elsewhere_stays_external(tmp_path, library, href):
    plant = model(tmp_path / "plants/plant.uml", "plant", "Plant", href)
    made = compiled(plant, passes=None)
    assert inputs(made) == ["plant.uml"]
    general = made.graph.target(made.graph["plant_class"], Edge.SPECIALIZES)
    assert general.attrs["external"]


def test_a_project_with_a_configuration_may_be_referred_to_throughout(tmp_path, library):
    plant = model(tmp_path / "plants/plant.uml", "plant", "Plant", "../lib/my%20library.uml")
    (tmp_path / "sysmlc.toml").touch()
    made = compiled(plant, passes=(), config=Config(folder=tmp_path))
    assert inputs(made) == ["lib/my library.uml", "plants/plant.uml"]


def test_a_file_that_is_referred_to_but_is_no_model_is_left_alone(tmp_path):
    (tmp_path / "notes.uml").write_text("<notes/>")
    plant = model(tmp_path / "plant.uml", "plant", "Plant", "notes.uml")
    made = compiled(plant, passes=())
    assert inputs(made) == ["plant.uml"]
    assert [diagnostic.rule.code for diagnostic in made.diagnostics] == []


def test_entries_of_an_archive_are_inputs_of_their_own(tmp_path):
    entry = "com.nomagic.magicdraw.uml_model.model"
    with zipfile.ZipFile(tmp_path / "plant.mdzip", "w") as archive:
        archive.writestr(entry, MODEL.format(id="p", name="P", inside=""))
        archive.writestr("diagrams/one.png", b"")
    assert inputs(compiled(tmp_path / "plant.mdzip", passes=())) == [f"plant.mdzip!{entry}"]


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"PK\x03\x04 and then nothing", "SM172"),
        (b"", "SM171"),
        (b"\xff\xfe\x00\x00\xff", "SM171"),
    ],
)
def test_a_damaged_archive_is_reported_and_nothing_old_is_removed(tmp_path, content, code):
    (tmp_path / "plant.mdzip").write_bytes(content)
    made = compiled(tmp_path / "plant.mdzip", passes=())
    assert [diagnostic.rule.code for diagnostic in made.diagnostics] == [code]
    assert (made.exit_code(), made.is_complete) == (1, False)


def test_strict_input_makes_unsupported_content_an_error(tmp_path):
    odd = '\n    <ownedWhatever xmi:type="uml:Whatever" xmi:id="d"/>'
    file = tmp_path / "plant.uml"
    file.write_text(MODEL.format(id="p", name="P", inside=odd))
    assert compiled(file, passes=()).exit_code() == 0
    made = compiled(file, passes=(), strict_input=True)
    assert made.exit_code() == 1
    unsupported = made.coverage.as_json()["total"]["unsupported"]
    (found,) = [f for f in made.diagnostics if f.rule.name == "unsupported-content"]
    assert unsupported == 1
    assert found.message.startswith("1 of the ")


@pytest.mark.parametrize(
    "place", ["work/Drives/lib/drives.uml", "work/Plant/Drives/lib/drives.uml"]
)
def test_files_of_an_eclipse_workspace_are_found_by_their_project(tmp_path, place):
    model(tmp_path / place, "lib", "Library")
    href = "platform:/resource/Drives/lib/drives.uml"
    plant = model(tmp_path / "work/Plant/models/plant.uml", "plant", "Plant", href)
    (tmp_path / "work/sysmlc.toml").touch()
    made = compiled(plant, passes=None, config=Config(folder=tmp_path / "work"))
    assert len(inputs(made)) == 2
    general = made.graph.target(made.graph["plant_class"], Edge.SPECIALIZES)
    assert general is made.graph["lib_class"]


def test_the_own_project_is_known_by_the_name_of_its_folder(tmp_path):
    model(tmp_path / "Plant/lib.uml", "lib", "Library")
    href = "platform:/resource/Plant/lib.uml"
    plant = model(tmp_path / "Plant/plant.uml", "plant", "Plant", href)
    assert inputs(compiled(plant, passes=None)) == ["lib.uml", "plant.uml"]


@pytest.mark.parametrize(
    "href", ["platform:/plugin/Plant/lib.uml", "platform:/resource/../lib.uml"]
)
def test_eclipse_leads_nowhere_else(tmp_path, href):
    model(tmp_path / "lib.uml", "lib", "Library")
    plant = model(tmp_path / "Plant/plant.uml", "plant", "Plant", href)
    assert inputs(compiled(plant, passes=None)) == ["plant.uml"]


def test_a_folder_of_models_that_refer_to_each_other_is_one_unit(tmp_path):
    model(tmp_path / "lib/library.uml", "lib", "Library")
    model(tmp_path / "cells/cell.uml", "cell", "Cell", "../lib/library.uml")
    model(tmp_path / "line.uml", "line", "Line", "lib/library.uml")
    made = compiled(tmp_path, passes=None)
    assert inputs(made) == ["cells/cell.uml", "lib/library.uml", "line.uml"]
    users = made.graph.sources(made.graph["lib_class"], Edge.SPECIALIZES)
    assert sorted(one.id for one in users) == ["cell_class", "line_class"]
    assert made.diagnostics == ()


def test_a_symbolic_link_out_of_the_folder_is_not_followed(tmp_path):
    model(tmp_path / "secret/lib.uml", "lib", "Library")
    plant = model(tmp_path / "plant/plant.uml", "plant", "Plant", "linked.uml")
    (tmp_path / "plant/linked.uml").symlink_to(tmp_path / "secret/lib.uml")
    assert inputs(compiled(plant, passes=None)) == ["plant.uml"]
    inside = model(tmp_path / "plant/real.uml", "lib", "Library")
    (tmp_path / "plant/linked.uml").unlink()
    (tmp_path / "plant/linked.uml").symlink_to(inside)
    assert inputs(compiled(plant, passes=None)) == ["plant.uml", "real.uml"]
