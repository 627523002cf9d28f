"""Errors that the pilot implementation expects (Xpect), and official models without errors."""

import csv
import re
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from official_models import FOLDER, load_standard_library, parse_folder
from xpect import XPECT_FOLDER, blank_comments, read_cases

from sysmlc.diagnostics import Severity, Sink, catalogue
from sysmlc.language.checks import check
from sysmlc.language.library import Library
from sysmlc.language.names import resolve

pytestmark = pytest.mark.corpus

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
"""Expected errors that sysmlc does not report; docs/sysml-v2-rules.md gives the reasons."""


TRUE_WARNINGS = {
    "omg-release/examples": [
        ("SM245", "'clutchPort' of type 'DrivePwrPort'"),
        ("SM245", "'req1_1' of type 'Req1_1'"),
        ("SM244", "'pusher.pusherBehavior.output' and 'cart.cartBehavior.input'"),
        ("SM244", "'battery.batteryBehavior.output' and 'motor.motorBehavior.input'"),
        ("SM244", "'motor.motorBehavior.output' and 'tire.tireBehavior.input'"),
        ("SM244", "'tire.tireBehavior.output' and 'motor.motorBehavior.input'"),
        ("SM244", "'tire.tireBehavior.output' and 'vehicleBehavior.input'"),
    ]
}
"""Warnings about published models: the ends of their connections and flows have unrelated types."""


@pytest.mark.parametrize(
    "folder",
    ["omg-release/training", "omg-release/examples", "omg-release/sysml.library", "ice-lab"],
)
def test_no_real_model_breaks_a_constraint(folder):
    library = Library([]) if folder.endswith("library") else load_standard_library()
    sink = Sink()
    check(resolve(parse_folder(FOLDER / folder), library, Sink()), sink)
    expected = TRUE_WARNINGS.get(folder, [])
    for diagnostic, (code, start) in zip(sink, expected, strict=True):
        assert diagnostic.rule.code == code
        assert diagnostic.message.startswith(start)


_ERROR_OF_THE_PILOT = "SM197"
"""An import without visibility: an error for the pilot; here a warning, because of old models."""


def list_diagnostics(case, severity=Severity.ERROR):
    """Return offset and code of the diagnostics of one severity about a test model."""
    sink = Sink()
    check(resolve(case.parse(sink), load_standard_library(), sink), sink)
    return sorted(
        (offset, diagnostic.rule.code)
        for offset, diagnostic in case.list_located(sink)
        if diagnostic.severity is severity
        or (diagnostic.rule.code == _ERROR_OF_THE_PILOT and severity is Severity.ERROR)
    )


def test_models_without_expected_errors_have_none():
    clean = [case for case in read_cases() if case.no_errors and not case.unresolved]
    diagnostics = {case.path.name: list_diagnostics(case) for case in clean}
    assert {name: errors for name, errors in diagnostics.items() if errors} == {}
    assert len(clean) >= 260


@cache
def read_expected_rows():
    """Return the expected diagnostics: file, severity, message, line and text of each."""
    with (XPECT_FOLDER / "expected-errors.tsv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def find_spans(text, line, words):
    """Return the ranges of the *words* that an expectation is about, in the first line with them.

    Words that Xpect's own quotes cut short may be anywhere in that line.
    """
    start = sum(len(previous) + 1 for previous in text.split("\n")[:line])
    pattern = r"\s*".join(re.escape(word) for word in re.split(r"(?:\\t|\s)+", words.strip()))
    first_bound, last_bound = (r"\b" if end.isalnum() else "" for end in (words[:1], words[-1:]))
    regex = re.compile(first_bound + (pattern or r"\S.*") + last_bound)
    first = regex.search(text, start)
    if first is None:
        return []
    end = text.find("\n", first.end())
    return [range(*match.span()) for match in regex.finditer(text, start, end)]


def iter_outcomes(rows, severity):
    """Yield each expected diagnostic with the codes that sysmlc reports at its location."""
    for case in read_cases():
        case_rows = [row for row in rows if row["file"] == case.name]
        if case_rows:
            diagnostics, text = list_diagnostics(case, severity), blank_comments(case.text)
            for row in case_rows:
                spans = find_spans(text, int(row["line"]), row["at_text"])
                codes = [
                    code for offset, code in diagnostics if any(offset in span for span in spans)
                ]
                yield row, codes


@cache
def list_error_outcomes():
    """Return file, text and reported code of each expected error; the code may be empty."""
    errors = [row for row in read_expected_rows() if row["severity"] == "errors"]
    return [
        (row["file"], row["at_text"], codes[0] if codes else "")
        for row, codes in iter_outcomes(errors, Severity.ERROR)
    ]


def test_errors_that_the_pilot_expects_are_reported_at_their_location():
    outcomes = list_error_outcomes()
    assert Counter(name[:5] for name, _, _ in outcomes) == {"sysml": 197, "kerml": 323}
    assert {(name, words) for name, words, code in outcomes if not code} == MISSED


def test_19_of_24_warnings_that_the_pilot_expects_are_reported_at_their_location():
    warnings = [
        row
        for row in read_expected_rows()
        if row["severity"] == "warnings" and "inherited member" not in row["message"]
    ]
    reported = [row for row, codes in iter_outcomes(warnings, Severity.WARNING) if codes]
    assert (len(reported), len(warnings)) == (19, 24)


def test_8_of_10_expected_warnings_about_hidden_members_are_reported():
    """Members that hide `self`, `start` or `done` are reported by other rules."""
    hidden = re.compile(r"inherited member name '(?!self|start|done)")
    rows = [row for row in read_expected_rows() if hidden.search(row["message"])]
    outcomes = list(iter_outcomes(rows, Severity.WARNING))
    reported = [row for row, codes in outcomes if "SM284" in codes]
    assert (len(reported), len(outcomes)) == (8, 10)


def format_table():
    """Return the table of the documentation: how many expected errors each rule reports."""
    counts = Counter((code, name[:5]) for name, _, code in list_error_outcomes() if code)
    codes = sorted({code for code, _ in counts})
    rows = [
        f"| {code} {catalogue()[code].name} | {counts[code, 'sysml']} | {counts[code, 'kerml']} |"
        for code in codes
    ]
    sysml, kerml = (
        sum(counts[code, language] for code in codes) for language in ("sysml", "kerml")
    )
    rows.append(f"| all | {sysml} of 197 | {kerml} of 323 |")
    return "\n".join(["| rule | SysML | KerML |", "|---|---|---|", *rows])


def test_the_documentation_counts_the_errors_that_each_rule_reports(request):
    before, _, rest = _PAGE.read_text(encoding="utf-8").partition("| rule |")
    after = rest.partition("\n\n")[2]
    if request.config.getoption("--update-golden"):
        _PAGE.write_text(f"{before}{format_table()}\n\n{after}", encoding="utf-8")
    assert format_table() in _PAGE.read_text(encoding="utf-8")
