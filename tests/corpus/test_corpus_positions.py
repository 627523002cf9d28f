"""Every diagnostic about an XML file has a location: file, line, column, XPath and a name."""

from pathlib import Path
from random import Random

import pytest
from reading_corpus import XMI_SUFFIXES, list_models

from dialects.mutations import mutate
from fuzz.aml_changes import AML_CHANGES
from long_runs import quick_first
from sysmlc.diagnostics.locations import is_xml
from sysmlc.diagnostics.renderers import make_report
from sysmlc.driver import Request, compile_model, select_backends

pytestmark = pytest.mark.corpus

ARCHIVES = (".mdzip", ".amlx")
FILE_RULES = {"SM100", "SM110", "SM141", "SM142", "SM148", "SM158", "SM171", "SM172", "SM178"}
"""Rules about a file as a whole, not about an element."""
LARGE = 700_000
MUTANTS = 3


def list_small_models() -> list[Path]:
    return list_models("xmi", "aml", suffixes=(*XMI_SUFFIXES, ".aml", ".amlx"), largest=LARGE)


def find_incomplete(path: Path, **options) -> list[str]:
    """Return the diagnostics without a complete location or, about XML, without a name."""
    compilation = compile_model(Request(inputs=(path,), **options))
    xml_files = {source.name for source in compilation.sources if is_xml(source.data)}
    return [
        f"{finding.where} {finding.xpath} {finding.diagnostic.subject} {finding.diagnostic.message}"
        for finding in make_report(compilation.diagnostics, compilation.sources).findings
        if not _is_complete(finding, xml_files)
    ]


def _is_complete(finding, xml_files) -> bool:
    subject = finding.diagnostic.subject
    if subject.place is None:
        return False
    if subject.place.file not in xml_files:
        return True
    if finding.diagnostic.rule.code in FILE_RULES:
        return bool(finding.line and finding.column)
    is_named = subject.name not in ("", subject.place.file, Path(subject.place.file).name)
    return bool(is_named and finding.line and finding.column and finding.xpath)


@pytest.mark.parametrize("path", quick_first(list_small_models(), 30), ids=lambda path: path.name)
def test_diagnostics_of_models_have_a_complete_location(path):
    backends = tuple(select_backends(()))
    assert find_incomplete(path, backends=backends, diagrams="both") == []


@pytest.mark.parametrize(
    "path",
    [p for p in list_small_models() if p.suffix not in ARCHIVES and "notwellformed" not in p.name][
        ::2
    ],
    ids=lambda p: p.name,
)
def test_diagnostics_of_mutated_models_have_a_complete_location(path, tmp_path):
    random = Random(path.name)
    for number in range(MUTANTS):
        changes = AML_CHANGES if path.suffix == ".aml" else None
        description, mutated = mutate(path.read_bytes(), random, changes=changes)
        target = tmp_path / f"{number}{path.suffix}"
        target.write_bytes(mutated)
        assert find_incomplete(target) == [], description


def test_the_corpus_has_models(corpus):
    assert len(list_small_models()) > 75
