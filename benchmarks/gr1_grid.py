"""Robots on a grid, as the thesis writes their contract (chapter 4): sensors, free cells, commands.

Each robot has a position and a target (inputs), four sensors, and a command; a bit a cell says that
it is free. Positions obey the commands; targets stay until they are reached.
"""

from collections.abc import Iterator
from itertools import combinations

COMMANDS = ("stay", "up", "down", "left", "right")
SENSORS = {"up": "su", "down": "sd", "left": "sl", "right": "sr"}


def holistic(side: int, robots: int) -> dict[str, object]:
    """The contract of all robots together, in the neutral form."""
    cells = range(side * side)
    rules = list(_seen(side, robots))
    motion = [rule for robot in range(robots) for rule in _motion(side, robot)]
    apart = [
        f"!(pos{one}={cell} & pos{other}={cell})"
        for one, other in combinations(range(robots), 2)
        for cell in cells
    ]
    return {
        "name": f"grid_{side * side}x{robots}",
        "variables": _variables(side, robots),
        "assumptions": {
            "init": [*apart, *rules],
            "safety": [*map(_primed, rules), *motion],
            "liveness": [],
        },
        "guarantees": {
            "init": [f"cmd{robot}=stay" for robot in range(robots)],
            "safety": [*apart, *_obedience(robots)],
            "liveness": [f"pos{robot}=tgt{robot}" for robot in range(robots)],
        },
    }


def _variables(side: int, robots: int) -> dict[str, dict[str, object]]:
    found: dict[str, dict[str, object]] = {}
    for robot in range(robots):
        for name in ("pos", "tgt"):
            found[f"{name}{robot}"] = {"owner": "env", "type": [0, side * side - 1]}
        for sensor in SENSORS.values():
            found[f"{sensor}{robot}"] = {"owner": "env", "type": "bool"}
        found[f"cmd{robot}"] = {"owner": "sys", "type": list(COMMANDS)}
    for cell in range(side * side):
        found[f"free{cell}"] = {"owner": "env", "type": "bool"}
    return found


def _seen(side: int, robots: int) -> Iterator[str]:
    """What sensors and free cells are, in one step."""
    for cell in range(side * side):
        there = " | ".join(f"pos{robot}={cell}" for robot in range(robots))
        yield f"free{cell} <-> !({there})"
    for robot in range(robots):
        for command, sensor in SENSORS.items():
            for cell in range(side * side):
                target = neighbour(side, cell, command)
                own = f"{sensor}{robot}"
                value = f"!{own}" if target == cell else f"({own} <-> free{target})"
                yield f"pos{robot}={cell} -> {value}"


def _primed(rule: str) -> str:
    """The rule about the next step: names begin with a letter and end with a digit."""
    return "".join(_words(rule))


def _words(rule: str) -> Iterator[str]:
    word = ""
    for char in f"{rule} ":
        if char.isalnum():
            word += char
            continue
        yield f"{word}'" if word[:1].isalpha() else word
        yield char
        word = ""


def _motion(side: int, robot: int) -> Iterator[str]:
    for cell in range(side * side):
        for command in COMMANDS:
            after = neighbour(side, cell, command)
            yield f"pos{robot}={cell} & cmd{robot}={command} -> pos{robot}'={after}"
        yield f"pos{robot}!=tgt{robot} & tgt{robot}={cell} -> tgt{robot}'={cell}"


def _obedience(robots: int) -> Iterator[str]:
    for robot in range(robots):
        for command, sensor in SENSORS.items():
            yield f"cmd{robot}'={command} -> {sensor}{robot}'"


def neighbour(side: int, cell: int, command: str) -> int:
    """The cell that a command leads to; a command into a wall leads nowhere."""
    row, column = divmod(cell, side)
    rows, columns = {"up": (-1, 0), "down": (1, 0), "left": (0, -1), "right": (0, 1)}.get(
        command, (0, 0)
    )
    row, column = row + rows, column + columns
    is_inside = 0 <= row < side and 0 <= column < side
    return row * side + column if is_inside else cell
