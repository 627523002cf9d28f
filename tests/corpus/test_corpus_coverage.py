"""What of the real models is read never shrinks unseen: a golden line for each file."""

import os
from pathlib import Path

import pytest

from sysmlc.diagnostics import Verdict
from sysmlc.driver import Request
from sysmlc.driver.coverage import measure_coverage

pytestmark = pytest.mark.corpus

SUFFIXES = {".uml", ".xmi", ".xml", ".mdxml", ".mdzip"}
_COLUMNS = ("elements", *(verdict.value for verdict in Verdict))


def models() -> list[Path]:
    folder = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "xmi"
    return sorted(path for path in folder.rglob("*") if path.suffix in SUFFIXES)


@pytest.fixture(scope="module")
def covered(corpus):
    """Each model as a unit of its own."""
    return {path.relative_to(corpus / "xmi").as_posix(): _files(path) for path in models()}


def _files(path):
    return measure_coverage(Request(inputs=(path,))).files


def test_no_model_is_read_less_than_before(covered, golden):
    """Fewer losses need ``--update-golden``; more of them need a reason, too."""
    lines = [_line("file", _COLUMNS)]
    for path, files in covered.items():
        totals = {v: sum(file.totals[v.value] for file in files) for v in Verdict}
        lines.append(_line(path, [sum(totals.values()), *totals.values()]))
    golden.check("coverage", {"corpus.txt": "\n".join(lines) + "\n"})


def _line(name, cells):
    return f"{name:<50}" + "".join(f"{cell:>18}" for cell in cells).rstrip()


def test_what_is_listed_adds_up_to_what_is_counted(covered):
    for path, files in covered.items():
        for file in files:
            listed = dict.fromkeys(Verdict, 0)
            for lost in file.losses:
                listed[lost.loss.verdict] += lost.loss.elements
            counted = {v: file.totals[v.value] for v in Verdict if v is not Verdict.MAPPED}
            assert {v: listed[v] for v in counted} == counted, (path, file.file)


def test_everything_that_is_listed_has_a_place_a_name_and_a_reason(covered):
    for path, files in covered.items():
        for file in files:
            bare = [x for x in file.losses if not (x.line and x.xpath and x.element)]
            assert bare == [], path
            assert all(lost.loss.reason for lost in file.losses), path


def test_the_models_are_there(corpus):
    assert len(models()) > 40


@pytest.mark.parametrize(
    ("page", "folder"),
    [
        ("papyrus.md", "papyrus"),
        ("cameo-magicdraw.md", "magicdraw"),
        ("enterprise-architect.md", "ea"),
    ],
)
def test_the_pages_of_the_tools_give_the_numbers_of_the_golden(page, folder):
    here = Path(__file__).parents[1]
    rows = (here / "golden" / "coverage" / "corpus.txt").read_text().splitlines()
    header, *cells = (row.split() for row in rows)
    chosen = [dict(zip(header, row, strict=True)) for row in cells if row[0].startswith(folder)]
    elements, mapped, external, unsupported, notation = (
        sum(int(row[column]) for row in chosen)
        for column in ("elements", "mapped", "external", "unsupported", "ignored_notation")
    )
    text = " ".join((here.parent / "docs" / page).read_text().split())
    assert f"{elements:,} XML elements in all" in text
    assert f"{round(100 * (mapped + external) / elements)} % are in the graph or lead" in text
    assert f"{float(f'{100 * notation / elements:.2g}'):g} % are " in text
    assert f"{unsupported} elements" in text if unsupported else "none is left out" in text
