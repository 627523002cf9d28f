"""Machines as JSON (metamodels/sysmlc-machine.schema.json) and as state machines in PlantUML."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from sysmlc.logic.contract import Contract, Variable
from sysmlc.logic.formats.document_text import type_of
from sysmlc.logic.printing import print_literal
from sysmlc.naming import file_names
from sysmlc.output import json_text
from sysmlc.synthesis.mealy import Machine, Move, Row

FORMAT = "sysmlc-machine/1"
MOST_SHOWN = 12
"""States up to which a diagram can be read."""
_MOST_LINES = 4
"""Inputs that an arrow tells one by one; more are counted."""


def files(made: Iterable[tuple[Machine, Contract]]) -> Iterator[tuple[str, str]]:
    """Name and text of the files of some machines; small ones have a diagram too."""
    known = {contract.component: (machine, contract) for machine, contract in made}
    for component, name in file_names(known).items():
        machine, contract = known[component]
        yield f"{name}.machine.json", json_of(machine, contract)
        if machine.size <= MOST_SHOWN:
            yield f"{name}.machine.puml", plantuml_of(machine, contract)


def json_of(machine: Machine, contract: Contract) -> str:
    """The machine as JSON text, a line a move."""
    head = {
        "format": FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "inputs": [_declared(one) for one in machine.inputs],
        "outputs": [_declared(one) for one in machine.outputs],
    }
    states = ",\n".join(f"    [{_listed(moves)}]" for moves in machine.moves)
    return f'{json_text(head, 2)[:-2]},\n  "states": [\n{states}\n  ]\n}}\n'


def _declared(variable: Variable) -> dict[str, object]:
    return {
        "name": variable.name,
        "type": type_of(variable.domain),
        "origin": variable.origin,
    }


def _listed(moves: Mapping[Row, Move]) -> str:
    if not moves:
        return ""
    lines = (
        f'      {{"input": {_row(row)}, "output": {_row(move.output)}, "next": {move.state}}}'
        for row, move in moves.items()
    )
    return "\n" + ",\n".join(lines) + "\n    "


def _row(row: Row) -> str:
    return "[" + ", ".join(json_text(one, 0) for one in row) + "]"


def plantuml_of(machine: Machine, contract: Contract) -> str:
    """The machine as a state diagram: on an arrow what is given, and below it what is answered."""
    lines = ["@startuml", f"title {contract.component}", "hide empty description"]
    lines += [f"state S{at}" for at in range(machine.size)]
    lines += ["[*] --> S0"]
    for state, moves in enumerate(machine.moves):
        lines += _arrows(state, moves, machine)
    return "\n".join((*lines, "@enduml", ""))


def _arrows(state: int, moves: Mapping[Row, Move], machine: Machine) -> Iterable[str]:
    names = [one.name for one in machine.inputs]
    shown = _telling(moves, len(names))
    groups: dict[Move, dict[str, None]] = {}
    for row, move in moves.items():
        said = " ".join(f"{names[at]}={print_literal(row[at])}" for at in shown)
        groups.setdefault(move, {})[said or "any"] = None
    for move, given in groups.items():
        label = "\\n".join([*_shortened(tuple(given)), f"/ {_answer(move, machine)}"])
        yield f"S{state} --> S{move.state} : {label}"


def _shortened(said: Sequence[str]) -> Sequence[str]:
    if len(said) <= _MOST_LINES:
        return said
    return [*said[: _MOST_LINES - 1], f"or {len(said) - _MOST_LINES + 1} more"]


def _answer(move: Move, machine: Machine) -> str:
    pairs = zip(machine.outputs, move.output, strict=True)
    return " ".join(f"{one.name}={print_literal(value)}" for one, value in pairs)


def _telling(moves: Mapping[Row, Move], count: int) -> list[int]:
    """Places of inputs that suffice to tell which move is made."""
    kept = list(range(count))
    for place in range(count):
        fewer = [one for one in kept if one != place]
        if _is_told(moves, fewer):
            kept = fewer
    return kept


def _is_told(moves: Mapping[Row, Move], places: Sequence[int]) -> bool:
    seen: dict[Row, Move] = {}
    return all(
        seen.setdefault(tuple(row[at] for at in places), move) == move
        for row, move in moves.items()
    )
