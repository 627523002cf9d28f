"""Overlays through the driver and the command line: found, named, refused, watched, cached."""

import json
import os

import pytest
from click.testing import CliRunner
from jsonschema import Draft202012Validator

from sysmlc.cli import group
from sysmlc.cli.watch import _is_input
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.ir import Kind
from sysmlc.support import cache, resources

PLANT = """\
Package plant "Plant"
  Class track "Track" role="interface block"
  Class stop "Stop" role="block"
    Port stop.out "out"
      -> typed-by track
  Class belt "Belt" role="block"
    Port belt.in "in"
      -> typed-by track
  Class line "Line" role="block"
    Property st "st" aggregation="composite" role="part"
      -> typed-by stop
    Property bt "bt" aggregation="composite" role="part"
      -> typed-by belt
    Connector l1 "l1"
      -> end l1.a l1.b
      ConnectorEnd l1.a
        -> role stop.out
        -> path st
      ConnectorEnd l1.b
        -> role belt.in
        -> path bt
"""
FLOW = """\
overlay: 1
items: {Pallet: {domain: physical}}
connectors:
  Plant/Line/l1:
    flows: [{item: Pallet, to: bt}]
"""
MODEL = """\
Package model "Stopping"
  Activity hold "Hold"
    Control start "start" subkind="initial"
"""
HOLD = 'overlay: 1\nblocks:\n  Plant/Line: {behavior: "models/stopping.ir#Stopping::Hold"}\n'


@pytest.fixture
def folder(tmp_path):
    (tmp_path / ".git").mkdir()
    (tmp_path / "line.ir").write_text(PLANT)
    return tmp_path


