"""A literal that is another one: only what asked for it is done again, as in a clean build."""

import os
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from edited_units import assert_is_as_from_a_clean_build, compiled_units, edited, files, sysmlc

from sysmlc.passes.activities import Activities
from sysmlc.passes.contracts import Contracts

LINE = """\
package Line {
    private import Parts::*;
    part def Cell {
        attribute speed : ScalarValues::Integer = 3;
        attribute rate : ScalarValues::Real = 1.5;
        attribute label : ScalarValues::String = "left, or right";
        attribute isOn : ScalarValues::Boolean = true;
        attribute offset : ScalarValues::Integer = -4;
        attribute sizes : ScalarValues::Integer [3] = (1, 2, 3);
        attribute both : ScalarValues::Integer = 2 + 3;
        part arm : Arm[1..2];
        part lost : Nowhere;
        action serve {
            in tray : ScalarValues::Integer = 5;
            attribute count : ScalarValues::Integer := 0;
            first start;
            then decide;
                if speed > 2 then done;
                else pick;
            then assign count := count + 1;
            action pick { in place : ScalarValues::Integer = 6; }
        }
        exhibit state modes {
            attribute limit : ScalarValues::Integer = 7;
            entry; then idle;
            state idle;
            state busy;
            transition first idle accept Start if limit > 1 then busy;
            transition first busy accept Start then idle;
        }
        assert constraint { speed < 9 }
    }
    attribute def Start;
    metadata def Note { attribute text : ScalarValues::String; }
    part def Seen { @Note { text = "seen"; } }
    enum def Level { enum low = 1; enum high = 2; }
}
"""
PARTS = """\
package Parts {
    doc /* What the cell has: 3 arms. */
    /* What it is. */
    part def Arm { attribute 'größe' : ScalarValues::Real = 1; part gone : Missing; }
    action def Draw { language "C" /* return 1 */ }
    requirement def <'R1'> Fast { doc /* The fastest. */
        attribute most : ScalarValues::Integer = 8; }
}
"""
LITERAL = re.compile(
    r"//[^\n]*|'[^']*'|"
    r'("[^"]*"|/\*.*?\*/|(?<![\w.])\d+(?:\.\d+)?(?![\w.])|\b(?:true|false)\b)',
    re.DOTALL,
)


@pytest.fixture
def runs(monkeypatch, tmp_path):
    """A cache of its own and a folder with a model; the list of units that were compiled."""
    return compiled_units(monkeypatch, tmp_path, {"line.sysml": LINE, "parts.sysml": PARTS})


def is_compiled(runs, *options) -> bool:
    """Whether the unit is compiled as a whole, beside the clean build."""
    before = len(runs)
    assert_is_as_from_a_clean_build(*options)
    return len(runs) > before + 1


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("rate : ScalarValues::Real = 1.5", "rate : ScalarValues::Real = 22.75"),
        ('"left, or right"', '"above"'),
        ("offset : ScalarValues::Integer = -4", "offset : ScalarValues::Integer = -40"),
        ("(1, 2, 3)", "(10, 2, 300)"),
        ("in place : ScalarValues::Integer = 6", "in place : ScalarValues::Integer = 66"),
        ("count : ScalarValues::Integer := 0", "count : ScalarValues::Integer := 11"),
        ("ScalarValues::Real = 1;", "ScalarValues::Real = 100;"),
        ("ScalarValues::Integer = 8;", "ScalarValues::Integer = 9;"),
        ("if limit > 1 then", "if limit > 2 then"),
        ("2 + 3", "2 + 4"),
        ("assign count := count + 1;", "assign count := count + 5;"),
        ("3 arms", "4 arms"),
        ("3 arms", "not one arm,\n         * but four"),
        ("What it is", "What it was"),
    ],
)
def test_a_literal_that_is_a_value_is_not_compiled(runs, old, new):
    sysmlc("unit", "-o", "out")
    before = files("out")
    edited("line.sysml" if old in LINE else "parts.sysml", old, new)
    assert not is_compiled(runs)
    assert files("out") != before


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("Arm[1..2]", "Arm[1..3]"),
        ("= 3;", "= 3.5;"),
        ("= 3;", "= true;"),
        ("= 3;", "= -3;"),
        ("= 3;", "= speed;"),
        ("= 3;", "= 1e999;"),
        ("<'R1'>", "<'R2'>"),
        ("/* What the cell has: 3 arms. */", "/* */"),
        ("/* What the cell has: 3 arms. */", "/* sysmlc-kept/1 {} */"),
        ("/* What the cell has: 3 arms. */", "/* As Line has it, see RecipeLevels. */"),
        ("/* The fastest. */", "/* The slowest. */"),
        ("/* return 1 */", "/* return 2 */"),
    ],
)
def test_what_may_mean_more_is_compiled(runs, old, new):
    sysmlc("unit")
    edited("line.sysml" if old in LINE else "parts.sysml", old, new)
    assert is_compiled(runs)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("limit : ScalarValues::Integer = 7", "limit : ScalarValues::Integer = 99"),
        ("if speed > 2 then", "if speed > 4 then"),
        ("if speed > 2 then", "if speed > 44 then"),
        ("speed < 9", "speed < 8"),
        ('@Note { text = "seen"; }', '@Note { text = "not seen"; }'),
        ('@Note { text = "seen"; }', '@Note { text = "Line::Level"; }'),
    ],
)
def test_a_value_that_findings_speak_of_comes_to_what_a_clean_build_finds(runs, old, new):
    sysmlc("unit")
    edited("line.sysml", old, new)
    assert_is_as_from_a_clean_build()


