"""The distributions that an installation brings are those that docs/dependencies.md lists."""

import re
import subprocess
import sys
import tomllib
from functools import cache
from importlib.metadata import Distribution, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/dependencies.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

STARTUP_FILES = {
    "future-fstrings": ["aaaaa_future_fstrings.pth"],
    "setuptools": ["distutils-precedence.pth"],
}
"""Files that Python runs at every start, by the distribution that adds them."""

SPDX = {
    "BSD": "BSD-3-Clause",
    "BSD 3-Clause": "BSD-3-Clause",
    "BSD License": "BSD-3-Clause",
    "MIT License": "MIT",
}
"""Identifiers of licences that metadata names in other words."""


@cache
def requirements(name: str) -> tuple[Requirement, ...]:
    """Return what a distribution requires here, without extras."""
    found = [Requirement(text) for text in distribution(name).requires or ()]
    return tuple(one for one in found if not one.marker or one.marker.evaluate({"extra": ""}))


def closure() -> dict[str, Distribution]:
    """Return all distributions that sysmlc needs, directly or not, without sysmlc itself."""
    names, waiting = {}, [Requirement(text) for text in PROJECT["dependencies"]]
    while waiting:
        name = canonicalize_name(waiting.pop().name)
        if name not in names:
            names[name] = distribution(name)
            waiting += requirements(name)
    return names


def licence(found: Distribution) -> str:
    """Return the licence that the metadata of a distribution states."""
    metadata = found.metadata
    classifiers = [text for text in metadata.get_all("Classifier") or () if "License ::" in text]
    stated = metadata.get("License-Expression") or metadata.get("License")
    stated = stated or classifiers[0].rpartition(" :: ")[2]
    return SPDX.get(stated, stated)


def rows(heading: str) -> list[list[str]]:
    """Return the cells of the table below a heading of the page."""
    (section,) = re.findall(rf"^## {heading}\n(.*?)(?=^## )", PAGE, re.DOTALL | re.MULTILINE)
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1:]]


def test_the_page_lists_the_direct_requirements_of_the_project():
    direct = rows("Required directly")
    assert [row[0].strip("`") for row in direct] == PROJECT["dependencies"]
    bounded = [row[0] for row in direct if "<" in row[0]]
    assert bounded == [row[0] for row in direct if row[3]]


def test_the_page_lists_all_other_distributions_and_what_requires_them():
    direct = {canonicalize_name(Requirement(text).name) for text in PROJECT["dependencies"]}
    names = closure()
    parents = {
        name: sorted(
            parent
            for parent in names
            if name in {canonicalize_name(one.name) for one in requirements(parent)}
        )
        for name in names.keys() - direct
    }
    listed = {row[0]: row[2].split(", ") for row in rows("Required indirectly")}
    assert listed == parents


def test_the_page_has_the_licences_of_the_installed_metadata():
    listed = {Requirement(row[0].strip("`")).name: row[1] for row in rows("Required directly")}
    listed |= {row[0]: row[1] for row in rows("Required indirectly")}
    installed = {name: licence(found) for name, found in closure().items()}
    assert {canonicalize_name(name): text for name, text in listed.items()} == installed


def test_every_requirement_is_met_by_what_is_installed():
    names = ["sysmlc", *closure()]
    unmet = [
        f"{name} requires {requirement}"
        for name in names
        for requirement in requirements(name)
        if not requirement.specifier.contains(distribution(requirement.name).version, True)
    ]
    assert unmet == []


def test_no_other_distribution_runs_code_at_every_start_of_python():
    found = {
        name: [
            str(path)
            for path in installed.files or ()
            if path.suffix == ".pth" or path.stem in ("sitecustomize", "usercustomize")
        ]
        for name, installed in closure().items()
    }
    assert {name: files for name, files in found.items() if files} == STARTUP_FILES
    for (file,) in STARTUP_FILES.values():
        assert f"`{file}`" in PAGE


def test_ecore_works_without_the_distribution_that_only_pyecore_asks_for(tmp_path):
    code = (
        "import sys; sys.modules['future_fstrings'] = None; sys.argv[0] = 'sysmlc'\n"
        "from sysmlc.cli import main; sys.exit(main())"
    )
    model = str(ROOT / "examples/baygate-behaviour/baygate-behaviour.uml")
    run = [sys.executable, "-c", code, model, "--emit", "ecore", "-o", str(tmp_path / "out")]
    done = subprocess.run(run, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert list((tmp_path / "out").rglob("*.xmi"))