def write(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def build(*paths, overlays=(), emit=()):
    backends = tuple(select_backends(emit)) if emit else ()
    return compile_model(Request(tuple(paths), overlays=tuple(overlays), backends=backends))


def items(made):
    return [made.graph.qualified_name(one) for one in made.graph.of_kind(Kind.ITEM_FLOW)]


def told(made):
    return [(f.rule.code, f.subject.place.file, f.subject.place.line) for f in made.diagnostics]


def sysmlc(*arguments):
    result = CliRunner().invoke(group.sysmlc, [str(one) for one in arguments])
    return result.exit_code, result.stdout, result.stderr


# -- where overlays are ------------------------------------------------------------------------


def test_the_overlay_beside_a_model_is_laid_over_it(folder):
    write(folder, "line.overlay.yaml", FLOW)
    made = build(folder / "line.ir")
    assert items(made) == ["Plant::<ItemFlow>"]
    assert [(one.path, one.language) for one in made.inputs] == [
        ("line.ir", "ir"),
        ("line.overlay.yaml", "overlay"),
    ]


def test_models_of_a_folder_have_their_overlays(folder):
    write(folder, "line.overlay.yaml", FLOW)
    assert items(build(folder)) == ["Plant::<ItemFlow>"]


def test_an_overlay_elsewhere_is_named(folder):
    other = write(folder, "refined/flows.yaml", FLOW)
    assert items(build(folder / "line.ir")) == []
    made = build(folder / "line.ir", overlays=[other])
    assert items(made) == ["Plant::<ItemFlow>"]
    assert [one.path for one in made.inputs] == ["line.ir", "refined/flows.yaml"]


def test_an_overlay_may_stand_among_the_models(folder):
    other = write(folder, "refined/flows.overlay.yaml", FLOW)
    assert items(build(folder / "line.ir", other)) == ["Plant::<ItemFlow>"]


def test_an_overlay_that_is_found_and_named_counts_once(folder):
    beside = write(folder, "line.overlay.yaml", FLOW)
    made = build(folder / "line.ir", overlays=[beside])
    assert items(made) == ["Plant::<ItemFlow>"]
    assert len(made.inputs) == 2


def test_models_that_an_overlay_names_join_the_unit(folder):
    write(folder, "line.overlay.yaml", HOLD)
    write(folder, "models/stopping.ir", MODEL)
    made = build(folder / "line.ir")
    assert [one.path for one in made.inputs] == [
        "line.ir",
        "models/stopping.ir",
        "line.overlay.yaml",
    ]
    (activity,) = made.graph.of_kind(Kind.ACTIVITY)
    assert made.graph.qualified_name(activity) == "Plant::Line::Hold"


def test_a_model_outside_of_the_folder_is_not_opened(folder):
    write(folder, "stopping.ir", MODEL)
    write(folder, "in/line.ir", PLANT)
    write(folder, "in/line.overlay.yaml", HOLD.replace("models/", "../"))
    made = build(folder / "in/line.ir")
    assert [one.path for one in made.inputs] == ["line.ir", "line.overlay.yaml"]
    (found,) = (diagnostic for diagnostic in made.diagnostics if diagnostic.rule.code == "SM324")
    assert found.help == "the file '../stopping.ir' is not part of the compile unit"


# -- what can be wrong with them ---------------------------------------------------------------


def test_a_broken_overlay_is_an_error_and_the_model_is_compiled_without(folder):
    write(folder, "line.overlay.yaml", FLOW.replace("items: {", "items: {{"))
    made = build(folder / "line.ir")
    assert [one[:2] for one in told(made)] == [
        ("SM300", "line.ir"),
        ("SM300", "line.ir"),
        ("SM320", "line.overlay.yaml"),
    ]
    assert made.exit_code() == 1
    assert not made.is_complete


def test_an_overlay_that_is_not_there_ends_with_exit_code_2(folder):
    code, _, errors = sysmlc("check", folder / "line.ir", "--overlay", folder / "gone.yaml")
    assert code == 2
    assert "error[SM170 missing-file]: there is no file or folder" in errors
    assert "gone.yaml" in errors


def test_a_model_is_no_overlay_though_it_is_an_input_too(folder):
    code, _, errors = sysmlc("check", folder / "line.ir", "--overlay", folder / "line.ir")
    assert code == 1
    assert "error[SM321 overlay-shape]" in errors


def test_what_rests_on_an_entry_that_is_wrong_is_withheld(folder):
    """The diagram with the connector whose flow has no item; the other diagrams are written."""
    write(folder, "line.overlay.yaml", FLOW.replace("item: Pallet", "item: Palette"))
    made = build(folder / "line.ir", emit=("plantuml",))
    assert [one[0] for one in told(made)] == ["SM300", "SM300", "SM324"]
    assert [path.rpartition("/")[2] for path in made.withheld] == ["Plant.Line.ibd.puml"]
    assert any(one.path.endswith("bdd.puml") for one in made.list_published())


def test_a_link_beside_a_model_that_leads_out_of_the_folder_is_not_followed(folder):
    secret = write(folder, "secret.yaml", FLOW)
    write(folder, "in/line.ir", PLANT)
    (folder / "in/line.overlay.yaml").symlink_to(secret)
    made = build(folder / "in/line.ir")
    assert items(made) == []
    assert "SM180" in [one[0] for one in told(made)]


def test_a_pipe_is_no_overlay(folder):
    os.mkfifo(folder / "line.overlay.yaml")
    made = build(folder / "line.ir")
    assert "SM179" in [one[0] for one in told(made)]


def test_a_finding_shows_the_line_of_the_overlay(folder):
    write(folder, "line.overlay.yaml", FLOW.replace("to: bt", "to: st/belt"))
    code, _, errors = sysmlc("check", folder / "line.ir", "--no-cache")
    assert code == 1
    assert "line.overlay.yaml:5:32 (st/belt)\n" in errors
    assert "    flows: [{item: Pallet, to: st/belt}]\n" in errors
    assert "help: did you mean 'st/out'?" in errors


def test_a_finding_about_an_added_flow_shows_the_line_of_the_overlay(folder):
    text = FLOW + "ports: {Plant/Belt/in: {direction: out}}\n"
    write(folder, "line.overlay.yaml", text)
    code, out, _ = sysmlc("check", folder / "line.ir", "--no-cache", "--format", "json")
    found = [one for one in json.loads(out)["diagnostics"] if one["code"] == "SM310"]
    assert [(one["file"].rpartition("/")[2], one["line"], one["column"]) for one in found] == [
        ("line.overlay.yaml", 5, 20)
    ]
    assert code == 0


# -- outputs -----------------------------------------------------------------------------------


def test_the_manifest_lists_the_overlay_and_the_trace_leads_into_it(folder):
    write(folder, "line.overlay.yaml", FLOW)
    code, _, _ = sysmlc(folder / "line.ir", "-o", folder / "out", "--no-cache")
    assert code == 0
    manifest = json.loads((folder / "out/manifest.json").read_text())
    schema = json.loads(resources.read_text("metamodels", "sysmlc-manifest.schema.json"))
    Draft202012Validator(schema).validate(manifest)
    assert "line.overlay.yaml" in json.dumps(manifest["inputs"])
    trace = (folder / "out/trace.json").read_text()
    assert '"line.overlay.yaml"' in trace
    drawn = (folder / "out/diagrams/Plant.Line.ibd.puml").read_text()
    assert "-[$physical_line]->" in drawn
    assert "<color:$physical>Pallet</color>" in drawn


def test_a_shipped_overlay_has_the_shape_of_the_schema():
    from ruamel.yaml import YAML

    schema = json.loads(resources.read_text("metamodels", "sysmlc-overlay.schema.json"))
    root = resources.path("metamodels").parent
    for path in root.glob("examples/*/*.overlay.yaml"):
        Draft202012Validator(schema).validate(YAML(typ="safe").load(path.read_text()))


def test_a_changed_overlay_is_compiled_again_and_an_unchanged_one_is_not(folder, monkeypatch):
    monkeypatch.setenv(cache.VARIABLE, str(folder / "cache"))
    path = write(folder, "line.overlay.yaml", FLOW)
    assert "Pallet" in drawn_after(folder)
    assert "Pallet" in drawn_after(folder)
    path.write_text(FLOW.replace("Pallet", "Tray"))
    assert "Tray" in drawn_after(folder)
    path.unlink()
    assert "Tray" not in drawn_after(folder)


def drawn_after(folder):
    sysmlc(folder / "line.ir", "-o", folder / "out")
    return (folder / "out/diagrams/Plant.Line.ibd.puml").read_text()


def test_a_saved_overlay_wakes_the_watch():
    assert _is_input(None, "/models/line.overlay.yaml")
    assert not _is_input(None, "/models/scenario.yaml")


def test_without_an_overlay_no_yaml_reader_is_loaded(folder):
    import subprocess
    import sys

    script = (
        "import sys; from sysmlc.cli.group import sysmlc\n"
        "try: sysmlc(['check', 'line.ir', '--no-cache'])\n"
        "except SystemExit: pass\n"
        "print('ruamel' in ''.join(sys.modules))"
    )
    run = [sys.executable, "-c", script]
    done = subprocess.run(run, cwd=folder, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "False"


def test_the_overlay_of_the_documentation_refines_the_example(tmp_path):
    root = resources.path("metamodels").parent
    page = (root / "docs" / "refine-a-plant.md").read_text()
    shown = page.partition("<!-- overlay -->\n```yaml\n")[2].partition("```")[0]
    plant = write(tmp_path, "baygate.aml", (root / "examples/baygate/baygate.aml").read_text())
    write(tmp_path, "baygate.overlay.yaml", shown)
    made = build(plant)
    assert [one for one in made.diagnostics if one.severity != "info"] == []
    assert len(items(made)) == 3


def test_a_flow_both_ways_is_two_flows_in_sysml_v2_and_one_in_uml(folder):
    write(folder, "line.overlay.yaml", FLOW.replace("to: bt", "both-ways: true"))
    made = build(folder / "line.ir", emit=("sysml", "uml"))
    texts = {one.path.partition("/")[0]: one.text for one in made.list_published()}
    assert len([line for line in texts["sysml"].splitlines() if "flow of" in line]) == 2
    assert texts["uml"].count("uml:InformationFlow") == 1