def test_several_literals_and_notes_at_once(runs):
    sysmlc("unit")
    edited("line.sysml", "= 1.5;", "= 2.5; // faster\n")
    edited("line.sysml", "(1, 2, 3)", "(1,   20, 3)")
    edited("parts.sysml", "Real = 1;", "Real =   17;")
    assert not is_compiled(runs)


def test_one_literal_after_the_other_and_back(runs):
    sysmlc("unit")
    for new in ("2.5", "3.5", "3.25", "1.5"):
        text = re.sub(r"(?<=Real = )\d\.\d+", new, Path("unit/line.sysml").read_text())
        Path("unit/line.sysml").write_text(text)
        assert not is_compiled(runs)


def test_what_was_restated_is_known_afterwards(runs, monkeypatch):
    sysmlc("unit", "-o", "out")
    edited("line.sysml", "= 1.5;", "= 2.5;")
    sysmlc("unit", "-o", "out")
    with monkeypatch.context() as without:
        without.setattr("sysmlc.driver.restoring.restored", lambda *_: None)
        assert not is_compiled(runs)
    edited("line.sysml", "= 2.5;", "= 2.5; // a note")
    assert not is_compiled(runs)


GUARDED = """\
package P {
    action def Serve {
        attribute isOn : ScalarValues::Boolean;
        first start;
        then decide;
            if isOn == true then done;
            else pick;
        action pick;
        then done;
    }
    action def Rest { first start; then action wait; then done; }
}
"""


def test_a_guard_makes_only_the_contract_of_its_activity_again(runs, monkeypatch):
    Path("unit/line.sysml").write_text(GUARDED)
    sysmlc("unit", "-o", "out")
    before = Path("out/contracts/P.Serve.md").read_text()
    edited("line.sysml", "== true", "== false")
    with monkeypatch.context() as without:
        for pass_ in (Activities, Contracts):
            without.setattr(pass_, "run", None)
        sysmlc("unit", "-o", "out")
    assert len(runs) == 1
    assert Path("out/contracts/P.Serve.md").read_text() != before
    assert_is_as_from_a_clean_build()


@pytest.mark.parametrize(
    "more",
    [
        "action def Other { doc /* [](isOn) */ }",
        "requirement def R { subject one : Serve; require constraint { one.isOn } }",
        'action serve : Serve { assert constraint { language "LTL" /* [](pick -> <>(isOn)) */ } }',
        "part def Serve { perform action a : P::Serve; exhibit state s { state t; } }",
    ],
)
def test_a_guard_where_more_is_said_of_its_activity(runs, more):
    Path("unit/line.sysml").write_text(f"{GUARDED[:-2]} {more} }}\n")
    sysmlc("unit", "-o", "out")
    edited("line.sysml", "== true", "== false")
    assert_is_as_from_a_clean_build()


