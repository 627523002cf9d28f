"""``--diagrams`` on the command line, in the configuration, and with the cache."""

import json

import pytest

from sysmlc.cli import group
from sysmlc.passes import pipeline

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
def plant(here, monkeypatch):
    from sysmlc.driver import registry

    monkeypatch.setattr(
        registry, "load_passes", lambda options: [*map(pipeline.load, pipeline.NAMES)]
    )
    here.write("plant.uml", MODEL)
    here.write("plant.notation", NOTATION)
    return here


def built(here, *args):
    done = here.sysmlc("build", "plant.uml", "--emit", "plantuml", *args)
    assert done.exit_code == 0, done.stderr
    return [path for path in here.files() if path.endswith(".puml")]


@pytest.mark.parametrize(
    ("args", "files"),
    [
        ((), [DERIVED]),
        (("--diagrams", "derived"), [DERIVED]),
        (("--diagrams", "author"), [AUTHORED]),
        (("--diagrams", "both"), [DERIVED, AUTHORED]),
    ],
)
def test_derived_authored_or_both(plant, args, files):
    assert built(plant, *args) == files


def test_the_configuration_chooses_and_the_option_goes_first(plant):
    plant.write("sysmlc.toml", 'diagrams = "author"\n')
    assert built(plant) == [AUTHORED]
    assert built(plant, "--diagrams", "derived") == [DERIVED]


def test_what_is_no_choice_is_refused(plant):
    assert plant.sysmlc("plant.uml", "--diagrams", "mine").exit_code == 2
    plant.write("sysmlc.toml", 'diagrams = "mine"\n')
    assert plant.sysmlc("plant.uml").exit_code == 2


def test_an_author_who_draws_something_else_is_seen_at_once(plant):
    built(plant, "--diagrams", "author")
    assert "Gate" in plant.read(f"out/{AUTHORED}")
    plant.write("plant.notation", NOTATION.replace("#gate", "#lift"))
    built(plant, "--diagrams", "author")
    assert "Lift" in plant.read(f"out/{AUTHORED}")
    assert "**Gate**" not in plant.read(f"out/{AUTHORED}")


def test_manifest_and_trace_lead_to_the_notation_file(plant):
    built(plant, "--diagrams", "author")
    inputs = [one["path"] for one in json.loads(plant.read("out/manifest.json"))["inputs"]]
    assert inputs == ["plant.uml", "plant.notation"]
    elements = json.loads(plant.read("out/trace.json"))["elements"]
    (view,) = [one for one in elements if one["qualified_name"] == "Plant::Gates"]
    assert view["source"] == {"file": "plant.notation", "line": 1, "column": 1}


def test_findings_are_the_same_from_the_cache(plant):
    plant.write("plant.notation", NOTATION.replace("#gate", "#gone"))
    args = ("check", "plant.uml", "--diagrams", "author", "--format", "json")
    first, second = plant.sysmlc(*args), plant.sysmlc(*args)
    assert first.stdout == second.stdout
    found = [one for one in json.loads(first.stdout)["diagnostics"] if one["code"] == "SM162"]
    assert [(one["file"], one["line"], one["xpath"]) for one in found] == [
        ("plant.notation", 1, "/notation:Diagram")
    ]


def test_the_option_stands_where_diagrams_are_made():
    for name in ("build", "check", "watch"):
        command = group.sysmlc.get_command(None, name)
        assert "--diagrams" in {option for p in command.params for option in p.opts}
