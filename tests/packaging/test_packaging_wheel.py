"""What is shipped: the wheel compiles an example in an empty environment, from another folder."""

import subprocess
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_PAGES = {path.name for path in (ROOT / "compiler/sysmlc/diagnostics/rules").glob("*.md")}
pytestmark = pytest.mark.slow


def test_the_wheel_carries_data_licence_and_types(dist):
    (wheel,) = dist.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    for folder in ("grammars", "metamodels", "templates"):
        found = (path for path in (ROOT / folder).rglob("*") if path.is_file())
        shipped = [path for path in found if path.parent.name != "__pycache__"]
        expected = {f"sysmlc/{path.relative_to(ROOT).as_posix()}" for path in shipped}
        assert expected <= set(names)
    assert "sysmlc/py.typed" in names
    for language in ("kerml", "sysml"):
        assert f"sysmlc/language/text/generated/{language}.tables" in names
    assert {name.removeprefix("sysmlc/diagnostics/rules/") for name in names} >= _PAGES
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert not [name for name in names if name.startswith(("tests", "compiler"))]
    assert not [name for name in names if name.endswith(".pth")]


def test_the_source_distribution_has_what_the_tests_need(dist):
    (archive,) = dist.glob("*.tar.gz")
    with tarfile.open(archive) as opened:
        names = {name.partition("/")[2] for name in opened.getnames()}
    assert {"LICENSE", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "Makefile"} <= names
    assert {"compiler/hatch_build.py", "grammars/sysml.lark"} <= names
    assert {name.removeprefix("compiler/sysmlc/diagnostics/rules/") for name in names} >= _PAGES
    assert {"tests/conftest.py", "examples/lego-recipe/lego-recipe.uml"} <= names


@pytest.mark.long
def test_installed_in_an_empty_environment_it_compiles_an_example(environment, tmp_path):
    model = ROOT / "examples/lego-recipe/lego-recipe.uml"
    run = [environment.python, "-m", "sysmlc", str(model), "-o", "out"]
    env = environment.variables()
    done = subprocess.run(run, capture_output=True, text=True, cwd=tmp_path, env=env)
    assert done.returncode == 0, done.stderr
    made = {path.relative_to(tmp_path / "out").parts[0] for path in (tmp_path / "out").rglob("*")}
    assert {"contracts", "recipes", "diagrams", "manifest.json", "trace.json"} <= made
    where = [environment.python, "-c", "import sysmlc; print(sysmlc.__file__)"]
    printed = subprocess.run(where, capture_output=True, text=True, cwd=tmp_path, env=env).stdout
    assert str(environment.folder) in printed
