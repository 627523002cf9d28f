"""CPU seconds of whole processes that compile SysML v2 without a cache, start-up included."""

import re
import shutil
from collections.abc import Callable
from itertools import count
from pathlib import Path

from measuring import SYSMLC, measure_command

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
"""Numbers that make every edit differ from the edits before."""
_PACKAGE = re.compile(r"^package (\w+)", re.MULTILINE)
_SERVICES = "services/conveyor.sysml"
_VALUE = re.compile(r"(?<= := )\d+(?=;)")
_STEP = re.compile(r"callReleasePallet\d*")
Edit = Callable[[str], str]


def _change_number(text: str) -> str:
    return _VALUE.sub(str(1000 + next(_number)), text, count=1)


def _rename_step(text: str) -> str:
    return _STEP.sub(f"callReleasePallet{next(_number)}", text, count=1)


def _add_part(text: str) -> str:
    connection = "connect cell1"
    part = f"part spare{next(_number)} : WorkCell;"
    return text.replace(connection, f"{part} {connection}", 1)


EDITS: dict[str, tuple[str, Edit]] = {
    "a number changed": (_SERVICES, _change_number),
    "a step renamed": (_SERVICES, _rename_step),
    "a part added": ("plant/ice_lab.sysml", _add_part),
}
"""File and function of each edit of one line of the ICE laboratory."""


def measure_sysmlc(arguments: list[str], rounds: int) -> float:
    """Return the least CPU time of several processes of ``sysmlc`` without a cache."""
    command = [SYSMLC, *arguments, "--no-cache"]
    return min(measure_command(command, is_checked=False) for _ in range(rounds))


def measure_check(folder: Path, content: str, rounds: int) -> float:
    """Return the CPU time of ``sysmlc check`` of one file with this content."""
    path = folder / "model.sysml"
    path.write_text(content, "utf-8")
    return measure_sysmlc(["check", str(path)], rounds)


def measure_laboratory(corpus: Path, folder: Path, rounds: int) -> float:
    """Return the CPU time of ``sysmlc build`` of the ICE laboratory."""
    unit = copy_laboratory(corpus, folder / "ice")
    return measure_sysmlc(["build", str(unit), "-o", str(folder / "out")], rounds)


def copy_laboratory(corpus: Path, unit: Path) -> Path:
    """Copy the ICE laboratory, with a configuration of its recipe levels, and return the copy."""
    shutil.copytree(corpus / "sysml2" / "ice-lab", unit)
    (unit / "sysmlc.toml").write_text(_LEVELS, "utf-8")
    return unit


def copy_official_files(corpus: Path, folder: Path) -> Path:
    """Copy all training and example files to one folder, and return it."""
    unit = folder / "official"
    for name in ("training", "examples"):
        shutil.copytree(corpus / "sysml2" / "omg-release" / name, unit / name)
    return unit


def copy_laboratories(corpus: Path, unit: Path, count: int) -> Path:
    """Write copies of the ICE laboratory whose packages have a number each, as one compile unit."""
    paths = sorted((corpus / "sysml2" / "ice-lab").rglob("*.sysml"))
    texts = {path: path.read_text("utf-8") for path in paths}
    packages = {name for text in texts.values() for name in _PACKAGE.findall(text)}
    name = re.compile(rf"\b({'|'.join(sorted(packages))})\b")
    for number in range(count):
        for path, text in texts.items():
            target = unit / f"copy{number}" / path.relative_to(corpus / "sysml2" / "ice-lab")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(name.sub(rf"\g<1>{number}", text), "utf-8")
    return unit
