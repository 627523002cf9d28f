"""After a build that was interrupted anywhere, the next build leaves the outputs of a clean one.

Each scenario starts from the outputs of one model, of which some become obsolete, some change, some
are new and some stay. A first run counts the system calls; then each of them fails once.
"""

import errno
import os
import random
import shutil
import signal
import time
from functools import cache
from pathlib import Path

import pytest

from sysmlc.driver import Target, compare, publish
from sysmlc.driver.outcome import Outcome, OutputFile, compute_text_digest

CALLS = ["open", "write", "replace", "fsync", "unlink", "rmdir", "mkdir", "close"]
FOREIGN = {"out/own.txt": "by hand", "out/contracts/own.txt": "by hand", "notes.txt": "by hand"}


@pytest.fixture(autouse=True)
def _skip_fsync(monkeypatch):
    """Let ``fsync`` return at once, because no test is about power failures."""
    monkeypatch.setattr(os, "fsync", _fsync)


def _fsync(_handle):
    pass


def make_outcome(**texts: str) -> Outcome:
    """Return the outcome of a model that gives *texts*; ``__`` stands for ``/``, ``_`` for ``.``"""
    files = {name.replace("__", "/").replace("_", "."): text for name, text in texts.items()}
    output_files = tuple(
        OutputFile(path, "test", compute_text_digest(text)) for path, text in files.items()
    )
    return Outcome(Path.cwd(), (), (), output_files, files)


FIRST = make_outcome(trace_json="1", contracts__a_md="1", diagrams__old__b_puml="1", same_txt="=")
SECOND = make_outcome(trace_json="2", contracts__a_md="2", recipes__c_json="2" * 9999, same_txt="=")
THIRD = make_outcome(trace_json="3", contracts__a_md="3", recipes__d_json="3", same_txt="=")


def read_tree(folder: Path) -> dict[str, bytes | None]:
    """Return each file of *folder* with its content, and each folder with None."""
    paths = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*")}
    return {name: None if path.is_dir() else path.read_bytes() for name, path in paths.items()}


