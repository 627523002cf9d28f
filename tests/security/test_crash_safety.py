"""A build that is interrupted anywhere: the next one leaves what an uninterrupted one leaves.

Each scenario starts from the outputs of one model, of which some become stale, some change, some
are new and some stay. The call sites are not listed by hand: a first run counts the calls.
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
def _no_waiting_for_the_disk(monkeypatch):
    """The calls of ``fsync`` are counted and fail like others; no power failure is tested."""
    monkeypatch.setattr(os, "fsync", _fsync)


def _fsync(_handle):
    pass


def make_outcome(**texts: str) -> Outcome:
    """Return the outcome of a model that gives *texts*; ``__`` stands for ``/``, ``_`` for ``.``"""
    files = {name.replace("__", "/").replace("_", "."): text for name, text in texts.items()}
    listed = tuple(
        OutputFile(path, "test", compute_text_digest(text)) for path, text in files.items()
    )
    return Outcome(Path.cwd(), (), (), listed, files)


FIRST = make_outcome(trace_json="1", contracts__a_md="1", diagrams__old__b_puml="1", same_txt="=")
SECOND = make_outcome(trace_json="2", contracts__a_md="2", recipes__c_json="2" * 9999, same_txt="=")
THIRD = make_outcome(trace_json="3", contracts__a_md="3", recipes__d_json="3", same_txt="=")


def read_tree(folder: Path) -> dict[str, bytes | None]:
    """Return each file of *folder* with its content, and each folder with None."""
    paths = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*")}
    return {name: None if path.is_dir() else path.read_bytes() for name, path in paths.items()}


def start(folder: Path) -> Target:
    """Make the state before the interrupted build in *folder*."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    target = Target(folder / "out", boundary=folder)
    assert not publish(FIRST, target).is_refused
    for name, text in FOREIGN.items():
        (folder / name).write_text(text)
    return target


def build_cleanly(folder: Path, outcome: Outcome) -> dict[str, bytes | None]:
    """Return what a build without an interruption leaves."""
    assert not publish(outcome, start(folder)).is_refused
    return read_tree(folder)


class Faults:
    """Counts system calls that change something, and fails the one with a given number."""

    def __init__(self, monkeypatch, failing: int, number: int) -> None:
        self.count = 0
        self.failing, self.number = failing, number
        for name in CALLS:
            monkeypatch.setattr(os, name, self._wrap(getattr(os, name)))

    def _wrap(self, call):
        def counted(*arguments, **options):
            self.count += 1
            if self.count == self.failing:
                if call.__name__ == "close":
                    call(*arguments, **options)
                raise OSError(self.number, os.strerror(self.number))
            return call(*arguments, **options)

        counted.__name__ = call.__name__
        return counted


@cache
def count_calls(folder: Path) -> int:
    with pytest.MonkeyPatch.context() as patch:
        target = start(folder)
        faults = Faults(patch, 0, 0)
        publish(SECOND, target)
        return faults.count


def test_the_wrapped_calls_are_those_that_publishing_makes(tmp_path):
    assert count_calls(tmp_path / "project") > 30


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO])
@pytest.mark.parametrize("next_outcome", [SECOND, FIRST, THIRD], ids=["same", "old", "new"])
def test_every_failing_call_is_reported_and_repaired(tmp_path, monkeypatch, number, next_outcome):
    folder = tmp_path / "project"
    clean = build_cleanly(folder, next_outcome)
    for failing in range(1, count_calls(folder) + 1):
        target = start(folder)
        with monkeypatch.context() as patch:
            Faults(patch, failing, number)
            publication = publish(SECOND, target)
        names = [diagnostic.rule.name for diagnostic in publication.diagnostics]
        assert names in (["unwritable-output"], []), failing
        assert names or read_tree(folder) == build_cleanly(tmp_path / "other", SECOND), failing
        assert publish(next_outcome, target).diagnostics == (), failing
        assert read_tree(folder) == clean, failing
        assert compare(next_outcome, target) == ["contracts/own.txt"], failing


def test_two_interruptions_in_a_row_are_repaired(tmp_path, monkeypatch):
    """The second build writes other contents than the first, so two pending manifests meet."""
    folder = tmp_path / "project"
    clean, calls = build_cleanly(folder, FIRST), count_calls(folder)
    for first in range(1, calls + 1, 5):
        for second in range(1, calls + 1, 7):
            target = start(folder)
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
    choice = random.Random(18)
    outcomes = [FIRST, SECOND, THIRD]
    clean = [build_cleanly(folder, outcome) for outcome in outcomes]
    begin = time.perf_counter()
    publish(SECOND, start(folder))
    duration = time.perf_counter() - begin
    for number in range(times):
        target = start(folder)
        for _ in range(choice.randint(1, 2)):
            kill_at(target, choice.choice(outcomes), choice.uniform(0, 1.2 * duration))
        last = choice.randrange(len(outcomes))
        assert publish(outcomes[last], target).diagnostics == (), number
        assert read_tree(folder) == clean[last], number


def test_killed_builds_are_repaired(tmp_path):
    kill_repeatedly(tmp_path / "project", 10)


@pytest.mark.long
def test_builds_killed_at_200_random_moments_are_repaired(tmp_path):
    kill_repeatedly(tmp_path / "project", 200)


def test_two_builds_at_once_leave_what_the_last_one_writes(tmp_path):
    target = start(tmp_path / "project")
    children = []
    for outcome in (SECOND, THIRD) * 5:
        child = os.fork()
        if child == 0:
            os._exit(int(publish(outcome, target).is_refused))
        children.append(child)
    assert {os.waitpid(child, 0)[1] for child in children} == {0}
    after = read_tree(tmp_path / "project")
    assert after in [build_cleanly(tmp_path / "other", outcome) for outcome in (SECOND, THIRD)]


def test_temporary_files_of_others_stay(tmp_path):
    target = start(tmp_path / "project")
    (target.folder / ".sysmlc-0123456789abcdef").write_text("of a killed build")
    (target.folder / ".sysmlc-notes").write_text("by hand")
    assert publish(SECOND, target).diagnostics == ()
    assert [path.name for path in target.folder.glob(".sysmlc*")] == [".sysmlc-notes"]


def test_an_interrupted_build_is_visible_to_check(tmp_path, monkeypatch):
    target = start(tmp_path / "project")
    monkeypatch.setattr(os, "replace", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        publish(SECOND, target)
    assert "trace.json" in compare(SECOND, target)


def test_files_are_synced_one_by_one_where_no_thread_starts(tmp_path, monkeypatch):
    """As under a limit on memory or on processes."""

    def refuse(_):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("threading.Thread.start", refuse)
    outcome = make_outcome(**{f"file{number}_txt": str(number) for number in range(40)})
    assert not publish(outcome, Target(tmp_path / "out", boundary=tmp_path)).is_refused
    assert len(list((tmp_path / "out").glob("*.txt"))) == 40
