"""Counter-strategies as PlantUML diagrams: what the environment does, and a run."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

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
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.plantuml_text import label
from sysmlc.synthesis.counterstrategy import counter_files as drawing
from sysmlc.synthesis.counterstrategy import counter_files as sysml
from sysmlc.synthesis.counterstrategy.counter_machine import (
    CounterStrategy,
    Row,
    State,
    example_run,
)
from sysmlc.synthesis.witnesses import Party, print_temporal, run_diagram

MAX_DIAGRAM_STATES = 12
"""States up to which a diagram can be read."""
_MAX_LABEL_LINES = 4
"""Conditions that an arrow tells one by one."""


def losing_run_diagram(counter: CounterStrategy, contract: Contract) -> str:
    """A run in which the component does what it may, and fails, as a sequence diagram."""
    title, trace = (
        [f"{label(contract.component)}", "cannot keep its contract"],
        example_run(counter),
    )
    if trace.loop < len(trace.steps):
        some = "not kept" if len(counter.missed) == 1 else "not all kept"
        title += [f"{some}: {label(print_temporal(one))}" for one in counter.missed]
    return run_diagram("\\n".join(title), trace, (Party(contract.component, contract),))


def state_diagram(counter: CounterStrategy, contract: Contract) -> str:
    """The environment as a state diagram: in a state what it gives, on an arrow what is answered.

    Inputs that are the same in all states are told once.
    """
    same = _constant_columns([state.given for state in counter.states])
    lines = [
        "@startuml",
        f"title what makes {label(contract.component)} fail",
        "hide empty description",
    ]
    if same:
        lines += [
            "note as same",
            f"  always {_print_values(counter.inputs, counter.states[0].given, same)}",
        ]
        lines += ["end note"]
    varying = [at for at in range(len(counter.inputs)) if at not in same]
    for number, state in enumerate(counter.states):
        given = _print_values(counter.inputs, state.given, varying)
        ending = "" if state.moves else "\\n<b>no answer is left</b>"
        lines.append(f'state "{label(given or "wait")}{ending}" as S{number}')
    lines.append("[*] --> S0")
    for number, state in enumerate(counter.states):
        for place, words in _list_arrows(state, counter.outputs):
            answers = "\\n".join(map(label, words))
            lines.append(f"S{number} --> S{place} : {answers}")
    return "\n".join((*lines, "@enduml", ""))


def _list_arrows(state: State, outputs: Sequence[Variable]) -> Iterator[tuple[int, list[str]]]:
    """The next states, each with the answers that lead there."""
    if len(state.moves) == 1:
        ((row, place),) = state.moves.items()
        yield place, [f"only {_print_values(outputs, row, range(len(row)))}"]
        return
    for place, rows in group_by_successor(state).items():
        others = [row for row, other in state.moves.items() if other != place]
        words = [
            " ".join(one) or "any answer" for one in _describe_conditions(rows, others, outputs)
        ]
        yield (
            place,
            words
            if len(words) <= _MAX_LABEL_LINES
            else [*words[: _MAX_LABEL_LINES - 1], "or more"],
        )


def group_by_successor(state: State) -> Mapping[int, list[Row]]:
    found: dict[int, list[Row]] = {}
    for row, place in state.moves.items():
        found.setdefault(place, []).append(row)
    return found


def _describe_conditions(
    rows: Sequence[Row], others: Sequence[Row], variables: Sequence[Variable]
) -> Iterator[list[str]]:
    """What rows have in common and none of the others has, in as few words as is simple."""
    for row, kept in distinguish_rows(rows, others):
        yield [f"{variables[at].name}={print_literal(row[at])}" for at in kept]


def distinguish_rows(rows: Sequence[Row], others: Sequence[Row]) -> Iterator[tuple[Row, list[int]]]:
    """Rows with the places that tell them from all others; each stands for all that agree there."""
    left = list(rows)
    while left:
        row, kept = left[0], list(range(len(left[0])))
        for place in list(kept):
            fewer = [one for one in kept if one != place]
            if not any(_agree_at(row, other, fewer) for other in others):
                kept = fewer
        yield row, kept
        left = [one for one in left if not _agree_at(row, one, kept)]


def _agree_at(one: Row, other: Row, places: Iterable[int]) -> bool:
    return all(one[place] == other[place] for place in places)


def _constant_columns(rows: Sequence[Row]) -> list[int]:
    """The places at which all rows agree; none when there is one row."""
    if len(rows) < 2:
        return []
    return [at for at in range(len(rows[0])) if all(row[at] == rows[0][at] for row in rows)]


def _print_values(variables: Sequence[Variable], row: Row, places: Iterable[int]) -> str:
    return ", ".join(f"{variables[at].name}={print_literal(row[at])}" for at in places)


QualifiedNames = Callable[[str], str]
"""The qualified name of the element with an id; empty when there is none."""


def sysml_text(counter: CounterStrategy, contract: Contract, named: QualifiedNames) -> str:
    """The environment as a part with a state machine, in SysML v2."""
    component = contract.component
    lines = [
        f"package {_quote_name(f'What makes {component} fail')} {{",
        "    private import ScalarValues::*;",
        f"    doc /* {_escape_comment(f'Made by sysmlc: the environment in which {component} fails.')} */",
    ]
    for variable in (*counter.inputs, *counter.outputs):
        lines += _declare_enumeration(variable)
    lines.append("    part def Environment {")
    first = dict(zip((one.name for one in counter.inputs), counter.states[0].given, strict=True))
    for variable in contract.variables:
        lines += _declare_attribute(variable, first.get(variable.name), named)
    lines += [*_print_state_machine(counter), "    }", "}", ""]
    return "\n".join(lines)


def _declare_enumeration(variable: Variable) -> Iterator[str]:
    if isinstance(variable.domain, EnumerationDomain):
        yield f"    enum def {_quote_name(f'values of {variable.name}')} {{"
        yield from (f"        enum {_quote_name(one)};" for one in variable.domain.literals)
        yield "    }"


def _declare_attribute(
    variable: Variable, first: Literal | None, named: QualifiedNames
) -> Iterator[str]:
    """What the environment gives is its output, what the component answers its input."""
    kinds = {BooleanDomain: "Boolean", EnumerationDomain: _quote_name(f"values of {variable.name}")}
    kind = kinds.get(type(variable.domain), "Integer")
    side = "out" if variable.owner is Owner.ENVIRONMENT else "in"
    value = "" if first is None else f" := {_print_sysml_literal(variable, first)}"
    element = named(variable.origin)
    if element:
        yield f"        /* {_escape_comment(f'{variable.name} is {element}')} */"
    yield f"        {side} attribute {_quote_name(variable.name)} : {kind}{value};"
    if isinstance(variable.domain, IntegerDomain):
        name, domain = _quote_name(variable.name), variable.domain
        bounds = f"{domain.low} <= {name} and {name} <= {domain.high}"
        yield f"        assert constraint {{ {bounds} }}"


def _print_state_machine(counter: CounterStrategy) -> Iterator[str]:
    yield "        exhibit state wins {"
    yield "            entry; then S0;"
    for number, state in enumerate(counter.states):
        yield f"            state S{number} {{"
        yield "                entry action {"
        for variable, value in zip(counter.inputs, state.given, strict=True):
            said = f"{_quote_name(variable.name)} := {_print_sysml_literal(variable, value)}"
            yield f"                    assign {said};"
        yield "                }"
        yield "            }"
    for number, state in enumerate(counter.states):
        for place, rows in group_by_successor(state).items():
            others = [row for row, other in state.moves.items() if other != place]
            guard = " or ".join(_print_guards(rows, others, counter.outputs))
            condition = "" if guard == "true" else f" if {guard}"
            yield f"            transition first S{number}{condition} then S{place};"
    yield "        }"


def _print_guards(
    rows: Sequence[Row], others: Sequence[Row], outputs: Sequence[Variable]
) -> Iterator[str]:
    for row, kept in distinguish_rows(rows, others):
        said = [
            f"{_quote_name(outputs[at].name)} == {_print_sysml_literal(outputs[at], row[at])}"
            for at in kept
        ]
        yield " and ".join(said) or "true"


def _print_sysml_literal(variable: Variable, value: Literal) -> str:
    if isinstance(variable.domain, EnumerationDomain):
        return f"{_quote_name(f'values of {variable.name}')}::{_quote_name(str(value))}"
    return print_literal(value)


def _quote_name(name: str) -> str:
    """An unrestricted name (KerML 1.0, 8.2.2.3)."""
    return "'" + name.replace("\\", "\\\\").replace("'", "\\'") + "'"


def _escape_comment(text: str) -> str:
    return text.replace("*/", "* /")


def counterstrategy_files(
    made: Iterable[tuple[CounterStrategy, Contract]], named: sysml.QualifiedNames
) -> Iterator[tuple[str, str]]:
    """Name and text of the files of counter-strategies; small ones have a diagram of states."""
    known = {contract.component: (counter, contract) for counter, contract in made}
    for component, name in assign_file_names(known).items():
        counter, contract = known[component]
        if len(counter.states) <= drawing.MAX_DIAGRAM_STATES:
            yield f"{name}.counter.puml", drawing.state_diagram(counter, contract)
        yield f"{name}.counter-run.puml", drawing.losing_run_diagram(counter, contract)
        yield f"{name}.counter.sysml", sysml.sysml_text(counter, contract, named)
