"""Hostile repositories get diagnostics, and change nothing but their output folder.

The number of a repository in a failure is its seed: ``make_repository(seed, models)`` makes it
again. SYSMLC_REPOSITORIES=2000 tries 2,000 with real models; by default it is 60, half a minute.
"""

import os

import pytest

from fuzz.mutants import SUFFIXES, list_models
from fuzz.repositories import FIRST_SEED, Repository, make_repository, run_command, take_snapshot
from long_runs import quick_first

BATCH = 100
LARGEST = 150 * 1024
FIRST_REAL = FIRST_SEED + 1_000
REAL = int(os.environ.get("SYSMLC_REPOSITORIES", "60"))


def find_unanswered(fork_server, folder, seeds, models):
    failures = []
    for seed in seeds:
        repository = make_repository(seed, models)
        _, problems = run_command(repository, fork_server, folder / "work")
        failures += [
            f"{seed} {repository.args} ({repository.description}): {problem}"
            for problem in problems
        ]
    return failures


@pytest.mark.parametrize("first", quick_first(range(FIRST_SEED, FIRST_SEED + 60, 5)))
def test_hostile_repositories_change_only_their_output_folder(fork_server, tmp_path, first):
    models = list_models(None, 0, [*SUFFIXES])
    assert find_unanswered(fork_server, tmp_path, range(first, first + 5), models) == []


@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.parametrize("first", range(FIRST_REAL, FIRST_REAL + REAL, BATCH))
def test_hostile_repositories_with_real_models_change_only_their_output_folder(
    fork_server, tmp_path, corpus, first
):
    models = list_models(corpus, LARGEST, [*SUFFIXES])
    assert find_unanswered(fork_server, tmp_path, range(first, first + BATCH), models) == []


def test_a_seed_determines_its_repository():
    models = list_models(None, 0)
    assert make_repository(FIRST_SEED, models) == make_repository(FIRST_SEED, models)
    assert make_repository(FIRST_SEED, models) != make_repository(FIRST_SEED + 1, models)


def test_a_change_outside_the_output_folder_is_detected(fork_server, tmp_path):
    """The command line may write anywhere, so it serves as a fault that must be detected."""
    files = {"m.sysml": b"package P { part def A; }"}
    for output in ("elsewhere", "../sentinel/new"):
        repository = Repository(0, files, {}, ("build", "m.sysml", "-o", output), "")
        _, problems = run_command(repository, fork_server, tmp_path / "work")
        assert any("outside project/out" in problem for problem in problems), problems
    repository = Repository(0, files, {}, ("build", "m.sysml", "-o", "out"), "")
    assert run_command(repository, fork_server, tmp_path / "work")[1] == []


def test_a_snapshot_lists_files_folders_and_links(tmp_path):
    before = take_snapshot(tmp_path)
    (tmp_path / "file").write_text("x")
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to("../x")
    assert set(take_snapshot(tmp_path)) - set(before) == {"file", "folder", "link"}
