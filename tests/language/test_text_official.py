"""The parser reads all official files without errors, and damaged ones without exceptions."""

import random

import pytest
from official_models import FOLDER

from sysmlc.diagnostics import Sink
from sysmlc.language.text import parse

pytestmark = pytest.mark.corpus

RELEASE = sorted((FOLDER / "omg-release").rglob("*.*ml"))
PLANTS = sorted((FOLDER / "ice-lab").rglob("*.sysml"), key=str)
SHOWCASE = sorted((FOLDER / "showcase").rglob("*.sysml"), key=str)
XPECT = sorted((FOLDER / "pilot-xpect").rglob("*.xt"))
PROPOSED = ("QPE-Qualifier", "QPE-Wildcard", "QPE-Traversal")
"""Tests of the pilot with syntax that it proposes and the standard does not have."""


def language_of(path):
    return "kerml" if ".kerml" in path.name else "sysml"


def list_codes(text, path):
    """Return the codes of the diagnostics, whose locations must be in the text."""
    sink = Sink()
    document = parse(text, path.name, language_of(path), sink)
    size = len(text.encode())
    assert all(0 <= diagnostic.subject.place.offset <= size for diagnostic in sink)
    assert document.root.members or sink or not text.strip()
    return [diagnostic.rule.code for diagnostic in sink]


def test_all_official_files_are_there():
    assert (len(RELEASE), len(PLANTS) + len(SHOWCASE), len(XPECT)) == (289, 23, 428)


@pytest.mark.parametrize("path", [*RELEASE, *PLANTS, *SHOWCASE], ids=lambda path: path.stem)
def test_an_official_file_has_no_syntax_error(path):
    assert list_codes(path.read_text("utf-8"), path) == []


def test_models_of_the_pilot_have_the_syntax_errors_that_it_tests():
    codes = {
        path.name.partition(".")[0]: list_codes(path.read_text("utf-8"), path) for path in XPECT
    }
    proposed = [codes.pop(name) for name in PROPOSED]
    assert all(proposed)
    assert {name: listed for name, listed in codes.items() if listed} == {
        "Import_Visibility_Invalid": ["SM197"],
        "ParsingTests_BadScopeWithOnlyTwoSingleDot": ["SM190"],
        "ParsingTests_BadScopeWithOnlyTwoSingleDotAtTheEnd": ["SM190"],
        "ParsingTests_Import_Visibility": ["SM197"],
    }


TOKENS = [
    *"{}()[];:=.,'\"#@~*<>$&|^%+-/\\?é\0\ufffd\n",
    *("/*", "*/", "//", "::", ":>", ":>>", "->", "..", " part ", " def ", " in ", " import "),
    *(" if ", " then ", " first ", " accept ", " transition ", " end ", " return ", " variant "),
    *(" abstract ", " private ", " feature ", " connector ", " binding ", " all ", " x ", " 1 "),
]


def damage(text, chance):
    """Insert, remove, copy or repeat parts of the text at random."""
    for _ in range(chance.randint(1, 6)):
        start, copy_start = chance.randrange(len(text) + 1), chance.randrange(len(text) + 1)
        text = chance.choice(
            [
                text[:start] + chance.choice(TOKENS) + text[start:],
                text[:start] + text[start + chance.randint(1, 30) :],
                text[:start] + text[copy_start : copy_start + chance.randint(1, 80)] + text[start:],
                text[:start] + chance.choice(TOKENS) * chance.randint(1, 5) + text[start:],
            ]
        )
    return text


@pytest.mark.parametrize("seed", range(12))
def test_the_parser_raises_no_exception_for_damaged_files(seed):
    chance = random.Random(seed)
    for _ in range(50 if XPECT else 0):
        path = chance.choice([*RELEASE, *PLANTS, *XPECT])
        list_codes(damage(path.read_text("utf-8")[:4_000], chance), path)
