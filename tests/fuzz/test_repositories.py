"""Hostile repositories are answered, and change nothing but their output folder.

The number of a repository in a failure is its seed: ``repository(seed, among)`` makes it again.
SYSMLC_REPOSITORIES=2000 tries so many with real models; by default it is 120, about one minute.
"""

import os

import pytest

from fuzz.mutants import SUFFIXES, models
from fuzz.repositories import FIRST_SEED, Repository, repository, run, take_snapshot
from long_runs import quick_first

BATCH = 100
LARGEST = 150 * 1024
FIRST_REAL = FIRST_SEED + 1_000
REAL = int(os.environ.get("SYSMLC_REPOSITORIES", "120"))


def find_unanswered(guard, folder, seeds, among):
    unanswered = []
    for seed in seeds:
        hostile = repository(seed, among)
        _, problems = run(hostile, guard, folder / "work")
        unanswered += [f"{seed} {hostile.args} ({hostile.done}): {p}" for p in problems]
    return unanswered


@pytest.mark.parametrize("first", quick_first(range(FIRST_SEED, FIRST_SEED + 60, 10)))
def test_hostile_repositories_change_only_their_output_folder(guard, tmp_path, first):
    among = models(None, 0, [*SUFFIXES])
    assert find_unanswered(guard, tmp_path, range(first, first + 10), among) == []


@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.parametrize("first", range(FIRST_REAL, FIRST_REAL + REAL, BATCH))
def test_hostile_repositories_with_real_models(guard, tmp_path, corpus, first):
    among = models(corpus, LARGEST, [*SUFFIXES])
    assert find_unanswered(guard, tmp_path, range(first, first + BATCH), among) == []


def test_a_repository_is_the_same_for_its_seed():
    among = models(None, 0)
    assert repository(FIRST_SEED, among) == repository(FIRST_SEED, among)
    assert repository(FIRST_SEED, among) != repository(FIRST_SEED + 1, among)


def test_a_change_outside_the_output_folder_would_be_found(guard, tmp_path):
    """The command line may write anywhere, so it serves as a fault that must be noticed."""
    files = {"m.sysml": b"package P { part def A; }"}
    for output in ("elsewhere", "../sentinel/new"):
        hostile = Repository(0, files, {}, ("build", "m.sysml", "-o", output), "")
        _, problems = run(hostile, guard, tmp_path / "work")
        assert any("outside project/out" in problem for problem in problems), problems
    hostile = Repository(0, files, {}, ("build", "m.sysml", "-o", "out"), "")
    assert run(hostile, guard, tmp_path / "work")[1] == []


def test_a_snapshot_sees_files_folders_and_links(tmp_path):
    before = take_snapshot(tmp_path)
    (tmp_path / "file").write_text("x")
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to("../x")
    assert set(take_snapshot(tmp_path)) - set(before) == {"file", "folder", "link"}
