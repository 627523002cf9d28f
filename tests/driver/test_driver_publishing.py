"""The output folder: only changes are written, stale files go, schemas hold."""

import json
import os

import pytest
from driver_fakes import FAULTY, PLANT, Outlines, compiled
from jsonschema import Draft202012Validator

from sysmlc.driver import Target, compare, publish, summarize
from sysmlc.support import resources


def build(folder, text=PLANT, **given):
    """Compile a text and bring ``folder/out`` up to date; return what changed."""
    publication = publication_of(folder, text, **given)
    assert publication.diagnostics == ()
    return list(publication.changed)


def publication_of(folder, text=PLANT, **given):
    (folder / "plant.ir").write_text(text)
    return publish(summarize(compiled(folder / "plant.ir", **given)), Target(folder / "out"))


def files(folder):
    out = folder / "out"
    return sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file())


ALL = ["coverage.json", "manifest.json", "outlines/Gate.txt", "outlines/Robot.txt", "trace.json"]


def test_the_folder_holds_what_was_made_and_three_files_about_it(tmp_path):
    assert sorted(build(tmp_path)) == ALL
    assert files(tmp_path) == ALL


@pytest.mark.parametrize("name", ["manifest", "coverage", "trace"])
@pytest.mark.parametrize("text", [PLANT, FAULTY, "Klass gate\n"])
def test_they_follow_their_schemas(tmp_path, name, text):
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


def test_only_what_changed_is_written(tmp_path):
    build(tmp_path)
    os.utime(tmp_path / "out/outlines/Robot.txt", (1, 1))
    changed = build(tmp_path, PLANT.replace('gate.in "in"', 'gate.in "entry"'))
    assert changed == ["outlines/Gate.txt", "trace.json", "manifest.json"]
    assert (tmp_path / "out/outlines/Robot.txt").stat().st_mtime == 1


def test_the_manifest_is_written_last(tmp_path):
    assert build(tmp_path)[-1] == "manifest.json"


def test_what_is_no_longer_made_is_removed_and_what_others_made_stays(tmp_path):
    build(tmp_path)
    (tmp_path / "out/outlines/own.txt").write_text("by hand")
    build(tmp_path, PLANT.replace("Robot", "Arm"))
    assert "outlines/Robot.txt" not in files(tmp_path)
    assert {"outlines/Arm.txt", "outlines/own.txt"} <= set(files(tmp_path))


def test_folders_that_become_empty_go_too(tmp_path):
    build(tmp_path)
    build(tmp_path, backends=())
    assert files(tmp_path) == ["coverage.json", "manifest.json", "trace.json"]
    assert not (tmp_path / "out/outlines").exists()


def test_a_withheld_file_is_removed_and_listed_with_the_reason(tmp_path):
    build(tmp_path)
    build(tmp_path, FAULTY)
    assert "outlines/Gate.txt" not in files(tmp_path)
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    listed = [entry["path"] for entry in manifest["files"]]
    assert listed == ["outlines/Robot.txt", "coverage.json", "trace.json"]
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
    assert files(tmp_path) == ALL
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    kept = ["outlines/Gate.txt", "outlines/Robot.txt"]
    assert [entry["path"] for entry in manifest["kept"]] == kept


def test_what_was_kept_is_removed_when_the_model_can_be_read_again(tmp_path):
    build(tmp_path)
    build(tmp_path, "Klass gate\n")
    build(tmp_path, PLANT.replace("Robot", "Arm"))
    assert "outlines/Robot.txt" not in files(tmp_path)


def test_differences_are_what_publishing_would_change(tmp_path):
    build(tmp_path)
    (tmp_path / "plant.ir").write_text(PLANT.replace("Robot", "Arm"))
    result, target = summarize(compiled(tmp_path / "plant.ir")), Target(tmp_path / "out")
    differences = compare(result, target)
    assert "outlines/Arm.txt" in differences
    assert sorted(publish(result, target).changed) == differences
    assert compare(result, target) == []


def test_a_file_in_the_way_of_the_folder_is_reported(tmp_path):
    (tmp_path / "out").write_text("a file")
    (diagnostic,) = publication_of(tmp_path).diagnostics
    assert (diagnostic.rule.name, "out" in diagnostic.message) == ("unwritable-output", True)


def test_an_interrupted_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch):
    build(tmp_path)
    before = (tmp_path / "out/outlines/Gate.txt").read_text()

    def fails(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.write", fails)
    (diagnostic,) = publication_of(tmp_path, PLANT.replace('"in"', '"entry"')).diagnostics
    assert "No space left" in diagnostic.message
    assert (tmp_path / "out/outlines/Gate.txt").read_text() == before
    assert files(tmp_path) == ALL


@pytest.mark.parametrize("backends", [(), (Outlines(),)])
def test_trace_is_laid_out_as_all_our_json(tmp_path, backends):
    build(tmp_path, PLANT.replace('"Gate"', '"Ga\\"te ü"'), backends=backends)
    text = (tmp_path / "out/trace.json").read_text(encoding="utf-8")
    assert text == json.dumps(json.loads(text), ensure_ascii=False, indent=1) + "\n"


def test_trace_leads_from_files_to_elements_to_lines(tmp_path):
    build(tmp_path, backends=(Outlines(),))
    trace = json.loads((tmp_path / "out/trace.json").read_text())
    assert trace["outputs"][0] == {"path": "outlines/Gate.txt", "elements": ["gate", "gate.in"]}
    assert trace["elements"][0] == {
        "id": "gate",
        "qualified_name": "Plant::Gate",
        "source": {"file": "plant.ir", "line": None, "column": None},
    }
