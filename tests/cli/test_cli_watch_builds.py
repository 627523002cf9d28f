"""The builds of ``sysmlc watch`` inside the process of the test."""

import gc
import json
import os
from pathlib import Path

import pytest
import watchfiles
from jsonschema import Draft202012Validator

from sysmlc.cli import session, watch, watching
from sysmlc.cli.session import Settings
from sysmlc.cli.watching import Watch
from sysmlc.driver.inputs import SUFFIXES
from sysmlc.support import resources


def test_outputs_are_not_updated_while_the_model_has_errors(workspace):
    watcher = Watch((workspace.folder / "plant.ir",), None, Settings(emit=("graph",)), 0)
    watcher.build()
    good = workspace.read("out/graph.json")
    workspace.write("plant.ir", 'Package pkg "Plant"\n  Class gate "Gate"\n    Port gate.in\n')
    watcher.build()
    assert workspace.read("out/graph.json") == good
    workspace.write("plant.ir", 'Package pkg "Plant"\n')
    watcher.build()
    assert workspace.read("out/graph.json") != good


def test_outputs_of_the_build_are_no_inputs():
    names = ("plant.uml", "sysmlc.toml", "out/graph.json")
    assert [watch._is_input(Path("/x", name), SUFFIXES) for name in names] == [True, True, False]


def test_a_saved_file_is_rebuilt(workspace, monkeypatch):
    def save_model(*folders, **_):
        workspace.write("plant.ir", 'Package pkg "Other"\n')
        yield {(1, "plant.ir")}

    monkeypatch.setattr(watchfiles, "watch", save_model)
    result = workspace.sysmlc("watch", "plant.ir", "--emit", "graph")
    assert result.stdout == "out: 4 changed\nout: 3 changed\n"
    assert '"Other"' in workspace.read("out/graph.json")


def test_only_new_errors_delay_the_build(tmp_path, monkeypatch):
    """New errors may come from a half-written file, so that the build waits for further saves."""
    settling_times = []
    wait_until_stable = watching.wait_until_stable

    def record_settling_time(paths, seconds):
        settling_times.append(seconds)
        return wait_until_stable(paths, 0)

    monkeypatch.setattr(watching, "wait_until_stable", record_settling_time)
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<uml:Model>")
    watcher = Watch((path,), tmp_path / "out", Settings(has_cache=False), 0.05)
    # A build may take long on a busy machine, and then the file is not fresh any more.
    monkeypatch.setattr(watching, "is_fresh", lambda stamps, seconds: True)
    watcher.build()
    path.write_bytes(b"<uml:Model ><!-- saved -->")
    watcher.build()
    assert settling_times == [0.05, 1.5, 0.05]


class Clock:
    """A clock that advances only during ``sleep``; *saves* are the times when a file grows."""

    def __init__(self, path, saves):
        self.now = 0.0
        self._path, self._saves = path, saves

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds
        while self._saves and self._saves[0] <= self.now:
            self._path.write_bytes(self._path.read_bytes() + b"x")
            del self._saves[0]


CELL = """package Cells {{ part def Cell {{ part {0} : Robot; }} part def Robot; }}
package Lines {{ part def Line {{ part cell : {1}; }} }}
"""


def test_keep_going_writes_the_outputs_that_no_error_affects(tmp_path, capsys):
    path, diagrams = tmp_path / "cell.sysml", tmp_path / "out" / "diagrams"
    settings = Settings(emit=("plantuml",), has_cache=False)
    watcher = Watch((path,), tmp_path / "out", settings, 0, keep_going=True)
    path.write_text(CELL.format("arm", "Cells::Cell"))
    watcher.build()
    assert {diagram.name for diagram in diagrams.iterdir()} == {"Cells.bdd.puml", "Lines.bdd.puml"}
    path.write_text(CELL.format("gripper", "Cells::Nowhere"))
    watcher.build()
    cells, lines = ((diagrams / f"{name}.bdd.puml").read_text() for name in ("Cells", "Lines"))
    assert "gripper" in cells
    assert "⚠" in lines
    assert "⚠" not in cells


