"""In continuous integration, skipped tests of PlantUML and of the corpus that is present fail."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SKIPPING_TESTS = """
import pytest

@pytest.mark.corpus
def test_corpus():
    pytest.skip("no model")

@pytest.mark.plantuml
def test_plantuml():
    pytest.skip("no java")

def test_other():
    pytest.skip("not here")
"""


@pytest.mark.parametrize(
    ("env", "expected"),
    [
        ({}, "tests of real models were skipped (1): SYSMLC_CORPUS is not set\n"),
        ({"CI": "1", "SYSMLC_CORPUS": "x"}, "2 failed, 1 skipped"),
        pytest.param({"SYSMLC_CORPUS": "x"}, "3 skipped", marks=pytest.mark.long),
        pytest.param({"CI": "1"}, "1 failed, 2 skipped", marks=pytest.mark.long),
    ],
)
def test_a_skip_fails_in_ci(tmp_path, env, expected):
    (tmp_path / "test_skips.py").write_text(SKIPPING_TESTS)
    inherited = {
        name: value for name, value in os.environ.items() if name not in ("CI", "SYSMLC_CORPUS")
    }
    run = [sys.executable, "-m", "pytest", "-p", "conftest", "-p", "no:cacheprovider"]
    options = ["-c", str(ROOT / "pyproject.toml"), "--rootdir", str(ROOT), "-v"]
    result = subprocess.run(
        [*run, *options, str(tmp_path / "test_skips.py")],
        env={**inherited, "PYTHONPATH": str(ROOT / "tests"), **env},
        capture_output=True,
        text=True,
    )
    assert expected in result.stdout
