"""The contents of the distributions, and a compilation with the installed wheel."""

import subprocess
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_PAGES = {path.name for path in (ROOT / "compiler/sysmlc/diagnostics/rules").glob("*.md")}
pytestmark = pytest.mark.slow


def test_the_wheel_contains_data_licence_and_types(dist):
    (wheel,) = dist.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    for folder in ("grammars", "metamodels", "templates"):
        paths = (path for path in (ROOT / folder).rglob("*") if path.is_file())
        shipped = [path for path in paths if path.parent.name != "__pycache__"]
        expected = {f"sysmlc/{path.relative_to(ROOT).as_posix()}" for path in shipped}
        assert expected <= set(names)
    assert "sysmlc/py.typed" in names
    for language in ("kerml", "sysml"):
        assert f"sysmlc/language/text/generated/{language}.tables" in names
    assert {name.removeprefix("sysmlc/diagnostics/rules/") for name in names} >= _PAGES
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert not [name for name in names if name.startswith(("tests", "compiler"))]
    assert not [name for name in names if name.endswith(".pth")]


def test_the_source_distribution_contains_the_files_of_the_tests(dist):
    (archive,) = dist.glob("*.tar.gz")
    with tarfile.open(archive) as source_archive:
        names = {name.partition("/")[2] for name in source_archive.getnames()}
    assert {"LICENSE", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "Makefile"} <= names
    assert {"compiler/hatch_build.py", "grammars/sysml.lark"} <= names
    assert {name.removeprefix("compiler/sysmlc/diagnostics/rules/") for name in names} >= _PAGES
    assert {"tests/conftest.py", "examples/lego-recipe/lego-recipe.uml"} <= names


@pytest.mark.long
def test_the_wheel_compiles_an_example_in_an_empty_environment(environment, tmp_path):
    model = ROOT / "examples/lego-recipe/lego-recipe.uml"
    run = [environment.python, "-m", "sysmlc", str(model), "-o", "out"]
    env = environment.variables()
    result = subprocess.run(run, capture_output=True, text=True, cwd=tmp_path, env=env)
    assert result.returncode == 0, result.stderr
    outputs = {
        path.relative_to(tmp_path / "out").parts[0] for path in (tmp_path / "out").rglob("*")
    }
    assert {"contracts", "recipes", "diagrams", "manifest.json", "trace.json"} <= outputs
    command = [environment.python, "-c", "import sysmlc; print(sysmlc.__file__)"]
    location = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=env).stdout
    assert str(environment.folder) in location
