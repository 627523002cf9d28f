"""The cache: nobody but the user can put an entry into it, and a damaged entry is a miss."""

import os
import random
import shutil
import stat
from pathlib import Path

import msgspec
import pytest

from sysmlc.diagnostics import Diagnostic, Place, Rule, Severity, Subject
from sysmlc.diagnostics.renderers import Finding
from sysmlc.driver import compilation
from sysmlc.driver.outcome import Outcome, OutputFile, Withheld
from sysmlc.driver.outcome_cache import load_outcome, store_outcome
from sysmlc.support import cache
from sysmlc.support.cache import Cache

FAULTY = """\
Package pkg "Plant"
  Class gate "Gate"
    Port gate.in "in"
      -> typed-by nowhere
"""
KEY = "ab" * 32


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """The folder of the user's cache, which is not there yet."""
    folder = tmp_path / "user" / "cache"
    monkeypatch.setenv(cache.VARIABLE, str(folder))
    return folder


def modes(folder: Path) -> set[str]:
    return {stat.filemode(path.lstat().st_mode) for path in (folder, *folder.rglob("*"))}


def test_the_folder_and_its_files_are_private(project, folder):
    old_mask = os.umask(0)
    try:
        project.run("check", "plant.ir")
    finally:
        os.umask(old_mask)
    assert modes(folder) == {"drwx------", "-rw-------"}


def test_a_committed_cache_cannot_hide_findings(project, monkeypatch):
    """The entries were made by a stranger who runs the same sysmlc on a clean model."""
    monkeypatch.setenv(cache.VARIABLE, str(project.folder / ".sysmlc-cache"))
    project.write("plant.ir", FAULTY)
    honest = project.run("check", "plant.ir")
    assert honest.exit_code == 1
    shutil.rmtree(project.folder / ".sysmlc-cache", ignore_errors=True)
    monkeypatch.setattr(compilation._CompilationRun, "_list_diagnostics", lambda self: ())
    store = Cache(project.folder / ".sysmlc-cache")
    store.folder.mkdir()
    monkeypatch.setattr(cache, "open_cache", lambda roots: store)
    assert project.run("check", "plant.ir").exit_code == 0
    monkeypatch.undo()
    monkeypatch.chdir(project.folder)
    monkeypatch.setenv(cache.VARIABLE, str(project.folder / ".sysmlc-cache"))
    result = project.run("check", "plant.ir")
    assert result.exit_code == 1
    assert "no cache is used" in result.stderr
    assert "lies inside the project" in result.stderr


def test_a_cache_does_not_hold_configurations(project, folder):
    project.write("sysmlc.toml", 'output = "made"\n')
    project.run("build")
    project.write("sysmlc.toml", 'output = "made"\nunknown = 1\n')
    assert project.run("check", "plant.ir").exit_code == 2


@pytest.mark.parametrize("chosen", [".cache", "./deep/../.cache", "{}/.cache"])
def test_a_folder_in_the_project_root_is_refused(project, monkeypatch, chosen):
    monkeypatch.setenv(cache.VARIABLE, chosen.format(project.folder))
    project.write("models/plant.ir")
    result = project.run("check", "models/plant.ir")
    assert (result.exit_code, result.stderr.count("no cache is used")) == (0, 1)
    assert not (project.folder / ".cache").exists()


def test_a_folder_that_leads_into_the_project_root_is_refused(project, folder):
    folder.parent.mkdir()
    (project.folder / "committed").mkdir()
    folder.symlink_to(project.folder / "committed")
    assert "lies inside the project" in project.run("check", "plant.ir").stderr


def test_a_link_is_refused(project, folder):
    folder.parent.mkdir()
    folder.symlink_to(project.outside)
    result = project.run("check", "plant.ir")
    assert result.exit_code == 0
    assert "is a symbolic link" in result.stderr
    assert sorted(path.name for path in project.outside.iterdir()) == ["secret.ir"]


@pytest.mark.parametrize("mode", [0o720, 0o702, 0o777, 0o1777])
def test_a_folder_that_others_can_write_to_is_refused(project, folder, mode):
    folder.mkdir(parents=True)
    folder.chmod(mode)
    result = project.run("check", "plant.ir")
    assert (result.exit_code, list(folder.iterdir())) == (0, [])
    assert "is writable by other users" in result.stderr


