"""The shipped examples through the installed command, in processes of their own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LEGO = ROOT / "examples/lego-recipe/lego-recipe.uml"


def sysmlc(folder, *args, **env):
    run = [sys.executable, "-m", "sysmlc", *map(str, args)]
    return subprocess.run(
        run, cwd=folder, env={**os.environ, **env}, capture_output=True, text=True
    )


def contents(folder):
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_the_same_model_gives_the_same_bytes_whatever_the_hash_seed_and_the_folder(tmp_path):
    copy = tmp_path / "elsewhere" / "lego-recipe.uml"
    copy.parent.mkdir()
    copy.write_bytes(LEGO.read_bytes())
    first = sysmlc(tmp_path, LEGO, "-o", "a", "--emit", "+graph,+ir,+ecore", PYTHONHASHSEED="1")
    assert first.returncode == 0, first.stderr
    second = sysmlc(tmp_path, copy, "-o", "b", "--emit", "+graph,+ir,+ecore", PYTHONHASHSEED="2")
    assert second.returncode == 0
    assert {"contracts", "diagrams", "recipes"} <= {
        path.name for path in (tmp_path / "a").iterdir()
    }
    assert contents(tmp_path / "a") == contents(tmp_path / "b")


def test_no_output_names_a_path_of_this_machine(tmp_path):
    sysmlc(tmp_path, LEGO, "-o", "out")
    for path, data in contents(tmp_path / "out").items():
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
def test_bad_input_is_findings_and_never_a_traceback(tmp_path, content, code):
    if content is not None:
        (tmp_path / "model.uml").write_bytes(content)
    done = sysmlc(tmp_path, "model.uml", "-o", "out")
    assert done.returncode == code
    assert done.stderr.startswith("error[SM1")
    assert "Traceback" not in done.stderr


def test_a_reader_that_goes_away_is_no_fault(tmp_path):
    run = f"{sys.executable} -m sysmlc show {LEGO} | head -n 1"
    done = subprocess.run(run, shell=True, cwd=tmp_path, capture_output=True, text=True)
    assert done.stdout.startswith("Package ")
    assert "fault of sysmlc" not in done.stderr
