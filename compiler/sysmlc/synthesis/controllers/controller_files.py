"""Machines as JSON (metamodels/sysmlc-machine.schema.json) and as state machines in PlantUML."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic import domains
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Variable
from sysmlc.logic.evaluate import Evaluation, evaluation
from sysmlc.logic.formats.document_text import type_of
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.printing import print_formula
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.json_text import append_members, encode_row
from sysmlc.support.plantuml_text import plain
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.controllers import controller_files as gr1c_text
from sysmlc.synthesis.controllers import controller_files as machine_text
from sysmlc.synthesis.controllers import controller_files as table_text
from sysmlc.synthesis.controllers.closed_loop import Controller
from sysmlc.synthesis.controllers.mealy import Machine, Move
from sysmlc.synthesis.controllers.table import Entry, Table
from sysmlc.synthesis.decision import Place

MACHINE_FORMAT = "sysmlc-machine/2"
MAX_DIAGRAM_STATES = 12
MAX_DIAGRAM_ARROWS = 40
"""States and moves up to which a diagram can be read."""
_MAX_LABEL_LINES = 4
"""Cases of a condition that an arrow tells one by one."""


def machine_json(machine: Machine, contract: Contract) -> str:
    """Return the machine as a JSON file with one line for each move."""
    names = register_names(machine)
    head = {
        "format": MACHINE_FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "inputs": [encode_variable(one) for one in machine.inputs],
        "outputs": [encode_variable(one) for one in machine.outputs],
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


def rename_registers(formula: Formula, registers: Mapping[str, str]) -> Formula:
    """A condition or an output of a move over the names of inputs and registers."""
    match formula:
        case Var(name, primed):
            return Var(name if primed else registers[name])
        case Apply(op, parts):
            return Apply(op, tuple(rename_registers(part, registers) for part in parts))
        case _:
            return formula


def encode_variable(variable: Variable) -> dict[str, object]:
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
                "when": _print_with_registers(move.when, names),
                "output": [_describe_output(output, names) for output in move.output],
                "next": move.state,
            }
        )
        for move in moves
    )
    return "\n" + ",\n".join(lines) + "\n    "


def _describe_output(output: Formula, names: Mapping[str, str]) -> object:
    return (
        output.value
        if isinstance(output, Const)
        else {"value": _print_with_registers(output, names)}
    )


def _print_with_registers(formula: Formula, names: Mapping[str, str]) -> str:
    return print_formula(rename_registers(formula, names))


def has_diagram(machine: Machine) -> bool:
    """Whether the machine is so small that a diagram of it can be read."""
    return machine.size <= MAX_DIAGRAM_STATES and machine.count <= MAX_DIAGRAM_ARROWS


def machine_diagram(machine: Machine, contract: Contract) -> str:
    """The machine as a state diagram: on an arrow what is given, and below it what is answered."""
    names = register_names(machine)
    lines = ["@startuml", f"title {plain(contract.component)}", "hide empty description"]
    lines += [f"state S{at}" for at in range(machine.size)]
    lines += ["[*] --> S0"]
    for state, moves in enumerate(machine.states):
        lines += (
            f"S{state} --> S{move.state} : {_arrow_label(move, machine, names)}" for move in moves
        )
    return "\n".join((*lines, *_legend(names), "@enduml", ""))


def _arrow_label(move: Move, machine: Machine, names: Mapping[str, str]) -> str:
    when = move.when
    cases = when.args if isinstance(when, Apply) and when.op is Op.OR else (when,)
    given = ["any" if one == Const(True) else _print_with_registers(one, names) for one in cases]
    if len(given) > _MAX_LABEL_LINES:
        given[_MAX_LABEL_LINES - 1 :] = ["or more"]
    return "\\n".join([*given, f"/ {_describe_answer(move, machine, names)}"])


def _describe_answer(move: Move, machine: Machine, names: Mapping[str, str]) -> str:
    """The outputs; registers that go on as they were are left out."""
    pairs = zip(machine.outputs, move.output, strict=True)
    told = [
        f"{one.name}={_print_with_registers(value, names)}"
        for one, value in pairs
        if value != Var(one.name)
    ]
    return " ".join(told) or "as before"


def _legend(names: Mapping[str, str]) -> Iterator[str]:
    if names:
        yield "legend"
        yield from (f"  {name} is what {of} was in the step before" for of, name in names.items())
        yield "  an output that is not told stays what it was"
        yield "endlegend"


TABLE_FORMAT = "sysmlc-controller/1"
_NODES_PER_LINE = 8
"""Nodes on a line."""


def table_json(table: Table, contract: Contract) -> str:
    """Return the table as a JSON file with several nodes on a line."""
    head = {
        "format": TABLE_FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "inputs": [encode_variable(one) for one in table.inputs],
        "outputs": [encode_variable(one) for one in table.outputs],
    }
    members = (
        _encode_list("bits", _encode_bits(table)),
        _encode_list("nodes", _encode_nodes(table)),
        f'  "first": {_encode_entry(table.first)}',
        _encode_list("modes", map(_encode_entry, table.modes)),
    )
    return append_members(head, members)


def _encode_list(name: str, rows: Iterable[str]) -> str:
    lines = ",\n".join(f"    {row}" for row in rows)
    return f'  "{name}": [\n{lines}\n  ]' if lines else f'  "{name}": []'


def _encode_bits(table: Table) -> Iterator[str]:
    for bit in table.bits:
        step = "before" if bit.is_before else "now"
        yield encode_row({"variable": bit.variable, "bit": bit.place, "step": step})


def _encode_nodes(table: Table) -> Iterator[str]:
    for start in range(0, len(table.nodes), _NODES_PER_LINE):
        yield ", ".join(map(encode_row, table.nodes[start : start + _NODES_PER_LINE]))


def _encode_entry(entry: Entry) -> str:
    return encode_row({"outputs": entry.outputs, "next": entry.onward})


GR1C_VERSION = 1
MAX_STEPS = 50_000
"""Steps that are tried; each next input of each node is one."""

Values = Mapping[str, Literal]


def gr1c_json(controller: Controller, contract: Contract, most: int = MAX_STEPS) -> str:
    """The controller as JSON text, a line a node.

    Raises LimitError when more than ``most`` steps would have to be tried.
    """
    head = {
        "version": GR1C_VERSION,
        "gr1c": "",
        "date": "",
        "extra": f"sysmlc: {contract.component}",
        "ENV": [_gr1c_declaration(one) for one in controller.inputs],
        "SYS": [_gr1c_declaration(one) for one in controller.outputs],
    }
    nodes = ",\n".join(_Unrolling(controller, contract, most).lines())
    return append_members(head, [f'  "nodes": {{\n{nodes}\n  }}'])


def _gr1c_declaration(variable: Variable) -> dict[str, object]:
    if isinstance(variable.domain, BooleanDomain):
        return {variable.name: "boolean"}
    return {variable.name: [0, domains.size(variable.domain) - 1]}


class _Unrolling:
    """The steps of a controller in all environments that keep the assumptions."""

    def __init__(self, controller: Controller, contract: Contract, most: int) -> None:
        self._controller, self._most, self._left = controller, most, most
        self._first = _compile_conjuncts(contract.assumptions, Class.INIT)
        self._later = _compile_conjuncts(contract.assumptions, Class.SAFETY)
        known = {one.name: one.domain for one in controller.inputs}
        if domains.count(known) > most:
            raise LimitError("steps of the strategy", f"{most:,}")
        self._inputs = list(domains.valuations(known))
        self._places: dict[tuple[tuple[Literal, ...], int], int] = {}
        self._found: list[tuple[dict[str, Literal], int]] = []

    def lines(self) -> Iterator[str]:
        """The nodes, those that are found first first."""
        first = set(self._after({}, 0, self._first))
        for place, (values, state) in enumerate(self._found):
            after = self._after(values, state, self._later)
            yield self._line(place, values, state, place in first, list(after))

    def _after(self, values: Values, state: int, rules: Sequence[Evaluation]) -> Iterator[int]:
        """The nodes that the inputs lead to that are allowed after a step."""
        for given in self._inputs:
            self._left -= 1
            if self._left < 0:
                raise LimitError("steps of the strategy", f"{self._most:,}")
            now, then = (values, given) if values else (given, None)
            if all(rule(now, then) for rule in rules):
                yield self._place(values, state, given)

    def _place(self, values: Values, state: int, given: Values) -> int:
        outputs, after = self._controller.step(state, values, given)
        step = dict(given) | outputs
        key = tuple(step.values()), after
        if key not in self._places:
            self._places[key] = len(self._found)
            self._found.append((step, after))
        return self._places[key]

    def _line(
        self, place: int, values: Values, state: int, is_first: bool, after: list[int]
    ) -> str:
        variables = (*self._controller.inputs, *self._controller.outputs)
        node = {
            "state": [_value_code(variable, values[variable.name]) for variable in variables],
            "mode": state,
            "rgrad": -1,
            "initial": is_first,
            "trans": [str(successor) for successor in after],
        }
        return f'    "{place}": {encode_row(node)}'


def _compile_conjuncts(conjuncts: Sequence[Conjunct], class_: Class) -> list[Evaluation]:
    return [evaluation(one.formula) for one in conjuncts if one.class_ is class_]


def _value_code(variable: Variable, value: Literal) -> int:
    return domains.values(variable.domain).index(value)


OWN, TABLE, GR1C = FORMS = ("own", "table", "gr1c")
"""Forms of controllers as files: machine or table, table, gr1c's JSON."""


