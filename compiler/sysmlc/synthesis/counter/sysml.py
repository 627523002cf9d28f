"""Counter-strategies as SysML v2 text: a part with a state machine, on the author's elements."""

from collections.abc import Callable, Iterator, Sequence

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
from sysmlc.synthesis.counter.drawing import by_next, told
from sysmlc.synthesis.counter.machine import Counter, Row

Named = Callable[[str], str]
"""The qualified name of the element with an id; empty when there is none."""


def text(counter: Counter, contract: Contract, named: Named) -> str:
    """The environment as a part with a state machine, in SysML v2."""
    component = contract.component
    lines = [
        f"package {_quoted(f'What makes {component} fail')} {{",
        "    private import ScalarValues::*;",
        f"    doc /* {_comment(f'Made by sysmlc: the environment in which {component} fails.')} */",
    ]
    for variable in (*counter.inputs, *counter.outputs):
        lines += _enumeration(variable)
    lines.append("    part def Environment {")
    first = dict(zip((one.name for one in counter.inputs), counter.states[0].given, strict=True))
    for variable in contract.variables:
        lines += _attribute(variable, first.get(variable.name), named)
    lines += [*_machine(counter), "    }", "}", ""]
    return "\n".join(lines)


def _enumeration(variable: Variable) -> Iterator[str]:
    if isinstance(variable.domain, EnumerationDomain):
        yield f"    enum def {_quoted(f'values of {variable.name}')} {{"
        yield from (f"        enum {_quoted(one)};" for one in variable.domain.literals)
        yield "    }"


def _attribute(variable: Variable, first: Literal | None, named: Named) -> Iterator[str]:
    """What the environment gives is its output, what the component answers its input."""
    kinds = {BooleanDomain: "Boolean", EnumerationDomain: _quoted(f"values of {variable.name}")}
    kind = kinds.get(type(variable.domain), "Integer")
    side = "out" if variable.owner is Owner.ENVIRONMENT else "in"
    value = "" if first is None else f" := {_literal(variable, first)}"
    element = named(variable.origin)
    if element:
        yield f"        /* {_comment(f'{variable.name} is {element}')} */"
    yield f"        {side} attribute {_quoted(variable.name)} : {kind}{value};"
    if isinstance(variable.domain, IntegerDomain):
        name, domain = _quoted(variable.name), variable.domain
        bounds = f"{domain.low} <= {name} and {name} <= {domain.high}"
        yield f"        assert constraint {{ {bounds} }}"


def _machine(counter: Counter) -> Iterator[str]:
    yield "        exhibit state wins {"
    yield "            entry; then S0;"
    for number, state in enumerate(counter.states):
        yield f"            state S{number} {{"
        yield "                entry action {"
        for variable, value in zip(counter.inputs, state.given, strict=True):
            said = f"{_quoted(variable.name)} := {_literal(variable, value)}"
            yield f"                    assign {said};"
        yield "                }"
        yield "            }"
    for number, state in enumerate(counter.states):
        for place, rows in by_next(state).items():
            others = [row for row, other in state.moves.items() if other != place]
            guard = " or ".join(_guards(rows, others, counter.outputs))
            condition = "" if guard == "true" else f" if {guard}"
            yield f"            transition first S{number}{condition} then S{place};"
    yield "        }"


def _guards(
    rows: Sequence[Row], others: Sequence[Row], outputs: Sequence[Variable]
) -> Iterator[str]:
    for row, kept in told(rows, others):
        said = [f"{_quoted(outputs[at].name)} == {_literal(outputs[at], row[at])}" for at in kept]
        yield " and ".join(said) or "true"


def _literal(variable: Variable, value: Literal) -> str:
    if isinstance(variable.domain, EnumerationDomain):
        return f"{_quoted(f'values of {variable.name}')}::{_quoted(str(value))}"
    return print_literal(value)


def _quoted(name: str) -> str:
    """An unrestricted name (KerML 1.0, 8.2.2.3)."""
    return "'" + name.replace("\\", "\\\\").replace("'", "\\'") + "'"


def _comment(text: str) -> str:
    return text.replace("*/", "* /")
