"""How the command line starts: version, help, imports, exceptions, progress."""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from sysmlc.cli.group import COMMANDS
from sysmlc.cli.progress import Progress

SLOW_PACKAGES = ("lxml", "networkx", "lark", "jinja2", "pyecore", "jsonschema", "ruamel")


def find_executable() -> str:
    return str(Path(sysconfig.get_path("scripts")) / "sysmlc")


def test_the_installed_command_and_the_module_print_the_version():
    for command in ([find_executable()], [sys.executable, "-m", "sysmlc"]):
        result = subprocess.run([*command, "--version"], capture_output=True, text=True, check=True)
        assert result.stdout.startswith("sysmlc 0.")


@pytest.mark.parametrize("args", [["--version"], ["--help"], ["build", "--help"]])
def test_help_and_version_import_no_slow_package(args):
    script = (
        "import sys\nfrom sysmlc.cli.group import sysmlc\n"
        f"sysmlc({args!r}, standalone_mode=False)\n"
        f"print('imported:', [m for m in {SLOW_PACKAGES!r} if m in sys.modules])"
    )
    run = [sys.executable, "-c", script]
    assert "imported: []" in subprocess.run(run, capture_output=True, text=True, check=True).stdout


def test_the_version_takes_at_most_0_15_s_of_cpu():
    resource = pytest.importorskip("resource")

    def measure_cpu_seconds() -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([find_executable(), "--version"], capture_output=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    assert min(measure_cpu_seconds() for _ in range(5)) < 0.15


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(workspace, command):
    result = workspace.sysmlc(command, "--help")
    assert result.exit_code == 0
    assert f"sysmlc {command}" in result.stdout


def test_an_exception_inside_the_compiler_is_reported_in_one_sentence(tmp_path):
    env = {**os.environ, "PYTHONPATH": str(tmp_path)}
    script = (
        "import sys, sysmlc.config\n"
        "def fails(*_): raise ZeroDivisionError('by zero')\n"
        "sysmlc.config.find_config_file = fails\n"
        "from sysmlc.cli import main\nsys.argv = ['sysmlc', 'x.uml']\nmain()"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=env)
    assert result.returncode == 2
    assert result.stderr.startswith("sysmlc: fault of sysmlc: ZeroDivisionError: by zero\n")
    assert "Traceback" not in result.stderr


# -- progress ------------------------------------------------------------------------------------


def test_progress_is_drawn_on_terminals_only_and_after_a_second(capsys, monkeypatch):
    times = iter([0.0, 0.5, 1.5, 2.0])
    progress = Progress(clock=lambda: next(times))
    progress._on_terminal = True
    progress.step("read", 0, 3)
    assert capsys.readouterr().err == ""
    progress.step("pass ports", 1, 2)
    assert "[############------------] pass ports" in capsys.readouterr().err
    piped = Progress(clock=lambda: 9.0)
    piped.step("read", 0, 3)
    assert capsys.readouterr().err == ""
