"""The errors that the pilot implementation expects, and the official models without any."""

import csv
import os
import re
from functools import cache
from pathlib import Path

import pytest
import xpect

from sysmlc.diagnostics import Severity, Sink
from sysmlc.language.checks import check
from sysmlc.language.library import Library, find
from sysmlc.language.names import resolve
from sysmlc.language.stored import read
from sysmlc.language.text import parse
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

_FOLDER = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "sysml2"
_XPECT = _FOLDER / "pilot-xpect"
REACHED = 193
"""Of 197 errors in SysML models, so many are told at their place."""


@cache
def library():
    return find(_FOLDER / "omg-release" / "sysml.library")


@pytest.mark.parametrize("folder", ["training", "examples", "sysml.library"])
def test_no_official_model_breaks_a_constraint(folder):
    root = _FOLDER / "omg-release" / folder
    paths = [path for path in sorted(root.rglob("*")) if path.suffix in (".sysml", ".kerml")]
    documents = [
        read(Source(path.name, path.read_bytes()), path.name, path.suffix[1:], Sink(), None)
        for path in paths
    ]
    sink = Sink()
    beside = Library([]) if folder == "sysml.library" else library()
    check(resolve(documents, beside, Sink()), sink)
    assert [found.message for found in sink] == []


def told(case):
    """Offsets and messages of all errors in a test model."""
    sink = Sink()
    beside = [parse(t, n, n.rpartition(".")[2], Sink()) for n, t in sorted(case.beside().items())]
    document = parse(case.text, case.path.name, case.language, sink)
    check(resolve([document, *beside], library(), sink), sink)
    text = case.text.encode()
    return {
        len(text[: found.subject.place.offset].decode()): found.message
        for found in sink
        if found.severity is Severity.ERROR and found.subject.place.file == case.path.name
    }


def cases(language):
    paths = sorted((_XPECT / language).rglob("*.xt"))
    read_in = [xpect.read(path) for path in paths if "queryx" not in path.parts]
    return [case for case in read_in if case.is_complete]


def test_models_without_errors_have_none():
    clean = [c for c in (*cases("sysml"), *cases("kerml")) if c.no_errors and not c.unresolved]
    assert [(case.path.name, told(case)) for case in clean if told(case)] == []
    assert len(clean) >= 260


def expected():
    """The expected errors of SysML models by file: line and the text they are about."""
    with (_XPECT / "expected-errors.tsv").open(encoding="utf-8", newline="") as rows:
        found = {}
        for row in csv.DictReader(rows, delimiter="\t"):
            if row["severity"] == "errors" and row["file"].startswith("sysml/"):
                one = (int(row["line"]), row["at_text"], row["message"])
                found.setdefault(row["file"], []).append(one)
    return found


def spans(plain, line, about):
    """Where the text stands that an expectation is about, on the first line that has it.

    A text that Xpect's own quotes cut short is anywhere on that line.
    """
    after = sum(len(one) + 1 for one in plain.split("\n")[:line])
    words = r"\s*".join(re.escape(word) for word in re.split(r"(?:\\t|\s)+", about.strip()))
    before, behind = (r"\b" if one.isalnum() else "" for one in (about[:1], about[-1:]))
    wanted = re.compile(before + (words or r"\S.*") + behind)
    first = wanted.search(plain, after)
    if first is None:
        return []
    end = plain.find("\n", first.end())
    return [range(*one.span()) for one in wanted.finditer(plain, after, end)]


def test_errors_that_the_pilot_expects_are_told_at_their_place():
    wanted, reached = expected(), 0
    for case in cases("sysml"):
        found = told(case)
        plain = xpect.model_text(case.text)
        for line, about, _ in wanted.get(case.path.relative_to(_XPECT).as_posix(), ()):
            places = spans(plain, line, about)
            reached += any(offset in place for place in places for offset in found)
    assert sum(map(len, wanted.values())) == 197
    assert reached >= REACHED
