"""A process that stays remembers; what it makes of many edits is what a new process makes."""

import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from edited_units import compiled_units, files, sysmlc
from test_driver_literals import EDITS, ICE, LINE, PARTS

SOUND = LINE.replace("Nowhere", "Arm")
"""What has errors is withheld, and not traced."""
WORD = re.compile(r"\b[a-z]\w*[a-z]\b")
STATEMENT = re.compile(r"\n[^\n{}]*;(?=\n)")


@pytest.fixture
def unit(monkeypatch, tmp_path):
    compiled_units(monkeypatch, tmp_path, {"line.sysml": SOUND, "parts.sysml": PARTS})
    sysmlc("unit", "-o", "out")
    return Path("unit")


def assert_is_as_from_a_new_process():
    told = sysmlc("unit", "-o", "out", "--format", "json")
    shutil.rmtree("clean", ignore_errors=True)
    command = [sys.executable, "-m", "sysmlc", "unit", "-o", "clean", "--no-cache"]
    new = subprocess.run(
        [*command, "--format", "json"], capture_output=True, text=True, check=False
    )
    assert told == (new.returncode, new.stdout, new.stderr)
    assert files("out") == files("clean")


def edited(text: str, edits: list[tuple[str, str]], chosen: random.Random) -> str:
    """One of the edits somewhere, a statement less or twice, a name or a line that is new."""
    number = str(chosen.randrange(3, 9))
    way = chosen.randrange(8)
    if way == 0:
        return put(text, STATEMENT, lambda _: "", chosen)
    if way == 1:
        return put(text, STATEMENT, lambda one: one * 2, chosen)
    if way == 2:
        return put(text, WORD, lambda one: one + number, chosen)
    if way == 3:
        return put(text, re.compile("\n"), lambda _: "\n\n // größer\n", chosen)
    old, new = chosen.choice(edits)
    return put(text, re.compile(old, re.DOTALL), None, chosen, new.replace("#", number))


def put(text, pattern, change, chosen, new=""):
    """The text with one match changed, or replaced by what ``new`` makes of it."""
    found = list(pattern.finditer(text))
    if not found:
        return text
    one = chosen.choice(found)
    said = change(one[0]) if change else one.expand(new)
    return text[: one.start()] + said + text[one.end() :]


@pytest.mark.parametrize("seed", range(3))
def test_many_edits_in_turn(unit, seed):
    chosen = random.Random(seed)
    for _ in range(5):
        for _ in range(chosen.randrange(1, 3)):
            path = unit / chosen.choice(["line.sysml", "parts.sysml"])
            path.write_text(edited(path.read_text(), EDITS, chosen))
        assert_is_as_from_a_new_process()


@pytest.mark.corpus
@pytest.mark.parametrize("seed", range(2))
def test_many_edits_of_the_laboratory_in_turn(unit, corpus, seed):
    chosen = random.Random(seed)
    shutil.rmtree("unit")
    shutil.copytree(corpus / "sysml2" / "ice-lab", "unit")
    sysmlc("unit", "-o", "out")
    for _ in range(6):
        path = chosen.choice(sorted(unit.rglob("*.sysml")))
        path.chmod(0o644)
        path.write_text(edited(path.read_text(), ICE, chosen))
        assert_is_as_from_a_new_process()


def test_what_was_undone_is_as_before(unit):
    path, seen = unit / "line.sysml", []
    for name in ("Cell", "Cell2", "Cell", "Cell3", "Cell2"):
        path.write_text(SOUND.replace("part def Cell", f"part def {name}"))
        sysmlc("unit", "-o", "out")
        seen.append(files("out"))
    assert seen[0] == seen[2] != seen[1] == seen[4]


def test_lines_are_others_though_every_element_starts_where_it_did(unit):
    text = SOUND.replace("[1..2]", "[1..3]").replace("    private", "\n   private")
    assert len(text) == len(SOUND)
    (unit / "line.sysml").write_text(text)
    assert_is_as_from_a_new_process()