def test_checks_know_of_literals_too(runs):
    sysmlc("check", "unit")
    edited("line.sysml", "= 1.5;", "= 2.5;")
    told = sysmlc("check", "unit")
    assert len(runs) == 1
    assert told == sysmlc("check", "unit", "--no-cache")


@pytest.mark.parametrize("emit", ["+graph", "+sysml", "+ecore", "+sysmlx"])
def test_back_ends_that_tell_places_are_compiled(runs, emit):
    sysmlc("unit", "--emit", emit)
    edited("line.sysml", "= 1.5;", "= 2.5;")
    assert is_compiled(runs, "--emit", emit)


def test_a_file_with_a_fault_in_its_syntax_is_compiled(runs):
    edited("line.sysml", "attribute rate :", "attribute rate : :")
    sysmlc("unit")
    edited("line.sysml", '"left, or right"', '"above"')
    assert is_compiled(runs)


def test_a_rule_that_the_project_silenced_stays_silent(runs):
    Path("unit/sysmlc.toml").write_text('[rules]\nassumed-range = "off"\n')
    sysmlc("unit")
    edited("line.sysml", "= 1.5;", "= 2.5;")
    assert not is_compiled(runs)


def test_a_damaged_entry_costs_time_only(runs, tmp_path):
    sysmlc("unit")
    for entry in (tmp_path / "cache").rglob("*.entry"):
        entry.write_bytes(entry.read_bytes()[:-7])
    edited("line.sysml", "= 1.5;", "= 2.5;")
    assert is_compiled(runs)


def another(literal: str, chosen: random.Random) -> str:
    """A literal of the same kind."""
    if literal in ("true", "false"):
        return chosen.choice(["true", "false"])
    if literal.startswith("/*"):
        return chosen.choice(["/* Other words. */", "/* Two\n * lines, 'größer' */", "/**/"])
    if literal.startswith('"'):
        return chosen.choice(['""', '"left"', '"Level::low"', '"größer\\n"', '"a b"'])
    return (
        f"{chosen.randrange(30)}.{chosen.randrange(9)}"
        if "." in literal
        else (str(chosen.choice([0, 1, 2, 3, 9, 15, 16, 1234])))
    )


@pytest.mark.parametrize("seed", range(12))
def test_any_literals_come_to_what_a_clean_build_comes_to(runs, seed):
    chosen = random.Random(seed)
    sysmlc("unit")
    for _ in range(4):
        path = Path("unit") / chosen.choice(["line.sysml", "line.sysml", "parts.sysml"])
        text = path.read_text()
        found = [one for one in LITERAL.finditer(text) if one[1]]
        for one in sorted(
            chosen.sample(found, min(len(found), chosen.randrange(1, 4))), reverse=True, key=_start
        ):
            text = text[: one.start()] + another(one[1], chosen) + text[one.end() :]
        path.write_text(text)
        assert_is_as_from_a_clean_build()


def _start(found: re.Match[str]) -> int:
    return found.start()


EDITS = [
    (r"= \d\.5;", "= #.5;"),
    (r";\n", "; // note\n"),
    (r"/\*.*?\*/", "/* What # says. */"),
    (r":= \d+", ":= #"),
    (r"speed > \d", "speed > #"),
    (r"speed (>|<=) ", "speed >= "),
    (r"count \+ 1", "count + 1 + #"),
    (r"(?<!then )action pick \{", "action place#; action pick {"),
    (r"action place\d+; ", ""),
    (r"part arm\d*", "part arm#"),
    (r"Arm\[1\.\.2\]", "Arm[0..#]"),
    (r"ScalarValues::Real =", "ScalarValues::Integer ="),
    (r"attribute label", "attribute more# : Start; attribute label"),
    (r"part lost", "part more# : Arm; part lost"),
    (r"part lost", "part one#; part other#; connect one# to other#; part lost"),
    (r"speed < \d+", "speed < 1#"),
    (r"state busy;", "state busy; state tired#;"),
    (r"enum high", "enum middle#; enum high"),
    (r"part lost : Nowhere;", "part lost : Arm;"),
]
"""Edits of one line: what is replaced, and by what; ``#`` is a number."""


