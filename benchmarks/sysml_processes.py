"""CPU seconds of whole processes that compile SysML v2 without a cache, start-up included."""

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
_SERVICES = "services/conveyor.sysml"
_VALUE = re.compile(r"(?<= := )\d+(?=;)")
_STEP = re.compile(r"callReleasePallet\d*")
Edit = Callable[[str], str]


def _change_number(text: str) -> str:
    return _VALUE.sub(str(1000 + next(_number)), text, count=1)


def _rename_step(text: str) -> str:
    return _STEP.sub(f"callReleasePallet{next(_number)}", text, count=1)


def _add_part(text: str) -> str:
    mark = "connect cell1"
    return text.replace(mark, f"part spare{next(_number)} : WorkCell; {mark}", 1)


LABORATORY: dict[str, tuple[str, Edit]] = {
    "a number": (_SERVICES, _change_number),
    "a step renamed": (_SERVICES, _rename_step),
    "a part more": ("plant/ice_lab.sysml", _add_part),
}
"""Edits of one line of the ICE laboratory: in which file, and how."""


def measure(arguments: list[str], rounds: int) -> float:
    """CPU time, user and system, of one process; the least of ``rounds``."""
    command = [str(Path(sysconfig.get_path("scripts")) / "sysmlc"), *arguments, "--no-cache"]
    return min(_run(command) for _ in range(rounds))


def _run(command: list[str]) -> float:
    environment = {**os.environ}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=False, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def text(folder: Path, content: str, rounds: int) -> float:
    """``sysmlc check`` of one file with that content."""
    path = folder / "model.sysml"
    path.write_text(content, "utf-8")
    return measure(["check", str(path)], rounds)


def copied(corpus: Path, unit: Path) -> Path:
    """A copy of the ICE laboratory with the names of its levels."""
    shutil.copytree(corpus / "sysml2" / "ice-lab", unit)
    (unit / "sysmlc.toml").write_text(_LEVELS, "utf-8")
    return unit


def laboratory(corpus: Path, folder: Path, rounds: int) -> float:
    """``sysmlc`` of a copy of the ICE laboratory."""
    unit = copied(corpus, folder / "ice")
    return measure(["build", str(unit), "-o", str(folder / "out")], rounds)


def gather(corpus: Path, folder: Path) -> Path:
    """A copy of all training and example files."""
    unit = folder / "official"
    for name in ("training", "examples"):
        shutil.copytree(corpus / "sysml2" / "omg-release" / name, unit / name)
    return unit
