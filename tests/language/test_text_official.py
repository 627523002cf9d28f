"""The official files: all of the text is understood, and nothing of it stops the parser."""

import os
import random
from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.language.text import parse

pytestmark = pytest.mark.corpus

_FOLDER = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "sysml2"
RELEASE = sorted((_FOLDER / "omg-release").rglob("*.*ml"))
PLANTS = sorted((_FOLDER / "ice-lab").rglob("*.sysml"), key=str)
SHOWCASE = sorted((_FOLDER / "showcase").rglob("*.sysml"), key=str)
XPECT = sorted((_FOLDER / "pilot-xpect").rglob("*.xt"))
INVENTED = ("QPE-Qualifier", "QPE-Wildcard", "QPE-Traversal")
"""Tests of a syntax that the pilot proposes and the standard does not have."""


def language(path):
    return "kerml" if ".kerml" in path.name else "sysml"


def codes(text, path):
    sink = Sink()
    document = parse(text, path.name, language(path), sink)
    size = len(text.encode())
    assert all(0 <= found.subject.place.offset <= size for found in sink)
    assert document.root.members or sink or not text.strip()
    return [found.rule.code for found in sink]


def test_all_official_files_are_there():
    if not RELEASE:
        pytest.skip("no corpus")
    assert (len(RELEASE), len(PLANTS) + len(SHOWCASE), len(XPECT)) == (289, 23, 428)


@pytest.mark.parametrize("path", [*RELEASE, *PLANTS, *SHOWCASE], ids=lambda path: path.stem)
def test_an_official_file_is_understood(path):
    assert codes(path.read_text("utf-8"), path) == []


def test_models_of_the_pilot_have_the_errors_of_syntax_that_it_tests():
    found = {path.name.partition(".")[0]: codes(path.read_text("utf-8"), path) for path in XPECT}
    assert {name: said for name, said in found.items() if said and name not in INVENTED} == {
        "Import_Visibility_Invalid": ["SM197"],
        "ParsingTests_BadScopeWithOnlyTwoSingleDot": ["SM190"],
        "ParsingTests_BadScopeWithOnlyTwoSingleDotAtTheEnd": ["SM190"],
        "ParsingTests_Import_Visibility": ["SM197"],
    } or not XPECT
    assert all(found[name] for name in INVENTED if XPECT)


TOKENS = [
    *"{}()[];:=.,'\"#@~*<>$&|^%+-/\\?é\0\ufffd\n",
    *("/*", "*/", "//", "::", ":>", ":>>", "->", "..", " part ", " def ", " in ", " import "),
    *(" if ", " then ", " first ", " accept ", " transition ", " end ", " return ", " variant "),
    *(" abstract ", " private ", " feature ", " connector ", " binding ", " all ", " x ", " 1 "),
]


def damaged(text, chance):
    for _ in range(chance.randint(1, 6)):
        at, other = chance.randrange(len(text) + 1), chance.randrange(len(text) + 1)
        text = chance.choice(
            [
                text[:at] + chance.choice(TOKENS) + text[at:],
                text[:at] + text[at + chance.randint(1, 30) :],
                text[:at] + text[other : other + chance.randint(1, 80)] + text[at:],
                text[:at] + chance.choice(TOKENS) * chance.randint(1, 5) + text[at:],
            ]
        )
    return text


@pytest.mark.parametrize("seed", range(12))
def test_damaged_files_are_told_and_never_stop_the_parser(seed):
    chance = random.Random(seed)
    for _ in range(50 if XPECT else 0):
        path = chance.choice([*RELEASE, *PLANTS, *XPECT])
        codes(damaged(path.read_text("utf-8")[:4_000], chance), path)
