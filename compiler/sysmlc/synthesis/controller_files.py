"""Files of synthesised controllers: machines, tables and gr1c's strategies as JSON, and diagrams.

The JSON documents conform to metamodels/sysmlc-machine.schema.json, to
metamodels/sysmlc-controller.schema.json, and to version 1 of gr1c's "strategy in JSON" (gr1c's
manual). A node of a gr1c strategy is a step: the values of all variables, and the nodes to which
the next inputs lead. Booleans are 0 and 1, integers and literals are counted from 0. The members
for gr1c's version and the date stay empty, so that equal contracts give equal texts.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.controllers.machine import Machine, Move
from sysmlc.controllers.table import Entry, Table
from sysmlc.diagnostics import Sink
from sysmlc.logic import domains
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Variable,
    select_classes,
)
from sysmlc.logic.evaluate import Evaluation, compile_evaluation
from sysmlc.logic.formats.contract_json import encode_domain
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.printing import print_formula
from sysmlc.support.output import append_members, assign_file_names, encode_row
from sysmlc.support.plantuml_text import escape_line
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.decision import Place
from sysmlc.synthesis.strategies.closed_loop import Controller

OWN, TABLE, GR1C = FORMS = ("own", "table", "gr1c")
"""Forms of controller files: a machine or a table, always a table, gr1c's JSON."""


class ControllerFiles(Struct, frozen=True):
    """The files of controllers, and the results of synthesis that they contain."""

    results: tuple[Synthesis, ...]
    """The results, without controllers that the format cannot express."""
    files: tuple[tuple[str, str], ...]
    """Names and texts."""


def write_controllers(
    results: Sequence[Synthesis], place: Place, sink: Sink, form: str = OWN
) -> ControllerFiles:
    """Return the files of all controllers, and report those that the format cannot express."""
    file_names = assign_file_names([result.contract.component for result in results])
    files: list[tuple[str, str]] = []
    written: list[Synthesis] = []
    for result in results:
        try:
            if result.machine is not None:
                files += controller_files(
                    file_names[result.contract.component], result.machine, result.contract, form
                )
            written.append(result)
        except LimitError as problem:
            subject, name = place(result.contract.origin), result.contract.component
            sink.report(rules.NO_MACHINE, subject, component=name, why=str(problem))
            written.append(replace(result, machine=None))
    return ControllerFiles(tuple(written), tuple(files))


def controller_files(
    name: str, controller: Controller, contract: Contract, form: str
) -> Iterator[tuple[str, str]]:
    """Yield names and texts of the files of one controller; small machines have a diagram.

    Raises LimitError if the controller is too large for gr1c's format.
    """
    if form == GR1C:
        yield f"{name}.gr1c.json", gr1c_json(controller, contract)
    elif not isinstance(controller, Machine):
        yield f"{name}.controller.json", table_json(controller, contract)
    else:
        yield f"{name}.machine.json", machine_json(controller, contract)
        if has_diagram(controller):
            yield f"{name}.machine.puml", machine_diagram(controller, contract)


# -- formats -----------------------------------------------------------------------------------

MACHINE_FORMAT = "sysmlc-machine/2"
MAX_DIAGRAM_STATES = 12
"""States up to which a diagram is readable."""
MAX_DIAGRAM_ARROWS = 40
"""Moves up to which a diagram is readable."""
_MAX_LABEL_LINES = 4
"""Lines of a condition on an arrow; further cases are abbreviated."""


def _encode_head(format_: str, controller: Controller, contract: Contract) -> dict[str, object]:
    return {
        "format": format_,
        "name": contract.component,
        "origin": contract.origin,
        "inputs": [_encode_variable(variable) for variable in controller.inputs],
        "outputs": [_encode_variable(variable) for variable in controller.outputs],
    }


def machine_json(machine: Machine, contract: Contract) -> str:
    """Return the machine as a JSON file with one line for each move."""
    names = register_names(machine)
    head = _encode_head(MACHINE_FORMAT, machine, contract)
    head["registers"] = [{"name": name, "of": of} for of, name in names.items()]
    states = ",\n".join(f"    [{_encode_moves(moves, names)}]" for moves in machine.states)
    return append_members(head, [f'  "states": [\n{states}\n  ]'])