def prepare_outputs(folder: Path) -> Target:
    """Write the outputs and foreign files that exist before the interrupted build."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    target = Target(folder / "out", boundary=folder)
    assert not publish(FIRST, target).is_refused
    for name, text in FOREIGN.items():
        (folder / name).write_text(text)
    return target


def build_cleanly(folder: Path, outcome: Outcome) -> dict[str, bytes | None]:
    """Return the files after a build without an interruption."""
    assert not publish(outcome, prepare_outputs(folder)).is_refused
    return read_tree(folder)


class Faults:
    """Count the system calls that change files, and let the one with a given number fail."""

    def __init__(self, monkeypatch, failing: int, number: int) -> None:
        self.count = 0
        self.failing, self.number = failing, number
        for name in CALLS:
            monkeypatch.setattr(os, name, self._wrap(getattr(os, name)))

    def _wrap(self, call):
        def count_call(*arguments, **options):
            self.count += 1
            if self.count == self.failing:
                if call.__name__ == "close":
                    call(*arguments, **options)
                raise OSError(self.number, os.strerror(self.number))
            return call(*arguments, **options)

        count_call.__name__ = call.__name__
        return count_call


@cache
def count_calls(folder: Path) -> int:
    with pytest.MonkeyPatch.context() as patch:
        target = prepare_outputs(folder)
        faults = Faults(patch, 0, 0)
        publish(SECOND, target)
        return faults.count


def test_publishing_makes_the_calls_that_are_counted(tmp_path):
    assert count_calls(tmp_path / "project") > 30


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO])
@pytest.mark.parametrize("next_outcome", [SECOND, FIRST, THIRD], ids=["same", "old", "new"])
def test_every_failing_call_is_reported_and_repaired(tmp_path, monkeypatch, number, next_outcome):
    folder = tmp_path / "project"
    clean = build_cleanly(folder, next_outcome)
    for failing in range(1, count_calls(folder) + 1):
        target = prepare_outputs(folder)
        with monkeypatch.context() as patch:
            Faults(patch, failing, number)
            publication = publish(SECOND, target)
        rule_names = [diagnostic.rule.name for diagnostic in publication.diagnostics]
        assert rule_names in (["unwritable-output"], []), failing
        assert rule_names or read_tree(folder) == build_cleanly(tmp_path / "other", SECOND), failing
        assert publish(next_outcome, target).diagnostics == (), failing
        assert read_tree(folder) == clean, failing
        assert compare(next_outcome, target) == ["contracts/own.txt"], failing


def test_two_interruptions_in_a_row_are_repaired(tmp_path, monkeypatch):
    """The second build has other outputs than the first, so that two pending manifests exist."""
    folder = tmp_path / "project"
    clean, calls = build_cleanly(folder, FIRST), count_calls(folder)
    for first in range(1, calls + 1, 5):
        for second in range(1, calls + 1, 7):
            target = prepare_outputs(folder)
            for outcome, failing in ((SECOND, first), (THIRD, second)):
                with monkeypatch.context() as patch:
                    Faults(patch, failing, errno.ENOSPC)
                    publish(outcome, target)
            assert publish(FIRST, target).diagnostics == (), (first, second)
            assert read_tree(folder) == clean, (first, second)


def kill_at(target: Target, outcome: Outcome, seconds: float) -> None:
    """Publish in a child process and kill it after *seconds*."""
    child = os.fork()
    if child == 0:
        publish(outcome, target)
        os._exit(0)
    time.sleep(seconds)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


def kill_repeatedly(folder: Path, times: int) -> None:
    generator = random.Random(18)
    outcomes = [FIRST, SECOND, THIRD]
    clean = [build_cleanly(folder, outcome) for outcome in outcomes]
    start = time.perf_counter()
    publish(SECOND, prepare_outputs(folder))
    duration = time.perf_counter() - start
    for number in range(times):
        target = prepare_outputs(folder)
        for _ in range(generator.randint(1, 2)):
            kill_at(target, generator.choice(outcomes), generator.uniform(0, 1.2 * duration))
        last = generator.randrange(len(outcomes))
        assert publish(outcomes[last], target).diagnostics == (), number
        assert read_tree(folder) == clean[last], number


def test_killed_builds_are_repaired(tmp_path):
    kill_repeatedly(tmp_path / "project", 10)


@pytest.mark.long
def test_builds_killed_at_100_random_moments_are_repaired(tmp_path):
    kill_repeatedly(tmp_path / "project", 100)


def test_two_concurrent_builds_leave_the_outputs_of_one_of_them(tmp_path):
    target = prepare_outputs(tmp_path / "project")
    children = []
    for outcome in (SECOND, THIRD) * 5:
        child = os.fork()
        if child == 0:
            os._exit(int(publish(outcome, target).is_refused))
        children.append(child)
    assert {os.waitpid(child, 0)[1] for child in children} == {0}
    tree = read_tree(tmp_path / "project")
    assert tree in [build_cleanly(tmp_path / "other", outcome) for outcome in (SECOND, THIRD)]


def test_only_temporary_files_of_sysmlc_are_removed(tmp_path):
    target = prepare_outputs(tmp_path / "project")
    (target.folder / ".sysmlc-0123456789abcdef").write_text("of a killed build")
    (target.folder / ".sysmlc-notes").write_text("by hand")
    assert publish(SECOND, target).diagnostics == ()
    assert [path.name for path in target.folder.glob(".sysmlc*")] == [".sysmlc-notes"]


def test_check_reports_an_interrupted_build(tmp_path, monkeypatch):
    target = prepare_outputs(tmp_path / "project")
    monkeypatch.setattr(os, "replace", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        publish(SECOND, target)
    assert "trace.json" in compare(SECOND, target)


def test_files_are_synced_one_by_one_if_no_thread_can_start(tmp_path, monkeypatch):
    """Threads cannot start under a limit on memory or processes."""

    def refuse(_):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("threading.Thread.start", refuse)
    outcome = make_outcome(**{f"file{number}_txt": str(number) for number in range(40)})
    assert not publish(outcome, Target(tmp_path / "out", boundary=tmp_path)).is_refused
    assert len(list((tmp_path / "out").glob("*.txt"))) == 40
