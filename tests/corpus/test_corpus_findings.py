"""Every error in the AutomationML and SysML v2 of the corpus is justified; facts are reported once.

Covered are the 30 AutomationML files in ``aml/dev``, and of SysML v2 and KerML the 94 files of the
OMG's library, its 100 training and 95 example files, 18 files of the ICE laboratory, 5 showcases,
28 files of ``evaluation``, 40 of ``values/valid``, and 25 of ``contracts``. ``values/wrong`` and
``pilot-xpect`` hold intended errors, which other tests compare with the expected ones; XMI is
covered by ``test_corpus_entries``.
"""

from collections import Counter

import pytest
from corpus_findings import build_model, list_repeated_facts

pytestmark = [pytest.mark.corpus, pytest.mark.long]

FILES = {"aml/dev": 30, "sysml2": 380, "contracts": 25}
"""Number of files of all units by their folder."""

JUSTIFIED = {
    ("aml/dev/i40_grouping_mirror.aml", "SM130"): (
        2,
        "the library of interface classes has neither 'Technical/Mechanical/PhysicalProperties' "
        "nor 'Load' in it",
    ),
    ("aml/dev/mtp_tud_minimal.aml", "SM130"): (
        1,
        "no library has a class 'ServicesSet', only another library than 'MTPSUCLib' a class "
        "'ServiceSet'; AML.Engine does not find it either",
    ),
    ("sysml2/ice-lab", "SM205"): (
        5,
        "the files are of two commits that do not fit (README): 'OpcUaConnection', "
        "'RoboticCellCmdPort', 'RoboticCellStatePort', 'cmdPort' and 'statePort' are nowhere",
    ),
}
"""Number of the errors and their reason, by unit and rule."""


def list_units(corpus):
    """Return the units by name: folders that are compiled together, and single files."""
    v2 = corpus / "sysml2"
    paths = sorted((corpus / "aml" / "dev").iterdir())
    paths += [v2 / "ice-lab", v2 / "omg-release" / "training", v2 / "omg-release" / "sysml.library"]
    paths += sorted((v2 / "omg-release" / "examples").iterdir())
    folders = [v2 / "showcase", v2 / "evaluation", v2 / "values" / "valid", corpus / "contracts"]
    paths += [path for folder in folders for path in sorted(folder.rglob("*.sysml"))]
    return {path.relative_to(corpus).as_posix(): path for path in paths}


@pytest.fixture(scope="module")
def findings(corpus, tmp_path_factory):
    """The findings of each unit."""
    units = list_units(corpus)
    return {
        name: build_model(path, tmp_path_factory.mktemp("out"))[1] for name, path in units.items()
    }


def test_the_units_have_all_files_that_are_said_to_be_covered(corpus):
    numbers = Counter()
    for name, path in list_units(corpus).items():
        files = [file for file in path.rglob("*") if file.is_file()] if path.is_dir() else [path]
        models = [file for file in files if file.suffix in (".aml", ".amlx", ".sysml", ".kerml")]
        folder = next(folder for folder in FILES if name.startswith(folder))
        numbers[folder] += len(models)
    assert numbers == FILES


def test_every_error_is_justified(findings):
    errors = Counter(
        (name, finding["code"])
        for name, listed in findings.items()
        for finding in listed
        if finding["severity"] == "error"
    )
    assert errors == {key: number for key, (number, _) in JUSTIFIED.items()}


def test_every_fact_is_reported_once(findings):
    repeated = [
        f"{name}: {line}"
        for name, listed in findings.items()
        for line in list_repeated_facts(listed)
    ]
    assert repeated == []


def test_a_model_without_errors_and_warnings_has_at_most_20_lines(findings):
    """The text has one line for each rule with infos, an empty line, and the summary."""
    rules = {
        name: {finding["code"] for finding in listed}
        for name, listed in findings.items()
        if all(finding["severity"] == "info" for finding in listed)
    }
    assert len(rules) > 100
    assert max(map(len, rules.values())) <= 20 - 2
