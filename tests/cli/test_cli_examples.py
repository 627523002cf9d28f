"""The example lego-recipe, compiled by ``python -m sysmlc`` in a process of its own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LEGO = ROOT / "examples/lego-recipe/lego-recipe.uml"


def run_sysmlc(folder, *args, **env):
    run = [sys.executable, "-m", "sysmlc", *map(str, args)]
    return subprocess.run(
        run, cwd=folder, env={**os.environ, **env}, capture_output=True, text=True
    )


def read_files(folder):
    return {
        path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()
    }


def test_outputs_depend_neither_on_the_hash_seed_nor_on_the_folder(tmp_path):
    copy = tmp_path / "elsewhere" / "lego-recipe.uml"
    copy.parent.mkdir()
    copy.write_bytes(LEGO.read_bytes())
    emit = ("--emit", "+graph,+ir,+ecore,+aml,+uml,+sysml")
    first = run_sysmlc(tmp_path, LEGO, "-o", "a", *emit, PYTHONHASHSEED="1")
    assert first.returncode == 0, first.stderr
    second = run_sysmlc(tmp_path, copy, "-o", "b", *emit, PYTHONHASHSEED="2")
    assert second.returncode == 0
    assert {"contracts", "diagrams", "recipes", "aml", "uml", "sysml"} <= {
        path.name for path in (tmp_path / "a").iterdir()
    }
    assert read_files(tmp_path / "a") == read_files(tmp_path / "b")


def test_no_output_contains_a_path_of_this_machine(tmp_path):
    run_sysmlc(tmp_path, LEGO, "-o", "out")
    for path, data in read_files(tmp_path / "out").items():
        assert str(ROOT).encode() not in data, path
        assert str(tmp_path).encode() not in data, path


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (LEGO.read_bytes()[:5000], 1),
        (b'<!DOCTYPE x [<!ENTITY e "e">]>' + LEGO.read_bytes(), 1),
        (b"not a model", 1),
        (None, 2),
    ],
    ids=["cut off", "DOCTYPE", "no model", "missing"],
)
def test_a_damaged_input_is_a_diagnostic_and_not_a_traceback(tmp_path, content, code):
    if content is not None:
        (tmp_path / "model.uml").write_bytes(content)
    result = run_sysmlc(tmp_path, "model.uml", "-o", "out")
    assert result.returncode == code
    assert result.stderr.startswith("error[SM1")
    assert "Traceback" not in result.stderr


def test_a_closed_pipe_is_not_reported(tmp_path):
    run = f"{sys.executable} -m sysmlc show {LEGO} | head -n 1"
    result = subprocess.run(run, shell=True, cwd=tmp_path, capture_output=True, text=True)
    assert result.stdout.startswith("Package ")
    assert "fault of sysmlc" not in result.stderr