def with_an_edit(text: str, chosen: random.Random) -> str:
    old, new = chosen.choice(EDITS)
    return re.sub(old, new.replace("#", str(chosen.randrange(3, 9))), text, count=1)


@pytest.mark.parametrize("seed", range(10))
def test_edits_of_every_kind_mixed(runs, seed):
    chosen = random.Random(seed)
    sysmlc("unit")
    for _ in range(4):
        path = Path("unit/line.sysml")
        text = with_an_edit(path.read_text(), chosen)
        path.write_text(with_an_edit(text, chosen) if chosen.random() < 0.5 else text)
        assert_is_as_from_a_clean_build()


ICE = [
    (r"doc /\*.*?\*/", "doc /* What # does. */"),
    (r":= \d+", ":= #"),
    (r"== (?:true|false)", "== false"),
    (r"(?<=[a-z] )==(?= [a-z])", "!="),
    (r'nodeId = "[^"]*', 'nodeId = "ns=2;s=N#'),
    (r"then done;", "then action more#; then done;"),
    (r"in palletNumber : Integer;", "in palletNumber : Integer; in extra# : Integer;"),
    (r"out result : Boolean;", "out result : Integer;"),
    (r"first start;", "attribute more# : Boolean; first start;"),
    (r"first start;", "assert constraint { palletNumber > # } first start;"),
    (r"attribute (\w+) : String \{", r"attribute \1 : String [0..1] {"),
    (r"connect cell\d", "part spare# : WorkCell; connect spare# to cell1; connect cell1"),
    (r"default \d+ \[s\]", "default # [s]"),
    (r":>> palletNumber = \d", ":>> palletNumber = #"),
]


@pytest.mark.corpus
@pytest.mark.parametrize("seed", range(3))
def test_edits_of_the_laboratory_of_every_kind(runs, corpus, seed):
    chosen = random.Random(seed)
    shutil.rmtree("unit")
    shutil.copytree(corpus / "sysml2" / "ice-lab", "unit")
    sysmlc("unit")
    for old, new in chosen.sample(ICE, 4):
        every = sorted(Path("unit").rglob("*.sysml"))
        path = chosen.choice([one for one in every if re.search(old, one.read_text(), re.DOTALL)])
        text = path.read_text()
        found = chosen.choice(list(re.finditer(old, text, re.DOTALL)))
        said = found.expand(new.replace("#", str(chosen.randrange(3, 9))))
        path.write_text(text[: found.start()] + said + text[found.end() :])
        assert_is_as_from_a_clean_build()


def test_an_example_with_another_number(runs):
    shutil.rmtree("unit")
    example = Path(__file__).parents[2] / "examples" / "lego-recipe-v2"
    shutil.copytree(example, "unit")
    sysmlc("unit")
    for path in sorted(Path("unit").glob("*.sysml")):
        text = path.read_text()
        path.write_text(re.sub(r"(?<== )\d+(?=;| \[)", lambda one: f"{one[0]}1", text, count=1))
        assert_is_as_from_a_clean_build()


@pytest.mark.corpus
def test_the_laboratory_with_another_number(runs, corpus):
    shutil.rmtree("unit")
    shutil.copytree(corpus / "sysml2" / "ice-lab", "unit")
    sysmlc("unit")
    edited("services/conveyor.sysml", ":= 0;", ":= 1042; // more\n")
    assert not is_compiled(runs)
    edited("recipes/demo_lego.sysml", "palletNumber = 1;", "palletNumber = 12;")
    assert not is_compiled(runs)
    edited("services/robotic_cell.sysml", "== true", "== false")
    assert_is_as_from_a_clean_build()


def test_it_is_the_same_whatever_the_seed_of_hashes(runs):
    def run(seed, *options):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        command = [sys.executable, "-m", "sysmlc", "unit", *options]
        return subprocess.run(command, env=environment, capture_output=True, check=False).stderr

    run("1", "-o", "out")
    edited("line.sysml", "= 1.5;", "= 2.5;")
    restated = run("2", "-o", "out")
    assert restated == run("3", "-o", "clean", "--no-cache")
    assert files("out") == files("clean")
