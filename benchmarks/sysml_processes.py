"""CPU seconds of whole processes that compile SysML v2, start-up and reading of the cache included.

The cache is one of its own. Before each round one line of a file is edited: a note only, which
changes no words, a comment, a number, a text, a guard, which are values, or what changes the tree.
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
_SERVICES = "services/conveyor.sysml"
_EQUIPMENT = "equipment/equipment_interfaces.sysml"
_PLANT = "plant/ice_lab.sysml"
_VALUE = re.compile(r"(?<= := )\d+(?=;)")
_COMPARED = re.compile(r"(?<=== )(?:true|false)\b")
_OPERATOR = re.compile(r"(?<= )[=!]=(?= )")
_COMMENT = re.compile(r"(?<=doc )/\*.*?\*/", re.DOTALL)
_NODE = re.compile(r'(?<=nodeId = ")[^"]*')
_TURNED = {"true": "false", "false": "true", "==": "!=", "!=": "=="}
Edit = Callable[[str], str]


def note(text: str) -> str:
    """A note at the end of the first line; all that follows stands one line further down."""
    return text.replace("\n", f" // note {next(_number)}\n\n", 1)


def number(text: str) -> str:
    """Another number for the first one that something is set to."""
    return _VALUE.sub(str(1000 + next(_number)), text, count=1)


def comment(text: str) -> str:
    """Another comment for the second one that documents something."""
    one = list(_COMMENT.finditer(text))[1]
    return f"{text[: one.start()]}/* What it does, {next(_number)}. */{text[one.end() :]}"


def node(text: str) -> str:
    """Another text for the last id of a node; findings quote the first one."""
    one = list(_NODE.finditer(text))[-1]
    return f"{text[: one.start()]}ns=2;s=Node{next(_number)}{text[one.end() :]}"


def _turned(pattern: re.Pattern[str]) -> Edit:
    """What turns round one of those that are found: another one each time."""

    def edit(text: str) -> str:
        found = list(pattern.finditer(text))
        one = found[next(_number) % len(found)]
        return text[: one.start()] + _TURNED[one[0]] + text[one.end() :]

    return edit


def _before(mark: str, more: str) -> Edit:
    """What puts something before the first place that has the mark; ``#`` is a new number."""
    return lambda text: text.replace(mark, f"{more.replace('#', str(next(_number)))} {mark}", 1)


def _replaced(old: str, new: str) -> Edit:
    """What replaces the first match of a pattern; ``#`` is a new number."""
    return lambda text: re.sub(old, new.replace("#", str(next(_number))), text, count=1)


def _either(one: str, other: str) -> Edit:
    """What replaces the first of two texts by the other, or back."""
    return lambda text: text.replace(one, other, 1) if one in text else text.replace(other, one, 1)


LABORATORY: dict[str, tuple[str, Edit]] = {
    "a note": (_SERVICES, note),
    "a comment": (_SERVICES, comment),
    "a number": (_SERVICES, number),
    "a node id": (_EQUIPMENT, node),
    "a truth value in a guard": (_SERVICES, _turned(_COMPARED)),
    "an operator in a guard": (_SERVICES, _turned(_OPERATOR)),
    "a step more": (_SERVICES, _before("then done;", "then action more#;")),
    "a step fewer": (_SERVICES, _replaced(r"\n *then done;", "")),
    "a step renamed": (_SERVICES, _replaced(r"callReleasePallet\d*", "callReleasePallet#")),
    "a parameter more": (_SERVICES, _before("first start;", "in extra# : Integer;")),
    "an attribute more": (_SERVICES, _before("first start;", "attribute extra# : Integer;")),
    "another type": (_SERVICES, _either("out result : Boolean;", "out result : Integer;")),
    "a constraint more": (
        _SERVICES,
        _before("first start;", "assert constraint { palletNumber > # }"),
    ),
    "another multiplicity": (
        _EQUIPMENT,
        _replaced(r"attribute (\w+) : (\w+) \{", r"attribute \1 : \2 [0..1] {"),
    ),
    "a part more": (_PLANT, _before("connect cell1", "part spare# : WorkCell;")),
    "a connection more": (_PLANT, _before("connect cell1", "connect cell1 to cell2;")),
}
"""Edits of one line of the ICE laboratory: in which file, and how."""


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
    arguments: list[str], folder: Path, rounds: int, *edits: tuple[Path, Edit]
) -> list[float]:
    """The first time, with an empty cache; for each edit of a file the least of ``rounds``."""
    shutil.rmtree(folder / "cache", ignore_errors=True)
    command = [str(Path(sysconfig.get_path("scripts")) / "sysmlc"), *arguments]
    first = seconds(command, folder)
    return [first, *(min(_after(edit, file, command, folder, rounds)) for file, edit in edits)]


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
    return edited(["check", str(path)], folder, rounds, (path, package))


def copied(corpus: Path, unit: Path) -> Path:
    """A copy of the ICE laboratory with the names of its levels."""
    shutil.copytree(corpus / "sysml2" / "ice-lab", unit)
    (unit / "sysmlc.toml").write_text(_LEVELS, "utf-8")
    return unit


def laboratory(corpus: Path, folder: Path, rounds: int) -> list[float]:
    """``sysmlc`` of a copy of the ICE laboratory: the first time, and each of the edits."""
    unit = copied(corpus, folder / "ice")
    arguments = [str(unit), "-o", str(folder / "out")]
    edits = ((unit / file, edit) for file, edit in LABORATORY.values())
    return edited(arguments, folder, rounds, *edits)


def gather(corpus: Path, folder: Path) -> Path:
    """A copy of all training and example files."""
    unit = folder / "official"
    for name in ("training", "examples"):
        shutil.copytree(corpus / "sysml2" / "omg-release" / name, unit / name)
    return unit


def official(unit: Path, folder: Path, rounds: int) -> list[float]:
    """``sysmlc check`` of these files as one unit: the first time, a note, a package."""
    file = min(unit.rglob("*.sysml"))
    return edited(["check", str(unit)], folder, rounds, (file, note), (file, package))
