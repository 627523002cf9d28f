"""Small floors with robots, and contracts by their names in the corpus."""

import os
import re
from pathlib import Path

from compact_contracts import assume_no_meeting, compact_contract

from sysmlc.logic.printing import print_formula
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.study import Grid, Order, Robot, Study, Target
from sysmlc.robots.system_contract import system_contract

CORPUS = Path(os.environ.get("SYSMLC_CORPUS", "")) / "gr1" / "robots"
_ENCODING = {"smart": "commands", "move": "moves"}
_WORDS = {
    "pos": "position",
    "tgt": "target",
    "su": "sensor_up",
    "sd": "sensor_down",
    "sl": "sensor_left",
    "sr": "sensor_right",
    "cmd": "command",
    "tm": "timer",
}


def floor(side, *starts, targets=(), orders=(), blocked=(), rows=None, **options):
    """Return a floor with robots r0, r1 ... (None: any start) and targets t0, t1 ... in cells."""
    return Study(
        "Hall",
        "hall",
        Grid(side, rows or side, tuple(blocked)),
        tuple(
            Robot(f"r{index}", f"r{index}", f"R{index}", start)
            for index, start in enumerate(starts)
        ),
        tuple(
            Target(f"t{index}", f"t{index}", cell, f"T{index}")
            for index, cell in enumerate(targets)
        ),
        tuple(Order(*order) for order in orders),
        obstacles=tuple(f"O{cell}" for cell in blocked),
        **options,
    )


def build_contract(name):
    """Return our contract for the floor of a file of corpus/gr1/robots."""
    kind, *rest = name.split("_")
    if kind == "robot":
        study = floor(int(int(rest[0]) ** 0.5), None)
        return robot_contract(study, study.robots[0])
    cells, robots = map(int, rest[0].split("x"))
    within = int(rest[2][1:]) if len(rest) > 2 else None
    study = floor(int(cells**0.5), *(None,) * robots, within=within)
    if kind == "env":
        is_assumed = rest[1] == "assume"
        literal = assume_no_meeting(study) if is_assumed else environment_contract(study, True)
        return environment_contract(study) if rest[1] == "arbitrated" else literal
    if rest[1] in _ENCODING:
        return compact_contract(study, _ENCODING[rest[1]])
    return system_contract(study)


def list_conjuncts(contract):
    """Return all conjuncts as text, with side and class."""
    sides = (("assumption", contract.assumptions), ("guarantee", contract.guarantees))
    return {
        (side, conjunct.class_, print_formula(conjunct.formula))
        for side, conjuncts in sides
        for conjunct in conjuncts
    }


def rename_variables(text):
    """Rename the variables of a formula of the corpus to ours."""
    text = re.sub(r"\bfree(\d+)", r"free_\1", text)
    pattern = rf"\b({'|'.join(_WORDS)})(\d*)(?!\w)"
    return re.sub(pattern, lambda match: f"r{match[2] or 0}_{_WORDS[match[1]]}", text)
