"""A process that stays uses again what it made: it comes to what a process that starts comes to."""

import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from edited_units import (
    assert_is_as_from_a_clean_build,
    compiled_units,
    files,
    sysmlc,
    work_used_again,
)

CELL = """\
package Cell {
    private import ScalarValues::*;
    private import Drives::*;
    enum def Mode { enum idle; enum busy; enum failed; }
    part def Station {
        attribute speed : Integer = 3;
        attribute count : Integer := 0;
        attribute full : Boolean := false;
        attribute mode : Mode;
        part drive : Drive;
        assert constraint { 0 <= count and count <= 9 }
        action serve {
            in tray : Integer = 5;
            out result : Boolean;
            first start;
            then decide;
                if speed > 2 then done;
                else pick;
            action pick { in place : Integer = 6; }
            then assign count := count + 1;
            then assign full := true;
            then done;
        }
        action unload {
            in other : Drive;
            first start;
            then action grip;
            then decide;
                if other.load > 3 then release;
                else done;
            action release;
            then assign full := false;
            then done;
        }
        exhibit state modes {
            attribute limit : Integer = 7;
            entry; then idle;
            state idle;
            state busy;
            transition first idle accept Start if count > 1 then busy;
            transition first busy accept Start do assign count := 0 then idle;
        }
    }
    attribute def Start;
    action def Wait { first start; then action hold : Turn; then done; }
}
"""
DRIVES = """\
package Drives {
    private import ScalarValues::*;
    part def Drive {
        attribute load : Integer = 1;
        attribute on : Boolean = true;
        action turn : Turn;
    }
    action def Turn {
        in angle : Integer = 90;
        attribute left : Integer := 3;
        first start;
        then merge again;
        then action step;
        then assign left := left - 1;
        then decide;
            if left > 0 then again;
            else done;
    }
}
"""
WORD = re.compile(r"\b[a-zA-Z]\w+\b")
LINES = re.compile(r"[^\n]*\n")
VALUE = re.compile(r"\b(?:\d+|true|false|idle|busy)\b|==|<=|[<>](?= \d)")
TYPE = re.compile(r"\b(?:Integer|Boolean|Drive|Mode)\b(?=[ ;])")
VALUES = ("0", "1", "4", "true", "false", "idle", "==", "<=", ">")
TYPES = ("Integer", "Boolean", "Drive", "Mode", "Real")


def replaced(text: str, found: re.Match[str], new: str) -> str:
    return text[: found.start()] + new + text[found.end() :]


def with_an_edit(text: str, chosen: random.Random) -> str:
    """A line more, fewer or elsewhere, another name here or everywhere, another value or type."""

    def one(pattern: re.Pattern[str]) -> re.Match[str]:
        return chosen.choice(list(pattern.finditer(text)))

    kind = chosen.randrange(8)
    line, word = one(LINES), one(WORD)
    if kind == 0:
        return replaced(text, line, "")
    if kind == 1:
        return replaced(text, line, line[0] * 2)
    if kind == 2:
        other = replaced(text, line, "")
        at = chosen.choice(list(LINES.finditer(other))).start()
        return other[:at] + line[0] + other[at:]
    if kind == 3:
        return replaced(text, word, f"{word[0]}{chosen.randrange(3)}")
    if kind == 4:
        return re.sub(rf"\b{word[0]}\b", f"{word[0]}{chosen.randrange(3)}", text)
    if kind == 5:
        return replaced(text, line, line[0] + "\n" * chosen.randrange(1, 4))
    pattern, others = chosen.choice([(VALUE, VALUES), (TYPE, TYPES)])
    return replaced(text, one(pattern), chosen.choice(others)) if pattern.search(text) else text


@pytest.fixture
def used_again(monkeypatch, tmp_path):
    """A unit of its own; the readers whose work was used again."""
    compiled_units(monkeypatch, tmp_path, {"cell.sysml": CELL, "drives.sysml": DRIVES})
    return work_used_again(monkeypatch)


def assert_it_comes_to_the_same() -> None:
    """Compiled into an empty folder: what has faults of syntax leaves old files where they are."""
    shutil.rmtree("out", ignore_errors=True)
    assert_is_as_from_a_clean_build()


def assert_a_new_process_comes_to_the_same(*options: str) -> None:
    command = [sys.executable, "-m", "sysmlc", "unit", "-o", "new", "--no-cache", *options]
    subprocess.run([*command, "--format", "json"], check=False, capture_output=True)
    assert files("new") == files("out")


@pytest.mark.parametrize("seed", range(8))
def test_any_edits_in_turn(used_again, seed):
    chosen = random.Random(seed)
    sysmlc("unit", "-o", "out")
    for _ in range(6):
        name, text = chosen.choice([("cell.sysml", CELL), ("drives.sysml", DRIVES)])
        path = Path("unit", name)
        before = path.read_text() if chosen.random() < 0.5 else text
        path.write_text(with_an_edit(before, chosen))
        assert_it_comes_to_the_same()
    assert_a_new_process_comes_to_the_same()
    assert used_again


@pytest.mark.corpus
@pytest.mark.parametrize("seed", range(2))
def test_any_edits_of_the_laboratory(used_again, corpus, seed):
    chosen = random.Random(seed)
    shutil.rmtree("unit")
    shutil.copytree(corpus / "sysml2" / "ice-lab", "unit")
    texts = {path: path.read_text() for path in sorted(Path("unit").rglob("*.sysml"))}
    sysmlc("unit", "-o", "out")
    for _ in range(5):
        path = chosen.choice(list(texts))
        before = path.read_text() if chosen.random() < 0.5 else texts[path]
        path.write_text(with_an_edit(before, chosen))
        assert_it_comes_to_the_same()
    assert_a_new_process_comes_to_the_same()
    assert {reader.split()[1] for reader in used_again} >= {"activities", "contracts"}


def test_what_was_not_edited_is_used_again_where_it_stands_now(used_again):
    for number in range(4):
        path = Path("unit/cell.sysml")
        path.write_text(
            CELL.replace("    enum def", f"\n    action def More{number};\n    enum def")
        )
        assert_is_as_from_a_clean_build()
    kinds = {reader.rpartition(" ")[0] for reader in used_again}
    assert {"pass activities", "pass contracts", "emit contracts contracts"} <= kinds


def test_templates_of_the_users_are_read_again(used_again):
    Path("mine/contracts").mkdir(parents=True)
    for number in range(4):
        Path("mine/contracts/contract.md.j2").write_text(f"Version {number}")
        Path("unit/cell.sysml").write_text(CELL.replace("grip", f"grip{number}"))
        assert_is_as_from_a_clean_build("--templates", "mine")
        assert Path("out/contracts/Cell.Wait.md").read_text() == f"Version {number}"


def test_templates_of_the_users_that_come_and_go(used_again):
    """Ours was taken where there was none: it must not stay when one comes."""
    mine = [Path("mine", name) for name in ("plantuml/act.puml.j2", "act.puml.j2", "_frame.j2")]
    mine[0].parent.mkdir(parents=True)
    for number, path in enumerate((None, *mine, *mine)):
        if path is not None and path.exists():
            path.unlink()
        elif path is not None:
            path.write_text(f"{path} {number}")
        Path("unit/cell.sysml").write_text(CELL.replace("grip", f"grip{number}"))
        sysmlc("unit", "-o", "out", "--templates", "mine")
        assert_a_new_process_comes_to_the_same("--templates", "mine")
