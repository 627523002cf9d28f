"""Machines as JSON (metamodels/sysmlc-machine.schema.json) and as state machines in PlantUML."""

from collections.abc import Iterator, Mapping, Sequence

from sysmlc.logic.contract import Contract, Variable
from sysmlc.logic.formats.document_text import type_of
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.printing import print_formula
from sysmlc.support.json_text import append_members, encode_row
from sysmlc.support.plantuml_text import plain
from sysmlc.synthesis.controllers.mealy import Machine, Move

FORMAT = "sysmlc-machine/2"
MOST_STATES = 12
MOST_ARROWS = 40
"""States and moves up to which a diagram can be read."""
_MOST_LINES = 4
"""Cases of a condition that an arrow tells one by one."""


def json_of(machine: Machine, contract: Contract) -> str:
    """Return the machine as a JSON file with one line for each move."""
    names = register_names(machine)
    head = {
        "format": FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "inputs": [declared(one) for one in machine.inputs],
        "outputs": [declared(one) for one in machine.outputs],
        "registers": [{"name": name, "of": of} for of, name in names.items()],
    }
    states = ",\n".join(f"    [{_encode_moves(moves, names)}]" for moves in machine.states)
    return append_members(head, [f'  "states": [\n{states}\n  ]'])


def register_names(machine: Machine) -> dict[str, str]:
    """What the register of a variable is called: ``last_x``, or longer if that is taken."""
    known = {one.name for one in (*machine.inputs, *machine.outputs)}
    found: dict[str, str] = {}
    for one in machine.registers:
        name = f"last_{one.name}"
        while name in known:
            name += "_"
        found[one.name] = name
    return found


def named(formula: Formula, registers: Mapping[str, str]) -> Formula:
    """A condition or an output of a move over the names of inputs and registers."""
    match formula:
        case Var(name, primed):
            return Var(name if primed else registers[name])
        case Apply(op, parts):
            return Apply(op, tuple(named(part, registers) for part in parts))
        case _:
            return formula


def declared(variable: Variable) -> dict[str, object]:
    """A variable as JSON."""
    return {
        "name": variable.name,
        "type": type_of(variable.domain),
        "origin": variable.origin,
    }


def _encode_moves(moves: Sequence[Move], names: Mapping[str, str]) -> str:
    if not moves:
        return ""
    lines = (
        "      "
        + encode_row(
            {
                "when": _said(move.when, names),
                "output": [_describe_output(output, names) for output in move.output],
                "next": move.state,
            }
        )
        for move in moves
    )
    return "\n" + ",\n".join(lines) + "\n    "


def _describe_output(output: Formula, names: Mapping[str, str]) -> object:
    return output.value if isinstance(output, Const) else {"value": _said(output, names)}


def _said(formula: Formula, names: Mapping[str, str]) -> str:
    return print_formula(named(formula, names))


def has_diagram(machine: Machine) -> bool:
    """Whether the machine is so small that a diagram of it can be read."""
    return machine.size <= MOST_STATES and machine.count <= MOST_ARROWS


def plantuml_of(machine: Machine, contract: Contract) -> str:
    """The machine as a state diagram: on an arrow what is given, and below it what is answered."""
    names = register_names(machine)
    lines = ["@startuml", f"title {plain(contract.component)}", "hide empty description"]
    lines += [f"state S{at}" for at in range(machine.size)]
    lines += ["[*] --> S0"]
    for state, moves in enumerate(machine.states):
        lines += (f"S{state} --> S{move.state} : {_label(move, machine, names)}" for move in moves)
    return "\n".join((*lines, *_legend(names), "@enduml", ""))


def _label(move: Move, machine: Machine, names: Mapping[str, str]) -> str:
    when = move.when
    cases = when.args if isinstance(when, Apply) and when.op is Op.OR else (when,)
    given = ["any" if one == Const(True) else _said(one, names) for one in cases]
    if len(given) > _MOST_LINES:
        given[_MOST_LINES - 1 :] = ["or more"]
    return "\\n".join([*given, f"/ {_answer(move, machine, names)}"])


def _answer(move: Move, machine: Machine, names: Mapping[str, str]) -> str:
    """The outputs; registers that go on as they were are left out."""
    pairs = zip(machine.outputs, move.output, strict=True)
    told = [f"{one.name}={_said(value, names)}" for one, value in pairs if value != Var(one.name)]
    return " ".join(told) or "as before"


def _legend(names: Mapping[str, str]) -> Iterator[str]:
    if names:
        yield "legend"
        yield from (f"  {name} is what {of} was in the step before" for of, name in names.items())
        yield "  an output that is not told stays what it was"
        yield "endlegend"
