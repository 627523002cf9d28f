"""The errors that the pilot implementation expects, and the official models without any."""

import csv
import os
import re
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
import xpect

from sysmlc.diagnostics import Severity, Sink, catalogue
from sysmlc.language.checks import check
from sysmlc.language.library import Library, find_library
from sysmlc.language.names import resolve
from sysmlc.language.text import parse
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

_FOLDER = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "sysml2"
_XPECT = _FOLDER / "pilot-xpect"
_PAGE = Path(__file__).parents[2] / "docs" / "sysml-v2-rules.md"
MISSED = {
    ("kerml/parsing/ParsingTests_BadScopeWithOnlyTwoSingleDot.kerml.xt", "::"),
    ("kerml/parsing/ParsingTests_BadScopeWithOnlyTwoSingleDot.kerml.xt", "A"),
    ("kerml/parsing/ParsingTests_BadScopeWithOnlyTwoSingleDotAtTheEnd.kerml.xt", "test"),
    ("kerml/parsing/ParsingTests_BadScopeWithOnlyTwoSingleDotAtTheEnd.kerml.xt", "A"),
    ("kerml/parsing/ParsingTests_Import_Visibility.kerml.xt", "}"),
    ("kerml/parsing/ParsingTests_ScopeWithFourDotAndDot.kerml.xt", "b"),
    ("kerml/validation/Feature_invalid_noType.kerml.xt", "classifier A;"),
    ("kerml/validation/Feature_invalid_noType.kerml.xt", "feature f;"),
    ("sysml/validation/invalid/Feature_invalid_noType.sysml.xt", "part def B;"),
    ("sysml/validation/invalid/Feature_invalid_noType.sysml.xt", "ref f;"),
    ("sysml/validation/invalid/Import_Visibility_Invalid.sysml.xt", "}"),
}
"""Errors that are not told; docs/sysml-v2-rules.md says why."""


@cache
def library():
    return find_library(_FOLDER / "omg-release" / "sysml.library")


@pytest.mark.parametrize(
    "folder",
    ["omg-release/training", "omg-release/examples", "omg-release/sysml.library", "ice-lab"],
)
def test_no_real_model_breaks_a_constraint(folder):
    root = _FOLDER / folder
    paths = [path for path in sorted(root.rglob("*")) if path.suffix in (".sysml", ".kerml")]
    documents = [
        parse(
            path.read_text("utf-8-sig"),
            path.name,
            path.suffix[1:],
            Sink(),
            Source(path.name, path.read_bytes()),
        )
        for path in paths
    ]
    sink = Sink()
    beside = Library([]) if folder.endswith("library") else library()
    check(resolve(documents, beside, Sink()), sink)
    assert [found.message for found in sink] == []


def told(case, severity=Severity.ERROR):
    """All findings of one severity in a test model: offset and code."""
    sink = Sink()
    beside = [parse(t, n, n.rpartition(".")[2], Sink()) for n, t in sorted(case.beside().items())]
    document = parse(case.text, case.path.name, case.language, sink)
    check(resolve([document, *beside], library(), sink), sink)
    text = case.text.encode()
    return sorted(
        (len(text[: found.subject.place.offset].decode()), found.rule.code)
        for found in sink
        if found.severity is severity and found.subject.place.file == case.path.name
    )


def cases(language):
    paths = sorted((_XPECT / language).rglob("*.xt"))
    read_in = [xpect.read(path) for path in paths if "queryx" not in path.parts]
    return [case for case in read_in if case.is_complete]


def test_models_without_errors_have_none():
    clean = [c for c in (*cases("sysml"), *cases("kerml")) if c.no_errors and not c.unresolved]
    assert [(case.path.name, told(case)) for case in clean if told(case)] == []
    assert len(clean) >= 260


@cache
def expected(severity="errors"):
    """The expectations by file: line, text they are about; warnings about inherited names apart."""
    with (_XPECT / "expected-errors.tsv").open(encoding="utf-8", newline="") as rows:
        found = {}
        for row in csv.DictReader(rows, delimiter="\t"):
            is_apart = severity == "warnings" and "inherited member" in row["message"]
            if row["severity"] == severity and not is_apart:
                found.setdefault(row["file"], []).append((int(row["line"]), row["at_text"]))
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


@cache
def outcome():
    """For each expected error its file, the text it is about and the code that we tell there."""
    rows = []
    for case in (*cases("sysml"), *cases("kerml")):
        name = case.path.relative_to(_XPECT).as_posix()
        if name in expected():
            found, plain = told(case), xpect.model_text(case.text)
            for line, about in expected()[name]:
                places = spans(plain, line, about)
                codes = [code for at, code in found if any(at in place for place in places)]
                rows.append((name, about, codes[0] if codes else ""))
    return rows


def test_errors_that_the_pilot_expects_are_told_at_their_place():
    assert Counter(name[:5] for name, _, _ in outcome()) == {"sysml": 197, "kerml": 323}
    assert {(name, about) for name, about, code in outcome() if not code} == MISSED


def test_most_warnings_that_the_pilot_expects_are_told_at_their_place():
    wanted = expected("warnings")
    reached = 0
    for case in (*cases("sysml"), *cases("kerml")):
        name = case.path.relative_to(_XPECT).as_posix()
        if name in wanted:
            found, plain = told(case, Severity.WARNING), xpect.model_text(case.text)
            for line, about in wanted[name]:
                places = spans(plain, line, about)
                reached += any(at in place for place in places for at, _ in found)
    assert (reached, sum(map(len, wanted.values()))) == (19, 24)


def test_members_that_hide_inherited_ones_are_told_where_the_pilot_does():
    """But for two; what `self` of two generals of different kinds hides is told as that."""
    wanted = reached = 0
    apart = re.compile(r"inherited member name '(?!self|start|done)")
    with (_XPECT / "expected-errors.tsv").open(encoding="utf-8", newline="") as rows:
        lines = [
            row for row in csv.DictReader(rows, delimiter="\t") if apart.search(row["message"])
        ]
    for case in (*cases("sysml"), *cases("kerml")):
        name = case.path.relative_to(_XPECT).as_posix()
        mine = [row for row in lines if row["file"] == name]
        if mine:
            found, plain = told(case, Severity.WARNING), xpect.model_text(case.text)
            hidden = [at for at, code in found if code == "SM284"]
            for row in mine:
                places = spans(plain, int(row["line"]), row["at_text"])
                wanted += 1
                reached += any(at in place for place in places for at in hidden)
    assert (reached, wanted) == (8, 10)


def table():
    """How many of the expected errors each rule tells."""
    counts = Counter((code, name[:5]) for name, _, code in outcome() if code)
    codes = sorted({code for code, _ in counts})
    rows = [
        f"| {code} {catalogue()[code].name} | {counts[code, 'sysml']} | {counts[code, 'kerml']} |"
        for code in codes
    ]
    total = [sum(n for (_, one), n in counts.items() if one == key) for key in ("sysml", "kerml")]
    rows.append(f"| all | {total[0]} of 197 | {total[1]} of 323 |")
    return "\n".join(["| rule | SysML | KerML |", "|---|---|---|", *rows])


def test_the_page_says_what_each_rule_tells(request):
    before, _, behind = _PAGE.read_text(encoding="utf-8").partition("| rule |")
    after = behind.partition("\n\n")[2]
    if request.config.getoption("--update-golden"):
        _PAGE.write_text(f"{before}{table()}\n\n{after}", encoding="utf-8")
    assert table() in _PAGE.read_text(encoding="utf-8")
