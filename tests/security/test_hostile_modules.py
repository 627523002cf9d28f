"""``python -m sysmlc`` in a folder whose files have the names of modules of the standard library.

Python searches the working folder first. ``__main__`` removes it, so that a foreign ``typing.py``
is not imported. Only what Python itself imports before it runs a module can be replaced;
docs/untrusted-repositories.md lists these modules.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

DOCUMENTATION = Path(__file__).parents[2] / "docs/untrusted-repositories.md"
HOSTILE_MODULE = """\
import sys
with open({log!r}, "a") as log:
    log.write(__name__ + "\\n")
# Become the real module, so that the start goes on and shows the next hostile import.
_finder = sys.modules["_frozen_importlib_external"].PathFinder
_spec = _finder.find_spec(__name__, [path for path in sys.path if path not in ("", {folder!r})])
if _spec.submodule_search_locations is not None:
    __path__, __package__ = _spec.submodule_search_locations, __name__
__spec__, __file__ = _spec, _spec.origin
_spec.loader.exec_module(sys.modules[__name__])
"""
LIST_MODULES = """\
import json, sys
from sysmlc.cli.group import sysmlc
try:
    sysmlc({arguments!r}, standalone_mode=False)
except SystemExit:
    pass
names = {{name.partition(".")[0] for name in sys.modules}} & sys.stdlib_module_names
print(json.dumps(sorted(names - set(sys.builtin_module_names))))
"""
COMMANDS = [
    ["--version"],
    ["build", "plant.ir", "-o", "out"],
    ["format", "--check", "plant.sysml"],
]


def run_python(*arguments: str) -> str:
    environment = {**os.environ, "SYSMLC_CACHE": "off"}
    command = [sys.executable, *arguments]
    result = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return result.stdout


def list_imported_modules(arguments: list[str]) -> list[str]:
    """Return the modules of the standard library that a command imports."""
    output = run_python("-P", "-c", LIST_MODULES.format(arguments=arguments))
    names = json.loads(output.splitlines()[-1])
    assert {"typing", "contextlib", "importlib", "json"} <= set(names)
    return names


def list_hijacked_modules(project, *arguments: str) -> set[str]:
    """Return the modules that a run of Python takes from the working folder."""
    log = project.outside / "log"
    log.write_text("")
    run_python(*arguments)
    return set(log.read_text().split())


@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: arguments[0])
def test_no_module_of_the_working_folder_is_imported(arguments, project, monkeypatch):
    project.write("plant.sysml", "package P;\n")
    names = list_imported_modules(arguments)
    # A module that imports nothing shows what Python imports before it runs any module.
    project.write("../outside/innocent/innocent.py", "")
    monkeypatch.setenv("PYTHONPATH", str(project.outside / "innocent"))
    for name in names:
        text = HOSTILE_MODULE.format(log=str(project.outside / "log"), folder=str(project.folder))
        project.write(f"{name}.py", text)
    by_python = list_hijacked_modules(project, "-m", "innocent")
    assert "importlib" in by_python  # the hostile files work
    assert list_hijacked_modules(project, "-m", "sysmlc", *arguments) == by_python
    assert list_hijacked_modules(project, "-P", "-m", "sysmlc", *arguments) == set()
    (sentence,) = re.findall(r"Python itself imports[^.]*\.", DOCUMENTATION.read_text())
    assert by_python <= set(re.findall(r"`(\w+)`", sentence))


def test_a_working_folder_that_was_deleted_is_one_message(tmp_path, monkeypatch):
    folder = tmp_path / "deleted"
    folder.mkdir()
    monkeypatch.chdir(folder)
    folder.rmdir()
    command = [sys.executable, "-m", "sysmlc", "check", "plant.ir"]
    result = subprocess.run(command, capture_output=True, text=True)
    assert (result.returncode, "Traceback" in result.stderr) == (2, False)
    assert "No such file or directory" in result.stderr
