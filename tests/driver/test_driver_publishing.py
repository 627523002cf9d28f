"""The output folder: only changes are written, obsolete files are removed, schemas are followed."""

import json
import os
import subprocess
import sys

import pytest
from driver_helpers import FAULTY, PLANT, OutlineBackend, compile_files
from jsonschema import Draft202012Validator

from sysmlc.driver import Target, compare, publish, summarize
from sysmlc.support import resources


def build(folder, text=PLANT, **options):
    """Compile a text, update ``folder/out`` and return the changed files."""
    publication = publish_text(folder, text, **options)
    assert publication.diagnostics == ()
    return list(publication.changed)


def publish_text(folder, text=PLANT, **options):
    (folder / "plant.ir").write_text(text)
    return publish(summarize(compile_files(folder / "plant.ir", **options)), Target(folder / "out"))


def list_files(folder):
    out = folder / "out"
    return sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file())


ALL_FILES = [
    "coverage.json",
    "manifest.json",
    "outlines/Gate.txt",
    "outlines/Robot.txt",
    "trace.json",
]


def test_the_folder_contains_the_outputs_manifest_coverage_and_trace(tmp_path):
    assert sorted(build(tmp_path)) == ALL_FILES
    assert list_files(tmp_path) == ALL_FILES


@pytest.mark.parametrize("name", ["manifest", "coverage", "trace"])
@pytest.mark.parametrize("text", [PLANT, FAULTY, "Klass gate\n"])
def test_manifest_coverage_and_trace_follow_their_schemas(tmp_path, name, text):
    build(tmp_path, text)
    schema = json.loads(resources.read_text("metamodels", f"sysmlc-{name}.schema.json"))
    Draft202012Validator.check_schema(schema)
    content = json.loads((tmp_path / "out" / f"{name}.json").read_text())
    assert list(Draft202012Validator(schema).iter_errors(content)) == []


def test_a_second_run_writes_nothing(tmp_path):
    build(tmp_path)
    for path in (tmp_path / "out").rglob("*"):
        os.utime(path, (1, 1))
    assert build(tmp_path) == []
    assert {path.stat().st_mtime for path in (tmp_path / "out").rglob("*")} == {1}


def test_only_changed_files_are_written(tmp_path):
    build(tmp_path)
    os.utime(tmp_path / "out/outlines/Robot.txt", (1, 1))
    changed = build(tmp_path, PLANT.replace('gate.in "in"', 'gate.in "entry"'))
    assert changed == ["outlines/Gate.txt", "trace.json", "manifest.json"]
    assert (tmp_path / "out/outlines/Robot.txt").stat().st_mtime == 1


def test_the_manifest_is_written_last(tmp_path):
    assert build(tmp_path)[-1] == "manifest.json"


def test_obsolete_outputs_are_removed_and_foreign_files_stay(tmp_path):
    build(tmp_path)
    (tmp_path / "out/outlines/own.txt").write_text("by hand")
    build(tmp_path, PLANT.replace("Robot", "Arm"))
    assert "outlines/Robot.txt" not in list_files(tmp_path)
    assert {"outlines/Arm.txt", "outlines/own.txt"} <= set(list_files(tmp_path))


def test_folders_that_become_empty_are_removed(tmp_path):
    build(tmp_path)
    build(tmp_path, backends=())
    assert list_files(tmp_path) == ["coverage.json", "manifest.json", "trace.json"]
    assert not (tmp_path / "out/outlines").exists()


def test_a_withheld_file_is_removed_and_listed_with_the_reason(tmp_path):
    build(tmp_path)
    build(tmp_path, FAULTY)
    assert "outlines/Gate.txt" not in list_files(tmp_path)
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    published = [entry["path"] for entry in manifest["files"]]
    assert published == ["outlines/Robot.txt", "coverage.json", "trace.json"]
    assert manifest["withheld"] == [
        {
            "path": "outlines/Gate.txt",
            "because": [
                {
                    "code": "SM940",
                    "name": "test-unnamed-port",
                    "message": "a port of 'Gate' has no name",
                    "element": "Plant::Gate::<Port>",
                }
            ],
        }
    ]


def test_a_model_that_cannot_be_read_removes_nothing(tmp_path):
    build(tmp_path)
    build(tmp_path, "Klass gate\n")
    assert list_files(tmp_path) == ALL_FILES
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    preserved = ["outlines/Gate.txt", "outlines/Robot.txt"]
    assert [entry["path"] for entry in manifest["kept"]] == preserved


