"""A process that stays gives after each edit what a process without a cache gives."""

import shutil
from pathlib import Path
from random import Random

import pytest
from edited_units import assert_is_as_from_a_clean_build, compiled_units, edited

from edited_texts import UNIT
from edited_texts import edited as edited_at_random
from sysmlc.language import kept

_BEHAVIOUR = """package Steps {
    private import ScalarValues::*;
    private import Alpha::*;
    action def Serve {
        in speed : Integer;
        out done : Boolean;
        first start;
        then action pick : Pick { in force = 3; }
        then decide;
            if speed > 2 then fast;
            else slow;
        action fast;
        action slow;
    }
    action def Pick { in force : Integer; }
    part def Cell :> Gate { perform action serve : Serve; attribute load : Integer = 7; }
}
"""


@pytest.fixture
def unit(monkeypatch, tmp_path):
    """The list of what is compiled; nothing is kept before, and nothing afterwards."""
    kept.take()
    yield compiled_units(monkeypatch, tmp_path, {**UNIT, "e.sysml": _BEHAVIOUR})
    kept.take()


def _texts():
    return {one.name: one.read_text() for one in Path("unit").iterdir()}


@pytest.mark.parametrize("seed", range(4))
def test_after_random_edits_outputs_and_findings_are_those_of_a_clean_build(unit, seed):
    random, before = Random(seed), [_texts()]
    for _ in range(10):
        shutil.rmtree("out", ignore_errors=True)  # where there are errors, nothing is written
        assert_is_as_from_a_clean_build("--emit", "+sysmlx")
        is_back = random.random() < 0.4
        texts = random.choice(before) if is_back else edited_at_random(_texts(), random)
        for name, text in texts.items():
            Path("unit", name).write_text(text)
        before.append(texts)


def test_what_asks_for_literals_is_known_of_what_is_kept(unit):
    """A value that an edit of the tree left as it is asked for: edited next, it is compiled."""
    assert_is_as_from_a_clean_build()
    for old, new in (
        ("action fast;", "action fast; action more;"),
        ("load : Integer = 7", "load : Integer = 8"),
        ("speed > 2", "speed > 5"),
        ("action more;", ""),
        ("in force = 3", "in force = 4"),
        ("speed > 5", "speed > 6"),
    ):
        edited("e.sysml", old, new)
        assert_is_as_from_a_clean_build()


def test_nothing_is_kept_of_a_compilation_that_fails(unit, monkeypatch):
    assert_is_as_from_a_clean_build()
    assert kept._LAST

    def fails(*_others):
        raise MemoryError

    with monkeypatch.context() as patched:
        patched.setattr("sysmlc.frontends.sysml.reading.lower", fails)
        edited("e.sysml", "action slow;", "action slow; action other;")
        with pytest.raises(AssertionError):
            assert_is_as_from_a_clean_build()
    assert not kept._LAST
    assert_is_as_from_a_clean_build()
