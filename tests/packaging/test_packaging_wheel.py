"""What is shipped: the wheel compiles an example in an empty environment, from another folder."""

import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def dist(tmp_path_factory):
    """A folder with the source distribution and the wheel that was built from it."""
    folder = tmp_path_factory.mktemp("dist")
    run = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    done = subprocess.run(run, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


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
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert not [name for name in names if name.startswith(("tests", "compiler"))]


def test_the_source_distribution_has_what_the_tests_need(dist):
    (archive,) = dist.glob("*.tar.gz")
    with tarfile.open(archive) as opened:
        names = {name.partition("/")[2] for name in opened.getnames()}
    assert {"LICENSE", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "Makefile"} <= names
    assert {"compiler/hatch_build.py", "grammars/sysml.lark"} <= names
    assert {"tests/conftest.py", "examples/lego-recipe/lego-recipe.uml"} <= names


def test_installed_in_an_empty_environment_it_compiles_an_example(dist, tmp_path):
    (wheel,) = dist.glob("*.whl")
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "env")], check=True)
    python = next((tmp_path / "env").glob("[bS]*/python*"))
    env = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, str(wheel)], check=True, env=env)
    model = ROOT / "examples/lego-recipe/lego-recipe.uml"
    run = [str(python), "-m", "sysmlc", str(model), "-o", "out"]
    done = subprocess.run(run, capture_output=True, text=True, cwd=tmp_path, env=env)
    assert done.returncode == 0, done.stderr
    made = {path.relative_to(tmp_path / "out").parts[0] for path in (tmp_path / "out").rglob("*")}
    assert {"contracts", "recipes", "diagrams", "manifest.json", "trace.json"} <= made
    where = [str(python), "-c", "import sysmlc; print(sysmlc.__file__)"]
    printed = subprocess.run(where, capture_output=True, text=True, cwd=tmp_path, env=env).stdout
    assert str(tmp_path) in printed
