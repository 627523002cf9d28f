"""Texts that are only laid out otherwise are not compiled again; places in them move along."""

import os
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from edited_units import assert_is_as_from_a_clean_build, compiled_units, edited, files, sysmlc

from sysmlc.driver import recall
from sysmlc.driver.manifest import MANIFEST

LINE = """\
package Line {
    private import Parts::*;
    part def Cell {
        attribute speed : ScalarValues::Real = 3;
        part arm : Arm;
        part lost : Nowhere;
        action serve {
            first start;
            then decide;
                if speed > 2 then done;
                else pick;
            action pick;
        }
        assert constraint { speed < 9 and speed -> collect { in x; x } != null }
    }
}
"""
PARTS = """\
package Parts {
    doc /* What the cell has. */
    part def Arm { attribute 'größe' : ScalarValues::Real = 1; part gone : Missing; }
}
"""
NOTES = ("// note\n", "//* note */", "\n", " ", "\t", "\r\n", "\n\n// größer { } ;\n", "\ufeff")


@pytest.fixture
def runs(monkeypatch, tmp_path):
    """A cache of its own and a folder with a model; the list of units that were compiled."""
    return compiled_units(monkeypatch, tmp_path, {"line.sysml": LINE, "parts.sysml": PARTS})


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("package Line {\n", "// The line.\npackage Line {\n"),
        ("    part def Cell {\n", "    // A cell.\n\n    part def Cell {   // see below\n"),
        ("            first start;\n", "\n\t\tfirst  start;\n"),
        ("speed > 2", "speed\n > // much\n 2"),
        ("part lost : Nowhere;\n", "part lost : //* where? */ Nowhere;\n"),
        ("}\n}\n", "}\n}\n\n\n// the end"),
        ("action serve {\n", "action serve {\r\n"),
    ],
)
def test_notes_and_blanks_are_not_compiled(runs, old, new):
    sysmlc("unit")
    edited("line.sysml", old, new)
    sysmlc("unit")
    is_in_one_line = new.count("\n") != old.count("\n") and "\n" not in old
    assert len(runs) == 1 + is_in_one_line
    assert_is_as_from_a_clean_build()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("= 3;", "= 3.5;"),
        ("speed > 2", "speed >= 2"),
        ("action pick;", "action pick; action place;"),
        ("'größe'", "'große'"),
        ("-> collect", "->collect"),
        ("part gone : Missing;", "part gone : // RecipeLevels\n Missing;"),
    ],
)
def test_what_says_something_else_is_compiled(runs, old, new):
    sysmlc("unit")
    name = "line.sysml" if old in LINE else "parts.sysml"
    edited(name, old, new)
    assert_is_as_from_a_clean_build()
    assert len(runs) == 3


def test_files_are_moved_one_by_one_and_again(runs):
    sysmlc("unit")
    edited("line.sysml", "    part def", "\n    part def")
    assert_is_as_from_a_clean_build()
    edited("parts.sysml", "    part def", "    // größer\n    part def")
    assert_is_as_from_a_clean_build()
    edited("line.sysml", "\n    part def", "    part def")
    assert_is_as_from_a_clean_build()
    assert len(runs) == 1 + 3


def test_a_mark_of_the_byte_order_moves_nothing(runs):
    sysmlc("unit")
    text = Path("unit/line.sysml").read_bytes()
    Path("unit/line.sysml").write_bytes(b"\xef\xbb\xbf" + text)
    assert_is_as_from_a_clean_build()


@pytest.mark.parametrize("emit", ["+graph", "+sysml", "+ecore", "+sysmlx"])
def test_back_ends_that_may_tell_places_run_again(runs, emit):
    sysmlc("unit", "--emit", emit)
    edited("line.sysml", "    part def", "\n    part def")
    assert_is_as_from_a_clean_build("--emit", emit)
    assert len(runs) == 3


def test_checks_are_moved_too(runs):
    first = sysmlc("check", "unit")
    edited("line.sysml", "        part lost", "        // where is it?\n        part lost")
    told = sysmlc("check", "unit")
    assert len(runs) == 1
    assert told == sysmlc("check", "unit", "--no-cache")
    assert told != first


def test_a_text_that_is_damaged_is_compiled(runs):
    edited("line.sysml", "package Line", "package § Line")
    sysmlc("unit")
    edited("line.sysml", "    part def", "\n    part def")
    assert_is_as_from_a_clean_build()
    assert len(runs) == 3


