"""A fixed sample of the mutants of ``python -m fuzz.hunt``: each one ends with diagnostics.

The number of a mutant in a failure is its seed: ``--seed N --count 1 --keep FOLDER`` makes it
again. Run in ``tests/``, ``python -m fuzz.hunt --count 10000 --corpus FOLDER`` tries more.
"""

from dataclasses import replace

import pytest

from fuzz import hunt
from fuzz.fork_server import Limits
from fuzz.hunt import Hunter
from fuzz.mutants import list_models, make_mutant, make_unchanged
from long_runs import quick_first

BATCH = 5
EXAMPLE_BATCHES = range(0, 60, BATCH)
REAL_BATCHES = range(0, 140, BATCH)
PLANT_BATCHES = range(0, 200, BATCH)
V2_BATCHES = range(0, 140, BATCH)
LARGEST = 150 * 1024


@pytest.fixture(scope="module")
def hunter(tmp_path_factory):
    hunter = Hunter(tmp_path_factory.mktemp("mutants"))
    yield hunter
    hunter.close()


def find_failures(hunter, seeds, models):
    return [
        f"{failure.mutant.name} ({failure.mutant.description}): {failure.problem}"
        for seed in seeds
        for failure in hunter.check(make_mutant(seed, models))
    ]


@pytest.mark.parametrize("first", quick_first(EXAMPLE_BATCHES))
def test_mutated_examples_end_with_diagnostics(hunter, first):
    assert find_failures(hunter, range(first, first + BATCH), list_models(None, 0)) == []


@pytest.mark.corpus
@pytest.mark.parametrize("first", quick_first(REAL_BATCHES))
def test_mutated_real_models_end_with_diagnostics(hunter, corpus, first):
    models = list_models(corpus / "xmi", LARGEST, ["xmi"])
    assert find_failures(hunter, range(first, first + BATCH), models) == []


@pytest.mark.corpus
@pytest.mark.parametrize("first", quick_first(PLANT_BATCHES))
def test_mutated_plants_end_with_diagnostics(hunter, corpus, first):
    models = list_models(corpus / "aml", LARGEST, ["aml"])
    assert find_failures(hunter, range(first, first + BATCH), models) == []


@pytest.mark.corpus
@pytest.mark.parametrize("first", quick_first(V2_BATCHES))
def test_mutated_texts_of_sysml_v2_end_with_diagnostics(hunter, corpus, first):
    models = list_models(corpus / "sysml2", LARGEST, ["v2"])
    assert find_failures(hunter, range(first, first + BATCH), models) == []


@pytest.mark.corpus
def test_invalid_models_of_the_pilot_implementation_end_with_diagnostics(hunter, corpus):
    """A sample of the 428 tests of the pilot implementation; --as-is tries all."""
    texts = sorted((corpus / "sysml2/pilot-xpect").rglob("*.xt"))
    mutants = [
        make_unchanged(number, path) for number, path in enumerate(texts) if number % 20 == 7
    ]
    assert [
        f"{mutant.description}: {failure.problem}"
        for mutant in mutants
        for failure in hunter.check(mutant)
    ] == []


@pytest.mark.long
@pytest.mark.corpus
def test_some_mutated_plants_are_valid_and_some_are_not(hunter, corpus):
    models = list_models(corpus / "aml", LARGEST, ["aml"])
    before = dict(hunter.codes)
    assert find_failures(hunter, range(700, 720), models) == []
    assert min(hunter.codes[code] - before.get(code, 0) for code in (0, 1)) > 5


def test_some_mutants_are_valid_and_some_are_not(hunter):
    """Mutations without effect, or that destroy every model, would find no faults."""
    assert find_failures(hunter, range(500, 515), list_models(None, 0)) == []
    assert min(hunter.codes[0], hunter.codes[1]) > 5


def test_a_seed_determines_its_mutant():
    models = list_models(None, 0)
    first = make_mutant(7, models)
    assert make_mutant(7, models) == first
    assert make_mutant(7, models) != make_mutant(8, models)


def test_no_temporary_file_remains(hunter, tmp_path):
    list(hunter.check(make_mutant(1, list_models(None, 0))))
    assert not list(hunter.folder.rglob(".sysmlc-*"))


@pytest.mark.long
def test_a_crash_and_an_exceeded_limit_are_reported(hunter, monkeypatch):
    """The hunter reports a command that needs too much memory or is killed."""
    monkeypatch.setattr(hunt, "MEMORY", 1)
    mutant = make_mutant(3, list_models(None, 0))
    assert [failure.mutant for failure in hunter.check(mutant)] == [mutant]
    monkeypatch.undo()
    monkeypatch.setattr(hunter, "limits", Limits(seconds=5, memory=1 << 20))
    # A small file would fit into memory that the process has freed.
    file = ("m.uml", b"<!--" + b"." * (64 << 20) + b"--><m/>")
    large = replace(mutant, name="m.uml", files=(file,))
    assert [failure.problem[:4] for failure in hunter.check(large)] == ["exit"]
