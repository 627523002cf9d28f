"""Every finding about an XML file says where: file, line, column, XPath and a name."""

import os
from pathlib import Path
from random import Random

import pytest

from dialects.mutations import mutate
from fuzz.aml_changes import AML_CHANGES
from long_runs import quick_first
from sysmlc.diagnostics.renderers import make_report
from sysmlc.diagnostics.xpath import is_xml
from sysmlc.driver import Request, compile_model, select_backends

pytestmark = pytest.mark.corpus

SUFFIXES = {".uml", ".xmi", ".xml", ".mdxml", ".mdzip", ".aml", ".amlx"}
ARCHIVES = (".mdzip", ".amlx")
OF_FILES = {"SM100", "SM110", "SM141", "SM142", "SM148", "SM158", "SM171", "SM172", "SM178"}
"""Rules about a file as a whole, which is no element."""
LARGE = 700_000
MUTANTS = 3


def models() -> list[Path]:
    corpus = Path(os.environ.get("SYSMLC_CORPUS", "nowhere"))
    folders = (corpus / "xmi", corpus / "aml")
    found = sorted(p for folder in folders for p in folder.rglob("*") if p.suffix in SUFFIXES)
    return [path for path in found if path.stat().st_size < LARGE]


def incomplete(path: Path, **asked) -> list[str]:
    """Findings that lack a part of their place or, about XML, a name."""
    made = compile_model(Request(inputs=(path,), **asked))
    xml = {source.name for source in made.sources if is_xml(source.data)}
    return [
        f"{finding.where} {finding.xpath} {finding.diagnostic.subject} {finding.diagnostic.message}"
        for finding in make_report(made.diagnostics, made.sources).findings
        if not _is_whole(finding, xml)
    ]


def _is_whole(finding, xml) -> bool:
    subject = finding.diagnostic.subject
    if subject.place is None:
        return False
    if subject.place.file not in xml:
        return True
    if finding.diagnostic.rule.code in OF_FILES:
        return bool(finding.line and finding.column)
    is_named = subject.name not in ("", subject.place.file, Path(subject.place.file).name)
    return bool(is_named and finding.line and finding.column and finding.xpath)


@pytest.mark.parametrize("path", quick_first(models(), 30), ids=lambda path: path.name)
def test_findings_of_models_have_a_whole_place(path):
    backends = tuple(select_backends(()))
    assert incomplete(path, backends=backends, diagrams="both") == []


@pytest.mark.parametrize(
    "path",
    [p for p in models() if p.suffix not in ARCHIVES and "notwellformed" not in p.name][::2],
    ids=lambda p: p.name,
)
def test_findings_of_spoilt_models_have_a_whole_place(path, tmp_path):
    random = Random(path.name)
    for number in range(MUTANTS):
        changes = AML_CHANGES if path.suffix == ".aml" else None
        done, spoilt = mutate(path.read_bytes(), random, changes=changes)
        target = tmp_path / f"{number}{path.suffix}"
        target.write_bytes(spoilt)
        assert incomplete(target) == [], done


def test_the_models_are_there(corpus):
    assert len(models()) > 75
