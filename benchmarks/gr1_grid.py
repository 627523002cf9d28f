"""Contracts of robots on a grid, as in chapter 4 of the thesis.

The inputs are the position, the target and four sensors of each robot, and a Boolean for each cell
that is true if the cell is free. The output of each robot is a command, which determines its next
position. A target changes only after the robot has reached it.
"""

from collections.abc import Iterator
from itertools import combinations

COMMANDS = ("stay", "up", "down", "left", "right")
SENSORS = {"up": "su", "down": "sd", "left": "sl", "right": "sr"}


def build_contract(side: int, robots: int) -> dict[str, object]:
    """Return one contract of all robots on a square grid, in the neutral form."""
    cells = range(side * side)
    rules = list(_iter_sensor_rules(side, robots))
    motion = [rule for robot in range(robots) for rule in _iter_motion_rules(side, robot)]
    no_collision = [
        f"!(pos{first}={cell} & pos{second}={cell})"
        for first, second in combinations(range(robots), 2)
        for cell in cells
    ]
    return {
        "name": f"grid_{side * side}x{robots}",
        "variables": _declare_variables(side, robots),
        "assumptions": {
            "init": [*no_collision, *rules],
            "safety": [*map(_prime_variables, rules), *motion],
            "liveness": [],
        },
        "guarantees": {
            "init": [f"cmd{robot}=stay" for robot in range(robots)],
            "safety": [*no_collision, *_iter_command_rules(robots)],
            "liveness": [f"pos{robot}=tgt{robot}" for robot in range(robots)],
        },
    }


def _declare_variables(side: int, robots: int) -> dict[str, dict[str, object]]:
    variables: dict[str, dict[str, object]] = {}
    for robot in range(robots):
        for name in ("pos", "tgt"):
            variables[f"{name}{robot}"] = {"owner": "env", "type": [0, side * side - 1]}
        for sensor in SENSORS.values():
            variables[f"{sensor}{robot}"] = {"owner": "env", "type": "bool"}
        variables[f"cmd{robot}"] = {"owner": "sys", "type": list(COMMANDS)}
    for cell in range(side * side):
        variables[f"free{cell}"] = {"owner": "env", "type": "bool"}
    return variables


def _iter_sensor_rules(side: int, robots: int) -> Iterator[str]:
    """Yield the values of sensors and free cells in one step, which positions determine."""
    for cell in range(side * side):
        robots_there = " | ".join(f"pos{robot}={cell}" for robot in range(robots))
        yield f"free{cell} <-> !({robots_there})"
    for robot in range(robots):
        for command, sensor in SENSORS.items():
            for cell in range(side * side):
                target = find_neighbour(side, cell, command)
                bit = f"{sensor}{robot}"
                value = f"!{bit}" if target == cell else f"({bit} <-> free{target})"
                yield f"pos{robot}={cell} -> {value}"


def _prime_variables(rule: str) -> str:
    """Return the rule about the next step: every name, which begins with a letter, gets a prime."""
    return "".join(_iter_primed_words(rule))


def _iter_primed_words(rule: str) -> Iterator[str]:
    word = ""
    for char in f"{rule} ":
        if char.isalnum():
            word += char
            continue
        yield f"{word}'" if word[:1].isalpha() else word
        yield char
        word = ""


def _iter_motion_rules(side: int, robot: int) -> Iterator[str]:
    for cell in range(side * side):
        for command in COMMANDS:
            successor = find_neighbour(side, cell, command)
            yield f"pos{robot}={cell} & cmd{robot}={command} -> pos{robot}'={successor}"
        yield f"pos{robot}!=tgt{robot} & tgt{robot}={cell} -> tgt{robot}'={cell}"


def _iter_command_rules(robots: int) -> Iterator[str]:
    for robot in range(robots):
        for command, sensor in SENSORS.items():
            yield f"cmd{robot}'={command} -> {sensor}{robot}'"


def find_neighbour(side: int, cell: int, command: str) -> int:
    """Return the cell that a command leads to: the same cell if there is a wall."""
    row, column = divmod(cell, side)
    rows, columns = {"up": (-1, 0), "down": (1, 0), "left": (0, -1), "right": (0, 1)}.get(
        command, (0, 0)
    )
    row, column = row + rows, column + columns
    is_inside = 0 <= row < side and 0 <= column < side
    return row * side + column if is_inside else cell
