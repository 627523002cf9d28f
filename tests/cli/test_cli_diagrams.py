"""``--diagrams`` on the command line, in the configuration, and with the cache."""

import json

import pytest

from sysmlc.cli import group

MODEL = """\
<uml:Model xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="Plant">
  <packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate"/>
  <packagedElement xmi:type="uml:Class" xmi:id="lift" name="Lift"/>
</uml:Model>
"""
NOTATION = """\
<notation:Diagram xmlns:xmi="http://www.omg.org/XMI" xmi:id="d" name="Gates"
    xmlns:notation="http://www.eclipse.org/gmf/runtime/1.0.3/notation"
    type="PapyrusUMLClassDiagram">
  <children type="Class_Shape"><element href="plant.uml#gate"/></children>
  <element href="plant.uml#m"/>
</notation:Diagram>
"""
DERIVED = "diagrams/Plant.bdd.puml"
AUTHORED = "diagrams/author/Plant.Gates.class.puml"


@pytest.fixture
def plant(workspace, all_passes):
    workspace.write("plant.uml", MODEL)
    workspace.write("plant.notation", NOTATION)
    return workspace


def build_diagrams(workspace, *args):
    result = workspace.sysmlc("build", "plant.uml", "--emit", "plantuml", *args)
    assert result.exit_code == 0, result.stderr
    return [path for path in workspace.list_files() if path.endswith(".puml")]


@pytest.mark.parametrize(
    ("args", "files"),
    [
        ((), [DERIVED]),
        (("--diagrams", "derived"), [DERIVED]),
        (("--diagrams", "author"), [AUTHORED]),
        (("--diagrams", "both"), [DERIVED, AUTHORED]),
    ],
)
def test_diagrams_are_derived_authored_or_both(plant, args, files):
    assert build_diagrams(plant, *args) == files


def test_the_option_takes_precedence_over_the_configuration(plant):
    plant.write("sysmlc.toml", 'diagrams = "author"\n')
    assert build_diagrams(plant) == [AUTHORED]
    assert build_diagrams(plant, "--diagrams", "derived") == [DERIVED]


def test_an_unknown_choice_is_refused(plant):
    assert plant.sysmlc("plant.uml", "--diagrams", "mine").exit_code == 2
    plant.write("sysmlc.toml", 'diagrams = "mine"\n')
    assert plant.sysmlc("plant.uml").exit_code == 2


def test_a_changed_notation_file_changes_the_authored_diagram(plant):
    build_diagrams(plant, "--diagrams", "author")
    assert "Gate" in plant.read(f"out/{AUTHORED}")
    plant.write("plant.notation", NOTATION.replace("#gate", "#lift"))
    build_diagrams(plant, "--diagrams", "author")
    assert "Lift" in plant.read(f"out/{AUTHORED}")
    assert "**Gate**" not in plant.read(f"out/{AUTHORED}")


def test_manifest_and_trace_name_the_notation_file(plant):
    build_diagrams(plant, "--diagrams", "author")
    assert plant.list_inputs() == ["plant.uml", "plant.notation"]
    elements = json.loads(plant.read("out/trace.json"))["elements"]
    (view,) = [entry for entry in elements if entry["qualified_name"] == "Plant::Gates"]
    assert view["source"] == {"file": "plant.notation", "line": 1, "column": 1}


def test_diagnostics_from_the_cache_are_the_same(plant):
    plant.write("plant.notation", NOTATION.replace("#gate", "#gone"))
    args = ("check", "plant.uml", "--diagrams", "author", "--format", "json")
    first, second = plant.sysmlc(*args), plant.sysmlc(*args)
    assert first.stdout == second.stdout
    diagnostics = json.loads(first.stdout)["diagnostics"]
    assert [
        (diagnostic["file"], diagnostic["line"], diagnostic["xpath"])
        for diagnostic in diagnostics
        if diagnostic["code"] == "SM162"
    ] == [("plant.notation", 1, "/notation:Diagram")]


def test_the_commands_that_write_diagrams_have_the_option():
    for name in ("build", "check", "watch"):
        command = group.sysmlc.get_command(None, name)
        assert "--diagrams" in {option for parameter in command.params for option in parameter.opts}