def test_preserved_outputs_are_removed_once_the_model_can_be_read(tmp_path):
    build(tmp_path)
    build(tmp_path, "Klass gate\n")
    build(tmp_path, PLANT.replace("Robot", "Arm"))
    assert "outlines/Robot.txt" not in list_files(tmp_path)


def test_compare_returns_the_files_that_publishing_changes(tmp_path):
    build(tmp_path)
    (tmp_path / "plant.ir").write_text(PLANT.replace("Robot", "Arm"))
    result, target = summarize(compile_files(tmp_path / "plant.ir")), Target(tmp_path / "out")
    differences = compare(result, target)
    assert "outlines/Arm.txt" in differences
    assert sorted(publish(result, target).changed) == differences
    assert compare(result, target) == []


def test_a_file_in_the_way_of_the_folder_is_reported(tmp_path):
    (tmp_path / "out").write_text("a file")
    (diagnostic,) = publish_text(tmp_path).diagnostics
    assert (diagnostic.rule.name, "out" in diagnostic.message) == ("unwritable-output", True)


def test_an_interrupted_write_leaves_the_old_files(tmp_path, monkeypatch):
    build(tmp_path)
    before = (tmp_path / "out/outlines/Gate.txt").read_text()

    def raise_disk_full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.write", raise_disk_full)
    (diagnostic,) = publish_text(tmp_path, PLANT.replace('"in"', '"entry"')).diagnostics
    assert "No space left" in diagnostic.message
    assert (tmp_path / "out/outlines/Gate.txt").read_text() == before
    assert list_files(tmp_path) == ALL_FILES


@pytest.mark.parametrize("backends", [(), (OutlineBackend(),)])
def test_trace_is_formatted_like_the_other_json_outputs(tmp_path, backends):
    build(tmp_path, PLANT.replace('"Gate"', '"Ga\\"te ü"'), backends=backends)
    text = (tmp_path / "out/trace.json").read_text(encoding="utf-8")
    assert text == json.dumps(json.loads(text), ensure_ascii=False, indent=1) + "\n"


def test_trace_maps_files_to_elements_and_elements_to_lines(tmp_path):
    build(tmp_path, backends=(OutlineBackend(),))
    trace = json.loads((tmp_path / "out/trace.json").read_text())
    assert trace["outputs"][0] == {"path": "outlines/Gate.txt", "elements": ["gate", "gate.in"]}
    assert trace["elements"][0] == {
        "id": "gate",
        "qualified_name": "Plant::Gate",
        "source": {"file": "plant.ir", "line": None, "column": None},
    }


SCRIPTS = """
Package p "装置"
  Class band "Förder band"
    Port band.in "in"
"""


def test_file_names_have_letters_of_all_scripts_and_the_manifest_the_full_names(tmp_path):
    (tmp_path / "plant.ir").write_text(SCRIPTS)
    arguments = [sys.executable, "-m", "sysmlc", "build", "plant.ir", "--emit", "plantuml,graph"]
    result = subprocess.run(arguments, cwd=tmp_path, capture_output=True)
    assert result.returncode == 0
    path = "diagrams/装置.bdd.puml"
    assert path in list_files(tmp_path)
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    names = {file["path"]: file.get("name") for file in manifest["files"]}
    assert names[path] == "装置"
    assert names["graph.json"] is None
    assert subprocess.run([*arguments, "--check"], cwd=tmp_path).returncode == 0


@pytest.mark.skipif(sys.platform != "linux", reason="other systems name files in Unicode")
@pytest.mark.parametrize(("option", "answer"), [([], b"SM912"), (["--check"], b"cannot use")])
def test_a_locale_without_the_letters_is_answered_in_a_sentence(tmp_path, option, answer):
    (tmp_path / "plant.ir").write_text(SCRIPTS)
    result = subprocess.run(
        [sys.executable, "-m", "sysmlc", "build", "plant.ir", "--emit", "plantuml", *option],
        cwd=tmp_path,
        capture_output=True,
        env={"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "HOME": str(tmp_path)},
    )
    assert result.returncode == 2
    assert answer in result.stderr
    assert b"set PYTHONUTF8=1" in result.stderr
    assert list_files(tmp_path) == []