def test_a_folder_of_somebody_else_is_refused(project, folder, monkeypatch):
    folder.mkdir(parents=True)
    own = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: own + 1)
    result = project.run("check", "plant.ir")
    assert (result.exit_code, list(folder.iterdir())) == (0, [])
    assert "belongs to another user" in result.stderr


# -- entries -----------------------------------------------------------------------------------


@pytest.fixture
def store(tmp_path) -> Cache:
    return Cache(tmp_path)


def entry_path(store: Cache, key: str = KEY) -> Path:
    return store.folder / key[:2] / f"{key}.entry"


def test_an_entry_under_another_key_is_a_miss(store):
    other = "ab" + "cd" * 31
    store.put(KEY, b"no findings")
    shutil.copy(entry_path(store), entry_path(store, other))
    assert store.get(KEY) == b"no findings"
    assert store.get(other) is None


def test_damaged_entries_are_misses(store):
    """Bits that flip, entries that are cut, grown or replaced by noise."""
    chance = random.Random(18)
    content = bytes(chance.randrange(256) for _ in range(500))
    store.put(KEY, content)
    whole = entry_path(store).read_bytes()
    for number in range(200):
        at = chance.randrange(len(whole))
        flipped = bytes([whole[at] ^ (1 << chance.randrange(8))])
        damaged = (
            whole[:at] + flipped + whole[at + 1 :],
            whole[:at],
            whole + whole[at:],
            chance.randbytes(at),
        )[number % 4]
        entry_path(store).write_bytes(damaged)
        assert store.get(KEY) is None


RULE = Rule("SM999", "made-up", Severity.ERROR, "phrase", "help", "page")
ERROR = Diagnostic(
    RULE, Severity.ERROR, "message", Subject("A::B", "b", Place("a.uml", 3)), ("note",), "help"
)
OUTCOME = Outcome(
    Path("/unit"),
    (),
    (Finding(ERROR, "a.uml", 4, 5, "  text", "/x", 1), Finding(ERROR)),
    (OutputFile("a.json", "graph", "12"),),
    {"a.json": "{}"},
    (Withheld("b.json", (ERROR,)),),
    False,
)


def test_an_outcome_is_stored_whole(store):
    store_outcome(store, KEY, OUTCOME)
    assert load_outcome(store, KEY, Path("/unit")) == OUTCOME


@pytest.mark.parametrize(
    "path", ["/etc/passwd", "../x", "a/../../x", "..\\x", "C:\\x", "C:x", "//host/x", ""]
)
def test_a_path_that_leads_out_is_a_miss(store, path):
    files = (OutputFile(path, "graph", "12"),)
    outcome = Outcome(Path("/unit"), (), (), files, {path: "{}"})
    store_outcome(store, KEY, outcome)
    assert store.get(KEY) is not None
    assert load_outcome(store, KEY, Path("/unit")) is None


def test_an_intact_entry_of_another_form_is_a_miss(store):
    """What an entry holds is checked against its types, value by value."""
    store_outcome(store, KEY, OUTCOME)
    entry = msgspec.json.decode(store.get(KEY))
    strangers = (None, 1, "x", True, [], {}, ["x"], [[]], {"x": 1}, -1.5, "SM000", [None] * 8)
    number = 0
    for change in _iter_changes(entry, strangers):
        store.put(KEY, msgspec.json.encode(change))
        loaded = load_outcome(store, KEY, Path("/unit"))
        assert loaded is None or isinstance(loaded, Outcome)
        number += loaded is None
    assert number > 200
    for text in (b"", b"{", b"[" * 100_000, b"\xff", b"null", b"[]"):
        store.put(KEY, text)
        assert load_outcome(store, KEY, Path("/unit")) is None


def _iter_changes(value, strangers):
    """Yield copies of *value* with one part replaced."""
    yield from strangers
    if isinstance(value, list):
        for at, part in enumerate(value):
            for changed in _iter_changes(part, strangers):
                yield [*value[:at], changed, *value[at + 1 :]]
    if isinstance(value, dict):
        for key, part in value.items():
            for changed in _iter_changes(part, strangers):
                yield value | {key: changed}


def test_nothing_unmarshals_or_unpickles_what_the_cache_holds():
    """The parse tables are part of the package; they are the only marshalled data."""
    package = Path(cache.__file__).parents[1]
    users = {
        path.relative_to(package).as_posix()
        for path in package.rglob("*.py")
        if "marshal.loads" in path.read_text("utf-8") or "pickle.load" in path.read_text("utf-8")
    }
    assert users == {"language/text/lalr.py"}
