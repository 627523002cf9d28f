"""Every entry of the corpus gives outputs or located findings; how many of which, is in a golden.

Errors on real models are worth a look each: ``JUSTIFIED`` says why those that are there are right.
"""

import json
import re
from collections import Counter

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

pytestmark = pytest.mark.corpus

ENTRIES = 48
NOT_MODELS = {
    "metamodel/types.ecore": "a metamodel, not a model",
    "metamodel/uml.ecore": "a metamodel, not a model",
    "profile/papyrus-SysML-1.6.profile.ecore": "a metamodel, not a model",
}
ELSEWHERE = {"huds/TMT_mtip.zip": "94 MB: read by tests/frontends/huds, to the resolved graph"}
JUSTIFIED = {
    ("papyrus/Arrowhead-5.0.uml", "SM421"): "both initial pseudostates of the region lead nowhere",
    ("papyrus/RoboCab.uml", "SM421"): "four transitions leave the region's initial pseudostate",
}
"""Errors that real models are right to get, by entry and rule."""


def entries(corpus):
    folder = corpus / "xmi"
    listed = re.findall(r"^\| ([\w-]+/[^|]+?) \|", (folder / "README.md").read_text(), re.M)
    found = sorted(path.relative_to(folder).as_posix() for path in folder.glob("*/*"))
    assert sorted(listed) == found
    return found


@pytest.fixture(scope="module")
def outcomes(corpus, tmp_path_factory):
    names = [name for name in entries(corpus) if name not in ELSEWHERE]
    return {name: build(corpus, name, tmp_path_factory.mktemp("out")) for name in names}


def build(corpus, name, output):
    """Exit code, findings, and the number of outputs beside the bookkeeping."""
    model = str(corpus / "xmi" / name)
    done = CliRunner().invoke(
        sysmlc, ["build", model, "-o", str(output), "--format", "json", "--no-cache"]
    )
    assert done.exception is None or isinstance(done.exception, SystemExit), name
    made = [path for folder in output.iterdir() if folder.is_dir() for path in folder.rglob("*.*")]
    return done.exit_code, json.loads(done.stdout)["diagnostics"], len(made)


@pytest.mark.long
def test_exit_codes_and_findings_of_every_entry(outcomes, golden):
    lines = [line(name, *outcome) for name, outcome in outcomes.items()]
    assert len(lines) + len(ELSEWHERE) == ENTRIES
    golden.check("corpus", {"entries.txt": "".join(lines)})


def line(name, exit_code, findings, outputs):
    counts = Counter(finding["code"] for finding in findings)
    told = "".join(f" {code}:{number}" for code, number in sorted(counts.items()))
    return f"{name} exit={exit_code} outputs={outputs}{told}\n"


def test_what_is_not_read_is_an_error_at_a_place(outcomes):
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


def test_every_finding_has_a_place(outcomes):
    placeless = [
        (name, finding["code"])
        for name, (_, findings, _) in outcomes.items()
        for finding in findings
        if not finding["file"]
    ]
    assert placeless == []
