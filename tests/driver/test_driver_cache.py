"""The cache: what did not change is not compiled again, and nothing shows that it was not."""

import json
import os
from pathlib import Path

import pytest
from click.testing import CliRunner
from driver_fakes import FAULTY, PLANT

from sysmlc import cache
from sysmlc.cache import Cache
from sysmlc.cli import group
from sysmlc.driver import compilation, dependencies


@pytest.fixture
def runs(monkeypatch, tmp_path):
    """A cache of its own; the list of runs in which the passes really ran."""
    monkeypatch.setenv(cache.VARIABLE, str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    happened = []
    monkeypatch.setattr(dependencies, "_tool_files", lambda: [str(tmp_path / "tool.py")])
    dependencies.tool_digest.cache_clear()
    real = compilation._Run.compilation

    def counted(run):
        happened.append(run)
        return real(run)

    monkeypatch.setattr(compilation._Run, "compilation", counted)
    yield happened
    dependencies.tool_digest.cache_clear()


def sysmlc(*arguments):
    result = CliRunner().invoke(group.sysmlc, list(arguments))
    return result.exit_code, result.stdout, result.stderr


def out_files(folder: Path) -> dict[str, str]:
    return {p.relative_to(folder).as_posix(): p.read_text() for p in folder.rglob("*.*")}


@pytest.mark.parametrize("form", ["text", "json", "sarif", "github", "concise"])
def test_the_second_run_says_and_writes_the_same_without_compiling(runs, form):
    Path("plant.ir").write_text(FAULTY)
    first = sysmlc("plant.ir", "-o", "one", "--format", form)
    second = sysmlc("plant.ir", "-o", "two", "--format", form)
    assert len(runs) == 1
    assert (second[0], second[1].replace("two:", "one:"), second[2]) == first
    assert out_files(Path("two")) == out_files(Path("one"))


def test_a_changed_file_is_compiled_again(runs):
    Path("plant.ir").write_text(PLANT)
    sysmlc("plant.ir")
    Path("plant.ir").write_text(PLANT.replace("Robot", "Arm"))
    sysmlc("plant.ir")
    assert len(runs) == 2


def test_another_tool_compiles_again(runs):
    Path("plant.ir").write_text(PLANT)
    sysmlc("plant.ir")
    Path("tool.py").write_text("a correction")
    dependencies.tool_digest.cache_clear()  # what another process does
    sysmlc("plant.ir")
    assert len(runs) == 2


def test_the_tool_is_all_that_is_shipped_and_what_plug_ins_bring():
    files = [Path(path) for path in dependencies._tool_files()]
    names = {path.name for path in files}
    assert {"graph.py", "ir.ecore", "expression.lark", "act.puml.j2"} <= names
    assert all(path.is_file() for path in files)


def test_files_that_are_gone_are_written_again_from_the_cache(runs):
    Path("plant.ir").write_text(PLANT)
    sysmlc("plant.ir")
    before = out_files(Path("out"))
    Path("out/trace.json").unlink()
    Path("out/coverage.json").write_text("{}")
    assert sysmlc("plant.ir")[1] == f"out: {len(before)} files, 2 changed\n"
    assert (out_files(Path("out")), len(runs)) == (before, 1)


@pytest.mark.parametrize(
    "further",
    [
        ("--emit", "+graph"),
        ("--strict-input",),
        ("--config", "other.toml"),
        ("--templates", "own"),
        ("--no-cache",),
        ("--verify-each",),
        ("--print-after", "resolve"),
        ("-v",),
    ],
)
def test_what_else_is_asked_for_is_not_answered_from_the_cache(runs, further):
    Path("plant.ir").write_text(PLANT)
    Path("own").mkdir()
    Path("own/note.txt").write_text("a template")
    Path("other.toml").write_text('[rules]\nSM300 = "off"\n')
    sysmlc("plant.ir")
    assert sysmlc("plant.ir", *further)[0] == 0
    assert len(runs) == 2


def test_check_is_content_with_findings_and_build_is_not(runs):
    Path("plant.ir").write_text(PLANT)
    sysmlc("check", "plant.ir")
    sysmlc("check", "plant.ir")
    assert len(runs) == 1
    sysmlc("build", "plant.ir")
    assert len(runs) == 2


def test_another_working_folder_sees_its_own_names_of_files(runs, monkeypatch):
    Path("models").mkdir()
    Path("models/plant.ir").write_text(FAULTY)
    there = sysmlc("check", "models/plant.ir", "--format", "json")[1]
    monkeypatch.chdir("models")
    here = sysmlc("check", "plant.ir", "--format", "json")[1]
    assert {found["file"] for found in json.loads(there)["diagnostics"]} == {"models/plant.ir"}
    assert {found["file"] for found in json.loads(here)["diagnostics"]} == {"plant.ir"}
    assert len(runs) == 1


@pytest.mark.parametrize("damage", [b"", b"no zip", b"\x78\x9c", None])
def test_a_damaged_cache_costs_time_only(runs, tmp_path, damage):
    Path("plant.ir").write_text(PLANT)
    sysmlc("plant.ir")
    before = out_files(Path("out"))
    for entry in (tmp_path / "cache").rglob("*.entry"):
        whole = entry.read_bytes()
        entry.write_bytes(whole[:-3] + b"abc" if damage is None else damage)
    Path("out/trace.json").unlink()
    assert sysmlc("plant.ir")[0] == 0
    assert (out_files(Path("out")), len(runs)) == (before, 2)


def test_a_cache_that_cannot_be_written_costs_time_only(runs, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv(cache.VARIABLE, str(tmp_path / "file"))
    Path("plant.ir").write_text(PLANT)
    assert sysmlc("plant.ir")[0] == 0
    assert sysmlc("plant.ir")[0] == 0
    assert len(runs) == 2


@pytest.fixture
def watched(monkeypatch):
    """``sysmlc watch`` of a model that is built, saved once and built again."""
    import watchfiles

    def saves(*_folders, **_options):
        Path("plant.ir").write_text(PLANT.replace("Robot", "Arm"))
        yield {(1, "plant.ir")}

    monkeypatch.setattr(watchfiles, "watch", saves)
    Path("plant.ir").write_text(PLANT)
    return lambda: sysmlc("watch", "plant.ir")


def test_what_is_watched_is_written_before_it_is_kept_and_then_found(runs, watched, monkeypatch):
    put, seen = Cache.put, []

    def noted(store, *parts):
        seen.append("Arm" in Path("out/trace.json").read_text())
        put(store, *parts)

    monkeypatch.setattr(Cache, "put", noted)
    assert watched()[0] == 0
    assert not seen[0]
    assert seen[-1]
    sysmlc("plant.ir")
    assert len(runs) == 2


@pytest.mark.parametrize("at", ["open", "replace"])
def test_an_entry_that_is_interrupted_leaves_nothing(runs, watched, tmp_path, monkeypatch, at):
    real = getattr(os, at)

    def interrupted(path, *others):
        if ".entry." in str(path):
            raise KeyboardInterrupt
        return real(path, *others)

    monkeypatch.setattr(os, at, interrupted)
    assert watched()[0] == 130
    assert "Robot" in Path("out/trace.json").read_text()
    assert not [path for path in (tmp_path / "cache").rglob("*") if path.is_file()]
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(cache.VARIABLE, str(tmp_path / "cache"))
    assert sysmlc("plant.ir", "--check")[0] == 0


def test_a_missing_file_is_reported_every_time(runs):
    assert sysmlc("check", "plant.ir")[0] == 2
    assert sysmlc("check", "plant.ir")[0] == 2
    assert len(runs) == 2


def test_what_was_not_used_for_longest_goes_first(tmp_path):
    store = Cache(tmp_path, limit=1500)
    noise = [bytes((i * 7919 + k * k * 31) % 251 for k in range(600)) for i in range(3)]
    store.put("aa1", noise[0])
    store.put("bb2", noise[1])
    os.utime(tmp_path / "aa/aa1.entry", (1, 1))
    os.utime(tmp_path / "bb/bb2.entry", (2, 2))
    assert store.get("aa1") == noise[0]
    store.put("cc3", noise[2])
    assert (store.get("aa1"), store.get("bb2"), store.get("cc3")) == (noise[0], None, noise[2])