@pytest.mark.parametrize(("saves", "pauses"), [(3, 1), pytest.param(8, 0, marks=pytest.mark.long)])
def test_memory_of_earlier_builds_is_freed(saves, pauses, tmp_path, monkeypatch):
    """The watch collects syntax trees and graphs in a pause, and after many saves without one."""
    monkeypatch.setenv("SYSMLC_CACHE", str(tmp_path / "cache"))
    path = tmp_path / "cell.sysml"
    path.write_text("package P;")
    watcher = Watch((path,), tmp_path / "out", Settings(), 0)
    for number in range(saves):
        path.write_text(f"package P {{ part def Cell{number} {{ part arm : Cell{number}; }} }}")
        watcher.build()
    for _ in range(pauses):
        watcher.clean_up()
    gc.unfreeze()
    assert gc.collect() < 50


def test_files_saved_during_the_first_build_are_built(tmp_path, monkeypatch):
    """The watch knows the files of a folder only after the first build has read it."""
    existing, new = tmp_path / "a.sysml", tmp_path / "b.sysml"
    existing.write_text("package A;")
    saves = {existing: "package Edited;", new: "package New;"}
    compute_outcome = session.compute_outcome

    def save_after_compiling(*args):
        outcome = compute_outcome(*args)
        while saves:
            path, text = saves.popitem()
            path.write_text(text)
        return outcome

    monkeypatch.setattr(session, "compute_outcome", save_after_compiling)
    settings = Settings(emit=("graph",), has_cache=False)
    Watch((tmp_path,), tmp_path / "out", settings, 0).build()
    graph = (tmp_path / "out" / "graph.json").read_text()
    assert '"Edited"' in graph
    assert '"New"' in graph


def test_a_file_created_before_notifications_start_is_built(tmp_path):
    (tmp_path / "a.sysml").write_text("package A;")
    settings = Settings(emit=("graph",), has_cache=False)
    watcher = Watch((tmp_path,), tmp_path / "out", settings, 0)
    watcher.build()
    (tmp_path / "b.sysml").write_text("package New;")
    watcher.build_if_changed(())
    assert '"New"' in (tmp_path / "out" / "graph.json").read_text()


def test_each_save_restarts_the_settling_time(tmp_path, monkeypatch):
    path = tmp_path / "a"
    path.write_bytes(b"")
    clock = Clock(path, [0.2, 0.4, 0.6, 2.0])
    monkeypatch.setattr(watching, "time", clock)
    stamps = watching.wait_until_stable([path], 0.3)
    assert stamps[path][0] == 3
    assert 0.9 <= clock.now < 1.1


def test_files_that_change_all_the_time_are_built_after_30_seconds(tmp_path, monkeypatch):
    path = tmp_path / "a"
    path.write_bytes(b"")
    clock = Clock(path, [n / 10 for n in range(1000)])
    monkeypatch.setattr(watching, "time", clock)
    watching.wait_until_stable([path], 0.3)
    assert 30 <= clock.now < 31


def test_changes_are_detected_by_size_and_time(tmp_path):
    path, missing = tmp_path / "a", tmp_path / "b"
    path.write_bytes(b"x")
    os.utime(path, (0, 0))
    stamps = watching.wait_until_stable([path, missing, tmp_path], 0)
    assert stamps == {path: (1, 0), missing: None, tmp_path: (0, 0)}
    assert not watching.is_fresh({path: (1, 0)}, 1)
    assert watching.is_fresh({missing: None}, 1)
    path.write_bytes(b"xy")
    assert watching.read_stamps([path]) != {path: (1, 0)}
    assert watching.find_empty_files(stamps) == {missing}
    path.write_bytes(b"")
    assert watching.find_empty_files(watching.read_stamps([path, missing, tmp_path])) == {
        path,
        missing,
    }
    path.write_bytes(b"xy")
    assert watching.is_fresh(watching.read_stamps([path]), 3600)


def test_json_is_one_line_for_each_build(workspace, capsys):
    settings = Settings(emit=("graph",), form="json")
    watcher = Watch((workspace.folder / "plant.ir",), workspace.folder / "out", settings, 0)
    watcher.build()
    workspace.write("plant.ir", 'Package pkg "Plant"\n  Class gate "Gate"\n    Port gate.in\n')
    watcher.build()
    documents = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    schema = json.loads(resources.read_text("metamodels", "sysmlc-diagnostics.schema.json"))
    for document in documents:
        assert list(Draft202012Validator(schema).iter_errors(document)) == []
    assert [document["summary"]["errors"] for document in documents] == [0, 1]
    assert [document["output"]["is_updated"] for document in documents] == [True, False]
    assert "graph.json" in documents[0]["output"]["changed"]