def register_names(machine: Machine) -> dict[str, str]:
    """Return the names of the registers: ``last_x``, or longer if that name is in use."""
    names = {variable.name for variable in (*machine.inputs, *machine.outputs)}
    registers: dict[str, str] = {}
    for variable in machine.registers:
        name = f"last_{variable.name}"
        while name in names:
            name += "_"
        registers[variable.name] = name
    return registers


def _rename_registers(formula: Formula, registers: Mapping[str, str]) -> Formula:
    """Replace the variables of a move by names: primed ones are inputs, unprimed ones registers."""
    match formula:
        case Var(name, primed):
            return Var(name if primed else registers[name])
        case Apply(op, parts):
            return Apply(op, tuple(_rename_registers(part, registers) for part in parts))
        case _:
            return formula


def _encode_variable(variable: Variable) -> dict[str, object]:
    """Return a variable as a JSON value."""
    kind = encode_domain(variable.domain)
    return {"name": variable.name, "type": kind, "origin": variable.origin}


def _encode_moves(moves: Sequence[Move], names: Mapping[str, str]) -> str:
    if not moves:
        return ""
    rows = (
        {
            "when": _print_with_registers(move.when, names),
            "output": [
                output.value
                if isinstance(output, Const)
                else {"value": _print_with_registers(output, names)}
                for output in move.output
            ],
            "next": move.state,
        }
        for move in moves
    )
    return "\n" + ",\n".join(f"      {encode_row(row)}" for row in rows) + "\n    "


def _print_with_registers(formula: Formula, names: Mapping[str, str]) -> str:
    return print_formula(_rename_registers(formula, names))


def has_diagram(machine: Machine) -> bool:
    """Whether the machine is small enough for a readable diagram."""
    return machine.size <= MAX_DIAGRAM_STATES and machine.count <= MAX_DIAGRAM_ARROWS


def machine_diagram(machine: Machine, contract: Contract) -> str:
    """Return the machine as a PlantUML state diagram, with conditions and outputs on the arrows."""
    names = register_names(machine)
    lines = ["@startuml", f"title {escape_line(contract.component)}", "hide empty description"]
    lines += [f"state S{index}" for index in range(machine.size)]
    lines += ["[*] --> S0"]
    for state, moves in enumerate(machine.states):
        lines += (
            f"S{state} --> S{move.state} : {_arrow_label(move, machine, names)}" for move in moves
        )
    return "\n".join((*lines, *_legend(names), "@enduml", ""))


def _arrow_label(move: Move, machine: Machine, names: Mapping[str, str]) -> str:
    when = move.when
    cases = when.args if isinstance(when, Apply) and when.op is Op.OR else (when,)
    conditions = [
        "any" if condition == Const(True) else _print_with_registers(condition, names)
        for condition in cases
    ]
    if len(conditions) > _MAX_LABEL_LINES:
        conditions[_MAX_LABEL_LINES - 1 :] = ["or more"]
    return "\\n".join([*conditions, f"/ {_describe_answer(move, machine, names)}"])


def _describe_answer(move: Move, machine: Machine, names: Mapping[str, str]) -> str:
    """Return the outputs as text, without registers that keep their values."""
    pairs = zip(machine.outputs, move.output, strict=True)
    outputs = [
        f"{variable.name}={_print_with_registers(value, names)}"
        for variable, value in pairs
        if value != Var(variable.name)
    ]
    return " ".join(outputs) or "unchanged"


def _legend(names: Mapping[str, str]) -> Iterator[str]:
    if names:
        yield "legend"
        yield from (
            f"  {name} is the value of {of} in the previous step" for of, name in names.items()
        )
        yield "  an output that is not listed keeps its value"
        yield "endlegend"


TABLE_FORMAT = "sysmlc-controller/1"
_NODES_PER_LINE = 8
"""Nodes on a line."""


def table_json(table: Table, contract: Contract) -> str:
    """Return the table as a JSON file with ``_NODES_PER_LINE`` nodes on a line."""
    head = _encode_head(TABLE_FORMAT, table, contract)
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
        yield encode_row({"variable": bit.variable, "bit": bit.position, "step": step})


def _encode_nodes(table: Table) -> Iterator[str]:
    for start in range(0, len(table.nodes), _NODES_PER_LINE):
        yield ", ".join(map(encode_row, table.nodes[start : start + _NODES_PER_LINE]))


def _encode_entry(entry: Entry) -> str:
    return encode_row({"outputs": entry.outputs, "next": entry.successors})


