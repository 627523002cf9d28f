"""Overlays: where the driver looks for them, what it reports, what depends on them."""

import json
import os
from pathlib import Path

import pytest
from driver_helpers import list_codes, list_inputs, run_sysmlc
from jsonschema import Draft202012Validator

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


def write_file(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def compile_paths(*paths, overlays=(), emit=()):
    backends = tuple(select_backends(emit)) if emit else ()
    return compile_model(Request(tuple(paths), overlays=tuple(overlays), backends=backends))


def list_item_flows(compilation):
    graph = compilation.graph
    return [graph.qualified_name(flow) for flow in graph.of_kind(Kind.ITEM_FLOW)]


# -- which overlays are applied ---------------------------------------------------------------


def test_an_overlay_in_the_folder_of_its_model_is_applied(folder):
    write_file(folder, "line.overlay.yaml", FLOW)
    compilation = compile_paths(folder / "line.ir")
    assert list_item_flows(compilation) == ["Plant::<ItemFlow>"]
    assert [(file.path, file.language) for file in compilation.inputs] == [
        ("line.ir", "ir"),
        ("line.overlay.yaml", "overlay"),
    ]


def test_overlays_of_models_in_a_folder_are_applied(folder):
    write_file(folder, "line.overlay.yaml", FLOW)
    assert list_item_flows(compile_paths(folder)) == ["Plant::<ItemFlow>"]


def test_an_overlay_in_another_folder_is_applied_if_it_is_named(folder):
    overlay = write_file(folder, "refined/flows.yaml", FLOW)
    assert list_item_flows(compile_paths(folder / "line.ir")) == []
    compilation = compile_paths(folder / "line.ir", overlays=[overlay])
    assert list_item_flows(compilation) == ["Plant::<ItemFlow>"]
    assert list_inputs(compilation) == ["line.ir", "refined/flows.yaml"]


def test_an_overlay_can_be_named_like_a_model(folder):
    overlay = write_file(folder, "refined/flows.overlay.yaml", FLOW)
    assert list_item_flows(compile_paths(folder / "line.ir", overlay)) == ["Plant::<ItemFlow>"]


def test_an_overlay_that_is_found_and_named_is_applied_once(folder):
    overlay = write_file(folder, "line.overlay.yaml", FLOW)
    compilation = compile_paths(folder / "line.ir", overlays=[overlay])
    assert list_item_flows(compilation) == ["Plant::<ItemFlow>"]
    assert len(compilation.inputs) == 2


def test_models_that_an_overlay_names_join_the_unit(folder):
    write_file(folder, "line.overlay.yaml", HOLD)
    write_file(folder, "models/stopping.ir", MODEL)
    compilation = compile_paths(folder / "line.ir")
    assert list_inputs(compilation) == [
        "line.ir",
        "models/stopping.ir",
        "line.overlay.yaml",
    ]
    (activity,) = compilation.graph.of_kind(Kind.ACTIVITY)
    assert compilation.graph.qualified_name(activity) == "Plant::Line::Hold"


def test_a_model_outside_of_the_folder_is_not_opened(folder):
    write_file(folder, "stopping.ir", MODEL)
    write_file(folder, "in/line.ir", PLANT)
    write_file(folder, "in/line.overlay.yaml", HOLD.replace("models/", "../"))
    compilation = compile_paths(folder / "in/line.ir")
    assert list_inputs(compilation) == ["line.ir", "line.overlay.yaml"]
    (diagnostic,) = (
        reported for reported in compilation.diagnostics if reported.rule.code == "SM324"
    )
    assert diagnostic.help == "the file '../stopping.ir' is not part of the compile unit"


# -- wrong overlays ---------------------------------------------------------------


def test_a_malformed_overlay_is_an_error_and_the_model_is_compiled_without_it(folder):
    write_file(folder, "line.overlay.yaml", FLOW.replace("items: {", "items: {{"))
    compilation = compile_paths(folder / "line.ir")
    assert [
        (diagnostic.rule.code, diagnostic.subject.place.file)
        for diagnostic in compilation.diagnostics
    ] == [("SM300", "line.ir"), ("SM300", "line.ir"), ("SM320", "line.overlay.yaml")]
    assert compilation.exit_code() == 1
    assert not compilation.is_complete


def test_a_missing_overlay_is_exit_code_2(folder):
    code, _, errors = run_sysmlc("check", folder / "line.ir", "--overlay", folder / "gone.yaml")
    assert code == 2
    assert "error[SM170 missing-file]: there is no file or folder" in errors
    assert "gone.yaml" in errors


def test_a_model_named_as_overlay_is_an_error(folder):
    code, _, errors = run_sysmlc("check", folder / "line.ir", "--overlay", folder / "line.ir")
    assert code == 1
    assert "error[SM321 overlay-shape]" in errors


def test_a_diagram_marks_what_a_wrong_entry_concerns(folder):
    """The flow has no item, so only the diagram with its connector has a mark."""
    write_file(folder, "line.overlay.yaml", FLOW.replace("item: Pallet", "item: Palette"))
    compilation = compile_paths(folder / "line.ir", emit=("plantuml",))
    assert list_codes(compilation) == ["SM300", "SM300", "SM324"]
    assert compilation.withheld == {}
    marked = [file.path for file in compilation.artefacts if "⚠" in file.text]
    assert [path.rpartition("/")[2] for path in marked] == ["Plant.Line.ibd.puml"]


def test_an_overlay_linked_from_outside_of_the_folder_is_not_read(folder):
    outside = write_file(folder, "secret.yaml", FLOW)
    write_file(folder, "in/line.ir", PLANT)
    (folder / "in/line.overlay.yaml").symlink_to(outside)
    compilation = compile_paths(folder / "in/line.ir")
    assert list_item_flows(compilation) == []
    assert "SM180" in list_codes(compilation)


def test_a_pipe_named_like_an_overlay_is_reported(folder):
    os.mkfifo(folder / "line.overlay.yaml")
    compilation = compile_paths(folder / "line.ir")
    assert "SM179" in list_codes(compilation)


def test_a_diagnostic_shows_the_line_of_the_overlay(folder):
    write_file(folder, "line.overlay.yaml", FLOW.replace("to: bt", "to: st/outt"))
    code, _, errors = run_sysmlc("check", folder / "line.ir", "--no-cache")
    assert code == 1
    assert "line.overlay.yaml:5:32 (st/outt)\n" in errors
    assert "    flows: [{item: Pallet, to: st/outt}]\n" in errors
    assert "help: did you mean 'st/out'?" in errors


def test_a_diagnostic_about_an_added_flow_shows_the_line_of_the_overlay(folder):
    text = FLOW + "ports: {Plant/Belt/in: {direction: out}}\n"
    write_file(folder, "line.overlay.yaml", text)
    code, out, _ = run_sysmlc("check", folder / "line.ir", "--no-cache", "--format", "json")
    (diagnostic,) = [
        reported for reported in json.loads(out)["diagnostics"] if reported["code"] == "SM310"
    ]
    assert diagnostic["file"].endswith("line.overlay.yaml")
    assert (diagnostic["line"], diagnostic["column"]) == (5, 20)
    assert code == 0


# -- outputs -----------------------------------------------------------------------------------


def test_manifest_trace_and_diagram_contain_the_overlay(folder):
    write_file(folder, "line.overlay.yaml", FLOW)
    code, _, _ = run_sysmlc(folder / "line.ir", "-o", folder / "out", "--no-cache")
    assert code == 0
    manifest = json.loads((folder / "out/manifest.json").read_text())
    schema = json.loads(resources.read_text("metamodels", "sysmlc-manifest.schema.json"))
    Draft202012Validator(schema).validate(manifest)
    assert "line.overlay.yaml" in json.dumps(manifest["inputs"])
    trace = (folder / "out/trace.json").read_text()
    assert '"line.overlay.yaml"' in trace
    diagram = (folder / "out/diagrams/Plant.Line.ibd.puml").read_text()
    assert "-[$physical_line]->" in diagram
    assert "<color:$physical>Pallet</color>" in diagram


def test_the_overlays_of_the_examples_follow_the_schema():
    from ruamel.yaml import YAML

    schema = json.loads(resources.read_text("metamodels", "sysmlc-overlay.schema.json"))
    root = resources.path("metamodels").parent
    for path in root.glob("examples/*/*.overlay.yaml"):
        Draft202012Validator(schema).validate(YAML(typ="safe").load(path.read_text()))


def test_a_changed_overlay_invalidates_the_cache(folder, monkeypatch):
    monkeypatch.setenv(cache.VARIABLE, str(folder / "cache"))
    path = write_file(folder, "line.overlay.yaml", FLOW)
    assert "Pallet" in build_diagram(folder)
    assert "Pallet" in build_diagram(folder)
    path.write_text(FLOW.replace("Pallet", "Tray"))
    assert "Tray" in build_diagram(folder)
    path.unlink()
    assert "Tray" not in build_diagram(folder)


def build_diagram(folder):
    run_sysmlc(folder / "line.ir", "-o", folder / "out")
    return (folder / "out/diagrams/Plant.Line.ibd.puml").read_text()


def test_the_watch_reacts_to_a_saved_overlay():
    assert _is_input(Path("/models/line.overlay.yaml"), frozenset())
    assert not _is_input(Path("/models/scenario.yaml"), frozenset())


def test_the_overlay_of_the_documentation_refines_the_example(tmp_path):
    root = resources.path("metamodels").parent
    page = (root / "docs" / "refine-a-plant.md").read_text()
    overlay = page.partition("<!-- overlay -->\n```yaml\n")[2].partition("```")[0]
    plant = write_file(tmp_path, "baygate.aml", (root / "examples/baygate/baygate.aml").read_text())
    write_file(tmp_path, "baygate.overlay.yaml", overlay)
    compilation = compile_paths(plant)
    assert [
        diagnostic for diagnostic in compilation.diagnostics if diagnostic.severity != "info"
    ] == []
    assert len(list_item_flows(compilation)) == 3


def test_a_flow_in_both_directions_is_two_flows_in_sysml_v2_and_one_in_uml(folder):
    write_file(folder, "line.overlay.yaml", FLOW.replace("to: bt", "both-ways: true"))
    compilation = compile_paths(folder / "line.ir", emit=("sysml", "uml"))
    texts = {
        artefact.path.partition("/")[0]: artefact.text for artefact in compilation.list_published()
    }
    assert len([line for line in texts["sysml"].splitlines() if "flow of" in line]) == 2
    assert texts["uml"].count("uml:InformationFlow") == 1
