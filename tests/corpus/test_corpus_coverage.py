"""The coverage of real models never shrinks unnoticed: the golden file has a line for each."""

import re
from pathlib import Path

import pytest
from reading_corpus import list_models

from sysmlc.diagnostics import Verdict
from sysmlc.driver import Request
from sysmlc.driver.coverage import measure_coverage

pytestmark = pytest.mark.corpus

_COLUMNS = ("elements", *(verdict.value for verdict in Verdict))


@pytest.fixture(scope="module")
def coverage(corpus):
    """Map each model to the coverage of its files."""
    return {
        path.relative_to(corpus / "xmi").as_posix(): _measure_files(path)
        for path in list_models("xmi")
    }


def _measure_files(path):
    return measure_coverage(Request(inputs=(path,))).files


def test_no_model_is_read_less_than_before(coverage, golden):
    """Fewer losses need ``--update-golden``; more losses need a reason as well."""
    lines = [_format_row("file", _COLUMNS)]
    for path, files in coverage.items():
        totals = {v: sum(file.totals[v.value] for file in files) for v in Verdict}
        lines.append(_format_row(path, [sum(totals.values()), *totals.values()]))
    golden.check("coverage", {"corpus.txt": "\n".join(lines) + "\n"})


def _format_row(name, cells):
    return f"{name:<50}" + "".join(f"{cell:>18}" for cell in cells).rstrip()


def test_listed_losses_add_up_to_the_totals(coverage):
    for path, files in coverage.items():
        for file in files:
            listed = dict.fromkeys(Verdict, 0)
            for loss in file.losses:
                listed[loss.loss.verdict] += loss.loss.elements
            counted = {
                verdict: file.totals[verdict.value]
                for verdict in Verdict
                if verdict is not Verdict.MAPPED
            }
            assert {verdict: listed[verdict] for verdict in counted} == counted, (path, file.file)


def test_every_listed_loss_has_a_location_a_name_and_a_reason(coverage):
    for path, files in coverage.items():
        for file in files:
            incomplete = [
                loss for loss in file.losses if not (loss.line and loss.xpath and loss.element)
            ]
            assert incomplete == [], path
            assert all(loss.loss.reason for loss in file.losses), path


def test_the_corpus_has_models(corpus):
    assert len(list_models("xmi")) > 40


@pytest.mark.parametrize(
    ("page", "folder"),
    [
        ("papyrus.md", "papyrus"),
        ("cameo-magicdraw.md", "magicdraw"),
        ("enterprise-architect.md", "ea"),
    ],
)
def test_the_pages_about_tools_state_the_numbers_of_the_golden_file(page, folder):
    tests = Path(__file__).parents[1]
    rows = (tests / "golden" / "coverage" / "corpus.txt").read_text().splitlines()
    header, *cells = (row.split() for row in rows)
    chosen = [dict(zip(header, row, strict=True)) for row in cells if row[0].startswith(folder)]
    elements, mapped, external, unsupported, notation = (
        sum(int(row[column]) for row in chosen)
        for column in ("elements", "mapped", "external", "unsupported", "ignored_notation")
    )
    text = " ".join((tests.parent / "docs" / page).read_text().split())
    assert f"{elements:,} XML elements" in text
    share = round(100 * (mapped + external) / elements)
    assert re.search(rf"\b{share} % (of the elements )?are in the graph or refer to other", text)
    share_of_notation = f"{float(f'{100 * notation / elements:.2g}'):g}"
    assert re.search(
        rf"\b{re.escape(share_of_notation)} % (of the elements )?are (drawings and )?settings", text
    )
    assert f"{unsupported} elements" in text if unsupported else "none is lost" in text
