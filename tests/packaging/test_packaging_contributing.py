"""What CONTRIBUTING shows works: the plug-in is installed; back end, pass and rule are tried."""

import os
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def block(title: str) -> str:
    """The code below the comment with this title."""
    pattern = rf"<!-- {re.escape(title)} -->\n(```+)\w+\n(.*?)\1\n"
    found = re.search(pattern, TEXT, re.DOTALL)
    assert found, title
    return found[2]


SHOWN = [
    "tests/plugin/sysmlc_outline/__init__.py",
    "tests/plugin/sysmlc_outline/SM949.md",
    "tests/plugin/sysmlc_stateless/__init__.py",
    "tests/plugin/sysmlc_stateless/SM948.md",
]


@pytest.mark.parametrize("path", SHOWN)
def test_the_files_shown_are_those_that_are_tested(path):
    assert block(path) == (ROOT / path).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "entry", ['outline = "sysmlc_outline:BACKEND"', 'statelessness = "sysmlc_stateless:PASS"']
)
def test_the_entry_points_shown_are_those_that_are_tested(entry):
    assert entry in (ROOT / "tests/plugin/pyproject.toml").read_text(encoding="utf-8")
    assert entry in TEXT


@pytest.fixture(scope="module")
def plugin(tmp_path_factory):
    """An environment in which the plug-in is installed beside sysmlc."""
    folder = tmp_path_factory.mktemp("plugin")
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    options = ["--no-deps", "--no-build-isolation", "--target", str(folder)]
    subprocess.run([*pip, *options, str(ROOT / "tests/plugin")], check=True)
    return {**os.environ, "PYTHONPATH": str(folder)}


def sysmlc(env, folder, *args):
    run = [sys.executable, "-m", "sysmlc", *args]
    return subprocess.run(run, env=env, cwd=folder, capture_output=True, text=True)


@pytest.mark.slow
def test_the_back_end_is_listed_emitted_and_explained(plugin, tmp_path):
    (tmp_path / "plant.ir").write_text(
        'Package p "Plant"\n  Class gate "Gate"\n    Port gate.in "in"\n  Class lamp "Lamp"\n'
    )
    assert "outline" in sysmlc(plugin, tmp_path, "backends").stdout
    done = sysmlc(plugin, tmp_path, "plant.ir", "--emit", "outline", "--format", "concise")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/outlines/Plant.Gate.md").read_text() == "# Gate\n\n- in\n"
    assert "warning[SM949 outline-without-ports]: block 'Lamp' has no ports to outline" in (
        done.stderr
    )
    explained = sysmlc(plugin, tmp_path, "explain", "outline-without-ports")
    assert explained.stdout.startswith("SM949 outline-without-ports (warning)")
    assert "Why:\n  An outline without ports says nothing" in explained.stdout


@pytest.mark.slow
def test_a_plug_in_that_cannot_be_loaded_is_one_sentence(plugin, tmp_path):
    broken = Path(plugin["PYTHONPATH"]) / "sysmlc_outline/__init__.py"
    whole = broken.read_text()
    broken.write_text("import no_such_module\n")
    try:
        done = sysmlc(plugin, tmp_path, "backends")
    finally:
        broken.write_text(whole)
    assert done.returncode == 2
    assert "back end 'outline' cannot be loaded: ModuleNotFoundError" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_the_rule_is_reported_and_explained(plugin, tmp_path):
    (tmp_path / "plant.ir").write_text('StateMachine gripper "Gripper"\n')
    done = sysmlc(plugin, tmp_path, "check", "plant.ir", "--format", "concise")
    assert "warning[SM948 stateless-machine]: state machine 'Gripper' has no states" in done.stderr
    explained = sysmlc(plugin, tmp_path, "explain", "stateless-machine").stdout
    assert explained.startswith("SM948 stateless-machine (warning)")
    assert "Its contract would allow everything." in explained
    assert "SM948" in sysmlc(plugin, tmp_path, "explain").stdout


@pytest.mark.slow
def test_the_rule_can_be_switched_off(plugin, tmp_path):
    (tmp_path / "plant.ir").write_text('StateMachine gripper "Gripper"\n')
    (tmp_path / "sysmlc.toml").write_text('[rules]\nstateless-machine = "off"\n')
    done = sysmlc(plugin, tmp_path, "check", "plant.ir", "--format", "concise")
    assert "SM948" not in done.stderr


def test_the_rule_shown_works_and_so_do_its_tests(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "tests/plugin")
    names: dict[str, object] = {"__name__": "contributing"}
    exec(compile(block("rule test"), "rule test", "exec"), names)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    assert len(tests) == 2
    for test in tests:
        test()
    monkeypatch.delitem(sys.modules, "sysmlc_stateless")
    catalogue = import_module("sysmlc.diagnostics.rule")
    catalogue._rules.pop("SM948")
    catalogue._names.discard("stateless-machine")
