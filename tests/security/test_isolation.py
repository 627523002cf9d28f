"""``--isolated`` reads no configuration, and no command imports code of the working folder."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

FAULTY_CONFIGURATIONS = {
    "sysmlc.toml": "no = such-key",
    "pyproject.toml": '[tool.sysmlc]\noutput = "../elsewhere"\n',
}
COMMANDS = {
    "build": ["build", "plant.ir", "-o", "out"],
    "check": ["check", "plant.ir"],
    "show": ["show", "plant.ir"],
    "diff": ["diff", "plant.ir", "plant.ir"],
    "coverage": ["coverage", "plant.ir"],
    "contracts": ["contracts", "check", "plant.ir"],
    "simulate": ["simulate", "plant.ir", "--scenario", "none.yaml"],
    "synth": ["synth", "plant.ir"],
    "robots": ["robots", "plant.ir"],
}


@pytest.mark.parametrize("configuration", FAULTY_CONFIGURATIONS)
@pytest.mark.parametrize("command", COMMANDS)
def test_isolated_commands_read_no_configuration(project, command, configuration):
    expected = project.run(*COMMANDS[command])
    project.write(configuration, FAULTY_CONFIGURATIONS[configuration])
    assert configuration in project.run(*COMMANDS[command]).stderr
    result = project.run(*COMMANDS[command], "--isolated")
    assert (result.exit_code, result.stderr) == (expected.exit_code, expected.stderr)


def test_isolated_and_a_configuration_exclude_each_other(project):
    result = project.run("check", "plant.ir", "--isolated", "--config", "sysmlc.toml")
    assert result.exit_code == 2
    assert "--isolated and --config exclude each other" in result.stderr


@pytest.mark.parametrize("module", ["click.py", "json.py", "jinja2/__init__.py"])
def test_python_m_imports_no_module_of_the_working_folder(module, project):
    Path(module).parent.mkdir(exist_ok=True)
    Path(module).write_text("open('pwned', 'w')\n")
    result = run_module(project)
    assert (result.returncode, Path("pwned").exists()) == (0, False), result.stderr


def test_a_plug_in_of_the_working_folder_is_not_loaded(project):
    Path("evil-1.dist-info").mkdir()
    Path("evil-1.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: evil\nVersion: 1\n")
    Path("evil-1.dist-info/entry_points.txt").write_text("[sysmlc.backends]\nevil = evil:BACKEND\n")
    Path("evil.py").write_text("open('pwned', 'w')\n")
    result = run_module(project)
    assert (result.returncode, Path("pwned").exists()) == (0, False), result.stderr


def run_module(project):
    environment = {**os.environ, "SYSMLC_CACHE": "off"}
    command = [sys.executable, "-m", "sysmlc", "build", "plant.ir", "-o", "out"]
    return subprocess.run(
        command, cwd=project.folder, env=environment, capture_output=True, text=True
    )
