"""Machines as JSON (metamodels/sysmlc-machine.schema.json) and as state machines in PlantUML."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

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
"""Conditions that an arrow tells one by one."""


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
    lines = ["@startuml", f"title {' '.join(contract.component.split())}", "hide empty description"]
    lines += [f"state S{at}" for at in range(machine.size)]
    lines += ["[*] --> S0"]
    for state, moves in enumerate(machine.moves):
        lines += _arrows(state, moves, machine)
    return "\n".join((*lines, "@enduml", ""))


def _arrows(state: int, moves: Mapping[Row, Move], machine: Machine) -> Iterator[str]:
    groups: dict[Move, list[Row]] = {}
    for row, move in moves.items():
        groups.setdefault(move, []).append(row)
    for move, rows in groups.items():
        others = [row for row, other in moves.items() if other != move]
        given = list(islice(_conditions(rows, others, machine), _MOST_LINES + 1))
        if len(given) > _MOST_LINES:
            given[_MOST_LINES - 1 :] = ["or more"]
        label = "\\n".join([*given, f"/ {_answer(move, machine)}"])
        yield f"S{state} --> S{move.state} : {label}"


def _conditions(rows: Sequence[Row], others: Sequence[Row], machine: Machine) -> Iterator[str]:
    """What the rows have in common that none of the others has, in as few words as is simple."""
    left = rows
    while left:
        row, kept = left[0], tuple(range(len(machine.inputs)))
        for place in kept:
            fewer = tuple(one for one in kept if one != place)
            if not any(_is_same(row, other, fewer) for other in others):
                kept = fewer
        said = (f"{machine.inputs[at].name}={print_literal(row[at])}" for at in kept)
        yield " ".join(said) or "any"
        left = [one for one in left if not _is_same(row, one, kept)]


def _is_same(one: Row, other: Row, places: Iterable[int]) -> bool:
    return all(one[place] == other[place] for place in places)


def _answer(move: Move, machine: Machine) -> str:
    pairs = zip(machine.outputs, move.output, strict=True)
    return " ".join(f"{one.name}={print_literal(value)}" for one, value in pairs)
