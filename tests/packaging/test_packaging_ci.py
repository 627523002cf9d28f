"""The workflow of public continuous integration and the hooks run what the Makefile runs."""

import re
import tomllib
from pathlib import Path

from ruamel.yaml import YAML

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


def read_yaml(path: str):
    return YAML(typ="safe").load((ROOT / path).read_text(encoding="utf-8"))


def test_the_workflow_runs_all_tests_with_the_oldest_and_the_newest_python():
    job = read_yaml(".github/workflows/ci.yml")["jobs"]["test"]
    commands = [step["run"] for step in job["steps"] if "run" in step]
    assert commands == ["make test", "make test-long"]
    for command in commands:
        assert re.search(rf"^{command.removeprefix('make ')}:", MAKEFILE, re.MULTILINE)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["requires-python"] == ">=3.11,<3.14"
    assert job["strategy"]["matrix"]["python"] == ["3.11", "3.13"]


def test_the_workflow_needs_no_secrets():
    text = (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
    assert "secrets" not in text
    assert read_yaml(".github/workflows/ci.yml")["permissions"] == {"contents": "read"}


def test_the_hooks_are_the_checks_of_the_makefile():
    (repository,) = read_yaml(".pre-commit-config.yaml")["repos"]
    commands = [hook["entry"].removesuffix(" --force-exclude") for hook in repository["hooks"]]
    assert repository["repo"] == "local"
    recipe = re.search(r"^check:.*\n((?:\t.*\n)+)", MAKEFILE, re.MULTILINE)
    assert commands == [line.strip() for line in recipe[1].splitlines()][:3]
