"""The cache: an unchanged model is not compiled again, and the results are the same."""

import json
import os
from pathlib import Path

import pytest
from driver_helpers import FAULTY, PLANT, run_sysmlc

from sysmlc.driver import compilation, outcome_cache
from sysmlc.support import cache
from sysmlc.support.cache import Cache


@pytest.fixture
def cache_folder(tmp_path_factory):
    """A folder for the cache outside of the project."""
    return tmp_path_factory.mktemp("user") / "cache"


@pytest.fixture
def compilations(monkeypatch, tmp_path, cache_folder):
    """Use an empty cache; return the list of compilations that were not answered from it."""
    monkeypatch.setenv(cache.VARIABLE, str(cache_folder))
    monkeypatch.chdir(tmp_path)
    compilations = []
    monkeypatch.setattr(outcome_cache, "_PACKAGE", tmp_path / "tool")
    outcome_cache.compute_tool_digest.cache_clear()
    compile_unit = compilation._CompilationRun.compile

    def record_compilation(run):
        compilations.append(run)
        return compile_unit(run)

    monkeypatch.setattr(compilation._CompilationRun, "compile", record_compilation)
    yield compilations
    outcome_cache.compute_tool_digest.cache_clear()


def read_files(folder: Path) -> dict[str, str]:
    return {path.relative_to(folder).as_posix(): path.read_text() for path in folder.rglob("*.*")}


@pytest.mark.parametrize("format_name", ["text", "json", "sarif", "github", "concise"])
def test_the_second_run_has_the_same_results_without_compiling(compilations, format_name):
    Path("plant.ir").write_text(FAULTY)
    first = run_sysmlc("plant.ir", "-o", "one", "--format", format_name)
    second = run_sysmlc("plant.ir", "-o", "two", "--format", format_name)
    assert len(compilations) == 1
    assert (second[0], second[1].replace("two:", "one:"), second[2]) == first
    assert read_files(Path("two")) == read_files(Path("one"))


def test_a_changed_file_is_compiled_again(compilations):
    Path("plant.ir").write_text(PLANT)
    run_sysmlc("plant.ir")
    Path("plant.ir").write_text(PLANT.replace("Robot", "Arm"))
    run_sysmlc("plant.ir")
    assert len(compilations) == 2


def test_a_changed_compiler_compiles_again(compilations):
    Path("plant.ir").write_text(PLANT)
    Path("tool").mkdir()
    Path("tool/pass.py").write_text("first")
    run_sysmlc("plant.ir")
    Path("tool/pass.py").write_text("a correction")
    outcome_cache.compute_tool_digest.cache_clear()  # like another process
    run_sysmlc("plant.ir")
    assert len(compilations) == 2


def test_the_digest_of_an_installed_compiler_is_the_digest_of_its_record(tmp_path, monkeypatch):
    """The times of the files differ between installations of the same wheel, for example in CI."""
    monkeypatch.setattr(outcome_cache, "_PACKAGE", tmp_path / "sysmlc")
    record = tmp_path / "sysmlc-1.0.dist-info" / "RECORD"
    record.parent.mkdir()
    record.write_text("sysmlc/graph.py,sha256=one,1")
    first = list(outcome_cache._digest_own_files())
    os.utime(record, (1, 1))
    assert list(outcome_cache._digest_own_files()) == first
    record.write_text("sysmlc/graph.py,sha256=two,1")
    assert list(outcome_cache._digest_own_files()) != first


def test_the_digest_of_a_checkout_covers_all_files():
    digested = " ".join(outcome_cache._digest_own_files())
    for name in ("graph.py", "ir.ecore", "expression.lark", "act.puml.j2"):
        assert f"{name} " in digested


def test_missing_outputs_are_restored_from_the_cache(compilations):
    Path("plant.ir").write_text(PLANT)
    run_sysmlc("plant.ir")
    before = read_files(Path("out"))
    Path("out/trace.json").unlink()
    Path("out/coverage.json").unlink()
    assert run_sysmlc("plant.ir")[1] == f"out: {len(before)} files, 2 changed\n"
    assert (read_files(Path("out")), len(compilations)) == (before, 1)


@pytest.mark.parametrize(
    "options",
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
def test_other_options_are_not_answered_from_the_cache(compilations, options):
    Path("plant.ir").write_text(PLANT)
    Path("own").mkdir()
    Path("own/note.txt").write_text("a template")
    Path("other.toml").write_text('[rules]\nSM300 = "off"\n')
    run_sysmlc("plant.ir")
    assert run_sysmlc("plant.ir", *options)[0] == 0
    assert len(compilations) == 2


def test_build_does_not_reuse_the_cache_entry_of_check(compilations):
    Path("plant.ir").write_text(PLANT)
    run_sysmlc("check", "plant.ir")
    run_sysmlc("check", "plant.ir")
    assert len(compilations) == 1
    run_sysmlc("build", "plant.ir")
    assert len(compilations) == 2


def test_paths_of_cached_diagnostics_are_relative_to_the_working_folder(compilations, monkeypatch):
    Path("models").mkdir()
    Path("models/plant.ir").write_text(FAULTY)
    seen_from_parent = run_sysmlc("check", "models/plant.ir", "--format", "json")[1]
    monkeypatch.chdir("models")
    seen_from_folder = run_sysmlc("check", "plant.ir", "--format", "json")[1]
    assert {diagnostic["file"] for diagnostic in json.loads(seen_from_parent)["diagnostics"]} == {
        "models/plant.ir"
    }
    assert {diagnostic["file"] for diagnostic in json.loads(seen_from_folder)["diagnostics"]} == {
        "plant.ir"
    }
    assert len(compilations) == 1


@pytest.mark.parametrize("damage", [b"", b"no zip", b"\x78\x9c", None])
def test_a_damaged_cache_entry_is_ignored(compilations, cache_folder, damage):
    Path("plant.ir").write_text(PLANT)
    run_sysmlc("plant.ir")
    before = read_files(Path("out"))
    for entry in cache_folder.rglob("*.entry"):
        data = entry.read_bytes()
        entry.write_bytes(data[:-3] + b"abc" if damage is None else damage)
    Path("out/trace.json").unlink()
    assert run_sysmlc("plant.ir")[0] == 0
    assert (read_files(Path("out")), len(compilations)) == (before, 2)


def test_a_cache_that_cannot_be_written_is_ignored(compilations, cache_folder, monkeypatch):
    cache_folder.write_text("no folder")
    monkeypatch.setenv(cache.VARIABLE, str(cache_folder / "below"))
    Path("plant.ir").write_text(PLANT)
    assert run_sysmlc("plant.ir")[0] == 0
    assert run_sysmlc("plant.ir")[0] == 0
    assert len(compilations) == 2


def test_a_missing_file_is_reported_every_time(compilations):
    assert run_sysmlc("check", "plant.ir")[0] == 2
    assert run_sysmlc("check", "plant.ir")[0] == 2
    assert len(compilations) == 2


def test_the_least_recently_used_entry_is_evicted(tmp_path):
    store = Cache(tmp_path, limit=1500)
    values = [bytes((i * 7919 + k * k * 31) % 251 for k in range(600)) for i in range(3)]
    store.put("aa1", values[0])
    store.put("bb2", values[1])
    os.utime(tmp_path / "aa/aa1.entry", (1, 1))
    os.utime(tmp_path / "bb/bb2.entry", (2, 2))
    assert store.get("aa1") == values[0]
    store.put("cc3", values[2])
    assert (store.get("aa1"), store.get("bb2"), store.get("cc3")) == (values[0], None, values[2])
