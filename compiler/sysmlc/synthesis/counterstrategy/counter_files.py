"""Files that show a counter-strategy: a losing run, a state diagram, and SysML v2 text."""

from collections.abc import Callable, Iterable, Iterator, Sequence

from sysmlc.controllers.counter_strategy import CounterStrategy, Row, State
from sysmlc.language.text.spelling import format_comment, quote_name
from sysmlc.logic.contract import (
    BooleanDomain,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Literal
from sysmlc.logic.printing import print_literal
from sysmlc.logic.region_formulas import describe_literals
from sysmlc.support.output import assign_file_names
from sysmlc.support.plantuml_text import format_label
from sysmlc.synthesis.counterstrategy.counter_machine import example_run
from sysmlc.synthesis.witnesses import Party, print_temporal, run_diagram

MAX_DIAGRAM_STATES = 12
"""States up to which a diagram is readable."""
_MAX_LABEL_LINES = 4
"""Lines of conditions on an arrow; further conditions are abbreviated."""


def _draw_losing_run(machine: CounterStrategy, contract: Contract) -> str:
    """Return a sequence diagram of a run in which the component fails in spite of good answers."""
    title = [format_label(contract.component), "cannot keep its contract"]
    trace = example_run(machine)
    # A run that ends violates safety guarantees; one that continues misses liveness guarantees.
    if trace.loop < len(trace.steps):
        unmet = machine.unmet_guarantees
        verdict = "not kept" if len(unmet) == 1 else "not all kept"
        title += [f"{verdict}: {format_label(print_temporal(conjunct))}" for conjunct in unmet]
    return run_diagram("\\n".join(title), trace, (Party(contract.component, contract),))


def _draw_states(machine: CounterStrategy, contract: Contract) -> str:
    """Return the counter-strategy as a state diagram: inputs in the states, answers on the arrows.

    A note lists the inputs that are the same in all states.
    """
    constant_inputs = _find_constant_columns([state.inputs for state in machine.states])
    lines = [
        "@startuml",
        f"title what makes {format_label(contract.component)} fail",
        "hide empty description",
    ]
    if constant_inputs:
        values = _print_values(machine.inputs, machine.states[0].inputs, constant_inputs)
        lines += ["note as same", f"  always {values}", "end note"]
    varying_inputs = [index for index in range(len(machine.inputs)) if index not in constant_inputs]
    for number, state in enumerate(machine.states):
        inputs = _print_values(machine.inputs, state.inputs, varying_inputs)
        ending = "" if state.moves else "\\n<b>no answer is left</b>"
        lines.append(f'state "{format_label(inputs or "wait")}{ending}" as S{number}')
    lines.append("[*] --> S0")
    for number, state in enumerate(machine.states):
        for successor, conditions in _iter_arrows(state, machine.outputs):
            answers = "\\n".join(map(format_label, conditions))
            lines.append(f"S{number} --> S{successor} : {answers}")
    return "\n".join((*lines, "@enduml", ""))


def _iter_arrows(state: State, outputs: Sequence[Variable]) -> Iterator[tuple[int, list[str]]]:
    """Yield each next state of *state* with conditions on the answers that lead there."""
    if len(state.moves) == 1:
        ((row, successor),) = state.moves.items()
        yield successor, [f"only {_print_values(outputs, row, range(len(row)))}"]
        return
    for successor, rows, other_rows in _iter_successors(state):
        conditions = [
            " ".join(condition) or "any answer"
            for condition in _describe_conditions(rows, other_rows, outputs)
        ]
        if len(conditions) > _MAX_LABEL_LINES:
            conditions = [*conditions[: _MAX_LABEL_LINES - 1], "or more"]
        yield successor, conditions


def _iter_successors(state: State) -> Iterator[tuple[int, list[Row], list[Row]]]:
    """Yield each next state, with the answers that lead there and all other answers."""
    for successor in dict.fromkeys(state.moves.values()):
        rows = [row for row in state.moves if state.moves[row] == successor]
        other_rows = [row for row in state.moves if state.moves[row] != successor]
        yield successor, rows, other_rows


def _describe_conditions(
    rows: Sequence[Row], other_rows: Sequence[Row], variables: Sequence[Variable]
) -> Iterator[list[str]]:
    """Yield lists of equations: each row satisfies all of some list, no other row does."""
    for row, columns in _distinguish_rows(rows, other_rows):
        yield [_print_value(variables[column], row[column]) for column in columns]


def _distinguish_rows(
    rows: Sequence[Row], other_rows: Sequence[Row]
) -> Iterator[tuple[Row, list[int]]]:
    """Yield rows, each with columns in which it differs from all *other_rows*.

    A yielded row represents all rows with the same values in these columns. No column of a row can
    be omitted.
    """
    remaining = list(rows)
    while remaining:
        row, columns = remaining[0], list(range(len(remaining[0])))
        for column in list(columns):
            fewer_columns = [candidate for candidate in columns if candidate != column]
            if not any(_agree_at(row, other_row, fewer_columns) for other_row in other_rows):
                columns = fewer_columns
        yield row, columns
        remaining = [candidate for candidate in remaining if not _agree_at(row, candidate, columns)]


def _agree_at(left: Row, right: Row, columns: Iterable[int]) -> bool:
    return all(left[column] == right[column] for column in columns)


def _find_constant_columns(rows: Sequence[Row]) -> list[int]:
    """Return the columns in which all rows agree. A single row has none, which would be all."""
    if len(rows) < 2:
        return []
    return [
        column
        for column in range(len(rows[0]))
        if all(row[column] == rows[0][column] for row in rows)
    ]


def _print_values(variables: Sequence[Variable], row: Row, columns: Iterable[int]) -> str:
    return ", ".join(_print_value(variables[column], row[column]) for column in columns)


def _print_value(variable: Variable, value: Literal) -> str:
    """Return a value as text: ``mode=auto``, and the region of a number as ``temp < 18 °C``."""
    regions = dict(describe_literals(variable))
    return regions.get(str(value)) or f"{variable.name}={print_literal(value)}"


QualifiedNames = Callable[[str], str]
"""Returns the qualified name of the element with an id, or an empty string."""


def _write_sysml(
    machine: CounterStrategy, contract: Contract, qualified_name: QualifiedNames
) -> str:
    """Return the counter-strategy as SysML v2 text: an environment with a state machine."""
    component = contract.component
    comment = f"Made by sysmlc: the environment in which {component} fails."
    lines = [
        f"package {quote_name(f'What makes {component} fail')} {{",
        "    private import ScalarValues::*;",
        "    doc",
        *(f"    {line}" for line in format_comment(comment)),
    ]
    for variable in (*machine.inputs, *machine.outputs):
        lines += _declare_enumeration(variable)
    lines.append("    part def Environment {")
    first_inputs = machine.inputs_in(0)
    for variable in contract.variables:
        lines += _declare_attribute(variable, first_inputs.get(variable.name), qualified_name)
    lines += [*_print_state_machine(machine), "    }", "}", ""]
    return "\n".join(lines)


def _declare_enumeration(variable: Variable) -> Iterator[str]:
    if isinstance(variable.domain, EnumerationDomain):
        yield f"    enum def {quote_name(f'values of {variable.name}')} {{"
        yield from (f"        enum {quote_name(literal)};" for literal in variable.domain.literals)
        yield "    }"


def _declare_attribute(
    variable: Variable, initial_value: Literal | None, qualified_name: QualifiedNames
) -> Iterator[str]:
    """Yield the declaration of a variable as an attribute of the environment.

    Inputs of the component are outputs of the environment, and vice versa.
    """
    kinds = {BooleanDomain: "Boolean", EnumerationDomain: quote_name(f"values of {variable.name}")}
    kind = kinds.get(type(variable.domain), "Integer")
    side = "out" if variable.owner is Owner.ENVIRONMENT else "in"
    value = "" if initial_value is None else f" := {_print_sysml_literal(variable, initial_value)}"
    element = qualified_name(variable.origin)
    if element:
        comment = format_comment(f"{variable.name} is {element}")
        yield from (f"        {line}" for line in comment)
    yield f"        {side} attribute {quote_name(variable.name)} : {kind}{value};"
    if isinstance(variable.domain, IntegerDomain):
        name, domain = quote_name(variable.name), variable.domain
        bounds = f"{domain.low} <= {name} and {name} <= {domain.high}"
        yield f"        assert constraint {{ {bounds} }}"


def _print_state_machine(machine: CounterStrategy) -> Iterator[str]:
    yield "        exhibit state wins {"
    yield "            entry; then S0;"
    for number, state in enumerate(machine.states):
        yield f"            state S{number} {{"
        yield "                entry action {"
        for variable, value in zip(machine.inputs, state.inputs, strict=True):
            assignment = f"{quote_name(variable.name)} := {_print_sysml_literal(variable, value)}"
            yield f"                    assign {assignment};"
        yield "                }"
        yield "            }"
    for number, state in enumerate(machine.states):
        for successor, rows, other_rows in _iter_successors(state):
            guard = " or ".join(_print_guards(rows, other_rows, machine.outputs))
            condition = "" if guard == "true" else f" if {guard}"
            yield f"            transition first S{number}{condition} then S{successor};"
    yield "        }"


def _print_guards(
    rows: Sequence[Row], other_rows: Sequence[Row], outputs: Sequence[Variable]
) -> Iterator[str]:
    for row, columns in _distinguish_rows(rows, other_rows):
        comparisons = (
            f"{quote_name(outputs[i].name)} == {_print_sysml_literal(outputs[i], row[i])}"
            for i in columns
        )
        yield " and ".join(comparisons) or "true"


def _print_sysml_literal(variable: Variable, value: Literal) -> str:
    if isinstance(variable.domain, EnumerationDomain):
        return f"{quote_name(f'values of {variable.name}')}::{quote_name(str(value))}"
    return print_literal(value)


def counterstrategy_files(
    machines: Iterable[tuple[CounterStrategy, Contract]], qualified_name: QualifiedNames
) -> Iterator[tuple[str, str]]:
    """Yield names and texts of all files; only small machines have a state diagram."""
    machines_by_component = {
        contract.component: (machine, contract) for machine, contract in machines
    }
    for component, name in assign_file_names(machines_by_component).items():
        machine, contract = machines_by_component[component]
        if len(machine.states) <= MAX_DIAGRAM_STATES:
            yield f"{name}.counter.puml", _draw_states(machine, contract)
        yield f"{name}.counter-run.puml", _draw_losing_run(machine, contract)
        yield f"{name}.counter.sysml", _write_sysml(machine, contract, qualified_name)