def test_a_text_with_a_fault_in_its_syntax_is_moved(runs):
    edited("line.sysml", "action pick;", "action pick")
    edited("line.sysml", "part lost : Nowhere;", "part lost : : Nowhere;")
    sysmlc("unit")
    edited("line.sysml", "    part def", "\n    part def")
    assert_is_as_from_a_clean_build()
    assert len(runs) == 2


@pytest.mark.parametrize("seed", range(8))
def test_any_layout_comes_to_what_a_clean_build_comes_to(runs, seed):
    chosen = random.Random(seed)
    sysmlc("unit")
    for _ in range(3):
        path = Path("unit") / chosen.choice(["line.sysml", "parts.sysml"])
        text = path.read_text()
        gaps = [found.start() for found in re.finditer(r"(?<=[;{}])|(?<=\s)(?=\w)|$", text)]
        for at in sorted(chosen.sample(gaps, 3), reverse=True):
            text = text[:at] + chosen.choice(NOTES) + text[at:]
        path.write_text(text)
        assert_is_as_from_a_clean_build()


@pytest.mark.parametrize("seed", range(4))
def test_edits_of_every_kind_one_after_the_other_and_back(runs, seed):
    chosen = random.Random(seed)
    path = Path("unit/line.sysml")
    written = {
        path.read_text(),
        LINE.replace("= 3;", "= 4;"),
        LINE.replace("part arm", "part hand"),
    }
    texts = sorted(written)
    for _ in range(5):
        lines = chosen.choice(texts).splitlines(keepends=True)
        lines.insert(chosen.randrange(1, len(lines)), chosen.choice(["\n", "// note\n", ""]))
        path.write_text("".join(lines))
        assert_is_as_from_a_clean_build()


def test_an_example_whose_layout_changes(runs):
    shutil.rmtree("unit")
    example = Path(__file__).parents[2] / "examples" / "lego-recipe-v2"
    shutil.copytree(example, "unit")
    sysmlc("unit")
    path, chosen = Path("unit/lego-recipe.sysml"), random.Random(1)
    lines = path.read_text().splitlines(keepends=True)
    for at in sorted(chosen.sample(range(len(lines)), 5), reverse=True):
        lines.insert(at, chosen.choice(["\n", "    // a note\n", "//* two\nlines */\n"]))
    path.write_text("".join(lines))
    assert_is_as_from_a_clean_build()


@pytest.mark.corpus
def test_the_laboratory_whose_layout_changes(runs, corpus):
    shutil.rmtree("unit")
    shutil.copytree(corpus / "sysml2" / "ice-lab", "unit")
    sysmlc("unit")
    edited("services/conveyor.sysml", ";\n", ";\n\n    // a note\n")
    edited("recipes/demo_lego.sysml", "{\n", "{  // a note\n")
    sysmlc("unit")
    assert len(runs) == 1
    assert_is_as_from_a_clean_build()


def test_it_is_the_same_whatever_the_seed_of_hashes(runs):
    def run(seed, *options):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        command = [sys.executable, "-m", "sysmlc", "unit", *options]
        return subprocess.run(command, env=environment, capture_output=True, check=False).stderr

    run("1", "-o", "out")
    edited("line.sysml", "        part lost", "        // where is it?\n        part lost")
    moved = run("2", "-o", "out")
    assert moved == run("3", "-o", "clean", "--no-cache")
    assert files("out") == files("clean")


@pytest.mark.parametrize("is_new", [False, True])
def test_texts_that_stay_are_kept_as_they_were(runs, monkeypatch, is_new):
    """Also by a new process, which has them from the cache."""
    sysmlc("unit", "-o", "out")
    before = files("out")
    edited("line.sysml", "part arm", "part hand")
    if is_new:
        recall._last.clear()
    packed, real = [], recall._new
    monkeypatch.setattr(recall, "_new", lambda text, *how: packed.append(text) or real(text, *how))
    sysmlc("unit", "-o", "out")
    after = files("out")
    same = {path for path, text in after.items() if before.get(path) == text}
    assert len(runs) == 2
    assert same
    assert same.isdisjoint(path for path, text in after.items() if text in packed)
    assert {path for path in after if after[path] in packed} == after.keys() - same - {MANIFEST}
    assert_is_as_from_a_clean_build()
