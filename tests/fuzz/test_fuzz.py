"""A fixed sample of what ``python -m fuzz.hunt`` tries: spoilt models are answered with findings.

The number of a mutant in a failure is its seed: ``--seed N --count 1 --keep FOLDER`` makes it
again. Run in ``tests/``, ``python -m fuzz.hunt --count 10000 --corpus FOLDER`` tries more.
"""

from dataclasses import replace

import pytest

from fuzz.hunt import Hunter
from fuzz.mutants import models, mutant, unspoilt
from long_runs import quick_first

BATCH = 10
EXAMPLES = range(0, 60, BATCH)
REAL = range(0, 140, BATCH)
PLANTS = range(0, 200, BATCH)
V2 = range(0, 140, BATCH)
LARGEST = 150 * 1024


@pytest.fixture(scope="module")
def hunter(tmp_path_factory):
    made = Hunter(tmp_path_factory.mktemp("mutants"))
    yield made
    made.close()


def unanswered(hunter, seeds, among):
    return [
        f"{found.mutant.name} ({found.mutant.done}): {found.what}"
        for seed in seeds
        for found in hunter.look(mutant(seed, among))
    ]


@pytest.mark.parametrize("first", quick_first(EXAMPLES))
def test_spoilt_examples_are_answered_with_findings(hunter, first):
    assert unanswered(hunter, range(first, first + BATCH), models(None, 0)) == []


@pytest.mark.corpus
@pytest.mark.parametrize("first", quick_first(REAL))
def test_spoilt_real_models_are_answered_with_findings(hunter, corpus, first):
    among = models(corpus / "xmi", LARGEST, ["xmi"])
    assert unanswered(hunter, range(first, first + BATCH), among) == []


@pytest.mark.corpus
@pytest.mark.parametrize("first", quick_first(PLANTS))
def test_spoilt_plants_are_answered_with_findings(hunter, corpus, first):
    among = models(corpus / "aml", LARGEST, ["aml"])
    assert unanswered(hunter, range(first, first + BATCH), among) == []


@pytest.mark.corpus
@pytest.mark.parametrize("first", quick_first(V2))
def test_spoilt_texts_of_sysml_v2_are_answered_with_findings(hunter, corpus, first):
    among = models(corpus / "sysml2", LARGEST, ["v2"])
    assert unanswered(hunter, range(first, first + BATCH), among) == []


@pytest.mark.corpus
def test_models_that_are_wrong_in_some_known_way_are_answered_with_findings(hunter, corpus):
    """Of the 428 tests of the pilot implementation a sample; --as-is tries all."""
    tests = sorted((corpus / "sysml2/pilot-xpect").rglob("*.xt"))
    asked = [unspoilt(number, path) for number, path in enumerate(tests) if number % 20 == 7]
    assert [f"{one.done}: {f.what}" for one in asked for f in hunter.look(one)] == []


@pytest.mark.long
@pytest.mark.corpus
def test_spoilt_plants_are_wrong_and_right(hunter, corpus):
    among = models(corpus / "aml", LARGEST, ["aml"])
    before = dict(hunter.codes)
    assert unanswered(hunter, range(700, 720), among) == []
    assert min(hunter.codes[code] - before.get(code, 0) for code in (0, 1)) > 5


def test_mutants_are_wrong_and_right(hunter):
    """Mutations that do nothing, or destroy everything, would find nothing."""
    assert unanswered(hunter, range(500, 515), models(None, 0)) == []
    assert min(hunter.codes[0], hunter.codes[1]) > 5


def test_a_mutant_is_the_same_for_its_seed():
    among = models(None, 0)
    first = mutant(7, among)
    assert mutant(7, among) == first
    assert mutant(7, among) != mutant(8, among)


def test_no_half_written_file_is_left(hunter, tmp_path):
    list(hunter.look(mutant(1, models(None, 0))))
    assert not list(hunter.folder.rglob(".sysmlc-*"))


@pytest.mark.long
def test_a_fault_would_be_found(hunter, monkeypatch):
    """The hunter sees what the guard says: killed, a traceback, a fault of ours."""
    from fuzz import hunt
    from fuzz.guard import Bounds

    monkeypatch.setattr(hunt, "MEMORY", 1)
    spoilt = mutant(3, models(None, 0))
    assert [found.mutant for found in hunter.look(spoilt)] == [spoilt]
    monkeypatch.undo()
    monkeypatch.setattr(hunter, "bounds", Bounds(seconds=5, memory=1 << 20))
    # What the process has set free would hold a small one.
    file = ("m.uml", b"<!--" + b"." * (64 << 20) + b"--><m/>")
    large = replace(spoilt, name="m.uml", files=(file,))
    assert [found.what[:4] for found in hunter.look(large)] == ["exit"]
