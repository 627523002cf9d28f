"""Every entry of the corpus yields outputs or located diagnostics, as counted in a golden file.

``JUSTIFIED`` states why each error in a real model is right.
"""

import re
from collections import Counter

import pytest
from corpus_findings import build_model, list_repeated_facts

pytestmark = [pytest.mark.corpus, pytest.mark.long]

ENTRIES = 48
NOT_MODELS = {
    "metamodel/types.ecore": "a metamodel, not a model",
    "metamodel/uml.ecore": "a metamodel, not a model",
    "profile/papyrus-SysML-1.6.profile.ecore": "a metamodel, not a model",
}
READ_ELSEWHERE = {"huds/TMT_mtip.zip": "94 MB: read by tests/frontends/huds, to the resolved graph"}
JUSTIFIED = {
    ("papyrus/Arrowhead-5.0.uml", "SM421"): "both initial pseudostates of the region lead nowhere",
    ("papyrus/RoboCab.uml", "SM421"): "three transitions leave the region's initial pseudostate",
}
"""Justified errors in real models, by entry and rule."""


def list_entries(corpus):
    folder = corpus / "xmi"
    listed = re.findall(r"^\| ([\w-]+/[^|]+?) \|", (folder / "README.md").read_text(), re.M)
    paths = sorted(path.relative_to(folder).as_posix() for path in folder.glob("*/*"))
    assert sorted(listed) == paths
    return paths


@pytest.fixture(scope="module")
def outcomes(corpus, tmp_path_factory):
    names = [name for name in list_entries(corpus) if name not in READ_ELSEWHERE]
    folder = corpus / "xmi"
    return {name: build_model(folder / name, tmp_path_factory.mktemp("out")) for name in names}


def test_every_entry_has_the_exit_code_and_diagnostics_of_the_golden_file(outcomes, golden):
    lines = [format_line(name, *outcome) for name, outcome in outcomes.items()]
    assert len(lines) + len(READ_ELSEWHERE) == ENTRIES
    golden.check("corpus", {"entries.txt": "".join(lines)})


def format_line(name, exit_code, findings, outputs):
    counts = Counter(finding["code"] for finding in findings)
    numbers = "".join(f" {code}:{number}" for code, number in sorted(counts.items()))
    return f"{name} exit={exit_code} outputs={outputs}{numbers}\n"


def test_a_file_that_is_not_a_model_is_a_located_error(outcomes):
    for name in NOT_MODELS:
        exit_code, findings, _ = outcomes[name]
        assert exit_code == 1, name
        assert findings
        assert all(finding["file"] for finding in findings), name


def test_every_error_on_a_real_model_is_justified(outcomes):
    errors = {
        (name, finding["code"])
        for name, (_, findings, _) in outcomes.items()
        for finding in findings
        if finding["severity"] == "error" and name not in NOT_MODELS
    }
    assert errors == set(JUSTIFIED)


def test_every_fact_is_reported_once(outcomes):
    repeated = [
        f"{name}: {line}"
        for name, (_, findings, _) in outcomes.items()
        for line in list_repeated_facts(findings)
    ]
    assert repeated == []


def test_every_diagnostic_has_a_location(outcomes):
    unlocated = [
        (name, finding["code"])
        for name, (_, findings, _) in outcomes.items()
        for finding in findings
        if not finding["file"]
    ]
    assert unlocated == []
