"""The cache: what did not change is not compiled again, and nothing shows that it was not."""

import json
import os
from pathlib import Path

import pytest
from click.testing import CliRunner
from driver_fakes import FAULTY, PLANT

from sysmlc.cli import group
from sysmlc.driver import compilation, outcome_cache
from sysmlc.support import cache
from sysmlc.support.cache import Cache


@pytest.fixture
def cache_folder(tmp_path_factory):
    """A folder outside of the project."""
    return tmp_path_factory.mktemp("user") / "cache"


@pytest.fixture
def runs(monkeypatch, tmp_path, cache_folder):
    """A cache of its own; the list of runs in which the passes really ran."""
    monkeypatch.setenv(cache.VARIABLE, str(cache_folder))
    monkeypatch.chdir(tmp_path)
    happened = []
    monkeypatch.setattr(outcome_cache, "_PACKAGE", tmp_path / "tool")
    outcome_cache.compute_tool_digest.cache_clear()
    real = compilation._CompilationRun.compile

    def counted(run):
        happened.append(run)
        return real(run)

    monkeypatch.setattr(compilation._CompilationRun, "compile", counted)
    yield happened
    outcome_cache.compute_tool_digest.cache_clear()


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
    Path("tool").mkdir()
    Path("tool/pass.py").write_text("first")
    sysmlc("plant.ir")
    Path("tool/pass.py").write_text("a correction")
    outcome_cache.compute_tool_digest.cache_clear()  # as another process does
    sysmlc("plant.ir")
    assert len(runs) == 2


def test_the_digest_of_an_installed_tool_is_that_of_its_record(tmp_path, monkeypatch):
    """Times of files differ between installations of the same wheel, as in CI."""
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


def test_files_that_are_gone_are_written_again_from_the_cache(runs):
    Path("plant.ir").write_text(PLANT)
    sysmlc("plant.ir")
    before = out_files(Path("out"))
    Path("out/trace.json").unlink()
    Path("out/coverage.json").unlink()
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
def test_a_damaged_cache_costs_time_only(runs, cache_folder, damage):
    Path("plant.ir").write_text(PLANT)
    sysmlc("plant.ir")
    before = out_files(Path("out"))
    for entry in cache_folder.rglob("*.entry"):
        whole = entry.read_bytes()
        entry.write_bytes(whole[:-3] + b"abc" if damage is None else damage)
    Path("out/trace.json").unlink()
    assert sysmlc("plant.ir")[0] == 0
    assert (out_files(Path("out")), len(runs)) == (before, 2)


def test_a_cache_that_cannot_be_written_costs_time_only(runs, cache_folder, monkeypatch):
    cache_folder.write_text("no folder")
    monkeypatch.setenv(cache.VARIABLE, str(cache_folder / "below"))
    Path("plant.ir").write_text(PLANT)
    assert sysmlc("plant.ir")[0] == 0
    assert sysmlc("plant.ir")[0] == 0
    assert len(runs) == 2


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