GR1C_VERSION = 1
MAX_STEPS = 50_000
"""Steps of the controller that are computed: one for each node and each next input."""

Values = Mapping[str, Literal]


def gr1c_json(controller: Controller, contract: Contract, max_steps: int = MAX_STEPS) -> str:
    """Return the controller as gr1c's JSON with a line for each node.

    Raises LimitError if more than *max_steps* steps would have to be computed.
    """
    head = {
        "version": GR1C_VERSION,
        "gr1c": "",
        "date": "",
        "extra": f"sysmlc: {contract.component}",
        "ENV": [_gr1c_declaration(variable) for variable in controller.inputs],
        "SYS": [_gr1c_declaration(variable) for variable in controller.outputs],
    }
    nodes = ",\n".join(_Unrolling(controller, contract, max_steps).iter_lines())
    return append_members(head, [f'  "nodes": {{\n{nodes}\n  }}'])


def _gr1c_declaration(variable: Variable) -> dict[str, object]:
    if isinstance(variable.domain, BooleanDomain):
        return {variable.name: "boolean"}
    return {variable.name: [0, domains.size(variable.domain) - 1]}


class _Unrolling:
    """The reachable steps of a controller, as nodes: its state, and the values in the step.

    Each input that the assumptions allow has a successor. Raises LimitError above *max_steps*.
    """

    def __init__(self, controller: Controller, contract: Contract, max_steps: int) -> None:
        self._controller, self._max_steps, self._steps_left = controller, max_steps, max_steps
        self._first = _compile_conjuncts(contract.assumptions, Class.INIT)
        self._later = _compile_conjuncts(contract.assumptions, Class.SAFETY)
        domains_by_name = {variable.name: variable.domain for variable in controller.inputs}
        # Check before the inputs are listed.
        if domains.count(domains_by_name) > max_steps:
            raise LimitError.of_number(max_steps, "step", "of the strategy")
        self._inputs = list(domains.valuations(domains_by_name))
        self._node_indices: dict[tuple[tuple[Literal, ...], int], int] = {}
        self._nodes: list[tuple[dict[str, Literal], int]] = []

    def iter_lines(self) -> Iterator[str]:
        """Yield the nodes in the order of their discovery."""
        initial_nodes = set(self._successors({}, 0, self._first))
        # The list grows while it is traversed.
        for index, (values, state) in enumerate(self._nodes):
            successors = self._successors(values, state, self._later)
            yield self._encode_node(index, values, state, index in initial_nodes, list(successors))

    def _successors(self, values: Values, state: int, rules: Sequence[Evaluation]) -> Iterator[int]:
        """Yield the next nodes after a step, one for each next input that *rules* allow.

        A verified machine lacks a move only for inputs after which no run satisfies the assumptions
        (``games.dead_ends``). They have no node.
        """
        for inputs in self._inputs:
            self._steps_left -= 1
            if self._steps_left < 0:
                raise LimitError.of_number(self._max_steps, "step", "of the strategy")
            current, following = (values, inputs) if values else (inputs, None)
            if all(rule(current, following) for rule in rules):
                try:
                    node = self._index_node(values, state, inputs)
                except LookupError:
                    continue
                yield node

    def _index_node(self, values: Values, state: int, inputs: Values) -> int:
        """Return the index of the node that *inputs* lead to; a new node is added."""
        outputs, next_state = self._controller.step(state, values, inputs)
        step = dict(inputs) | outputs
        key = tuple(step.values()), next_state
        if key not in self._node_indices:
            self._node_indices[key] = len(self._nodes)
            self._nodes.append((step, next_state))
        return self._node_indices[key]

    def _encode_node(
        self, index: int, values: Values, state: int, is_first: bool, successors: list[int]
    ) -> str:
        variables = (*self._controller.inputs, *self._controller.outputs)
        node = {
            "state": [
                domains.values(variable.domain).index(values[variable.name])
                for variable in variables
            ],
            "mode": state,
            # gr1c's measure of the distance to a goal, which this compiler does not compute.
            "rgrad": -1,
            "initial": is_first,
            "trans": [str(successor) for successor in successors],
        }
        return f'    "{index}": {encode_row(node)}'


def _compile_conjuncts(conjuncts: Sequence[Conjunct], class_: Class) -> list[Evaluation]:
    return [compile_evaluation(item.formula) for item in select_classes(conjuncts, class_)]
