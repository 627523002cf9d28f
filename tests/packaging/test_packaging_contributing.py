"""The plug-in in CONTRIBUTING works: it is installed, and its back end, pass and rules are used."""

import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from documentation import read_block

ROOT = Path(__file__).parents[2]


DOCUMENTED_FILES = [
    "tests/plugin/pyproject.toml",
    "tests/plugin/sysmlc_outline/__init__.py",
    "tests/plugin/sysmlc_outline/ACME001.md",
    "tests/plugin/sysmlc_stateless/__init__.py",
    "tests/plugin/sysmlc_stateless/ACME002.md",
]


@pytest.mark.parametrize("path", DOCUMENTED_FILES)
def test_the_documented_files_are_the_files_of_the_plug_in(path):
    assert read_block("CONTRIBUTING.md", path) == (ROOT / path).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def plugin(tmp_path_factory):
    """Environment variables with which Python finds the installed plug-in."""
    folder = tmp_path_factory.mktemp("plugin")
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    options = ["--no-deps", "--no-build-isolation", "--target", str(folder)]
    subprocess.run([*pip, *options, str(ROOT / "tests/plugin")], check=True)
    return {**os.environ, "PYTHONPATH": str(folder)}


def run_sysmlc(env, folder, *args):
    run = [sys.executable, "-m", "sysmlc", *args]
    return subprocess.run(run, env=env, cwd=folder, capture_output=True, text=True)


@pytest.mark.slow
def test_the_back_end_is_listed_emitted_and_explained(plugin, tmp_path):
    (tmp_path / "plant.ir").write_text(
        'Package p "Plant"\n  Class gate "Gate"\n    Port gate.in "in"\n  Class lamp "Lamp"\n'
    )
    assert "outline" in run_sysmlc(plugin, tmp_path, "backends").stdout
    result = run_sysmlc(plugin, tmp_path, "plant.ir", "--emit", "outline", "--format", "concise")
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out/outlines/Plant.Gate.md").read_text() == "# Gate\n\n- in\n"
    assert "warning[ACME001 outline-without-ports]: block 'Lamp' has no ports to outline" in (
        result.stderr
    )
    explanation = run_sysmlc(plugin, tmp_path, "explain", "outline-without-ports")
    assert explanation.stdout.startswith("ACME001 outline-without-ports (warning)")
    assert "Why:\n  An outline without ports says nothing" in explanation.stdout


@pytest.mark.slow
def test_a_plug_in_that_cannot_be_loaded_is_a_warning(plugin, tmp_path):
    broken = Path(plugin["PYTHONPATH"]) / "sysmlc_outline/__init__.py"
    source = broken.read_text()
    broken.write_text("import no_such_module\n")
    try:
        listing = run_sysmlc(plugin, tmp_path, "backends")
        (tmp_path / "plant.ir").write_text('Class gate "Gate"\n')
        check = run_sysmlc(plugin, tmp_path, "build", "plant.ir")
    finally:
        broken.write_text(source)
    warning = "back end 'outline' cannot be loaded: ModuleNotFoundError"
    assert listing.stderr.startswith(f"sysmlc: warning: {warning}")
    assert check.stderr.startswith(f"warning[SM914 plug-in-ignored]: {warning}")
    for result in (listing, check):
        assert result.returncode == 0
        assert "Traceback" not in result.stderr


@pytest.mark.slow
def test_the_rule_is_reported_and_explained(plugin, tmp_path):
    (tmp_path / "plant.ir").write_text('StateMachine gripper "Gripper"\n')
    result = run_sysmlc(plugin, tmp_path, "check", "plant.ir", "--format", "concise")
    message = "warning[ACME002 stateless-machine]: state machine 'Gripper' has no states"
    assert message in result.stderr
    explanation = run_sysmlc(plugin, tmp_path, "explain", "stateless-machine").stdout
    assert explanation.startswith("ACME002 stateless-machine (warning)")
    assert "Its contract would allow everything." in explanation
    assert "ACME002" in run_sysmlc(plugin, tmp_path, "explain").stdout


@pytest.mark.slow
def test_the_rule_can_be_switched_off(plugin, tmp_path):
    (tmp_path / "plant.ir").write_text('StateMachine gripper "Gripper"\n')
    (tmp_path / "sysmlc.toml").write_text('[rules]\nstateless-machine = "off"\n')
    result = run_sysmlc(plugin, tmp_path, "check", "plant.ir", "--format", "concise")
    assert "ACME002" not in result.stderr


def test_the_documented_tests_of_the_rule_pass(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "tests/plugin")
    names: dict[str, object] = {"__name__": "contributing"}
    exec(compile(read_block("CONTRIBUTING.md", "rule test"), "rule test", "exec"), names)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    assert len(tests) == 2
    for test in tests:
        test()
    monkeypatch.delitem(sys.modules, "sysmlc_stateless")
    catalogue = import_module("sysmlc.diagnostics.rule")
    catalogue._rules.pop("ACME002")
    catalogue._names.discard("stateless-machine")