class ControllerFiles(Struct, frozen=True):
    """What was made, and the files of it; what a form cannot say counts as not made."""

    made: tuple[Synthesis, ...]
    files: tuple[tuple[str, str], ...]
    """Names and texts; small machines have a diagram too."""


def write_controllers(
    made: Sequence[Synthesis], place: Place, sink: Sink, form: str = OWN
) -> ControllerFiles:
    """The files of all controllers there are; what cannot be said in this form is reported."""
    names = assign_file_names([one.contract.component for one in made])
    files: list[tuple[str, str]] = []
    kept: list[Synthesis] = []
    for one in made:
        try:
            if one.machine is not None:
                files += controller_files(
                    names[one.contract.component], one.machine, one.contract, form
                )
            kept.append(one)
        except LimitError as problem:
            subject, name = place(one.contract.origin), one.contract.component
            sink.report(rules.NO_MACHINE, subject, component=name, why=str(problem))
            kept.append(replace(one, machine=None))
    return ControllerFiles(tuple(kept), tuple(files))


def controller_files(
    name: str, controller: Controller, contract: Contract, form: str
) -> Iterator[tuple[str, str]]:
    """The files of one controller. Raises LimitError for one that is too large for gr1c's form."""
    if form == GR1C:
        yield f"{name}.gr1c.json", gr1c_text.gr1c_json(controller, contract)
    elif not isinstance(controller, Machine):
        yield f"{name}.controller.json", table_text.table_json(controller, contract)
    else:
        yield f"{name}.machine.json", machine_text.machine_json(controller, contract)
        if machine_text.has_diagram(controller):
            yield f"{name}.machine.puml", machine_text.machine_diagram(controller, contract)
