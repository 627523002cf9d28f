"""CPU seconds of whole processes that compile SysML v2, start-up and reading of the cache included.

The cache is one of its own. Before each round one line of a file is edited: what is written is
something else (a package or a step more), a number, or a note only, which changes no words.
"""

import os
import re
import resource
import shutil
import subprocess
import sysconfig
from collections.abc import Callable
from itertools import count
from pathlib import Path

_LEVELS = """\
[recipe.levels]
recipe = "RecipePrimitives::Recipe"
task = "RecipePrimitives::Task"
machine-service = "RecipePrimitives::MachineService"
machine = "ISA95EquipmentHierarchy::ProductionEquipment"
opc-ua-call = "OpcUaBinding::OpcUaMethod"
"""
ALONE = "package P { part def Cell { part arm : Robot; } part def Robot; }\n"
WITH_LIBRARY = """\
package P {
    private import ISQ::*;
    private import SI::*;
    private import ScalarValues::*;
    part def Cell {
        attribute load :> ISQ::mass = 10 [kg];
        attribute count : Integer = 3;
        action serve { in speed : Real; }
    }
}
"""
_number = count()
_VALUE = re.compile(r"(?<= := )\d+(?=;)")
_COMPARED = re.compile(r"(?<=== )(?:true|false)\b")
_TURNED = {"true": "false", "false": "true"}
Edit = Callable[[str], str]


def note(text: str) -> str:
    """A note at the end of the first line; all that follows stands one line further down."""
    return text.replace("\n", f" // note {next(_number)}\n\n", 1)


def number(text: str) -> str:
    """Another number for the first one that something is set to."""
    return _VALUE.sub(str(1000 + next(_number)), text, count=1)


def guard(text: str) -> str:
    """A comparison with true or false, turned round: another one each time."""
    found = list(_COMPARED.finditer(text))
    one = found[next(_number) % len(found)]
    return text[: one.start()] + _TURNED[one[0]] + text[one.end() :]


def step(text: str) -> str:
    """One more step before the end of the first action."""
    return text.replace("then done;", f"then action more{next(_number)}; then done;", 1)


def package(text: str) -> str:
    """One more package at the end."""
    return f"{text}package Edited{next(_number)};\n"


def seconds(command: list[str], folder: Path) -> float:
    """CPU time, user and system, of one process with a cache in ``folder``."""
    environment = {**os.environ, "SYSMLC_CACHE": str(folder / "cache")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=False, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def edited(
    file: Path, arguments: list[str], folder: Path, rounds: int, *edits: Edit
) -> list[float]:
    """The first time, with an empty cache; for each edit of ``file`` the least of ``rounds``."""
    shutil.rmtree(folder / "cache", ignore_errors=True)
    command = [str(Path(sysconfig.get_path("scripts")) / "sysmlc"), *arguments]
    first = seconds(command, folder)
    return [first, *(min(_after(edit, file, command, folder, rounds)) for edit in edits)]


def _after(edit: Edit, file: Path, command: list[str], folder: Path, rounds: int) -> list[float]:
    found = []
    for _ in range(rounds):
        before = file.read_text("utf-8")
        after = edit(before)
        assert after != before
        file.write_text(after, "utf-8")
        found.append(seconds(command, folder))
    return found


def text(folder: Path, content: str, rounds: int) -> list[float]:
    """``sysmlc check`` of one file with that content."""
    path = folder / "model.sysml"
    path.write_text(content, "utf-8")
    return edited(path, ["check", str(path)], folder, rounds, package)


def laboratory(corpus: Path, folder: Path, rounds: int) -> list[float]:
    """``sysmlc`` of a copy of the ICE laboratory: the first time, a note, number, guard, step."""
    unit = folder / "ice"
    shutil.copytree(corpus / "sysml2" / "ice-lab", unit)
    (unit / "sysmlc.toml").write_text(_LEVELS, "utf-8")
    file = unit / "services" / "conveyor.sysml"
    arguments = [str(unit), "-o", str(folder / "out")]
    return edited(file, arguments, folder, rounds, note, number, guard, step)


def gather(corpus: Path, folder: Path) -> Path:
    """A copy of all training and example files."""
    unit = folder / "official"
    for name in ("training", "examples"):
        shutil.copytree(corpus / "sysml2" / "omg-release" / name, unit / name)
    return unit


def official(unit: Path, folder: Path, rounds: int) -> list[float]:
    """``sysmlc check`` of these files as one unit: the first time, a note, a package."""
    file = min(unit.rglob("*.sysml"))
    return edited(file, ["check", str(unit)], folder, rounds, note, package)
