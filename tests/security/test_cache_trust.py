"""The cache: only the user can write entries, and a damaged entry is a miss."""

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
    """The folder of the user's cache, which does not exist yet."""
    folder = tmp_path / "user" / "cache"
    monkeypatch.setenv(cache.VARIABLE, str(folder))
    return folder


def list_modes(folder: Path) -> set[str]:
    return {stat.filemode(path.lstat().st_mode) for path in (folder, *folder.rglob("*"))}


def test_the_folder_and_its_files_are_private(project, folder):
    old_mask = os.umask(0)
    try:
        project.run("check", "plant.ir")
    finally:
        os.umask(old_mask)
    assert list_modes(folder) == {"drwx------", "-rw-------"}


def test_a_committed_cache_cannot_hide_diagnostics(project, monkeypatch):
    """An attacker commits entries that the same version of sysmlc stored for a clean model."""
    monkeypatch.setenv(cache.VARIABLE, str(project.folder / ".sysmlc-cache"))
    project.write("plant.ir", FAULTY)
    original = project.run("check", "plant.ir")
    assert original.exit_code == 1
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


def test_configurations_are_not_cached(project, folder):
    project.write("sysmlc.toml", 'output = "gen"\n')
    project.run("build")
    project.write("sysmlc.toml", 'output = "gen"\nunknown = 1\n')
    assert project.run("check", "plant.ir").exit_code == 2


@pytest.mark.parametrize("location", [".cache", "./deep/../.cache", "{}/.cache"])
def test_a_folder_in_the_project_root_is_refused(project, monkeypatch, location):
    monkeypatch.setenv(cache.VARIABLE, location.format(project.folder))
    project.write("models/plant.ir")
    result = project.run("check", "models/plant.ir")
    assert (result.exit_code, result.stderr.count("no cache is used")) == (0, 1)
    assert not (project.folder / ".cache").exists()


def test_a_link_into_the_project_root_is_refused(project, folder):
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
def test_a_folder_that_is_writable_by_other_users_is_refused(project, folder, mode):
    folder.mkdir(parents=True)
    folder.chmod(mode)
    result = project.run("check", "plant.ir")
    assert (result.exit_code, list(folder.iterdir())) == (0, [])
    assert "is writable by other users" in result.stderr


def test_a_folder_of_another_user_is_refused(project, folder, monkeypatch):
    folder.mkdir(parents=True)
    user = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: user + 1)
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
    other_key = "ab" + "cd" * 31
    store.put(KEY, b"no findings")
    shutil.copy(entry_path(store), entry_path(store, other_key))
    assert store.get(KEY) == b"no findings"
    assert store.get(other_key) is None


def test_damaged_entries_are_misses(store):
    """Bits are flipped, entries are cut, extended or replaced by random bytes."""
    generator = random.Random(18)
    content = bytes(generator.randrange(256) for _ in range(500))
    store.put(KEY, content)
    data = entry_path(store).read_bytes()
    for misses in range(200):
        index = generator.randrange(len(data))
        flipped = bytes([data[index] ^ (1 << generator.randrange(8))])
        damaged = (
            data[:index] + flipped + data[index + 1 :],
            data[:index],
            data + data[index:],
            generator.randbytes(index),
        )[misses % 4]
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


def test_an_outcome_is_stored_completely(store):
    store_outcome(store, KEY, OUTCOME)
    assert load_outcome(store, KEY, Path("/unit")) == OUTCOME


@pytest.mark.parametrize(
    "path", ["/etc/passwd", "../x", "a/../../x", "..\\x", "C:\\x", "C:x", "//host/x", ""]
)
def test_an_entry_with_a_path_out_of_the_folder_is_a_miss(store, path):
    files = (OutputFile(path, "graph", "12"),)
    outcome = Outcome(Path("/unit"), (), (), files, {path: "{}"})
    store_outcome(store, KEY, outcome)
    assert store.get(KEY) is not None
    assert load_outcome(store, KEY, Path("/unit")) is None


def test_an_intact_entry_with_values_of_other_types_is_a_miss(store):
    """The types of all values of an entry are checked."""
    store_outcome(store, KEY, OUTCOME)
    entry = msgspec.json.decode(store.get(KEY))
    foreign_values = (None, 1, "x", True, [], {}, ["x"], [[]], {"x": 1}, -1.5, "SM000", [None] * 8)
    misses = 0
    for change in _iter_changes(entry, foreign_values):
        store.put(KEY, msgspec.json.encode(change))
        loaded = load_outcome(store, KEY, Path("/unit"))
        assert loaded is None or isinstance(loaded, Outcome)
        misses += loaded is None
    assert misses > 200
    for text in (b"", b"{", b"[" * 100_000, b"\xff", b"null", b"[]"):
        store.put(KEY, text)
        assert load_outcome(store, KEY, Path("/unit")) is None


def _iter_changes(value, foreign_values):
    """Yield copies of *value* with one part replaced."""
    yield from foreign_values
    if isinstance(value, list):
        for index, part in enumerate(value):
            for changed in _iter_changes(part, foreign_values):
                yield [*value[:index], changed, *value[index + 1 :]]
    if isinstance(value, dict):
        for key, part in value.items():
            for changed in _iter_changes(part, foreign_values):
                yield value | {key: changed}


def test_cached_data_is_neither_unmarshalled_nor_unpickled():
    """The only marshalled data are the parse tables, which are part of the package."""
    package = Path(cache.__file__).parents[1]
    users = {
        path.relative_to(package).as_posix()
        for path in package.rglob("*.py")
        if "marshal.loads" in path.read_text("utf-8") or "pickle.load" in path.read_text("utf-8")
    }
    assert users == {"language/text/lalr.py"}
