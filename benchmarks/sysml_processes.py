"""CPU seconds of whole processes that compile SysML v2, start-up and reading of the cache included.

The cache is one of its own. Before each round a remark is put at the end of the file that is
edited, so that the outcome of no earlier run is used, but what it parsed is.
"""

import os
import resource
import shutil
import subprocess
import sysconfig
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


def seconds(command: list[str], folder: Path) -> float:
    """CPU time, user and system, of one process with a cache in ``folder``."""
    environment = {**os.environ, "SYSMLC_CACHE": str(folder / "cache")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=False, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def edited(file: Path, arguments: list[str], folder: Path, rounds: int) -> tuple[float, float]:
    """The first time, with an empty cache; the least of ``rounds`` after edits of ``file``."""
    shutil.rmtree(folder / "cache", ignore_errors=True)
    command = [str(Path(sysconfig.get_path("scripts")) / "sysmlc"), *arguments]
    first = seconds(command, folder)
    return first, min(_after_edit(file, command, folder) for _ in range(rounds))


def _after_edit(file: Path, command: list[str], folder: Path) -> float:
    with file.open("a", encoding="utf-8") as text:
        text.write(f"// edit {next(_number)}\n")
    return seconds(command, folder)


def text(folder: Path, content: str, rounds: int) -> tuple[float, float]:
    """``sysmlc check`` of one file with that content."""
    path = folder / "model.sysml"
    path.write_text(content, "utf-8")
    return edited(path, ["check", str(path)], folder, rounds)


def laboratory(corpus: Path, folder: Path, rounds: int) -> tuple[float, float]:
    """``sysmlc`` of a copy of the ICE laboratory: one line of one of its files is edited."""
    unit = folder / "ice"
    shutil.copytree(corpus / "sysml2" / "ice-lab", unit)
    (unit / "sysmlc.toml").write_text(_LEVELS, "utf-8")
    file = unit / "recipes" / "recipe_core.sysml"
    return edited(file, [str(unit), "-o", str(folder / "out")], folder, rounds)


def official(corpus: Path, folder: Path, rounds: int) -> tuple[float, float]:
    """``sysmlc check`` of all training and example files as one unit."""
    unit = folder / "official"
    for name in ("training", "examples"):
        shutil.copytree(corpus / "sysml2" / "omg-release" / name, unit / name)
    file = min(unit.rglob("*.sysml"))
    return edited(file, ["check", str(unit)], folder, rounds)
