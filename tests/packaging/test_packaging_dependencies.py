"""The distributions that sysmlc depends on are those in docs/dependencies.md."""

import re
import subprocess
import sys
import tomllib
from functools import cache
from importlib.metadata import Distribution, distribution
from pathlib import Path

from documentation import read_block
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from sysmlc import compile_model

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
"""SPDX identifiers of licences that metadata states in another form."""


@cache
def list_requirements(name: str) -> tuple[Requirement, ...]:
    """Return the requirements of a distribution on this platform, without extras."""
    declared = [Requirement(text) for text in distribution(name).requires or ()]
    return tuple(
        requirement
        for requirement in declared
        if not requirement.marker or requirement.marker.evaluate({"extra": ""})
    )


def find_dependencies() -> dict[str, Distribution]:
    """Return all distributions that sysmlc needs, directly or not, without sysmlc itself."""
    names, pending = {}, [Requirement(text) for text in PROJECT["dependencies"]]
    while pending:
        name = canonicalize_name(pending.pop().name)
        if name not in names:
            names[name] = distribution(name)
            pending += list_requirements(name)
    return names


def read_licence(installed: Distribution) -> str:
    """Return the licence that the metadata of a distribution states."""
    metadata = installed.metadata
    classifiers = [text for text in metadata.get_all("Classifier") or () if "License ::" in text]
    licence_text = metadata.get("License-Expression") or metadata.get("License")
    licence_text = licence_text or classifiers[0].rpartition(" :: ")[2]
    return SPDX.get(licence_text, licence_text)


def read_table(heading: str) -> list[list[str]]:
    """Return the cells of the table below a heading of the page."""
    (section,) = re.findall(rf"^## {heading}\n(.*?)(?=^## )", PAGE, re.DOTALL | re.MULTILINE)
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1:]]


def test_the_page_lists_the_direct_requirements_of_the_project():
    direct = read_table("Required directly")
    assert [row[0].strip("`") for row in direct] == PROJECT["dependencies"]
    with_upper_bound = [row[0] for row in direct if "<" in row[0]]
    assert with_upper_bound == [row[0] for row in direct if row[3]]


def test_the_page_lists_all_other_distributions_and_what_requires_them():
    direct = {canonicalize_name(Requirement(text).name) for text in PROJECT["dependencies"]}
    names = find_dependencies()
    parents = {
        name: sorted(
            parent
            for parent in names
            if name
            in {canonicalize_name(requirement.name) for requirement in list_requirements(parent)}
        )
        for name in names.keys() - direct
    }
    listed = {row[0]: row[2].split(", ") for row in read_table("Required indirectly")}
    assert listed == parents


def test_the_page_has_the_licences_in_the_metadata():
    listed = {
        Requirement(row[0].strip("`")).name: row[1] for row in read_table("Required directly")
    }
    listed |= {row[0]: row[1] for row in read_table("Required indirectly")}
    installed = {name: read_licence(dependency) for name, dependency in find_dependencies().items()}
    assert {canonicalize_name(name): text for name, text in listed.items()} == installed


def test_installed_distributions_meet_every_requirement():
    names = ["sysmlc", *find_dependencies()]
    unmet = [
        f"{name} requires {requirement}"
        for name in names
        for requirement in list_requirements(name)
        if not requirement.specifier.contains(distribution(requirement.name).version, True)
    ]
    assert unmet == []


def test_only_documented_distributions_run_code_at_every_start_of_python():
    startup_files = {
        name: [
            str(path)
            for path in installed.files or ()
            if path.suffix == ".pth" or path.stem in ("sitecustomize", "usercustomize")
        ]
        for name, installed in find_dependencies().items()
    }
    assert {name: files for name, files in startup_files.items() if files} == STARTUP_FILES
    for (file,) in STARTUP_FILES.values():
        assert f"`{file}`" in PAGE


def test_the_documented_program_loads_the_graph_without_future_fstrings(tmp_path):
    model = ROOT / "examples/lego-recipe/lego-recipe.uml"
    (artefact,) = compile_model(model, emit=["ecore"]).artefacts
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / artefact.path).write_text(artefact.text, encoding="utf-8")
    program = "import sys; sys.modules['future_fstrings'] = None\n"
    program += read_block("docs/look-inside.md", "example: ecore")
    run = [sys.executable, "-c", program]
    result = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True)
    assert "handOver ['StackPassage']" in result.stdout.splitlines(), result.stderr
